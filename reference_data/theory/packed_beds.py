"""Fluid through beds of spheres: pressure drop, permeability, start-up, and hindered settling beside it.

Two forces are meant by "drag" (drag_laws/README.md): f_d, which leaves the mean pressure gradient out, and the whole force of
the fluid on a grain, f_d/eps in a uniform steady bed. A bed at rest balances the pressure gradient with the whole force on its
n = (1 - eps)/V grains per volume, and a law F = f_d/(3 pi mu d u_s), Re = rho d u_s/mu, with u_s = eps u gives

    -dp/dx = n f_d/eps = 18 mu (1 - eps) u_s F(eps, Re)/(eps d^2)                                                     (1)

Anything that takes f_d for the whole force is too permeable by 1/eps.

Start-up. The fluid of a uniform fixed bed is driven by the acceleration G (a body force, or a mean pressure gradient rho G that
the grains feel too): eps rho du/dt = eps rho G - n f_d, u the interstitial velocity, so

    du/dt = G - a u - b u^2,    a + b u = n f_d/(eps rho u) = 18 nu (1 - eps) F/d^2                                   (2)

with a = 150 nu (1 - eps)^2/(eps^2 d^2) and b = 1.75 (1 - eps)/(eps d) for Ergun. From rest, with s = sqrt(a^2 + 4 b G):

    u = 2 G (1 - e^(-s t))/[s (1 + e^(-s t)) + a (1 - e^(-s t))]                                                       (3)

which is (G/a)(1 - e^(-a t)) at b = 0 and sqrt(G/b) tanh(sqrt(b G) t) at a = 0.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from drag_laws.drag_laws import LAWS

from .settling import FLUIDS, GRAIN, archimedes, hindered_re

BED_EPS = (0.36, 0.4, 0.45, 0.5, 0.55, 0.62, 0.7, 0.78, 0.85, 0.9, 0.95)
BED_RE = (0.0, 0.01, 0.1, 1.0, 10.0, 100.0)
HINDERED_EPS = tuple(round(0.4 + 0.05 * i, 2) for i in range(12)) + (0.97, 0.99)


def pressure_gradient(law, eps, u_s, d, rho, mu):
    """-dp/dx of equation (1), Pa/m, at superficial velocity u_s; law(eps, Re) is F of the drag laws."""
    return 18.0 * mu * (1.0 - eps) * u_s * law(eps, rho * d * u_s / mu) / (eps * d**2)


def whole_force(law, eps, u_s, d, rho, mu):
    """Force of the fluid on one grain of a steady uniform bed, N: f_d/eps = 3 pi mu d u_s F/eps."""
    return 3.0 * math.pi * mu * d * u_s * law(eps, rho * d * u_s / mu) / eps


def ergun_gradient(eps, u_s, d, rho, mu):
    """Ergun (1952), -dp/dx in Pa/m, from the paper's own form."""
    return 150.0 * mu * (1.0 - eps) ** 2 * u_s / (eps**3 * d**2) + 1.75 * rho * (1.0 - eps) * u_s**2 / (eps**3 * d)


def kozeny_carman(eps, d):
    """Permeability d^2 eps^3/(180 (1 - eps)^2), m2; Ergun's creeping part has 150 for 180."""
    return d**2 * eps**3 / (180.0 * (1.0 - eps) ** 2)


def darcy_permeability(law, eps, d):
    """K = mu u_s/(-dp/dx) at Re -> 0, m2: d^2 eps/(18 (1 - eps) F(eps, 0))."""
    return d**2 * eps / (18.0 * (1.0 - eps) * law(eps, 0.0))


def superficial_velocity(law, eps, gradient, d, rho, mu):
    """u_s, m/s, at which equation (1) gives `gradient` > 0."""
    darcy = darcy_permeability(law, eps, d) * gradient / mu
    low, high = 1e-6 * darcy, 2.0 * darcy
    while pressure_gradient(law, eps, high, d, rho, mu) < gradient:
        high *= 2.0
    return brentq(lambda u: pressure_gradient(law, eps, u, d, rho, mu) / gradient - 1.0, low, high, xtol=1e-300, rtol=1e-14)


