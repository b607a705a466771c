"""A lone grain under kernels of the coupling that are narrower or wider than the fluid's: linear theory (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import self_disturbance, self_disturbance_history, settling, sph_operators  # noqa: E402
from theory.lone_grain import OwnVolume, backflow, by_law, law_of, terminal_speed  # noqa: E402

UNITS = {"off_theory": "1", "off_law": "1"}
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


def fall(run):
    t, v = run.series("v")
    return t[1:], -np.ravel(v)[1:]


def off_law(run):
    """Greatest distance from the drag law over u_t, from 5 tau_p on."""
    s, (t, v) = setting(run.scene), fall(run)
    law = by_law(s, t)
    return float(np.max(np.abs(v - law)[t > EARLIEST * s.tau * (1.0 - 1e-9)])) / terminal_speed(s)


def measure(quantity, run):
    if quantity == "off_law":
        return off_law(run)
    if quantity == "off_theory":  # over the bound
        s, (t, v) = setting(run.scene), fall(run)
        expected, u = settled(s, tuple(t))
        return float(np.max(np.abs(v - expected) / np.maximum(SHARE * u, FLOOR * terminal_speed(s))))
    return NotImplemented


def reference(quantity, scene, t):
    return 0.0


# --- the page ---


def done(runs):
    return [run for run in runs if not run.failure]


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

    runs = done(runs)
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
    return [("map", figure, "Error of a lone grain's speed over the width of the coupling's kernel.")]
