"""A lone grain under kernels of the coupling that are narrower or wider than the fluid's: linear theory (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))
sys.path.insert(0, str(HERE))

import lattice_wake  # noqa: E402
from theory import self_disturbance, self_disturbance_history, settling, sph_operators  # noqa: E402
from theory.lone_grain import OwnVolume, backflow, by_law, law_of, terminal_speed  # noqa: E402
from theory.released_sphere import Sphere  # noqa: E402

UNITS = {"off_theory": "1", "off_law": "1", "law_met": "1", "theory_met": "1", "edge": "1", "edge_ratio": "1"}
MOST = 0.005  # a corrected grain may be off the law by, of u_t
SHARE, FLOOR, EARLIEST = 0.10, 0.005, 5.0  # of the wake, of u_t; in tau_p
SMOOTHING = 1.5  # h over the spacing


class Setting(NamedTuple):
    """Of the scene as it is meant (two-way, one width for all of the coupling); `width` = kernel width over h; hashable."""

    rho: float
    mu: float
    rho_p: float
    d: float
    kernel: str
    h: float
    width: float
    c: float
    box: tuple
    end: float

    @property
    def tau(self):
        return settling.relaxation_time(self.rho_p, self.d, self.mu)

    @property
    def volume(self):
        return math.pi / 6.0 * self.d**3

    @property
    def scheme(self):
        coupling = self_disturbance.Smoothing(self.kernel, self.width * self.h)
        return self_disturbance.Scheme(coupling, coupling, self_disturbance.Smoothing(self.kernel, self.h))


def setting(scene):
    fluid, grain = scene["fluid"], scene["grains"]
    return Setting(fluid["density"], fluid["viscosity"], grain["density"], grain["diameter"], fluid["kernel"], fluid["smoothing"] * fluid["spacing"],
                   scene["coupling"]["kernel_width"]["times_smoothing"], fluid["sound_speed"], tuple(scene["domain"]["size"]), scene["time"]["end"])


@lru_cache(maxsize=None)
def settled(s, times):
    """(v, u_self), m/s, downwards, of the uncorrected scheme."""
    modes = self_disturbance.box_modes(s.scheme, s.box, reach=14.0)
    eps = 1.0 - self_disturbance.own_volume_fraction(s.scheme, s.d)
    grain = OwnVolume(law_of(eps), s.rho_p, s.d, s.rho, s.mu)
    grain.b, grain.share_of_box = backflow(s.scheme, modes, s), s.volume / math.prod(s.box)
    found = self_disturbance_history.plain_settling(grain, s.scheme, modes, np.array(times), "slip", stress=True)
    return found.v / (1.0 + grain.b), found.u_self


def lattice_noise(s):
    """Equation (2): what sums over the lattice may differ from integrals by, relative."""
    return 6.0 * abs(float(sph_operators.transform(s.kernel, 3, 2.0 * math.pi * SMOOTHING * s.width)))


@lru_cache(maxsize=None)
def missed(s, at):
    """(over the bound of the law, over that of the theory): what lattice and correction or theory disagree on, equation (5)."""
    found = lattice_wake.felt(s, s.h / SMOOTHING, at, terminal_speed(s))
    times = found.t[5::6]
    _, u = settled(s, tuple(times))
    modes = self_disturbance.box_modes(s.scheme, s.box, reach=14.0)
    u_t, ramp = terminal_speed(s), 1.0 - np.exp(-times / s.tau)
    between = followed(times / s.tau, found.u[5::6] - (u - backflow(s.scheme, modes, s) * u_t * ramp))
    own = self_disturbance.own_volume_fraction(s.scheme, s.d)  # which the correction puts back, up to eps = 1
    speeds = [law_speed(s, eps) for eps in (1.0 - own, 1.0 - found.own, min(1.0, 1.0 + own - found.own))]
    corrected = np.abs(between + speeds[2] - u_t)[times > EARLIEST * s.tau]
    plain = np.abs(between + speeds[1] - speeds[0])
    return float(corrected.max()) / (MOST * u_t), float(np.max(plain / np.maximum(SHARE * u, FLOOR * u_t)))


def followed(t, u):
    """What a grain makes of a velocity of the fluid: dv/dt = u - v from rest, t in relaxation times; u straight between the times."""
    v, last, speed = np.zeros(len(t)), 0.0, 0.0
    for n, (step, now) in enumerate(zip(np.diff(t, prepend=0.0), u)):
        left = math.exp(-step)
        slope = (now - last) / step
        speed = now - slope + (speed - last + slope) * left
        v[n], last = speed, now
    return v


def law_speed(s, eps):
    return Sphere(law_of(eps), s.rho_p, s.d, s.rho, s.mu).terminal_speed()


def predicted_edge(s, at, kind):
    """Width over h at which `missed` is one: the grain's own lattice, no constant."""
    low, high = 0.55, 1.1  # to 0.5 %
    for _ in range(7):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if missed(s._replace(width=middle), at)[kind] > 1.0 else (low, middle)
    return math.sqrt(low * high)


