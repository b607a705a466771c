"""Exact motion of a grain released from rest under constant gravity, buoyancy and drag (README.md).

`python3 reference.py` writes ten_decades.csv again.
"""

import csv
import math
from functools import lru_cache
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
DECADES = 11  # diameters 1e-6 ... 1e-1 m by half decades, so tau_p over ten decades
UNITS = {"path": "m", "amplification": "1", "excess": "1", "distance": "1", "progress": "1"}


def drag_factor(law, re):
    """C_D Re/24 of one sphere."""
    if law == "stokes":
        return 1.0
    if law == "schiller_naumann":  # Schiller & Naumann (1935), Re < 800
        return 1.0 + 0.15 * re**0.687
    raise ValueError(f"no exact motion for the drag law {law}")


class Fall:
    """One grain: acceleration a(v) = a_0 - f(Re) v/tau_p downwards, v(0) = 0."""

    def __init__(self, scene, diameter):
        grain, fluid = scene["grains"], scene["fluid"]
        self.tau = grain["density"] * diameter**2 / (18.0 * fluid["viscosity"])
        self.a_0 = -scene["domain"]["gravity"][2] * (1.0 - fluid["density"] / grain["density"])
        self.re_per_speed = fluid["density"] * diameter / fluid["viscosity"]
        self.law = scene["coupling"]["drag"]
        self.terminal = terminal_velocity(self.law, self.a_0, self.tau, self.re_per_speed)

    def state(self, t):
        """(speed, path) downwards at time t, m/s and m."""
        if self.law == "stokes":
            share = -math.expm1(-t / self.tau)
            return self.terminal * share, self.terminal * stokes_path(t / self.tau) * self.tau
        return state_by_quadrature(self.law, self.a_0, self.tau, self.re_per_speed, float(t))


def stokes_path(s):
    """s - (1 - e^-s), without cancellation at small s (Taylor series below 1e-2: 1e-18 relative there)."""
    if s > 1e-2:
        return s + math.expm1(-s)
    return s**2 / 2.0 - s**3 / 6.0 + s**4 / 24.0 - s**5 / 120.0 + s**6 / 720.0 - s**7 / 5040.0


def acceleration(law, a_0, tau, re_per_speed, v):
    return a_0 - drag_factor(law, re_per_speed * v) * v / tau


@lru_cache(maxsize=None)
def terminal_velocity(law, a_0, tau, re_per_speed):
    """Root of the acceleration, m/s; between 0 and Stokes' value."""
    stokes = a_0 * tau
    if law == "stokes":
        return stokes
    return brentq(lambda v: acceleration(law, a_0, tau, re_per_speed, v), 0.0, stokes, xtol=1e-18, rtol=1e-15)


@lru_cache(maxsize=None)
def state_by_quadrature(law, a_0, tau, re_per_speed, t):
    """dt = dv/a(v) and dx = v dv/a(v) with v = u_t (1 - e^-s), which removes the singularity at the terminal velocity."""
    if t == 0.0:
        return 0.0, 0.0
    terminal = terminal_velocity(law, a_0, tau, re_per_speed)

    def speed(s):
        return -terminal * math.expm1(-s)

    def integral(s, weight):
        def integrand(q):
            v = speed(q)
            return weight(v) * terminal * math.exp(-q) / acceleration(law, a_0, tau, re_per_speed, v)

        return quad(integrand, 0.0, s, epsabs=0.0, epsrel=1e-13, limit=100)[0]

    # a lies between a_0 (1 - v/u_t) and a_0 (1 - (v/u_t)^1.687), hence s between these two:
    least = t * a_0 / terminal
    s = brentq(lambda q: integral(q, lambda v: 1.0) - t, (1.0 - 1e-9) * least, 1.7 * least, xtol=1e-15, rtol=1e-14)
    return speed(s), integral(s, lambda v: v)


def diameters(scene):
    """Diameters of the scene's grains in their order, m."""
    grain = scene["grains"]
    if isinstance(grain["diameter"], float):
        return [grain["diameter"]]
    with open(HERE / grain["arrange"]["path"], newline="", encoding="utf-8") as stream:
        return [float(row["diameter [m]"]) for row in csv.DictReader(stream)]


def ratio(scene):
    """z = step/tau_p of the first grain."""
    return scene["time"]["step"] / Fall(scene, diameters(scene)[0]).tau


def measure(quantity, run):
    """Derived quantities. Nothing of the exact motion enters but the terminal velocity that scales them."""
    if quantity == "velocity":
        return NotImplemented
    if quantity == "path":
        t, z = run.series("position")
        return t, run.scene["grains"]["arrange"]["position"][2] - z
    terminal = np.array([Fall(run.scene, d).terminal for d in diameters(run.scene)])
    t, v = run.series("velocity")
    share = -v.reshape(len(t), -1) / terminal
    if quantity == "progress":
        return t, share
    if quantity == "excess":  # how far outside [0, 1] any grain's share of its terminal velocity ever was
        return float(max(np.max(share) - 1.0, -np.min(share)))
    if quantity == "distance":
        return float(np.max(np.abs(1.0 - share[-1])))
    if quantity == "amplification":  # of the distance to the terminal velocity, in the second step
        return float((1.0 - share[2, 0]) / (1.0 - share[1, 0]))
    raise KeyError(quantity)


def reference(quantity, scene, t):
    falls = [Fall(scene, d) for d in diameters(scene)]
    if quantity == "velocity":
        return np.array([[-fall.state(time)[0] for fall in falls] for time in t])
    if quantity == "path":
        return np.array([falls[0].state(time)[1] for time in t])
    if quantity == "progress":
        return np.array([[fall.state(time)[0] / fall.terminal for fall in falls] for time in t])
    if quantity == "amplification":
        z = ratio(scene)
        factor = {"exponential": math.exp(-z), "implicit": 1.0 / (1.0 + z + z**2 / 2.0), "explicit": 1.0 - z + z**2 / 2.0}
        return factor[scene["coupling"]["exchange"]]
    raise KeyError(quantity)


if __name__ == "__main__":
    with open(HERE / "ten_decades.csv", "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["x [m]", "y [m]", "z [m]", "diameter [m]"])
        for k in range(DECADES):
            writer.writerow([repr(0.15 * (k + 1)), "1.0", "0.25", repr(float(f"{10 ** (-6 + 0.5 * k):.6g}"))])
