"""Permeability of periodic arrays of cylinders in creeping cross flow (README.md)."""

import math
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import tables  # noqa: E402
from theory import cylinder_arrays  # noqa: E402

UNITS = {
    "permeability": "1",
    "superficial_velocity": "m/s",
    "mean_fluid_velocity": "m/s",
    "force_per_length": "N/m",
    "reynolds": "1",
    "cross_permeability": "1",
    "drift": "1",
    "area_excess": "1",
}
NOMINAL = (0.1, 0.2, 0.3, 0.4, 0.5, 0.6)  # solid fractions of this case's arrays
DENSEST = {"square": math.pi / 4.0, "hexagonal": math.pi / (2.0 * math.sqrt(3.0))}


def tabulated(array):
    """{c: K/r^2} of the committed table, six digits."""
    rows = tables.table(f"sangani_acrivos_1982/{array}.csv")
    return dict(zip(rows["solid_fraction"].tolist(), rows["permeability"].tolist()))


def permeability(c, array):
    """K/r^2 of the solid fraction c: the table's value where it has one, else computed (up to 0.9 of the densest packing)."""
    if not 0.0 < c < 0.9 * DENSEST[array]:
        raise ValueError(f"solid fraction {c} outside (0, {0.9 * DENSEST[array]:.3f}) of the {array} array")
    known = tabulated(array)
    return known[c] if c in known else cylinder_arrays.permeability_from_force(cylinder_arrays.force(c, array), c)


class Cell(NamedTuple):
    """One period of an array: sides, m, cylinders in it and their radius, m."""

    sides: tuple
    count: int
    radius: float
    array: str

    @property
    def area(self):
        return self.sides[0] * self.sides[1]

    @property
    def solid_fraction(self):
        return self.count * math.pi * self.radius**2 / self.area

    def permeability(self):
        """K, m2."""
        return self.radius**2 * permeability(self.solid_fraction, self.array)


def centres(scene):
    """Places [n, 2], m, of the scene's cylinders, each once: one that crosses periodic sides is given once per image."""
    size, found = np.asarray(scene["domain"]["size"][:2], float), []
    for wall in (wall for wall in scene["wall"] if wall["shape"] == "cylinder"):
        away = [np.asarray(wall["point"][:2], float) - other for other in found]
        if all(np.linalg.norm(a - size * np.round(a / size)) > 1e-6 * size[0] for a in away):
            found.append(np.asarray(wall["point"][:2], float))
    return np.array(found)


def cell(scene):
    """The scene's period: one cylinder in a square box, or two in a box of sides 1 : sqrt(3) (their centres half a box apart).

    sqrt(3) is met to 1e-3, since both sides are whole numbers of spacings.
    """
    sides = tuple(scene["domain"]["size"][:2])
    radii = [wall["radius"] for wall in scene["wall"] if wall["shape"] == "cylinder"]
    count = len(centres(scene))
    if len(set(radii)) != 1:
        raise ValueError("an array has cylinders of one radius")
    if count == 1 and math.isclose(sides[0], sides[1], rel_tol=1e-9):
        return Cell(sides, 1, radii[0], "square")
    if count == 2 and math.isclose(max(sides) / min(sides), math.sqrt(3.0), rel_tol=1e-3):
        return Cell(sides, 2, radii[0], "hexagonal")
    raise ValueError("one cylinder in a square box or two in a box of sides 1 : sqrt(3)")


def nominal(period):
    """The cell with the radius of its nominal solid fraction, the one of NOMINAL nearest to it: a scene's radius is under test."""
    c = min(NOMINAL, key=lambda value: abs(value - period.solid_fraction))
    return period._replace(radius=math.sqrt(c * period.area / (period.count * math.pi)))


def hexagonal_box(radius, solid_fraction):
    """Sides (a, sqrt(3) a), m, of the box with two cylinders, at (a/4, b/4) and (3a/4, 3b/4) say."""
    a = math.sqrt(2.0 * math.pi * radius**2 / (solid_fraction * math.sqrt(3.0)))
    return a, math.sqrt(3.0) * a


def superficial_velocity(k, force, nu):
    """U, m/s: Darcy's K/mu times the pressure gradient rho f that the force per mass f, m/s2, replaces."""
    return k * force / nu


def driving(scene):
    """Force per mass [2], m/s2."""
    return np.asarray(scene["fluid"]["body_force"][:2], float)


def viscosity(scene):
    """Kinematic, m2/s."""
    return scene["fluid"]["viscosity"] / scene["fluid"]["density"]


