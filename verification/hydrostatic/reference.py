"""A column at rest under gravity: compressible (Tait) and incompressible profiles (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import tait  # noqa: E402

UNITS = {
    "bottom_pressure": "Pa",
    "bottom_density": "kg/m3",
    "height": "m",
    "mass": "kg",
    "pressure_error": "1",
    "speed": "m/s",
    "period": "s",
}


class Column:
    """initial = {law = "hydrostatic", depth = H}: fluid of density rho_0 filled to H, then left to its own weight.

    Along the axis of gravity; the sides of the box give the base (size of the other axes; 1 m along z for a plane scene).
    """

    def __init__(self, scene):
        fluid, gravity = scene["fluid"], scene["domain"]["gravity"]
        self.axis = int(np.argmax(np.abs(gravity)))
        self.g = abs(gravity[self.axis])
        self.filled = fluid["initial"]["depth"]
        self.rho, self.c = fluid["density"], fluid["sound_speed"]
        sides = [s for n, s in enumerate(scene["domain"]["size"]) if n != self.axis and s > 0.0]
        self.base = math.prod(sides)
        self.mass = self.rho * self.filled * self.base
        self.bottom_pressure = self.rho * self.g * self.filled  # weight over base, whatever the equation of state
        self.height = self.depth_of_pressure(self.bottom_pressure)

    def density(self, depth):
        """rho, kg/m3, at a depth below the surface, m: c^2/(gamma-1) [(rho/rho_0)^(gamma-1) - 1] = g depth."""
        exponent = tait.GAMMA - 1.0
        return self.rho * np.exp(np.log1p(exponent * self.g * np.asarray(depth, float) / self.c**2) / exponent)

    def pressure(self, depth):
        """p, Pa, at a depth below the surface."""
        return tait.pressure(self.density(depth), self.rho, self.c)

    def incompressible_pressure(self, depth):
        return self.rho * self.g * np.asarray(depth, float)

    def depth_of_pressure(self, p):
        """Depth, m, at which the pressure is p: the inverse of `pressure`."""
        return tait.enthalpy(tait.density(p, self.rho, self.c), self.rho, self.c) / self.g

    def settled(self, z):
        """Height at rest, m, of the fluid that lay at height z of the uniform column: what is above weighs the same."""
        above = self.rho * self.g * (self.filled - np.asarray(z, float))
        return self.height - self.depth_of_pressure(above)

    def periods(self, count=3):
        """Periods, s, of the first standing sound waves of the column (closed below, p = 0 above), uniform c: 4H/((2n+1) c)."""
        return 4.0 * self.filled / ((2.0 * np.arange(count) + 1.0) * self.c)


def pressure_error(column, height, p):
    """(relative L2 error, bias) of pressures p [n] at heights [n], m, above the floor; over the bottom pressure."""
    exact = column.pressure(column.height - np.minimum(np.asarray(height, float), column.height))
    error = (np.asarray(p, float) - exact) / column.bottom_pressure
    return float(np.sqrt(np.mean(error**2))), float(np.mean(error))


def reference(quantity, scene, t):
    column = Column(scene)
    if quantity in ("bottom_pressure", "height", "mass"):
        return getattr(column, quantity)
    if quantity == "bottom_density":
        return float(column.density(column.height))
    if quantity == "period":
        return float(column.periods(1)[0])
    if quantity in ("pressure_error", "speed"):
        return 0.0
    raise KeyError(quantity)