def kind_of(run):
    return 0 if "corrected" in run.variant else 1


def place(run):
    return tuple(run.scene["grains"]["arrange"]["position"])


def fall(run):
    t, v = run.series("v")
    return t[1:], -np.ravel(v)[1:]


def off_law(run):
    """Greatest distance from the drag law over u_t, from 5 tau_p on."""
    s, (t, v) = setting(run.scene), fall(run)
    law = by_law(s, t)
    return float(np.max(np.abs(v - law)[t > EARLIEST * s.tau * (1.0 - 1e-9)])) / terminal_speed(s)


def off_theory(run):
    """Greatest distance from linear theory without a lattice over its bound."""
    s, (t, v) = setting(run.scene), fall(run)
    expected, u = settled(s, tuple(t))
    return float(np.max(np.abs(v - expected) / np.maximum(SHARE * u, FLOOR * terminal_speed(s))))


def edge(run):
    """Width of a bisected variant between which and the next narrower one the bound is crossed: the bisection's "unstable" is "met"."""
    return math.sqrt(run.stable * run.unstable)


def measure(quantity, run):
    if quantity == "off_law":
        return off_law(run)
    if quantity == "off_theory":
        return off_theory(run)
    if quantity == "law_met":
        return MOST / off_law(run)
    if quantity == "theory_met":
        return 1.0 / off_theory(run)
    if quantity == "edge":
        return edge(run)
    if quantity == "edge_ratio":
        return edge(run) / predicted_edge(setting(run.scene), place(run), kind_of(run))
    return NotImplemented


def reference(quantity, scene, t):
    return 0.0


# --- the page ---


def done(runs):
    return [run for run in runs if not run.failure and not run.variant.startswith("edge")]


def edges(runs):
    return [run for run in runs if run.variant.startswith("edge") and getattr(run, "stable", None) and getattr(run, "unstable", None)]


