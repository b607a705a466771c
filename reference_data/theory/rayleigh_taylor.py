"""Growth rate of the viscous Rayleigh-Taylor instability, Chandrasekhar (1961), section 94, no surface tension."""

import math

from scipy.optimize import brentq

from .settling import FLUIDS, GRAIN, GRAVITY

PACKING = 0.63  # random close packing of the Krieger-Dougherty viscosity used for the published reference
EPS = 0.8  # porosity of the upper layer
LENGTH = 4.0e-3  # m, periodic width of the slides' box: k = 2 pi/L and sqrt(2) 2 pi/L


def suspension_viscosity(mu, eps):
    """Krieger & Dougherty (1959): mu (1 - phi/phi_m)^(-2.5 phi_m), Pa s."""
    return mu * (1.0 - (1.0 - eps) / PACKING) ** (-2.5 * PACKING)


def characteristic(n, k, lower, upper, g=GRAVITY):
    """Chandrasekhar's determinant (eq. 113) for two superposed fluids (rho, mu), zero at the growth rate n, 1/s."""
    (rho1, mu1), (rho2, mu2) = lower, upper
    a1, a2 = rho1 / (rho1 + rho2), rho2 / (rho1 + rho2)
    nu1, nu2 = mu1 / rho1, mu2 / rho2
    q1, q2 = math.sqrt(k**2 + n / nu1), math.sqrt(k**2 + n / nu2)
    jump = a1 * nu1 - a2 * nu2
    return (
        -((g * k / n**2) * (a1 - a2) + 1.0) * (a2 * q1 + a1 * q2 - k)
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
