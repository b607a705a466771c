"""Speed of one grain in a cubic periodic cell of creeping fluid: Hasimoto's, and that of a wide force (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import hasimoto, self_disturbance, sph_operators  # noqa: E402

UNITS = {"over_hasimoto": "1", "over_wide": "1", "over_plain": "1"}


class Cell:
    """The scene's numbers, SI units; speeds are downwards."""

    def __init__(self, scene):
        fluid, grain = scene["fluid"], scene["grains"]
        self.rho, self.mu, self.d = fluid["density"], fluid["viscosity"], grain["diameter"]
        self.side, self.kernel, self.h = scene["domain"]["size"][0], fluid["kernel"], fluid["smoothing"] * fluid["spacing"]
        self.volume = math.pi / 6.0 * self.d**3
        self.phi = self.volume / self.side**3
        self.weight = (grain["density"] - self.rho) * self.volume * -scene["domain"]["gravity"][2]
        self.scheme = self_disturbance.one_kernel(self.kernel, self.h)
        correction = scene["coupling"].get("self_disturbance", "none")
        self.end = scene["time"]["end"] if correction != "none" and correction["history"] == "unsteady" else math.inf

    @property
    def stokes(self):
        """Stokes' velocity, m/s."""
        return self.weight / (3.0 * math.pi * self.mu * self.d)

    @property
    def hasimoto(self):
        return self.stokes * hasimoto.inverse_drag(self.phi)

    @property
    def wide(self):
        """README (2): Stokes' speed and the velocity by the images of a smoothed force; (4) where the wake taken out still grows."""
        return self.stokes * hasimoto.corrected_speed(self.scheme, self.d, self.side) + self.weight * self.missing

    @property
    def missing(self):
        """README (4): what a lone grain's wake still lacks at the end of the run, per unit force, m/(s N)."""
        k, weight = self_disturbance.wave_numbers(self.scheme)
        rate = self_disturbance.decay_rate(self.scheme, self_disturbance.Fluid(self.rho, self.mu), k)
        share = weight * k**2 * self_disturbance.filter_product(self.scheme, k) / (3.0 * math.pi**2 * self.rho)
        return float(share @ (np.exp(-rate * self.end) / rate))

    @property
    def plain(self):
        """README (3). Of the weight the mean gradient carries phi, and the pressure and stress of the wake f; the rest is drag."""
        modes = self_disturbance.box_modes(self.scheme, (self.side,) * 3, reach=14.0)
        fluid = self_disturbance.Fluid(self.rho, self.mu)
        wake = self_disturbance.steady_velocity(modes, self.scheme, fluid, self.weight * (1.0 - self.phi))
        own = self_disturbance.own_volume_fraction(self.scheme, self.d)
        smoothed = sph_operators.transform(self.kernel, 3, modes.k * self.h)
        back = self.volume * float((modes.share * modes.cosine**2 / smoothed).sum())
        return (self.stokes * (1.0 - self.phi) * (1.0 - own) + wake) / (1.0 + back)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    cell = Cell(run.scene)
    (_, v), (_, u) = run.series("grain"), run.series("fluid")
    speed = -float(v.ravel()[-1] - ((1.0 - cell.phi) * u.ravel()[-1] + cell.phi * v.ravel()[-1]))  # at zero net flux
    return speed / getattr(cell, quantity.removeprefix("over_"))


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 1.0
    raise KeyError(quantity)


# --- the page ---

MARKS = {"plain": "x", "unsteady": "s"}


def table(runs):
    rows = []
    for run in runs:
        cell = Cell(run.scene)
        speed = measure("over_hasimoto", run) * cell.hasimoto / cell.stokes
        law = cell.plain if run.variant.startswith("plain") else cell.wide
        rows.append([run.variant, f"{cell.h / cell.d:.3g}", f"{cell.side / cell.d:.4g}", f"{speed:.4f}", f"{cell.hasimoto / cell.stokes:.4f}",
                     f"{law / cell.stokes:.4f}"])
    return {"columns": ["run", "h/d", "L/d", "v/Stokes", "Hasimoto", "theory of the scheme"], "rows": rows,
            "caption": "Final speed relative to the mean of the cell, over Stokes' velocity."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    sides = np.geomspace(7.0, 40.0, 60)
    axes.plot(sides, [hasimoto.inverse_drag(hasimoto.volume_fraction(side)) for side in sides], "k-", lw=1.2, label="Hasimoto")
    for width, colour in ((2.0, "C0"), (3.0, "C1")):
        chosen = [(Cell(run.scene), run) for run in runs if abs(Cell(run.scene).h / Cell(run.scene).d / width - 1.0) < 1e-6]
        if not chosen:
            continue
        d = chosen[0][0].d
        axes.plot(sides, [hasimoto.corrected_speed(chosen[0][0].scheme, d, side * d) for side in sides], "--", color=colour, lw=1.0,
                  label=f"theory, h/d = {width:g}")
        for cell, run in chosen:
            mark = next((MARKS[kind] for kind in MARKS if run.variant.startswith(kind)), "o")
            axes.plot(cell.side / cell.d, measure("over_hasimoto", run) * cell.hasimoto / cell.stokes, mark, color=colour, ms=6, mfc="none")
    for mark, label in (("o", "runs, steady wake out"), (MARKS["unsteady"], "runs, unsteady wake out"), (MARKS["plain"], "runs, not corrected")):
        axes.plot([], [], mark, color="0.3", mfc="none", label=label)
    axes.set(xlabel="L/d (-)", ylabel="settling speed/Stokes' velocity (-)", xscale="log")
    axes.set_xticks([8, 12, 16, 24, 32], labels=["8", "12", "16", "24", "32"])
    axes.minorticks_off()
    axes.legend(fontsize=8)
    return [("cells", figure, "Settling speed of one grain per periodic cell.")]
