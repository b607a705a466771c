"""Exact two-dimensional Taylor-Green vortex, and norms of what particles make of it (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators, tait  # noqa: E402
from theory.field_errors import component_norms, without_mean  # noqa: E402

UNITS = {
    "kinetic_energy": "m2/s2",
    "greatest_speed": "m/s",
    "velocity_l1": "1",
    "velocity_l2": "1",
    "velocity_linf": "1",
    "pressure_l2": "1",
    "decay_rate": "1/s",
    "decay_rate_operator": "1/s",
}


class Vortex:
    """The flow of a scene: initial = {law = "taylor_green", speed = U}, one wavelength L = size[0] = size[1] to the box."""

    def __init__(self, scene):
        fluid = scene["fluid"]
        size = scene["domain"]["size"]
        if size[0] != size[1]:
            raise ValueError("the Taylor-Green box is a square")
        self.speed = fluid["initial"]["speed"]
        self.k = 2.0 * math.pi / size[0]
        self.rho, self.c = fluid["density"], fluid.get("sound_speed")
        self.nu = fluid["viscosity"] / fluid["density"]
        self.reynolds = self.speed * size[0] / self.nu
        self.rate = 2.0 * self.nu * self.k**2  # of the velocity: each of its waves has |K|^2 = 2 k^2

    def velocity(self, x, t):
        """[n, 2], m/s, at positions x [n, >= 2], m."""
        x = np.asarray(x, float)
        a, b = self.k * x[:, 0], self.k * x[:, 1]
        u = np.stack([-np.cos(a) * np.sin(b), np.sin(a) * np.cos(b)], axis=1)
        return self.speed * math.exp(-self.rate * t) * u

    def pressure(self, x, t):
        """[n], Pa, with zero mean over the box (incompressible)."""
        x = np.asarray(x, float)
        waves = np.cos(2.0 * self.k * x[:, 0]) + np.cos(2.0 * self.k * x[:, 1])
        return -0.25 * self.rho * self.speed**2 * math.exp(-2.0 * self.rate * t) * waves

    def density(self, x, t):
        """[n], kg/m3: Tait's density of that pressure. A start at uniform density rings with sound instead."""
        return tait.density(self.pressure(x, t), self.rho, self.c)

    def kinetic_energy(self, t):
        """Mean of u^2/2 over the box, m2/s2."""
        return 0.25 * self.speed**2 * np.exp(-2.0 * self.rate * np.asarray(t, float))

    def operator_rate(self, kernel, smoothing_length):
        """Rate of the velocity under Morris' operator, 1/s: lambda at |K| = sqrt(2) k (many neighbours, convection left out)."""
        return self.rate * float(sph_operators.viscosity_ratio(kernel, 2, math.sqrt(2.0) * self.k * smoothing_length))


def velocity_norms(scene, x, v, t, volume=None):
    """{"l1", "l2", "linf"} of the error of velocities v [n, >= 2] at x, by component, over the speed U exp(-rate t)."""
    vortex = Vortex(scene)
    scale = vortex.speed * math.exp(-vortex.rate * t)
    return component_norms(np.asarray(v)[:, :2], vortex.velocity(x, t), scale, volume)


def pressure_norms(scene, x, p, t, volume=None):
    """The same for pressures p [n], both less their means, over rho U^2/2 exp(-2 rate t), the largest exact difference/2."""
    vortex = Vortex(scene)
    scale = 0.5 * vortex.rho * vortex.speed**2 * math.exp(-2.0 * vortex.rate * t)
    exact = without_mean(vortex.pressure(x, t), volume)
    return component_norms(without_mean(np.asarray(p, float), volume), exact, scale, volume)


def reference(quantity, scene, t):
    vortex = Vortex(scene)
    if quantity == "kinetic_energy":
        return vortex.kinetic_energy(t)
    if quantity == "greatest_speed":
        return vortex.speed * np.exp(-vortex.rate * np.asarray(t, float))
    if quantity == "decay_rate":
        return vortex.rate
    if quantity == "decay_rate_operator":
        fluid = scene["fluid"]
        return vortex.operator_rate(fluid["kernel"], fluid["smoothing"] * fluid["spacing"])
    if quantity in ("velocity_l1", "velocity_l2", "velocity_linf", "pressure_l2"):
        return 0.0  # norms of errors; judged by absolute metrics
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity not in ("velocity_l1", "velocity_l2", "velocity_linf", "pressure_l2"):
        return NotImplemented
    last = run.snapshot(-1)
    fluid, t = last["fluid"], last["time"]
    if quantity == "pressure_l2":
        return float(np.max(pressure_norms(run.scene, fluid["x"], fluid["p"], t)["l2"]))
    return float(np.max(velocity_norms(run.scene, fluid["x"], fluid["v"], t)[quantity.removeprefix("velocity_")]))
