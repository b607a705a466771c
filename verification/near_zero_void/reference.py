"""Beds of little void on a grid: waves of compression among free grains, and flow through beds that are held (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "reference_data")]

from compression_waves import LongWave, Symbols, factor, least  # noqa: E402
from drag_laws.drag_laws import LAWS  # noqa: E402

UNITS = {"late_growth": "1", "growth": "1", "boundary_share": "1", "superficial": "m/s", "force_share": "1", "mean_porosity": "1", "least_porosity": "1",
         "flow_share": "1", "bounded": "1"}
UNITS |= {f"z.{name}": "Pa s" for name in ("stable", "unstable", "boundary")}
UNITS |= {f"added_mass.{name}": "kg/m3" for name in ("stable", "unstable", "boundary")}


class Bed:
    """The scene's numbers."""

    def __init__(self, scene):
        self.scene, fluid, grain, coupling = scene, scene["fluid"], scene["grains"], scene["coupling"]
        self.h, self.length = fluid["spacing"], scene["domain"]["size"][0]
        self.d, self.rho, self.mu, self.dt = grain["diameter"], fluid["density"], fluid["viscosity"], scene["time"]["step"]
        self.ratio = grain["density"] / self.rho
        self.phi = math.pi / 6.0 * (self.d / grain["arrange"]["spacing"]) ** 3
        self.z = self.dt * 18.0 * self.mu / (grain["density"] * self.d**2)
        self.exchange, self.gradient = coupling["exchange"], float("pressure_gradient" in coupling["forces"])
        self.width = coupling["kernel_width"]

    def factor(self, z=None, ratio=None):
        """The largest growth factor of all waves along the box but the shortest, which the stress does not see."""
        cells = round(self.length / self.h)
        return max(factor(self.exchange, self.z if z is None else z, self.phi, ratio or self.ratio, s, self.gradient)
                   for s in symbols(self.width, self.h, cells))

    def boundary_z(self):
        return least(lambda z: self.factor(z) - 1.0 - 1e-9, 1e-3, 100.0)

    def boundary_density(self):
        """Of the fluid, kg/m3; z does not depend on it."""
        grains = self.ratio * self.rho
        return least(lambda rho: self.factor(ratio=grains / rho) - 1.0 - 1e-9, 0.02 * grains, 20.0 * grains)


