"""Growth rate of the viscous Rayleigh-Taylor instability, Chandrasekhar (1961), section 94, no surface tension.

Grains of finite inertia (the "dusty" relation). Let the upper layer carry grains of volume fraction phi, density rho_p and
relaxation time tau, small beside the wavelength, and let everything grow as exp(n t). Relative to the state before, a grain
follows the fluid's velocity u with v:

    rho_p n v = rho_p (u - v)/tau + rho n u         (drag, and the pressure gradient that accelerates the fluid)
    v = f u,     f = (1 + b n tau)/(1 + n tau),     b = rho/rho_p                                                     (1)

The mixture's momentum per volume is (1 - phi) rho u + phi rho_p v, so phi rho_p becomes phi rho_p f in the inertia; grains are
carried by v, n dphi = -v_z Dphi, so the driving difference g phi (rho_p - rho) becomes its f-th part. Of the fluid's
incompressibility (1 - phi) u + phi v only the leading part, u, is kept: an error of phi (1 - f). With b = 0 these are the
equations of a dusty gas, f = 1/(1 + n tau) (Saffman 1962, J. Fluid Mech. 13, 120; Michael 1964). Limits: tau -> 0 gives f = 1
and Chandrasekhar's mixture; tau -> infinity at b = 0 decouples the grains, f -> 1/(n tau), and without viscosity
n^3 = g k phi (rho_p - rho)/[tau (rho + (1 - phi) rho)]. At b = 1 inertia is the mixture's at any tau.

The base state is taken at rest in the frame of the grains: it holds while the grains fall less than a wavelength in 1/n.
"""

import math

import numpy as np
from scipy.optimize import brentq

from drag_laws.drag_laws import di_felice

from .settling import FLUIDS, GRAIN, GRAVITY, archimedes, hindered_re, relaxation_time

PACKING = 0.63  # random close packing of the Krieger-Dougherty viscosity used for the published reference
EPS = 0.8  # porosity of the upper layer
LENGTH = 4.0e-3  # m, periodic width of the slides' box: k = 2 pi/L and sqrt(2) 2 pi/L


def suspension_viscosity(mu, eps):
    """Krieger & Dougherty (1959): mu (1 - phi/phi_m)^(-2.5 phi_m), Pa s."""
    return mu * (1.0 - (1.0 - eps) / PACKING) ** (-2.5 * PACKING)


def characteristic(n, k, lower, upper, g=GRAVITY, driving=None):
    """Chandrasekhar's determinant (eq. 113) for two superposed fluids (rho, mu), zero at the growth rate n, 1/s.

    driving: the density difference that gravity acts on, kg/m3, where it is not that of the inertia.
    """
    (rho1, mu1), (rho2, mu2) = lower, upper
    a1, a2 = rho1 / (rho1 + rho2), rho2 / (rho1 + rho2)
    nu1, nu2 = mu1 / rho1, mu2 / rho2
    q1, q2 = math.sqrt(k**2 + n / nu1), math.sqrt(k**2 + n / nu2)
    jump = a1 * nu1 - a2 * nu2
    weight = a2 - a1 if driving is None else driving / (rho1 + rho2)
    return (
        -(1.0 - (g * k / n**2) * weight) * (a2 * q1 + a1 * q2 - k)
        - 4.0 * k * a1 * a2
        + (4.0 * k**2 / n) * jump * (a2 * q1 - a1 * q2 + k * (a1 - a2))
        + (4.0 * k**3 / n**2) * jump**2 * (q1 - k) * (q2 - k)
    )


def growth_rate(k, lower, upper, g=GRAVITY):
    """Largest real root n, 1/s. It lies below the inviscid rate sqrt(g k (a2 - a1))."""
    inviscid = math.sqrt(g * k * (upper[0] - lower[0]) / (upper[0] + lower[0]))
    high = inviscid * (1.0 - 1e-9)
    low = high
    sign = math.copysign(1.0, characteristic(high, k, lower, upper, g))
    while math.copysign(1.0, characteristic(low, k, lower, upper, g)) == sign:
        high, low = low, 0.98 * low
        if low < 1e-6 * inviscid:
            raise ValueError("no root between 1e-6 of the inviscid growth rate and the inviscid rate")
    return brentq(characteristic, low, high, args=(k, lower, upper, g), xtol=1e-13, rtol=1e-14)


def following(n, tau, density_ratio=0.0):
    """f of equation (1), the share of the fluid's velocity that a grain takes up; density_ratio = rho/rho_p, 0 in a gas."""
    return (1.0 + density_ratio * n * tau) / (1.0 + n * tau)


