"""A lone grain on a grid: carried by its own wake as linear theory of the grid says, and corrected as its drag law says (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import grid_wake, self_disturbance, self_disturbance_history, settling  # noqa: E402
from theory.lone_grain import OwnVolume, by_law, fall, from_rest, law_of, terminal_speed  # noqa: E402

UNITS = {"off_theory": "1", "off_plain_law": "1", "off_law": "1"}
SHARE, FLOOR = 0.10, 0.005  # of the disturbance, of u_t: the larger of both is the bound
EARLIEST = 5.0  # tau_p: from here on one-way and corrected runs are compared


class Setting(NamedTuple):
    """What the theory needs of a scene; hashable."""

    two_way: bool
    corrected: bool
    rho: float
    mu: float
    rho_p: float
    d: float
    kernel: str
    width: float
    cell: float
    box: tuple
    end: float

    @property
    def tau(self):
        return settling.relaxation_time(self.rho_p, self.d, self.mu)

    @property
    def volume(self):
        return math.pi / 6.0 * self.d**3


def setting(scene):
    """Of the scene as it is meant: direction, drag law and own volume are the case's, which a twin may break. Where a gradient balances the
    weight the run is meant to be two-way."""
    fluid, grain, coupling = scene["fluid"], scene["grains"], scene["coupling"]
    width = coupling["kernel_width"]
    width = width["times_diameter"] * grain["diameter"] if isinstance(width, dict) else width
    return Setting(coupling["mean_pressure_gradient"] != [0.0, 0.0, 0.0], coupling["self_disturbance"] != "none",
                   fluid["density"], fluid["viscosity"], grain["density"], grain["diameter"],
                   coupling["kernel"], width, fluid["spacing"], tuple(scene["domain"]["size"]), scene["time"]["end"])


@lru_cache(maxsize=None)
def settled(s, times):
    """(v, u_self), m/s, downwards, at the times (increasing, > 0) of the uncorrected scheme."""
    scheme = grid_wake.GridScheme(s.kernel, s.width, s.cell)
    modes = grid_wake.box_modes(scheme, s.box)
    eps = 1.0 - grid_wake.own_volume_fraction(modes, s.d)
    grain = OwnVolume(law_of(eps), s.rho_p, s.d, s.rho, s.mu)
    if s.two_way:
        grain.b = grid_wake.backflow(modes, s.d)
        grain.share_of_box = s.volume / math.prod(s.box)
    else:  # the fluid does not feel the grain, nor its room
        modes = modes._replace(share=0.0 * modes.share)
    memory = grid_wake.Memory(modes, scheme, self_disturbance.Fluid(s.rho, s.mu))
    found = self_disturbance_history.plain_settling(grain, scheme, modes, np.array(times), "slip", stress=s.two_way, memory=memory)
    return found.v / (1.0 + grain.b), found.u_self


def theory(s, t):
    """The same at times t that may begin with 0."""
    return from_rest(settled, s, t)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    s, (t, v) = setting(run.scene), fall(run)
    u_t = terminal_speed(s)
    late = t > EARLIEST * s.tau * (1.0 - 1e-4)
    if quantity == "off_law":
        return float(np.max(np.abs(v - by_law(s, t))[late])) / u_t
    expected, u = theory(s, t)
    if quantity == "off_theory":  # over the bound
        return float(np.max(np.abs(v - expected) / np.maximum(SHARE * u, FLOOR * u_t)))
    return float(np.max(np.abs(v[late] / expected[late] - 1.0)))


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0
    raise KeyError(quantity)


# --- the page ---

FLUIDS = {"glycerol": ("C0", "glycerol-water"), "water": ("C3", "water"), "air": ("C4", "air")}  # colour, label


def fluid_of(run):
    return next(name for name in FLUIDS if run.variant.startswith(name))


def table(runs):
    rows = []
    for run in runs:
        s, (t, v) = setting(run.scene), fall(run)
        u_t = terminal_speed(s)
        expected, u = theory(s, t)
        law = by_law(s, t)
        at = int(np.argmin(np.abs(t - s.end)))
        late = t > EARLIEST * s.tau * (1.0 - 1e-4)
        worst = np.max(np.abs(v - law)[late]) / u_t if s.corrected else np.max(np.abs(v - expected)) / u_t
        rows.append([run.variant, f"{s.width / s.d:g}", f"{s.cell / s.d:g}", f"{run.scene['time']['step'] / s.tau:.3g}", f"{t[at] / s.tau:.0f}",
                     f"{v[at] / u_t:.4f}", f"{(law if s.corrected else expected)[at] / u_t:.4f}", f"{u[at] / u_t:.4f}", f"{worst:.4f}"])
    return {"columns": ["run", "width/d", "cell/d", "step/tau_p", "end/tau_p", "v/u_t", "theory, or law", "wake by theory", "greatest distance"], "rows": rows,
            "caption": "Speeds over u_t of Di Felice's law at porosity 1, at the end; the greatest distance from the theory, or, corrected, from the law's relaxation (5 tau_p on)."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    for fluid, (colour, label) in FLUIDS.items():
        chosen = [(setting(run.scene), run) for run in runs if fluid_of(run) == fluid and setting(run.scene).two_way]
        plain = [(s, run) for s, run in chosen if not s.corrected]
        for s, run in plain:
            t, v = fall(run)
            u_t = terminal_speed(s)
            after = t > 1.5 * s.tau
            name = f"{label}, {s.width / s.d:g} d, cells {s.cell / s.d:g} d"
            line = left.plot(t[after] / s.tau, 100.0 * (theory(s, t)[0][after] / u_t - 1.0), "-", lw=1.0)[0]
            left.plot(t[after] / s.tau, 100.0 * (v[after] / u_t - 1.0), "o", ms=3.0, mfc="none", color=line.get_color(), label=name)
        out = [(s, run) for s, run in chosen if s.corrected]
        marks = [(s.width / s.d, 100.0 * measure("off_law", run)) for s, run in out]
        if marks:
            right.plot(*zip(*marks), "o", color=colour, ms=5, mfc="none", label=label)
    right.plot([0.9, 1.5, 1.5, 4.3], [5.0, 5.0, 1.0, 1.0], "k-", lw=0.8, label="bound")
    left.set(title="not corrected (lines: theory)", xlabel="t/τ_p (-)", ylabel="error of v (%)", xscale="log", ylim=(-8.0, None))
    right.set(title="corrected: greatest error from 5 τ_p on", xlabel="width/d (-)", ylabel="|error| (%)", yscale="log", ylim=(0.005, 30.0))
    for axes in (left, right):
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize=6)
    return [("single_grain_grid", figure, "Speed of a lone two-way coupled grain on a grid against its drag law's terminal one. Left: not corrected, over "
             "time; right: with its own disturbance taken out.")]
