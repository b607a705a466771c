"""Tait's equation of state as weakly compressible SPH uses it: p = B [(rho/rho_0)^gamma - 1], B = rho_0 c^2/gamma.

Cole (1948), Underwater Explosions, for gamma = 7 and water; Monaghan (1994), J. Comput. Phys. 110, 399, for SPH, with c an
artificial sound speed of about ten times the largest flow speed. c is the sound speed at rho_0; p(rho_0) = 0.
"""

import numpy as np

GAMMA = 7.0  # Cole (1948), Monaghan (1994)


def stiffness(rho_0, c, gamma=GAMMA):
    """B, Pa."""
    return rho_0 * c**2 / gamma


def pressure(rho, rho_0, c, gamma=GAMMA):
    """p, Pa, of the density rho, kg/m3."""
    return stiffness(rho_0, c, gamma) * np.expm1(gamma * np.log(np.asarray(rho) / rho_0))


def density(p, rho_0, c, gamma=GAMMA):
    """rho, kg/m3, of the pressure p, Pa: the inverse of `pressure`."""
    return rho_0 * np.exp(np.log1p(np.asarray(p) / stiffness(rho_0, c, gamma)) / gamma)


def sound_speed(rho, rho_0, c, gamma=GAMMA):
    """sqrt(dp/drho) = c (rho/rho_0)^((gamma-1)/2), m/s."""
    return c * (np.asarray(rho) / rho_0) ** (0.5 * (gamma - 1.0))


def enthalpy(rho, rho_0, c, gamma=GAMMA):
    """Int dp/rho from rho_0 = c^2/(gamma-1) [(rho/rho_0)^(gamma-1) - 1], J/kg."""
    return c**2 / (gamma - 1.0) * np.expm1((gamma - 1.0) * np.log(np.asarray(rho) / rho_0))