def dusty_growth_rate(k, fluid, phi, mu_2, tau, density_ratio=0.0, g=GRAVITY):
    """Growth rate, 1/s, of grains (GRAIN's density) at volume fraction phi above clear fluid, with equation (1).

    The root is where n, put into f, is returned by the determinant; it is single because f falls with n.
    """
    rho, mu = fluid["rho"], fluid["mu"]
    excess = GRAIN["rho_p"] - rho

    def residual(n):
        f = following(n, tau, density_ratio)
        upper = ((1.0 - phi) * rho + phi * GRAIN["rho_p"] * f, mu_2)
        return characteristic(n, k, (rho, mu), upper, g, phi * excess * f)

    high = math.sqrt(g * k * phi * excess / (rho + (1.0 - phi) * rho))  # no viscosity, no inertia of the grains
    low = high
    while residual(low) <= 0.0:
        high, low = low, 0.98 * low
        if low < 1e-9 * math.sqrt(g * k):
            raise ValueError("no root above 1e-9 of sqrt(g k)")
    return brentq(residual, low, high, xtol=1e-13, rtol=1e-14)


def hindered_relaxation_time(fluid, eps, slip=0.0):
    """tau of equation (1) in a suspension that settles at superficial slip `slip`, m/s: Stokes' over d(u_s F)/du_s of Di Felice.

    The whole force is f_d/eps = 3 pi mu d (u - v) F: the drag's reaction on the fluid adds to the pressure gradient on the grain.
    """
    d, mu = GRAIN["d"], fluid["mu"]
    re = fluid["rho"] * d * slip / mu
    change = (float(di_felice(eps, 1.001 * re)) - float(di_felice(eps, 0.999 * re))) / 0.002  # Re dF/dRe
    return relaxation_time(GRAIN["rho_p"], d, mu) / (float(di_felice(eps, re)) + change)


def settling_slip(fluid, eps):
    """Superficial slip of a settling suspension, m/s."""
    rho, mu, d = fluid["rho"], fluid["mu"], GRAIN["d"]
    return hindered_re(archimedes(GRAIN["rho_p"], rho, d, mu), eps, 1) * mu / (rho * d)


def lowest_grain(t, rates, settling_speed):
    """Fall of the slides' lowest grain since the start, m, by linear theory: rates = n at k1 and at sqrt(2) k1, 1/s.

    The lattice is displaced by -(d/8)(1 - cos k1 x)(1 - cos k1 y): two waves of k1 and their product, d/8 each, add up below the
    lowest grain. Each grows like exp(n t) from the start; the time that motion from rest takes is left out, as on the slides.
    """
    t = np.asarray(t, float)
    waves = 2.0 * np.expm1(rates[0] * t) + np.expm1(rates[1] * t)
    return settling_speed * t + GRAIN["d"] / 8.0 * waves


def rows():
    """(fluid, k, mu_2 closure, rho_2, mu_2, n) for eps = 0.8 grains above clear fluid."""
    result = []
    for name, fluid in FLUIDS.items():
        rho, mu = fluid["rho"], fluid["mu"]
        rho_2 = EPS * rho + (1.0 - EPS) * GRAIN["rho_p"]
        for closure, mu_2 in (("krieger_dougherty", suspension_viscosity(mu, EPS)), ("pure_fluid", mu)):
            for factor in (1.0, math.sqrt(2.0)):
                k = factor * 2.0 * math.pi / LENGTH
                result.append((name, closure, k, rho_2, mu_2, growth_rate(k, (rho, mu), (rho_2, mu_2))))
    return result


def dusty_rows():
    """(fluid, mu_2 closure, k, which tau, tau, n as in a dusty gas, n with the pressure gradient on the grains)."""
    result = []
    for name, fluid in FLUIDS.items():
        mu, phi = fluid["mu"], 1.0 - EPS
        hindered = hindered_relaxation_time(fluid, EPS, settling_slip(fluid, EPS))
        for closure, mu_2 in (("krieger_dougherty", suspension_viscosity(mu, EPS)), ("pure_fluid", mu)):
            for k in (2.0 * math.pi / LENGTH, math.sqrt(2.0) * 2.0 * math.pi / LENGTH):
                for which, tau in (("stokes", relaxation_time(GRAIN["rho_p"], GRAIN["d"], mu)), ("hindered", hindered)):
                    gas = dusty_growth_rate(k, fluid, phi, mu_2, tau)
                    liquid = dusty_growth_rate(k, fluid, phi, mu_2, tau, fluid["rho"] / GRAIN["rho_p"])
                    result.append((name, closure, k, which, tau, gas, liquid))
    return result