def edge_figure(runs):
    """Narrowest width that keeps the bound, over h/d: bisected, and predicted."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    ratios = (1.5, 2.0, 2.5, 3.0, 4.0, 5.0)
    for kind, (name, colour) in enumerate((("corrected, within 0.5 % of the law", "C0"), ("plain, on the theory without a lattice", "C1"))):
        chosen = [run for run in edges(runs) if kind_of(run) == kind]
        seen = []
        for run in chosen:
            s = setting(run.scene)
            seen.append((s.h / s.d, predicted_edge(s, place(run), kind)))
            axes.plot([s.h / s.d] * 2, [run.stable, run.unstable], "-", color=colour, lw=3, alpha=0.5)
            axes.plot(s.h / s.d, edge(run), "o", color=colour, ms=4, label=name if run is chosen[0] else None)
        if seen:
            axes.plot(*zip(*sorted(seen)), "k--" if kind == 0 else "k:", lw=1, label="predicted, (3) to (5)")
    axes.axhline(1.0 / SMOOTHING, color="0.6", lw=0.8)
    axes.annotate("one spacing", (ratios[0], 1.0 / SMOOTHING), fontsize="x-small", va="bottom")
    axes.axhline(1.0, color="0.6", lw=0.8, ls="--")
    axes.annotate("as published, and plumb_grains", (ratios[0], 1.0), fontsize="x-small", va="bottom")
    axes.set(xlabel="h/d", ylabel="kernel width of the coupling over h", ylim=(0.5, 1.15), xlim=(1.4, 4.6))
    axes.legend(fontsize="x-small")
    return figure


def table(runs):
    rows = []
    for run in done(runs):
        s, (t, v) = setting(run.scene), fall(run)
        u_t, (expected, u) = terminal_speed(s), settled(s, tuple(t))
        rows.append([run.variant, f"{s.h / s.d:g}", f"{s.width:g}", f"{100 * (v[-1] / u_t - 1):.2f}", f"{100 * (expected[-1] / u_t - 1):.2f}",
                     f"{100 * u[-1] / u_t:.2f}", f"{100 * off_law(run):.2f}", f"{100 * lattice_noise(s):.2f}"])
    return {"columns": ["run", "h/d", "kernel width/h", "error at the end (%)", "theory, plain (%)", "of it the wake (%)", "greatest from 5 tau_p (%)",
                        "lattice (2) (%)"], "rows": rows, "caption": "Speed against the drag law's at porosity 1."}


def figures(runs):
    from matplotlib.figure import Figure

    every, runs = runs, done(runs)
    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    widths = np.geomspace(0.4, 2.2, 10)
    for n, h_d in enumerate((2, 3, 4)):
        plain = sorted((r for r in runs if r.variant.startswith(f"plain_h{h_d}")), key=lambda r: setting(r.scene).width)
        corrected = sorted((r for r in runs if r.variant.startswith(f"corrected_h{h_d}")), key=lambda r: setting(r.scene).width)
        if plain:
            s = setting(plain[0].scene)
            curve = [settled(s._replace(width=a), (s.end,))[0][-1] / terminal_speed(s) - 1.0 for a in widths]
            left.plot(widths, 100.0 * np.array(curve), "-", color=f"C{n}", lw=0.8)
            left.plot([setting(r.scene).width for r in plain], [100.0 * (fall(r)[1][-1] / terminal_speed(s) - 1.0) for r in plain], "o", ms=4, mfc="none",
                      color=f"C{n}", label=f"h/d = {h_d}")
        if corrected:
            s = setting(corrected[0].scene)
            wake = [lattice_noise(s._replace(width=a)) * settled(s._replace(width=a), (s.end,))[1][-1] / terminal_speed(s) for a in widths]
            right.plot(widths, 100.0 * np.array(wake), ":", color=f"C{n}", lw=0.8)
            right.plot([setting(r.scene).width for r in corrected], [100.0 * off_law(r) for r in corrected], "o-", ms=4, mfc="none", lw=0.6, color=f"C{n}",
                       label=f"h/d = {h_d}")
    right.axhline(0.5, color="k", lw=0.8)
    left.axhline(0.0, color="0.7", lw=0.6)
    left.set(title="plain, after 20 tau_p (lines: theory)", xlabel="kernel width of the coupling over h (-)", ylabel="error of the settling velocity (%)")
    right.set(title="corrected, from 5 tau_p on (dotted: (2) times the wake)", xlabel="kernel width of the coupling over h (-)", ylabel="|error| (%)",
              yscale="log", ylim=(0.01, 30.0))
    for axes in (left, right):
        axes.legend(fontsize="small")
    found = [("map", figure, "Error of a lone grain's speed over the width of the coupling's kernel.")]
    if edges(every):
        found.append(("edges", edge_figure(every), "Narrowest kernel that keeps the bound: between the ends of each bar, bisected; lines: linear theory on the lattice."))
    return found
