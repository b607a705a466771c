"""Where the exchange of drag between grains and fluid stops being stable: the slip of a uniform bed (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import ergun  # noqa: E402
from theory import sph_operators  # noqa: E402

UNITS = {"slip": "1", "energy_growth": "1", "slip.boundary": "Pa s", "slip.stable": "Pa s", "slip.unstable": "Pa s",
         "friction_share": "1", "friction.stable": "1", "friction.unstable": "1", "friction.boundary": "1"}

# What a step of z = rate times dt leaves of the slip, as the solver documents it (plumb laws).
LEFT = {
    "exponential": lambda z: math.exp(-z),
    "implicit": lambda z: 1.0 / (1.0 + z + 0.5 * z * z),
    "explicit": lambda z: 1.0 - z + 0.5 * z * z,
}
GROWTH = 2.0  # of the slip, which ends the measurement


class Bed:
    """The scene's numbers: README, equations (1) and (2)."""

    def __init__(self, scene):
        fluid, grain, time = scene["fluid"], scene["grains"], scene["time"]
        self.d, self.mu, self.dt = grain["diameter"], fluid["viscosity"], time["step"]
        if self.dt == "auto":
            self.dt = math.nan
        self.parts = 1 if math.isnan(self.dt) else max(1, math.ceil(self.dt / time["grain_step"] * (1.0 - 1e-12)))
        self.steps = 0 if math.isnan(self.dt) else round(time["end"] / self.dt)
        self.exchange = scene["coupling"]["exchange"]
        self.tau_p = grain["density"] * self.d**2 / (18.0 * self.mu)
        if grain["arrange"]["law"] != "lattice":
            return
        phi = math.pi / 6.0 * (self.d / grain["arrange"]["spacing"]) ** 3
        self.eps = 1.0 - phi
        self.load = phi * grain["density"] / (self.eps * fluid["density"])
        if scene["coupling"]["drag"] == "ergun":
            self.tau_p /= self.eps * float(ergun(self.eps, 0.0))

    @property
    def z(self):
        """Relaxations of the slip in a step of the grains."""
        return (1.0 + self.load) * self.dt / (self.parts * self.tau_p)

    def left(self):
        """Slip over its start after 0, 1, ... steps of the fluid."""
        return LEFT[self.exchange](self.z) ** (self.parts * np.arange(self.steps + 1))

    def boundary(self):
        """The viscosity, Pa s, at which the slip of explicit exchange has grown by GROWTH at the end."""
        wanted = GROWTH ** (1.0 / (self.steps * self.parts))
        return self.mu * brentq(lambda z: LEFT[self.exchange](z) - wanted, 1.0, 10.0) / self.z


def reference(quantity, scene, t):
    if quantity == "slip":
        return Bed(scene).left()
    if quantity == "slip.boundary":
        return Bed(scene).boundary()
    raise KeyError(quantity)


def slip(run):
    """(t, mean velocity of grains less that of the fluid, over its start)."""
    (t, v), (_, u) = run.series("grains"), run.series("fluid")
    w = (v - u).ravel()
    return t, w / w[0]


def friction_share(run):
    """Step times the rate at which friction takes a fluid of this porosity's shear wave: README, equation (4)."""
    fluid, size = run.scene["fluid"], run.scene["domain"]["size"][0]
    k, h = 2.0 * math.pi * fluid["initial"]["waves"] / size, fluid["smoothing"] * fluid["spacing"]
    ratio = sph_operators.lattice_viscosity(fluid["kernel"], [k, 0.0, 0.0], h, fluid["spacing"])
    return float(run.info["step"] * fluid["viscosity"] / fluid["density"] * k**2 * ratio / Bed(run.scene).eps)


def measure(quantity, run):
    if quantity == "friction_share":
        return friction_share(run)
    if quantity == "slip":
        return slip(run)
    if quantity == "energy_growth":
        energy = run.series("energy")[1].ravel()
        return float(energy.max() / energy[0])
    return NotImplemented


def ratio(run, mu):
    """dt/tau_p of a run at another viscosity."""
    bed = Bed(run.scene)
    return bed.dt / bed.tau_p * mu / bed.mu


def map_figure(runs):
    """Trials of the bisection over load and dt/tau_p, the boundary, and the runs of the other exchanges."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.6), layout="constrained")
    axes = figure.subplots()
    loads = np.geomspace(0.05, 2000.0, 60)
    axes.fill_between(loads, 2.0 / (1.0 + loads), 1e3, color="0.92", lw=0)
    axes.plot(loads, 2.0 / (1.0 + loads), "k-", lw=1, label="2/(1 + load): explicit is unstable above")
    axes.axhline(2.0, color="k", ls=":", lw=1, label="2: the same without the fluid's inertia")
    seen = set()

    def mark(run, mu, style, label):
        axes.plot(Bed(run.scene).load, ratio(run, mu), style, ms=5, mfc="none", label=None if label in seen else label)
        seen.add(label)

    for run in runs:
        if run.scene["grains"]["arrange"]["law"] != "lattice" or run.variant.startswith(("half", "friction")):
            continue
        if getattr(run, "stable", None) is not None:
            mark(run, run.stable, "C0o", "explicit, highest stable")
        if getattr(run, "unstable", None) is not None:
            mark(run, run.unstable, "C3x", "explicit, lowest unstable")
        if not run.failure and Bed(run.scene).exchange != "explicit":
            exchange = Bed(run.scene).exchange
            mark(run, Bed(run.scene).mu, "C2^" if exchange == "implicit" else "C1v", f"{exchange}, stable")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(1e-3, 300.0)
    axes.set_xlim(0.05, 2000.0)
    axes.set_xlabel("mass of grains over fluid, load [-]")
    axes.set_ylabel("step over relaxation time of a grain, dt/tau_p [-]")
    axes.legend(fontsize="x-small", loc="lower left")
    return figure


def figures(runs):
    return [("map", map_figure(runs), "Exchange of drag in a uniform bed: runs and the predicted boundary of explicit exchange.")]