@lru_cache(maxsize=None)
def symbols(width, h, cells):
    return tuple(Symbols(width, h, 2.0 * math.pi * m / (cells * h)) for m in range(1, (cells + 1) // 2))


def superficial(scene):
    """u_s of the law at the mean porosity: n f_d = -dp/dx, README, equation (7)."""
    bed, gradient = Bed(scene), -scene["coupling"]["mean_pressure_gradient"][0]
    eps = 1.0 - bed.phi
    law, number = LAWS[scene["coupling"]["drag"].removesuffix("_missing_eps")], 6.0 * bed.phi / (math.pi * bed.d**3)

    def excess(u):
        force = 3.0 * math.pi * bed.mu * bed.d * u * float(law(eps, bed.rho * bed.d * u / bed.mu))
        return number * force / eps - gradient

    return brentq(excess, 1e-12, 10.0, xtol=1e-16, rtol=1e-12)


def reference(quantity, scene, t):
    if quantity == "growth":
        return Bed(scene).factor()
    if quantity == "z.boundary":
        bed = Bed(scene)
        return bed.mu / bed.z * bed.boundary_z()
    if quantity == "added_mass.boundary":
        return Bed(scene).boundary_density()
    if quantity == "superficial":
        return superficial(scene)
    if quantity == "mean_porosity":
        return 1.0 - grain_volume(scene) / math.prod(scene["domain"]["size"])
    if quantity in ("force_share", "flow_share", "least_porosity"):
        return scene["coupling"]["least_porosity"] if quantity == "least_porosity" else 1.0
    raise KeyError(quantity)


def grain_volume(scene):
    arrange = scene["grains"]["arrange"]
    counts = [round((b - a) / arrange["spacing"]) for a, b in zip(arrange["lower"], arrange["upper"])]
    return math.prod(counts) * math.pi / 6.0 * scene["grains"]["diameter"] ** 3


def waves(run):
    """Root mean square of the part of the grains' velocities that depends on x, by step."""
    v = run.series("grains")[1]
    along = round(run.scene["domain"]["size"][0] / run.scene["fluid"]["spacing"])
    mean = v.reshape(len(v), -1, along).mean(axis=1)
    return np.sqrt(((mean - mean.mean(axis=1, keepdims=True)) ** 2).mean(axis=1))


def measure(quantity, run):
    if quantity not in UNITS or "." in quantity:
        return NotImplemented
    if quantity == "late_growth":  # of the last quarter over the second one; what has grown a thousandfold may have ended as disorder
        size = waves(run)
        quarter, greatest = len(size) // 4, float(size.max() / size[0])
        return greatest if greatest > 1e3 else float(size[-quarter:].max() / size[quarter : 2 * quarter].max())
    if quantity == "growth":  # a step's, over the last four
        size = waves(run)
        return float((size[-1] / size[-5]) ** 0.25)
    if quantity == "bounded":
        return float(run.info["coupling"]["bounded_porosities"])
    if quantity == "superficial":
        return float(run.series("flow_in")[1].ravel()[-1] / math.prod(run.scene["domain"]["size"][1:]))  # of eps u
    if quantity == "force_share":  # force on all grains over what drives both phases
        drive = -run.scene["coupling"]["mean_pressure_gradient"][0] * math.prod(run.scene["domain"]["size"])
        return float(run.series("force")[1].ravel()[-1] / drive)
    if quantity == "flow_share":
        ratio = run.series("flow_out")[1].ravel()[1:] / run.series("flow_in")[1].ravel()[1:]
        return float(ratio[np.argmax(np.abs(ratio - 1.0))])
    porosity = run.snapshot(-1)["fluid"]["rho"] / run.scene["fluid"]["density"]
    return float(porosity.mean() if quantity == "mean_porosity" else porosity.min())


def figures(runs):
    return [("stability", stability_figure(runs), "Free grains: trials, the boundary of each box and kernel (crosses) and that of long waves (lines)."),
            ("growth", growth_figure(runs), "Size of the waves of compression, step by step, and the largest factor of theory.")]


def stability_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.8), layout="constrained")
    axes = figure.subplots()
    phis = np.linspace(0.15, 0.9, 60)
    for ratio, gradient, style, label in ((2.0, 1.0, "C0-", "pressure_gradient, density ratio 2"), (1000.0, 1.0, "C0--", "the same, 1000"),
                                          (2.0, 0.0, "C1-", "no pressure_gradient, any density")):
        line = [least(lambda z, p=p: factor("exponential", z, p, ratio, LongWave, gradient) - 1.0 - 1e-9, 1e-3, 1e3) for p in phis]
        axes.semilogy(1.0 - phis, [np.nan if z is None else z for z in line], style, lw=1, label=label)
    for run in runs:
        if getattr(run, "stable", None) is None or getattr(run, "unstable", None) is None or run.variant.startswith("added"):
            continue
        bed = Bed(run.scene)
        colour = "C0" if bed.gradient else "C1"
        for value, mark in ((run.stable, "o"), (run.unstable, "s")):
            axes.plot(1.0 - bed.phi, bed.z * value / bed.mu, mark, color=colour, mfc="none", ms=5)
        axes.plot(1.0 - bed.phi, bed.boundary_z(), "k+", ms=9)
    axes.plot([], [], "ko", mfc="none", label="highest stable (box of 16 cells)")
    axes.plot([], [], "ks", mfc="none", label="lowest unstable")
    axes.plot([], [], "k+", label="theory of the box and kernel")
    axes.set(xlabel="eps [-]", ylabel="step over relaxation time, dt/tau_p [-]", ylim=(1e-2, 1e2), xlim=(0.1, 0.85))
    axes.legend(fontsize="x-small", loc="upper left")
    return figure


def growth_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    for number, run in enumerate(run for run in runs if run.variant.startswith(("grows", "decays")) and not run.failure):
        size = waves(run)
        axes.semilogy(size / size[0], f"C{number}o", ms=3, label=run.variant)
        steps = np.arange(len(size))
        axes.semilogy(steps, size[-1] / size[0] * Bed(run.scene).factor() ** (steps - steps[-1]), f"C{number}-", lw=1)
    axes.set(xlabel="step", ylabel="velocity over its start [-]", ylim=(1e-4, 1e12))
    axes.legend(fontsize="x-small")
    return figure
