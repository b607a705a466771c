"""Taylor-Green vortex in space at Re = 100: start, and decay of the kinetic energy from a Fourier solution (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicHermiteSpline, CubicSpline

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import tables  # noqa: E402
from theory import tait  # noqa: E402

UNITS = {"kinetic_energy": "m2/s2", "dissipation": "m2/s3", "energy_share": "1"}
REYNOLDS, END = 100.0, 10.0  # of the table: Re = U (L/2 pi)/nu, times up to 10 L/(2 pi U)


class Vortex:
    """initial = {law = "taylor_green_3d", speed = U}; the cube's side is L, lengths are scaled by L/(2 pi)."""

    def __init__(self, scene):
        fluid, size = scene["fluid"], scene["domain"]["size"]
        if not size[0] == size[1] == size[2]:
            raise ValueError("the Taylor-Green box is a cube")
        self.speed, self.rho, self.c = fluid["initial"]["speed"], fluid["density"], fluid.get("sound_speed")
        self.k = 2.0 * math.pi / size[0]
        self.nu = fluid["viscosity"] / fluid["density"]
        self.reynolds = self.speed / (self.k * self.nu)

    def start_velocity(self, x):
        """[n, 3], m/s, at t = 0."""
        a, b, c = (self.k * np.asarray(x, float)).T
        flat = np.zeros_like(a)
        u = np.stack([np.sin(a) * np.cos(b) * np.cos(c), -np.cos(a) * np.sin(b) * np.cos(c), flat], axis=1)
        return self.speed * u

    def start_pressure(self, x):
        """[n], Pa, at t = 0, zero mean: lap p = -rho d_i u_j d_j u_i."""
        a, b, c = (self.k * np.asarray(x, float)).T
        return self.rho * self.speed**2 / 16.0 * (np.cos(2 * a) + np.cos(2 * b)) * (np.cos(2 * c) + 2.0)

    def start_density(self, x):
        """[n], kg/m3: Tait's density of that pressure."""
        return tait.density(self.start_pressure(x), self.rho, self.c)

    def _scaled_time(self, t):
        """U k t; raises beyond the table and at another Reynolds number."""
        if abs(self.reynolds / REYNOLDS - 1.0) > 1e-6:
            raise ValueError(f"the table is for Re {REYNOLDS:g}, the scene has {self.reynolds:g}")
        scaled = self.speed * self.k * np.asarray(t, float)
        if np.any(scaled > END * (1.0 + 1e-9)):
            raise ValueError(f"the table ends at t U 2 pi/L = {END:g}")
        return scaled

    def kinetic_energy(self, t):
        """Mean of u^2/2, m2/s2: Hermite interpolation with the table's own slopes, dE/dt = -dissipation."""
        rows = tables.table("taylor_green_3d/decay.csv")
        return self.speed**2 * CubicHermiteSpline(rows["t"], rows["energy"], -rows["dissipation"])(self._scaled_time(t))

    def dissipation(self, t):
        """nu <omega^2>, m2/s3."""
        rows = tables.table("taylor_green_3d/decay.csv")
        return self.speed**3 * self.k * CubicSpline(rows["t"], rows["dissipation"])(self._scaled_time(t))


def reference(quantity, scene, t):
    vortex = Vortex(scene)
    if quantity == "kinetic_energy":
        return vortex.kinetic_energy(t)
    if quantity == "dissipation":
        return vortex.dissipation(t)
    if quantity == "energy_share":  # of the energy at the start
        return vortex.kinetic_energy(t) / (vortex.speed**2 / 8.0)
    raise KeyError(quantity)


def slope(t, values):
    """(t, d values/dt) by central differences of the inner points; the ends are left out."""
    return t[1:-1], (values[2:] - values[:-2]) / (t[2:] - t[:-2])


def measure(quantity, run):
    if quantity != "dissipation":
        return NotImplemented
    t, rate = slope(*(np.ravel(part) for part in run.series("kinetic_energy")))
    return t, -rate