def minimum_fluidisation(law, eps, d, rho, mu, rho_p, g):
    """u_s, m/s, at which the bed's weight less buoyancy is carried: -dp/dx = (1 - eps)(rho_p - rho) g."""
    return superficial_velocity(law, eps, (1.0 - eps) * (rho_p - rho) * g, d, rho, mu)


def ergun_coefficients(eps, d, rho, mu):
    """(a, b) of equation (2), 1/s and 1/m, for Ergun's law."""
    return 150.0 * mu * (1.0 - eps) ** 2 / (rho * eps**2 * d**2), 1.75 * (1.0 - eps) / (eps * d)


def linear_coefficient(law, eps, d, rho, mu):
    """a of equation (2), 1/s, for a law at Re = 0."""
    return 18.0 * mu * (1.0 - eps) * float(law(eps, 0.0)) / (rho * d**2)


def start_up(t, acceleration, a, b):
    """Interstitial velocity u(t) of equation (3), m/s, from rest; a, b >= 0, not both zero."""
    s = math.sqrt(a**2 + 4.0 * b * acceleration)
    gained = -np.expm1(-s * np.asarray(t, float))
    return 2.0 * acceleration * gained / (s * (2.0 - gained) + a * gained)


def start_up_of_law(t, acceleration, law, eps, d, rho, mu):
    """u(t) of equation (2) for any law, integrated with Radau's method to 1e-10; t increasing from 0."""

    def rate(_, u):
        re = rho * d * eps * abs(u[0]) / mu
        return [acceleration - 18.0 * mu * (1.0 - eps) * float(law(eps, re)) / (rho * d**2) * u[0]]

    scale = acceleration / linear_coefficient(law, eps, d, rho, mu)
    solved = solve_ivp(rate, (0.0, float(t[-1])), [0.0], "Radau", t_eval=t, rtol=1e-10, atol=1e-12 * scale)
    return solved.y[0]


def richardson_zaki_exponent(re_t):
    """n of v = u_t eps^n, Re on the terminal velocity, no wall term; Richardson & Zaki (1954)."""
    if re_t < 0.2:
        return 4.65
    if re_t < 1.0:
        return 4.35 * re_t**-0.03
    return 4.45 * re_t**-0.1 if re_t < 500.0 else 2.39


def bed_rows():
    """(law, eps, Re, -dp/dx over mu u_s/d^2, the same over Ergun's, K/d^2 of the law at Re -> 0, K/d^2 of Kozeny-Carman)."""
    rows = []
    for name, law in LAWS.items():
        for eps in BED_EPS:
            for re in BED_RE:
                scaled = float(18.0 * (1.0 - eps) * law(eps, re) / eps)  # equation (1) with mu = d = u_s = 1
                ergun = 150.0 * (1.0 - eps) ** 2 / eps**3 + 1.75 * (1.0 - eps) * re / eps**3
                permeabilities = float(darcy_permeability(law, eps, 1.0)), kozeny_carman(eps, 1.0)
                rows.append((name, eps, re, scaled, scaled / ergun, *permeabilities))
    return rows


def hindered_rows():
    """(fluid, eps, v with eps^(1 + chi), v with eps^chi, v after Richardson & Zaki on Di Felice's u_t, their n), zero net flux."""
    d, rho_p = GRAIN["d"], GRAIN["rho_p"]
    rows = []
    for name, fluid in FLUIDS.items():
        rho, mu = fluid["rho"], fluid["mu"]
        ar, speed = archimedes(rho_p, rho, d, mu), mu / (rho * d)
        alone = hindered_re(ar, 1.0, 1)
        n = richardson_zaki_exponent(alone)
        for eps in HINDERED_EPS:
            rows.append((name, eps, hindered_re(ar, eps, 1) * speed, hindered_re(ar, eps, 0) * speed, alone * speed * eps**n, n))
    return rows
