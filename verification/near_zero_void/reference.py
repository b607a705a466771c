"""Beds of little void on a grid: waves of compression among free grains, and flow through beds that are held (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "reference_data")]

from compression_waves import Bed, LongWave, Symbols, factor, history, least  # noqa: E402
from drag_laws.drag_laws import LAWS  # noqa: E402

UNITS = {"late_growth": "1", "waves": "1", "greatest": "1", "superficial": "m/s", "force_share": "1", "mean_porosity": "1", "least_porosity": "1",
         "flow_share": "1", "bounded": "1"}
UNITS |= {f"added_mass.{name}": "kg/m3" for name in ("stable", "unstable", "boundary")}


STEPS = 12  # that are compared


class Scene:
    """The scene's numbers."""

    def __init__(self, scene):
        self.scene, fluid, grain, coupling = scene, scene["fluid"], scene["grains"], scene["coupling"]
        self.h, self.length = fluid["spacing"], scene["domain"]["size"][0]
        self.d, self.rho, self.mu, self.dt = grain["diameter"], fluid["density"], fluid["viscosity"], scene["time"]["step"]
        self.density = grain["density"]
        self.phi = math.pi / 6.0 * (self.d / grain["arrange"]["spacing"]) ** 3
        self.z = self.dt * 18.0 * self.mu / (self.density * self.d**2)
        self.exchange, self.gradient = coupling["exchange"], "pressure_gradient" in coupling["forces"]
        self.virtual = "virtual_mass" in coupling["forces"] and self.exchange != "explicit"  # for which the theory has none
        self.width = coupling["kernel_width"]

    def bed(self, rho=None):
        """In a fluid of another density too."""
        virtual = 0.5 * (rho or self.rho) / self.density if self.virtual else 0.0
        return Bed(self.exchange, self.z, self.phi, self.density / (rho or self.rho), self.gradient, self.dt * self.mu / self.density, virtual)

    @property
    def waves(self):
        """Symbols of all waves along the box but the shortest, which the stress does not see."""
        return symbols(self.width, self.h, round(self.length / self.h))

    def factor(self, rho):
        return max(factor(self.bed(rho), wave) for wave in self.waves)

    def boundary_density(self):
        """Of the fluid, kg/m3; dt/tau_p does not depend on it."""
        return least(lambda rho: self.factor(rho) - 1.0 - 1e-9, 0.02 * self.density, 20.0 * self.density)


