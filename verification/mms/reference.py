"""Manufactured solution of the weakly compressible equations on a periodic square, with its sources (README.md)."""

import math
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import deformed_lattice, tait  # noqa: E402
from theory.field_errors import component_norms, without_mean  # noqa: E402

UNITS = {"velocity_l1": "1", "velocity_l2": "1", "velocity_linf": "1", "pressure_l2": "1", "density_l2": "1",
         "pressure_shape_l2": "1", "mean_pressure": "1"}


class Term(NamedTuple):
    """amplitude * s(t) * cos(a X + b Y - phase), X = 2 pi x/L, Y = 2 pi y/L; s = 1, cos(w t) or sin(w t) for swing 0, 1, 2."""

    amplitude: float
    a: int
    b: int
    phase: float
    swing: int = 0


SINE = 0.5 * math.pi  # cos(q - pi/2) = sin q
# psi k/U = sin X sin Y + cos(wt) cos(2X + Y)/2, with sin X sin Y = [cos(X - Y) - cos(X + Y)]/2
STREAM = (Term(0.5, 1, -1, 0.0), Term(-0.5, 1, 1, 0.0), Term(0.5, 2, 1, 0.0, 1))
# chi k/U = [1/2 + sin(wt)] cos(X - 2Y), times the scene's divergence
POTENTIAL = (Term(0.5, 1, -2, 0.0), Term(1.0, 1, -2, 0.0, 2))
# p/(rho_0 U^2) = [cos 2X + cos Y]/4 + sin(wt) sin(X + 2Y)/2
PRESSURE = (Term(0.25, 2, 0, 0.0), Term(0.25, 0, 1, 0.0), Term(0.5, 1, 2, SINE, 2))


def _along(terms, axis):
    """Terms of the derivative by X (axis 0) or Y (1): d cos(q - f) = -sin(q - f) dq = cos(q - f + pi/2) dq."""
    return tuple(t._replace(amplitude=t.amplitude * (t.b if axis else t.a), phase=t.phase - SINE) for t in terms)


def _scaled(terms, factor):
    return tuple(t._replace(amplitude=factor * t.amplitude) for t in terms)


class Manufactured:
    """initial = {law = "manufactured", speed = U, divergence = d}: velocities are curl psi + d grad chi."""

    def __init__(self, scene):
        fluid, initial = scene["fluid"], scene["fluid"]["initial"]
        self.speed, self.rho, self.c = initial["speed"], fluid["density"], fluid["sound_speed"]
        self.viscosity = fluid["viscosity"]
        self.k = 2.0 * math.pi / scene["domain"]["size"][0]
        self.omega = self.k * self.speed  # one period of the swing takes L/U
        share = initial["divergence"]
        self.u_terms = _along(STREAM, 1) + _scaled(_along(POTENTIAL, 0), share)
        self.v_terms = _scaled(_along(STREAM, 0), -1.0) + _scaled(_along(POTENTIAL, 1), share)

    def _sum(self, terms, x, t, rate=False):
        """Sum of the terms at x [n, >= 2] and t, or of their derivatives by w t."""
        swing = (0.0, -math.sin(self.omega * t), math.cos(self.omega * t)) if rate else (
            1.0, math.cos(self.omega * t), math.sin(self.omega * t))
        x = np.asarray(x, float) * self.k
        return sum(q.amplitude * swing[q.swing] * np.cos(q.a * x[:, 0] + q.b * x[:, 1] - q.phase) for q in terms)

    def _laplacian(self, terms, x, t):
        return self._sum([q._replace(amplitude=-(q.a**2 + q.b**2) * q.amplitude) for q in terms], x, t)

    def velocity(self, x, t):
        """[n, 2], m/s."""
        return self.speed * np.stack([self._sum(self.u_terms, x, t), self._sum(self.v_terms, x, t)], axis=1)

    def velocity_gradient(self, x, t):
        """[n, 2, 2], 1/s: d v_i/d x_j."""
        rows = [[self._sum(_along(terms, axis), x, t) for axis in (0, 1)] for terms in (self.u_terms, self.v_terms)]
        return self.speed * self.k * np.moveaxis(np.array(rows), -1, 0)

    def pressure(self, x, t):
        """[n], Pa."""
        return self.rho * self.speed**2 * self._sum(PRESSURE, x, t)

    def density(self, x, t):
        """[n], kg/m3: Tait's density of the pressure."""
        return tait.density(self.pressure(x, t), self.rho, self.c)

    def divergence(self, x, t):
        """div v [n], 1/s."""
        return self.speed * self.k * (self._sum(_along(self.u_terms, 0), x, t) + self._sum(_along(self.v_terms, 1), x, t))

    def pressure_gradient(self, x, t):
        """[n, 2], Pa/m."""
        parts = [self._sum(_along(PRESSURE, axis), x, t) for axis in (0, 1)]
        return self.rho * self.speed**2 * self.k * np.stack(parts, axis=1)

    def density_source(self, x, t):
        """[n], kg/m3/s, for D rho/Dt = -rho div v + source: (dp/dt + v.grad p)/c_local^2 + rho div v."""
        rate = self.rho * self.speed**2 * self.omega * self._sum(PRESSURE, x, t, rate=True)
        carried = np.sum(self.velocity(x, t) * self.pressure_gradient(x, t), axis=1)
        rho = self.density(x, t)
        return (rate + carried) / tait.sound_speed(rho, self.rho, self.c) ** 2 + rho * self.divergence(x, t)

    def momentum_source(self, x, t):
        """[n, 2], m/s2, for D v/Dt = -grad p/rho + mu/rho lap v + source."""
        v, rho = self.velocity(x, t), self.density(x, t)
        source = self.pressure_gradient(x, t) / rho[:, None]
        for axis, terms in enumerate((self.u_terms, self.v_terms)):
            rate = self.speed * self.omega * self._sum(terms, x, t, rate=True)
            slopes = [self.speed * self.k * self._sum(_along(terms, d), x, t) for d in (0, 1)]
            viscous = self.viscosity / rho * self.speed * self.k**2 * self._laplacian(terms, x, t)
            source[:, axis] += rate + v[:, 0] * slopes[0] + v[:, 1] * slopes[1] - viscous
        return source


