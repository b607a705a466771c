"""Motion of one sphere released from rest in fluid at rest, for any single-sphere drag law f(Re) = C_D Re/24.

    (m + k rho V) dv/dt = (rho_p - rho) V g - 3 pi mu d f(Re) v - H(t),   k = 0 or 1/2 (virtual mass)

H is nothing, Basset's force with its creeping-flow kernel, or the finite-Reynolds-number kernel of Mei & Adrian (1992).
Speeds are downwards.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import brentq

GRAVITY = 9.81  # m/s2


class Sphere(NamedTuple):
    """A sphere of density rho_p and diameter d in a fluid of density rho and viscosity mu, under drag factor f(Re)."""

    factor: object
    rho_p: float
    d: float
    rho: float
    mu: float

    def volume(self):
        return math.pi * self.d**3 / 6.0

    def weight(self):
        """Weight less buoyancy, N."""
        return (self.rho_p - self.rho) * self.volume() * GRAVITY

    def reynolds(self, v):
        return self.rho * abs(v) * self.d / self.mu

    def drag(self, v):
        """N at speed v; v may be an array."""
        re = self.rho * np.abs(v) * self.d / self.mu
        return 3.0 * math.pi * self.mu * self.d * v * self.factor(np.asarray(re, dtype=float))

    def inertia(self, added_mass):
        return (self.rho_p + (0.5 * self.rho if added_mass else 0.0)) * self.volume()

    def terminal_speed(self):
        """Root of drag = weight, m/s. Every drag here grows with v (C_D Re rises), so there is one; it is below Stokes'."""
        stokes = self.weight() / (3.0 * math.pi * self.mu * self.d)
        return brentq(lambda v: float(self.drag(v)) - self.weight(), 1e-9 * stokes, 2.0 * stokes, xtol=1e-16, rtol=1e-14)


def speed_without_history(sphere, times, added_mass):
    """v [nt] at increasing times from 0, by an explicit Runge-Kutta method of order 8 to 1e-10."""
    mass, weight = sphere.inertia(added_mass), sphere.weight()

    def rate(_, v):
        return (weight - sphere.drag(v)) / mass

    solution = solve_ivp(rate, (0.0, times[-1]), [0.0], method="DOP853", rtol=1e-10, atol=1e-15, t_eval=times)
    return solution.y[0]


def basset_weights(sphere, t, _):
    """Integrals of (3/2) d^2 sqrt(pi rho mu)/sqrt(t_n - s) over each interval, times 1 and times the local coordinate."""
    constant = 1.5 * sphere.d**2 * math.sqrt(math.pi * sphere.rho * sphere.mu)
    before, after = np.sqrt(t[-1] - t[:-1]), np.sqrt(t[-1] - t[1:])
    whole = 2.0 * (before - after)
    moment = before**2 * whole - 2.0 / 3.0 * (before**3 - after**3)
    rising = moment / np.diff(t)
    return constant * (whole - rising), constant * rising


def mei_adrian_weights(sphere, t, v):
    """The same for Mei & Adrian (1992), J. Fluid Mech. 237, 323: 6 pi mu a K(t_n - s), a = d/2,

    K = {[pi lag nu/a^2]^(1/4) + [(pi/2) v^3 lag^2/(a nu f_H^3)]^(1/2)}^-2,   f_H = 0.75 + 0.105 Re.

    1/sqrt(lag) is integrated exactly, the ratio to it taken at the middle of each interval.
    """
    a, nu = sphere.d / 2.0, sphere.mu / sphere.rho
    falling, rising = basset_weights(sphere, t, v)
    lag, speed = t[-1] - 0.5 * (t[:-1] + t[1:]), 0.5 * (v[:-1] + v[1:])
    f_h = 0.75 + 0.105 * speed * sphere.d / nu
    creeping = (math.pi * lag * nu / a**2) ** 0.25
    ratio = (creeping / (creeping + np.sqrt(0.5 * math.pi * speed**3 * lag**2 / (a * nu * f_h**3)))) ** 2
    return ratio * falling, ratio * rising


def speed_with_history(sphere, times, weights=basset_weights, nodes=1000):
    """v [nt] with virtual mass and a history force, by product integration of the Volterra equation for y = dv/dt.

    y is smooth in sqrt(t) (it starts as y_0 - c sqrt(t)), so the nodes are t_n = end (n/N)^2; y is linear between them, the
    kernel is integrated exactly, each node is solved by Newton's method. 1000 nodes: 5e-6 of the final speed (by halving).
    """
    t = times[-1] * (np.arange(nodes + 1) / nodes) ** 2
    y, v = np.zeros(nodes + 1), np.zeros(nodes + 1)
    mass, weight = sphere.inertia(True), sphere.weight()
    y[0] = weight / mass
    for n in range(1, nodes + 1):
        h = t[n] - t[n - 1]
        v[n] = v[n - 1] + h * y[n - 1]
        falling, rising = weights(sphere, t[: n + 1], v[: n + 1])
        past = falling @ y[:n] + rising[:-1] @ y[1:n]
        y[n] = _newton(sphere, mass + rising[-1], weight - past, v[n - 1] + 0.5 * h * y[n - 1], 0.5 * h, y[n - 1])
        v[n] = v[n - 1] + 0.5 * h * (y[n - 1] + y[n])
    return CubicHermiteSpline(t, v, y)(times)


def _newton(sphere, mass, force, v_known, share, y):
    """Root y of mass y = force - drag(v_known + share y)."""
    scale = abs(sphere.weight()) / mass
    for _ in range(50):
        v = v_known + share * y
        step = 1e-6 * max(abs(v), 1e-9)
        slope = (float(sphere.drag(v + step)) - float(sphere.drag(v))) / step
        change = (mass * y - force + float(sphere.drag(v))) / (mass + share * slope)
        y -= change
        if abs(change) < 1e-12 * scale:
            return y
    return y  # a jump of a piecewise drag law (Morsi-Alexander) may keep Newton from settling; the jump is below 2.4 %


def time_to_share(times, v, share=0.95):
    """First time at which v reaches `share` of its last value, s; v rises. Linear between the given times."""
    target = share * v[-1]
    k = int(np.argmax(v >= target))
    return times[k - 1] + (target - v[k - 1]) / (v[k] - v[k - 1]) * (times[k] - times[k - 1])
