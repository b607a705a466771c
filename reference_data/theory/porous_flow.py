"""Steady flow through porous media that fill a channel or a pipe (verification/porous_plug).

    0 = -eps grad p + div(eps mu grad u) - beta(eps, |u|) u + eps rho f     (with eps rho u.grad u on the left along a pipe)

u is the velocity between the solid, eps u the superficial one.
"""

import numpy as np
from scipy.integrate import quad


def darcy(permeability):
    """beta(eps, speed, density, viscosity), kg/(m3 s), of eps u = -(K/mu) grad p."""
    return lambda eps, speed, density, viscosity: eps**2 * viscosity / permeability


def kozeny_carman(diameter):
    """K = d^2 eps^3/(180 (1 - eps)^2) (Carman 1937)."""
    return lambda eps, speed, density, viscosity: eps**2 * viscosity * 180.0 * (1.0 - eps) ** 2 / (diameter**2 * eps**3)


def ergun(diameter):
    """-grad p = 150 mu (1-eps)^2 w/(d^2 eps^3) + 1.75 rho (1-eps) w^2/(d eps^3), w = eps u (Ergun 1952); beta = -eps grad p/u."""

    def beta(eps, speed, density, viscosity):
        w = eps * speed
        viscous = 150.0 * viscosity * (1.0 - eps) ** 2 / (diameter**2 * eps**3)
        return eps**2 * (viscous + 1.75 * density * (1.0 - eps) * w / (diameter * eps**3))

    return beta


LAWS = {"darcy": lambda table: darcy(table["permeability"]), "kozeny_carman": lambda table: kozeny_carman(table["diameter"]),
        "ergun": lambda table: ergun(table["diameter"])}


def resistance(table):
    """beta of a scene's table {law = ..., ...}."""
    return LAWS[table["law"]](table)


def brinkman(y, height, force, density, viscosity, permeability, eps):
    """u(y), m/s, between plates at 0 and `height` with uniform eps: u'' = (u - U)/K', K' = K/eps, U = K rho f/(eps mu)."""
    length = np.sqrt(permeability / eps)
    far = permeability * density * force / (eps * viscosity)
    half = 0.5 * height
    return far * (1.0 - np.cosh((np.asarray(y) - half) / length) / np.cosh(half / length))


def chebyshev(n):
    """Points from 1 to -1 and the differentiation matrix (Trefethen 2000, Spectral Methods in MATLAB, chapter 6)."""
    x = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2.0, np.ones(n - 1), 2.0] * (-1.0) ** np.arange(n + 1)
    difference = x[:, None] - x[None, :]
    d = np.outer(c, 1.0 / c) / (difference + np.eye(n + 1))
    return x, d - np.diag(d.sum(axis=1))


class Layered:
    """u(y) between plates at 0 and `height` where eps varies across: (eps mu u')' - beta u + eps rho f = 0, by Chebyshev
    collocation; beta must not depend on the speed."""

    def __init__(self, height, force, density, viscosity, eps, beta, points=80):
        x, d = chebyshev(points)
        self.height, y = height, 0.5 * height * (x + 1.0)
        d = d * 2.0 / height
        share = eps(y)
        matrix = d @ (viscosity * share[:, None] * d) - np.diag(beta(share, 0.0, density, viscosity))
        right = -share * density * force
        matrix[[0, -1]], right[[0, -1]] = np.eye(points + 1)[[0, -1]], 0.0
        self.coefficients = np.polynomial.chebyshev.chebfit(x, np.linalg.solve(matrix, right), points)

    def velocity(self, y, order=0):
        """u [m/s], or its derivative of some order."""
        x = 2.0 * np.asarray(y) / self.height - 1.0
        made = np.polynomial.chebyshev.chebder(self.coefficients, order) if order else self.coefficients
        return np.polynomial.chebyshev.chebval(x, made) * (2.0 / self.height) ** order


class Plug:
    """Flow along a pipe without walls, eps(x) linear from `lower` to `upper` over `length`; `superficial` = eps u, m/s."""

    def __init__(self, length, lower, upper, superficial, density, viscosity, beta):
        self.length, self.lower, self.slope = length, lower, (upper - lower) / length
        self.superficial, self.density, self.viscosity, self.beta = superficial, density, viscosity, beta

    def eps(self, x):
        return self.lower + self.slope * np.asarray(x)

    def velocity(self, x):
        return self.superficial / self.eps(x)

    def pressure_slope(self, x):
        """dp/dx = -rho u u' + (eps mu u')'/eps - beta u/eps, Pa/m; eps u' = -q eps'/eps, its derivative q eps'^2/eps^2."""
        eps, u = self.eps(x), self.velocity(x)
        inertia = self.density * u * (-u * self.slope / eps)
        friction = self.viscosity * self.superficial * self.slope**2 / eps**3
        return -inertia + friction - self.beta(eps, u, self.density, self.viscosity) * u / eps

    def pressure(self, x):
        """p(x) - p(0), Pa."""
        return np.array([quad(self.pressure_slope, 0.0, at, epsabs=1e-12, epsrel=1e-12)[0] for at in np.ravel(x)])
