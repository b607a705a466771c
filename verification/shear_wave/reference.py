"""Decay of a shear wave by viscosity, and by the viscous operator of SPH (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators  # noqa: E402
from theory.field_errors import component_norms  # noqa: E402

UNITS = {
    "amplitude": "m/s",
    "amplitude_operator": "m/s",
    "kinetic_energy": "m2/s2",
    "decay_rate": "1/s",
    "decay_rate_operator": "1/s",
    "decay_rate_lattice": "1/s",
    "velocity_l2": "1",
}


class Wave:
    """initial = {law = "shear_wave", speed = U, waves = m}: u_x = U sin(k y), k = 2 pi m/size[1]; any dimension."""

    def __init__(self, scene):
        fluid, initial = scene["fluid"], scene["fluid"]["initial"]
        self.speed = initial["speed"]
        self.k = 2.0 * math.pi * initial.get("waves", 1) / scene["domain"]["size"][1]
        self.nu = fluid["viscosity"] / fluid["density"]
        self.rate = self.nu * self.k**2
        self.fluid = fluid

    def velocity(self, x, t, rate=None):
        """[n, d], m/s, at positions x [n, d]; `rate`: another decay rate, 1/s."""
        x = np.asarray(x, float)
        u = np.zeros_like(x)
        u[:, 0] = self.speed * math.exp(-(self.rate if rate is None else rate) * t) * np.sin(self.k * x[:, 1])
        return u

    def operator_rate(self, dimension):
        """lambda(k), 1/s, of Morris' operator with the scene's kernel and h, many neighbours."""
        h = self.fluid["smoothing"] * self.fluid["spacing"]
        return self.rate * float(sph_operators.viscosity_ratio(self.fluid["kernel"], dimension, self.k * h))

    def lattice_rate(self, dimension):
        """lambda, 1/s, of the sum over the particles on their initial square or cubic lattice, the wave along an axis."""
        h = self.fluid["smoothing"] * self.fluid["spacing"]
        k = np.zeros(dimension)
        k[1] = self.k
        return self.rate * sph_operators.lattice_viscosity(self.fluid["kernel"], k, h, self.fluid["spacing"])


def amplitude(x, v, wave, volume=None):
    """Least-squares amplitude of sin(k y) in the x velocities, m/s: a projection, which noise of other waves leaves alone."""
    shape = np.sin(wave.k * np.asarray(x)[:, 1])
    weight = np.ones(len(shape)) if volume is None else np.asarray(volume)
    return float(weight @ (shape * np.asarray(v)[:, 0]) / (weight @ shape**2))


def decay_rate(t, amplitudes):
    """Slope of -ln(amplitude) against t by least squares, 1/s."""
    return float(-np.polyfit(t, np.log(amplitudes), 1)[0])


def velocity_norms(scene, x, v, t, volume=None):
    """{"l1", "l2", "linf"} of the velocity error by component over U exp(-nu k^2 t)."""
    wave = Wave(scene)
    return component_norms(v, wave.velocity(x, t), wave.speed * math.exp(-wave.rate * t), volume)


def reference(quantity, scene, t):
    wave = Wave(scene)
    t = np.asarray(t, float)
    if quantity == "amplitude":
        return wave.speed * np.exp(-wave.rate * t)
    if quantity == "amplitude_operator":
        return wave.speed * np.exp(-wave.operator_rate(sph_operators.dimension(scene["domain"]["size"])) * t)
    if quantity == "kinetic_energy":  # mean of u^2/2 over the box
        return 0.25 * wave.speed**2 * np.exp(-2.0 * wave.rate * t)
    if quantity == "decay_rate":
        return wave.rate
    if quantity == "decay_rate_operator":
        return wave.operator_rate(sph_operators.dimension(scene["domain"]["size"]))
    if quantity == "decay_rate_lattice":
        return wave.lattice_rate(sph_operators.dimension(scene["domain"]["size"]))
    if quantity == "velocity_l2":
        return 0.0
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity.startswith("decay_rate"):
        return decay_rate(*run.series("amplitude"))
    return NotImplemented
