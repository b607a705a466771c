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
}
DENSEST = {"square": math.pi / 4.0, "hexagonal": math.pi / (2.0 * math.sqrt(3.0))}


def table(array):
    """{c: K/r^2} of the committed table, six digits."""
    rows = tables.table(f"sangani_acrivos_1982/{array}.csv")
    return dict(zip(rows["solid_fraction"].tolist(), rows["permeability"].tolist()))


def permeability(c, array):
    """K/r^2 of the solid fraction c: the table's value where it has one, else computed (up to 0.9 of the densest packing)."""
    if not 0.0 < c < 0.9 * DENSEST[array]:
        raise ValueError(f"solid fraction {c} outside (0, {0.9 * DENSEST[array]:.3f}) of the {array} array")
    known = table(array)
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


def cell(scene):
    """The scene's period: one cylinder in a square box, or two in a box of sides 1 : sqrt(3) (their centres half a box apart)."""
    sides = tuple(scene["domain"]["size"][:2])
    radii = [wall["radius"] for wall in scene["wall"] if wall["shape"] == "cylinder"]
    if len(set(radii)) != 1:
        raise ValueError("an array has cylinders of one radius")
    if len(radii) == 1 and math.isclose(sides[0], sides[1], rel_tol=1e-9):
        return Cell(sides, 1, radii[0], "square")
    if len(radii) == 2 and math.isclose(max(sides) / min(sides), math.sqrt(3.0), rel_tol=1e-3):
        return Cell(sides, 2, radii[0], "hexagonal")
    raise ValueError("one cylinder in a square box or two in a box of sides 1 : sqrt(3)")


def hexagonal_box(radius, solid_fraction):
    """Sides (a, sqrt(3) a), m, of the box with two cylinders, at (a/4, b/4) and (3a/4, 3b/4) say."""
    a = math.sqrt(2.0 * math.pi * radius**2 / (solid_fraction * math.sqrt(3.0)))
    return a, math.sqrt(3.0) * a


def superficial_velocity(k, force, nu):
    """U, m/s: Darcy's K/mu times the pressure gradient rho f that the force per mass f, m/s2, replaces."""
    return k * force / nu


def reference(quantity, scene, t):
    period, fluid = cell(scene), scene["fluid"]
    nu = fluid["viscosity"] / fluid["density"]
    force = math.hypot(*scene["domain"]["gravity"][:2])
    u = superficial_velocity(period.permeability(), force, nu)
    if quantity == "permeability":  # over r^2
        return period.permeability() / period.radius**2
    if quantity == "superficial_velocity":
        return u
    if quantity == "mean_fluid_velocity":
        return u / (1.0 - period.solid_fraction)
    if quantity == "force_per_length":  # by the fluid on one cylinder when pressure is periodic
        return fluid["density"] * force * period.area * (1.0 - period.solid_fraction) / period.count
    if quantity == "reynolds":
        return 2.0 * period.radius * u / nu
    raise KeyError(quantity)


def measured_permeability(scene, v, volume=None):
    """K/r^2 from the velocities v [n, >= 2] of the fluid's particles at rest in time: (1 - c) <v> nu/(f r^2), <v> over the fluid."""
    period, fluid = cell(scene), scene["fluid"]
    gravity = np.asarray(scene["domain"]["gravity"][:2], float)
    force = float(np.linalg.norm(gravity))
    mean = np.average(np.asarray(v, float)[:, :2], axis=0, weights=volume) @ gravity / force
    nu = fluid["viscosity"] / fluid["density"]
    return float((1.0 - period.solid_fraction) * mean * nu / (force * period.radius**2))