def reference(quantity, scene, t):
    period, nu = nominal(cell(scene)), viscosity(scene)
    force = float(np.linalg.norm(driving(scene)))
    u = superficial_velocity(period.permeability(), force, nu)
    if quantity == "permeability":  # over r^2
        return period.permeability() / period.radius**2
    if quantity == "superficial_velocity":
        return u
    if quantity == "mean_fluid_velocity":
        return u / (1.0 - period.solid_fraction)
    if quantity == "force_per_length":  # by the fluid on one cylinder when pressure is periodic
        return scene["fluid"]["density"] * force * period.area * (1.0 - period.solid_fraction) / period.count
    if quantity == "reynolds":
        return 2.0 * period.radius * u / nu
    if quantity in ("cross_permeability", "drift", "area_excess"):
        return 0.0
    raise KeyError(quantity)


def permeabilities(scene, mean):
    """K/r^2 along the force and across it from mean velocities [n, 2] of the particles: (1 - c) <v> nu/(f r^2), the case's radius."""
    period, force = nominal(cell(scene)), driving(scene)
    size = float(np.linalg.norm(force))
    along = force / size
    across = np.array([-along[1], along[0]])
    scale = (1.0 - period.solid_fraction) * viscosity(scene) / (size * period.radius**2)
    return scale * (mean @ along), scale * (mean @ across)


def measured_permeability(scene, v, volume=None):
    """K/r^2 from the velocities v [n, >= 2] of the fluid's particles at rest in time."""
    mean = np.average(np.asarray(v, float)[:, :2], axis=0, weights=volume)
    return float(permeabilities(scene, mean)[0])


def probed(run):
    """(t, K/r^2 along, K/r^2 across) from the probes."""
    t, x = run.series("mean_velocity_x")
    mean = np.stack((np.ravel(x), np.ravel(run.series("mean_velocity_y")[1])), axis=1)
    return t, *permeabilities(run.scene, mean)


def area_excess(scene, fluid):
    """Area of the particles over that of the pores, less 1: how well whole particles fit round the cylinders."""
    period = nominal(cell(scene))
    pores = (1.0 - period.solid_fraction) * period.area
    spacing = np.broadcast_to(scene["fluid"]["spacing"], 2)
    return float(np.sum(fluid.get("open", np.ones(len(fluid["x"]))))) * spacing[0] * spacing[1] / pores - 1.0


def measure(quantity, run):
    if quantity == "area_excess":
        return area_excess(run.scene, run.snapshot(-1)["fluid"])
    if quantity not in ("permeability", "cross_permeability", "drift"):
        return NotImplemented
    t, along, across = probed(run)
    if quantity == "permeability":
        return t, along
    if quantity == "cross_permeability":  # over the expected one along: 0 in an isotropic array
        return float(across[-1] / reference("permeability", run.scene, t))
    return float(along[-1] / along[np.searchsorted(t, 0.8 * t[-1] * (1.0 - 1e-9))] - 1.0)


def table(runs):
    """Every run: permeability, its error, residual drift, area of the particles."""
    rows = []
    for run in runs:
        if run.failure is None:
            expected, (_, along, _) = reference("permeability", run.scene, None), probed(run)
            values = (along[-1], expected, 100.0 * (along[-1] / expected - 1.0), 100.0 * measure("drift", run), 100.0 * measure("area_excess", run))
            rows.append([run.variant, f"{np.ravel(run.scene['fluid']['spacing'])[0]:g}", *(f"{value:.4g}" for value in values)])
    columns = ["variant", "spacing (m)", "K/r2", "theory", "error (%)", "drift (%)", "excess of area (%)"]
    return {"columns": columns, "rows": rows, "caption": "Permeability at the end of the run; drift is its change in the last fifth."}


def figures(runs):
    """The speed in the finest run of every array."""
    import matplotlib.pyplot as plt

    finest = {run.variant: run for run in runs if run.failure is None}
    figure, axes = plt.subplots(1, len(finest), figsize=(2.3 * len(finest), 3.0), squeeze=False)
    for axis, (name, run) in zip(axes[0], finest.items()):
        fluid, size = run.snapshot(-1)["fluid"], run.scene["domain"]["size"]
        speed = np.linalg.norm(fluid["v"][:, :2], axis=1)
        dots = axis.scatter(fluid["x"][:, 0] % size[0], fluid["x"][:, 1] % size[1], c=speed / np.max(speed), s=1.0, cmap="viridis")
        for wall in run.scene["wall"]:
            axis.add_patch(plt.Circle(wall["point"], wall["radius"], fill=False, color="k", lw=0.8))
        axis.set(title=name, aspect="equal", xlim=(0, size[0]), ylim=(0, size[1]), xticks=[], yticks=[])
        axis.title.set_fontsize(8)
    figure.colorbar(dots, ax=axes[0], shrink=0.7, label="speed / greatest")
    return [("speed", figure, "Every particle of the finest run by its speed; the cylinders' surfaces as circles.")]