@lru_cache(maxsize=None)
def symbols(width, h, cells):
    return tuple(Symbols(width, h, 2.0 * math.pi * m / (cells * h)) for m in range(1, (cells + 1) // 2))


def superficial(scene):
    """u_s of the law at the mean porosity: n f_d = -dp/dx, README, equation (8)."""
    bed, gradient = Scene(scene), -scene["coupling"]["mean_pressure_gradient"][0]
    eps = 1.0 - bed.phi
    law, number = LAWS[scene["coupling"]["drag"].removesuffix("_missing_eps")], 6.0 * bed.phi / (math.pi * bed.d**3)

    def excess(u):
        force = 3.0 * math.pi * bed.mu * bed.d * u * float(law(eps, bed.rho * bed.d * u / bed.mu))
        return number * force / eps - gradient

    return brentq(excess, 1e-12, 10.0, xtol=1e-16, rtol=1e-12)


def reference(quantity, scene, t):
    if quantity == "waves":
        own = Scene(scene)
        return np.array([history(own.bed(), wave, STEPS) for wave in own.waves]).ravel()
    if quantity == "added_mass.boundary":
        return Scene(scene).boundary_density()
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


def along(run):
    """The grains' velocities by step and place along x, m/s: means over y and z, less that of all."""
    v = run.series("grains")[1]
    mean = v.reshape(len(v), -1, round(run.scene["domain"]["size"][0] / run.scene["fluid"]["spacing"])).mean(axis=1)
    return mean - mean.mean(axis=1, keepdims=True)


def size(run):
    """Root mean square of that, by step."""
    return np.sqrt((along(run) ** 2).mean(axis=1))


def measure(quantity, run):
    if quantity not in UNITS or "." in quantity:
        return NotImplemented
    if quantity == "late_growth":  # of the last quarter over the second one; what has grown a thousandfold may have ended as disorder, what is
        found = size(run)          # below a thousandth is the solver's residual
        quarter, greatest = len(found) // 4, float(found.max() / found[0])
        if found[-quarter:].max() < 1e-3 * found[0]:
            return float(found[-quarter:].max() / found[0])
        return greatest if greatest > 1e3 else float(found[-quarter:].max() / found[quarter : 2 * quarter].max())
    if quantity == "greatest":  # after the start, over the start
        return float((size(run)[1:] / size(run)[0]).max())
    if quantity == "waves":  # each over its start, one after the other
        modes = np.fft.rfft(along(run), axis=1)[: STEPS + 1, 1 : 1 + len(Scene(run.scene).waves)]
        found = (modes / modes[0]).T.ravel()
        return np.arange(len(found)), np.real(found) + np.abs(np.imag(found))
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
    return [("waves", waves_figure(runs), "Size of the waves of compression, step by step: runs (points) and theory from each run's own start (lines)."),
            ("stability", stability_figure(runs), "Left: largest factor of a step by theory, with what is foreseen, density ratio 2, long waves. Right: explicit exchange at a hundredth of the relaxation time, trials of each box (circles stable, squares unstable), its boundary by theory (crosses) and that of long waves at any short step (line).")]


def waves_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 4.6), layout="constrained")
    axes = figure.subplots()
    for number, run in enumerate(run for run in runs if run.variant.startswith("waves") and not run.failure):
        own, found = Scene(run.scene), size(run)
        start = np.abs(np.fft.rfft(along(run), axis=1)[0, 1 : 1 + len(own.waves)])
        theory = np.sqrt(sum((a * history(own.bed(), wave, len(found) - 1)) ** 2 for a, wave in zip(start, own.waves)) / (start**2).sum())
        colour = f"C{number % 10}"
        axes.semilogy(found / found[0], "o" if number < 10 else "s", color=colour, ms=3, mfc="none",
                      label=f"{run.variant}: eps {1.0 - own.phi:.2g}, dt/tau_p {own.z:.3g}")
        axes.semilogy(theory, color=colour, lw=1)
    axes.set(xlabel="step", ylabel="velocity over its start [-]", ylim=(1e-6, 2.0))
    axes.legend(fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def stability_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    phis, zs = np.linspace(0.05, 0.95, 46), np.geomspace(1e-2, 1e3, 51)
    factors = [[factor(Bed("exponential", z, phi, 2.0), LongWave) for phi in phis] for z in zs]
    drawn = left.pcolormesh(1.0 - phis, zs, factors, vmin=0.0, vmax=1.0, cmap="viridis", shading="nearest", rasterized=True)
    left.set(yscale="log", xlabel="eps [-]", ylabel="step over relaxation time, dt/tau_p [-]", title="exponential exchange, foreseen")
    figure.colorbar(drawn, ax=left, label="largest factor of a step [-]")
    right.plot(1.0 - phis, 0.5 * (1.0 - phis) / phis, "C0-", lw=1, label="long waves, any short step")
    for run in runs:
        if getattr(run, "stable", None) is None or getattr(run, "unstable", None) is None:
            continue
        own = Scene(run.scene)
        for value, mark in ((run.stable, "o"), (run.unstable, "s")):
            right.plot(1.0 - own.phi, value / own.density, mark, color="C0", mfc="none", ms=5)
        right.plot(1.0 - own.phi, own.boundary_density() / own.density, "k+", ms=9)
    right.set(xlabel="eps [-]", ylabel="density of the fluid over that of grains [-]", xlim=(0.2, 0.7), ylim=(0.0, 1.2), title="explicit exchange")
    right.legend(fontsize="x-small", loc="upper left")
    return figure
