"""Speed of one grain in a cubic periodic cell of creeping fluid on a grid: Hasimoto's, and that of a wide force (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import grid_wake, hasimoto, self_disturbance  # noqa: E402

UNITS = {"over_hasimoto": "1", "over_wide": "1", "over_plain": "1"}


class Cell:
    """The scene's numbers, SI units; speeds are downwards."""

    def __init__(self, scene):
        fluid, grain = scene["fluid"], scene["grains"]
        self.rho, self.mu, self.d = fluid["density"], fluid["viscosity"], grain["diameter"]
        self.side = scene["domain"]["size"][0]
        self.width = scene["coupling"]["kernel_width"]["times_diameter"] * self.d
        self.scheme = grid_wake.GridScheme(scene["coupling"]["kernel"], self.width, fluid["spacing"])
        self.phi = hasimoto.volume_fraction(self.side / self.d)
        self.weight = (grain["density"] - self.rho) * math.pi / 6.0 * self.d**3 * -scene["domain"]["gravity"][2]

    @property
    def stokes(self):
        """Stokes' velocity, m/s."""
        return self.weight / (3.0 * math.pi * self.mu * self.d)

    @property
    def hasimoto(self):
        return self.stokes * hasimoto.inverse_drag(self.phi)

    @property
    def wide(self):
        """README (1)."""
        return self.stokes * wide_speed(self.width / self.d, self.side / self.d)

    @property
    def plain(self):
        """README (2). Of the weight the mean gradient carries phi, and the pressure and stress of the wake f; the rest is drag."""
        modes = grid_wake.box_modes(self.scheme, (self.side,) * 3)
        fluid = self_disturbance.Fluid(self.rho, self.mu)
        wake = grid_wake.steady_velocity(modes, self.scheme, fluid, self.weight * (1.0 - self.phi))
        own, back = grid_wake.own_volume_fraction(modes, self.d), grid_wake.backflow(modes, self.d)
        return (self.stokes * (1.0 - self.phi) * (1.0 - own) + wake) / (1.0 + back)


def wide_speed(width, side):
    """Over Stokes' velocity; lengths in diameters. The Gaussian is cut off: its moment is the cut one's."""
    q = np.linspace(0.0, grid_wake.GAUSSIAN_REACH, 4001)
    w = np.exp(-0.5 * q**2) * q**2
    moment = float((w * q**2).sum() / w.sum()) * width**2  # <r^2>
    lattice = hasimoto.POINT_LATTICE / (6.0 * math.pi * side)
    return 1.0 + 3.0 * math.pi * (2.0 / 9.0 * moment / side**3 - lattice)


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


def table(runs):
    rows = []
    for run in runs:
        cell = Cell(run.scene)
        law = cell.plain if run.variant.startswith("plain") else cell.wide
        rows.append([run.variant, f"{cell.width / cell.d:.3g}", f"{cell.scheme.cell / cell.d:.3g}", f"{cell.side / cell.d:.4g}",
                     f"{measure('over_hasimoto', run) * cell.hasimoto / cell.stokes:.4f}", f"{cell.hasimoto / cell.stokes:.4f}", f"{law / cell.stokes:.4f}"])
    return {"columns": ["run", "width/d", "cell/d", "L/d", "v/Stokes", "Hasimoto", "theory of the scheme"], "rows": rows,
            "caption": "Final speed relative to the mean of the cell, over Stokes' velocity."}


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    sides = np.geomspace(9.0, 40.0, 60)
    axes.plot(sides, [hasimoto.inverse_drag(hasimoto.volume_fraction(side)) for side in sides], "k-", lw=1.2, label="Hasimoto")
    for width, colour in ((1.0, "C1"), (2.0, "C0")):
        axes.plot(sides, [wide_speed(width, side) for side in sides], "--", color=colour, lw=1.0, label=f"theory, width {width:g} d")
        for run in runs:
            cell = Cell(run.scene)
            if abs(cell.width / cell.d / width - 1.0) < 1e-6:
                mark = "x" if run.variant.startswith("plain") else "o"
                axes.plot(cell.side / cell.d, measure("over_hasimoto", run) * cell.hasimoto / cell.stokes, mark, color=colour, ms=6, mfc="none")
    for mark, label in (("o", "runs"), ("x", "runs, not corrected")):
        axes.plot([], [], mark, color="0.3", mfc="none", label=label)
    axes.set(xlabel="L/d (-)", ylabel="settling speed/Stokes' velocity (-)", xscale="log")
    axes.set_xticks([10, 12, 16, 24, 32], labels=["10", "12", "16", "24", "32"])
    axes.minorticks_off()
    axes.legend(fontsize=8)
    return [("cells", figure, "Settling speed of one grain per periodic cell of a grid.")]