def velocity_norms(scene, x, v, t, volume=None):
    """{"l1", "l2", "linf"} of the velocity error by component over U."""
    made = Manufactured(scene)
    return component_norms(np.asarray(v)[:, :2], made.velocity(x, t), made.speed, volume)


def pressure_norms(scene, x, p, t, volume=None):
    """The same for pressures p [n], over rho_0 U^2. The constant counts: Tait's equation and the density source fix it."""
    made = Manufactured(scene)
    return component_norms(p, made.pressure(x, t), made.rho * made.speed**2, volume)


def density_norms(scene, x, rho, t, volume=None):
    """The same for densities rho [n], over rho_0 Ma^2, the size of the exact variation."""
    made = Manufactured(scene)
    return component_norms(rho, made.density(x, t), made.rho * (made.speed / made.c) ** 2, volume)


def plain_drift(scene, t, side=24, steps=20):
    """Mean pressure of the plain operators at t over rho_0 U^2: c^2 times the time integral of the mean of -D over particles
    (README, eq. 8)."""
    made, fluid = Manufactured(scene), scene["fluid"]
    length = 2.0 * math.pi / made.k
    middles = (np.arange(side) + 0.5) * length / side
    x = np.stack(np.meshgrid(middles, middles), axis=-1).reshape(-1, 2)
    times = np.linspace(0.0, t, steps + 1)
    means = deformed_lattice.divergence_errors(fluid["kernel"], fluid["smoothing"], made.velocity, made.velocity_gradient, x,
                                               times).mean(axis=1)
    return -((made.c / made.speed) ** 2) * np.mean(0.5 * (means[1:] + means[:-1])) * t


def reference(quantity, scene, t):
    if quantity == "mean_pressure":
        return plain_drift(scene, float(np.max(t)))
    if quantity in UNITS:
        return 0.0  # norms of errors; judged by absolute metrics
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    last = run.snapshot(-1)
    fluid, t = last["fluid"], last["time"]
    made, x, p = Manufactured(run.scene), fluid["x"], fluid["p"]
    scale = made.rho * made.speed**2
    if quantity == "mean_pressure":
        return float(np.mean(p - made.pressure(x, t))) / scale
    if quantity == "pressure_shape_l2":
        return float(component_norms(without_mean(p), without_mean(made.pressure(x, t)), scale)["l2"][0])
    name, norm = quantity.split("_")
    norms = {"velocity": velocity_norms, "pressure": pressure_norms, "density": density_norms}[name]
    field = {"velocity": fluid["v"], "pressure": p, "density": fluid["rho"]}[name]
    return float(np.max(norms(run.scene, x, field, t)[norm]))


def table(runs):
    """Velocity errors, and their order from one run to the next finer one; growing_50, growing_100 and growing_200 are one path."""
    paths = {}
    for run in (run for run in runs if run.failure is None):
        paths.setdefault("growing" if run.variant.startswith("growing_") else run.variant, []).append(run)
    rows = [row for name, path in paths.items() for row in path_rows(name, path)]
    columns = ["path", "spacing (m)", "h/spacing", "velocity error", "order"]
    return {"columns": columns, "rows": rows, "caption": "Root mean square of the velocity error, the worse component, over U; order since the row above."}


def path_rows(name, path):
    """Rows of the table for runs of one path of refinement."""
    rows, before = [], None
    for run in sorted(path, key=lambda run: -run.scene["fluid"]["spacing"]):
        fluid, error = run.scene["fluid"], measure("velocity_l2", run)
        order = math.log(before[1] / error) / math.log(before[0] / fluid["spacing"]) if before else math.nan
        rows.append([name, f"{fluid['spacing']:g}", f"{fluid['smoothing']:g}", f"{error:.3g}", f"{order:.2f}" if before else ""])
        before = (fluid["spacing"], error)
    return rows
