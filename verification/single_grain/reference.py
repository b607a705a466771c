"""A grain carried by its own wake: linear theory of the two-way coupled scheme, without correction (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import self_disturbance, self_disturbance_history, settling  # noqa: E402
from theory.lone_grain import OwnVolume, backflow, by_law, fall, from_rest, law_of, terminal_speed  # noqa: E402

UNITS = {"off_theory": "1", "off_plain_law": "1", "off_law": "1"}
SHARE, FLOOR = 0.10, 0.005  # of the disturbance, of u_t: the larger of both is the bound
REACH = 14.0  # k h of the greatest wave: beyond, the product of the filters is below 1e-6
EARLIEST = 5.0  # tau_p: from here on the one-way and the corrected runs are compared


class Setting(NamedTuple):
    """What the theory needs of a scene; hashable."""

    two_way: bool
    corrected: bool
    rho: float
    mu: float
    rho_p: float
    d: float
    kernel: str
    h: float
    c: float
    box: tuple
    end: float

    @property
    def tau(self):
        return settling.relaxation_time(self.rho_p, self.d, self.mu)

    @property
    def volume(self):
        return math.pi / 6.0 * self.d**3


def setting(scene):
    """Of the scene as it is meant: direction, coupling width, drag law and viscous operator are the case's, which a twin may break.
    Where a gradient balances the weight the run is meant to be two-way."""
    fluid, grain = scene["fluid"], scene["grains"]
    return Setting(scene["coupling"]["mean_pressure_gradient"] != [0.0, 0.0, 0.0],
                   scene["coupling"].get("self_disturbance", "none") != "none",
                   fluid["density"], fluid["viscosity"], grain["density"], grain["diameter"], fluid["kernel"],
                   fluid["smoothing"] * fluid["spacing"], fluid["sound_speed"], tuple(scene["domain"]["size"]), scene["time"]["end"])


@lru_cache(maxsize=None)
def settled(s, times):
    """(v, u_self), m/s, downwards, at the times (increasing, > 0) of the uncorrected scheme."""
    scheme = self_disturbance.one_kernel(s.kernel, s.h)
    modes = self_disturbance.box_modes(scheme, s.box, reach=REACH)
    eps = 1.0 - self_disturbance.own_volume_fraction(scheme, s.d)
    grain = OwnVolume(law_of(eps), s.rho_p, s.d, s.rho, s.mu)
    grain.b = backflow(scheme, modes, s)
    if s.two_way:
        grain.share_of_box = s.volume / math.prod(s.box)
    else:
        modes = modes._replace(share=0.0 * modes.share)
    found = self_disturbance_history.plain_settling(grain, scheme, modes, np.array(times), "slip", stress=s.two_way)
    return found.v / (1.0 + grain.b), found.u_self


def theory(s, t):
    """The same at times t that may begin with 0."""
    return from_rest(settled, s, t)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    s, (t, v) = setting(run.scene), fall(run)
    u_t = terminal_speed(s)
    if quantity == "off_law":
        return float(np.max(np.abs(v - by_law(s, t))[t > EARLIEST * s.tau * (1.0 - 1e-9)])) / u_t
    expected, u = theory(s, t)
    if quantity == "off_theory":  # over the bound
        return float(np.max(np.abs(v - expected) / np.maximum(SHARE * u, FLOOR * u_t)))
    late = t > EARLIEST * s.tau * (1.0 - 1e-9)
    return float(np.max(np.abs(v[late] / expected[late] - 1.0)))


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


# --- the page ---


def table(runs):
    rows = []
    for run in runs:
        s, (t, v) = setting(run.scene), fall(run)
        expected, u = theory(s, t)
        for multiple in (5, 10, 20, 50, 100):
            at = int(np.argmin(np.abs(t / s.tau - multiple)))
            if abs(t[at] / s.tau - multiple) < 0.02 * multiple:
                u_t = terminal_speed(s)
                rows.append([run.variant, f"{s.h / s.d:g}", multiple, f"{v[at] / u_t:.4f}", f"{expected[at] / u_t:.4f}", f"{u[at] / u_t:.4f}"])
    return {"columns": ["run", "h/d", "t/tau_p", "v/u_t", "theory", "of it the wake"], "rows": rows,
            "caption": "Speed over the terminal velocity of Di Felice's law at porosity 1."}


WIDTHS = {1.0: "C8", 1.5: "C4", 2.0: "C0", 3.0: "C1", 4.0: "C2", 5.0: "C6", 6.0: "C5"}  # h/d: colour
FLUIDS = {"glycerol": ("C0", "glycerol-water"), "water": ("C3", "water"), "hot_water": ("C1", "water, 60 °C"), "r134a": ("C2", "R134a"),
          "air": ("C4", "air")}  # colour, label


def fluid_of(run):
    return max((name for name in FLUIDS if run.variant.startswith(name)), key=len)


def figures(runs):
    from matplotlib.figure import Figure

    by_width = Figure(figsize=(10.0, 4.2), layout="constrained")
    left, right = by_width.subplots(1, 2)
    for fluid in FLUIDS:
        longest = _longest([run for run in runs if fluid_of(run) == fluid and setting(run.scene).two_way])
        _draw_plain(left, [run for run in longest if not setting(run.scene).corrected], fluid)
        _draw_corrected(right, [run for run in longest if setting(run.scene).corrected], fluid)
    for run in _longest([run for run in runs if not setting(run.scene).two_way]):
        s, (_, v) = setting(run.scene), fall(run)
        left.plot(s.h / s.d, _percent(s, v[-1]), "x", color=FLUIDS[fluid_of(run)][0], ms=5)
    left.plot([], [], "x", color="0.3", ms=5, label="one way")
    left.axhspan(-2.0, 2.0, color="0.9", zorder=0, label="claim of the slides, h > 2 d")
    left.set(title="not corrected: error at the end (lines: theory)", xlabel="h/d (-)", ylabel="error of the settling velocity (%)")
    right.plot([1.0, 2.0, 2.0, 6.3], [3.0, 3.0, 0.5, 0.5], "k-", lw=0.8, label="bound, liquids")
    right.plot([2.0, 6.3], [1.0, 1.0], "k--", lw=0.8, label="bound, air")
    right.set(title="corrected: greatest error from 5 τ_p on", xlabel="h/d (-)", ylabel="|error| (%)", yscale="log", ylim=(0.01, 30.0))
    for axes in (left, right):
        axes.legend(fontsize=7)
    histories = Figure(figsize=(10.0, 4.2), layout="constrained")
    for axes, fluid in zip(histories.subplots(1, 2), ("glycerol", "water")):
        for run in runs:
            if fluid_of(run) == fluid and setting(run.scene).two_way:
                _draw_history(axes, run)
        axes.axhspan(-2.0, 2.0, color="0.9", zorder=0)
        axes.set(title=FLUIDS[fluid][1], xlabel="t/τ_p (-)", ylabel="error of v (%)", xscale="log", ylim=(-8.0, 26.0))
        axes.legend(*_once(axes), fontsize=7)
    return [("error_by_width", by_width, "Settling velocity of one two-way coupled grain against its drag law, over the width h of the kernels. Left: not corrected; "
             "100 relaxation times in liquids, 6 in air."),
            ("error_in_time", histories, "Error of the speed against the terminal velocity of Di Felice's law. Open: not corrected; lines: theory; dots: corrected; "
             "grey: the 2 % of the slides' claim.")]


def _longest(runs):
    """Of runs with one width and correction the longest, by width."""
    best = {}
    for run in runs:
        s = setting(run.scene)
        key = (round(s.h / s.d, 3), s.corrected, s.rho, s.two_way)
        if key not in best or s.end > setting(best[key].scene).end:
            best[key] = run
    return [best[key] for key in sorted(best)]


def _draw_plain(axes, runs, fluid):
    if not runs:
        return
    colour, label = FLUIDS[fluid]
    s = [setting(run.scene) for run in runs]
    widths = [one.h / one.d for one in s]
    axes.plot(widths, [_percent(one, theory(one, fall(run)[0])[0][-1]) for one, run in zip(s, runs)], "-", color=colour, lw=1.0)
    axes.plot(widths, [_percent(one, fall(run)[1][-1]) for one, run in zip(s, runs)], "o", color=colour, mfc="none", label=label)


def _draw_corrected(axes, runs, fluid):
    colour, label = FLUIDS[fluid]
    widths = [setting(run.scene).h / setting(run.scene).d for run in runs]
    axes.plot(widths, [100.0 * measure("off_law", run) for run in runs], "o-", color=colour, lw=0.8, ms=5, label=label)


def _once(axes):
    """Handles and labels without repetition, in the order of the labels."""
    found = dict(sorted(zip(*reversed(axes.get_legend_handles_labels())), key=lambda pair: pair[0]))
    return list(found.values()), list(found)


def _percent(s, v):
    return 100.0 * (v / terminal_speed(s) - 1.0)


def _draw_history(axes, run):
    s, (t, v) = setting(run.scene), fall(run)
    width = round(s.h / s.d, 3)
    after = t > 1.5 * s.tau
    if s.corrected:
        axes.plot(t[after] / s.tau, _percent(s, v[after]), ".", color=WIDTHS[width], ms=3.0)
        return
    axes.plot(t[after] / s.tau, _percent(s, theory(s, t)[0][after]), "-", color=WIDTHS[width], lw=1.0)
    axes.plot(t[after] / s.tau, _percent(s, v[after]), "o", color=WIDTHS[width], ms=3.5, mfc="none", label=f"h/d = {width:g}")
