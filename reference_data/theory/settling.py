"""Terminal and hindered settling velocities. Scene of Robinson, Luding & Ramaioli 2014 (slides 2013)."""

import math

from scipy.optimize import brentq

GRAVITY = 9.81  # m/s2
GRAIN = {"d": 1.0e-4, "rho_p": 2500.0}  # slides, "Set of realistic fluid-particle parameters"
FLUIDS = {  # slides, same table; "Glycerol-water" is called a 10 % solution there, which cannot have 8.9 mPa s
    "air": {"rho": 1.18, "mu": 1.86e-5},
    "water": {"rho": 1000.0, "mu": 8.9e-4},
    "glycerol_water": {"rho": 1150.0, "mu": 8.9e-3},
}


def relaxation_time(rho_p, d, mu):
    """Stokes' tau_p = m/(3 pi mu d) = rho_p d^2/(18 mu), s."""
    return rho_p * d**2 / (18.0 * mu)


def stokes_velocity(rho_p, rho, d, mu, g=GRAVITY):
    """Stokes (1851): u_t = (rho_p - rho) g d^2/(18 mu), m/s."""
    return (rho_p - rho) * g * d**2 / (18.0 * mu)


def archimedes(rho_p, rho, d, mu, g=GRAVITY):
    """Ar = rho (rho_p - rho) g d^3/mu^2."""
    return rho * (rho_p - rho) * g * d**3 / mu**2


def di_felice_chi(re):
    """Di Felice (1994): exponent of the voidage function; re on the superficial slip."""
    return 3.7 - 0.65 * math.exp(-((1.5 - math.log10(re)) ** 2) / 2.0)


def dallavalle_drag(re):
    """C_D Re^2 with C_D = (0.63 + 4.8/sqrt(Re))^2, Dallavalle (1948)."""
    return (0.63 * re + 4.8 * math.sqrt(re)) ** 2


def hindered_re(ar, eps, extra):
    """Root Re of (4/3) Ar eps^(extra + chi(Re)) = C_D Re^2.

    With zero net flux the superficial slip of the suspension equals the grains' settling speed, so Re is on that speed.
    extra = 1: the mean pressure gradient also carries the suspended weight, so the effective weight on one grain is
    eps (rho_p - rho) V g (force balance of the mixture); extra = 0 leaves that out, as the slides' row of Re does.
    """

    def residual(log_re):
        re = math.exp(log_re)
        return math.log(4.0 / 3.0 * ar) + (extra + di_felice_chi(re)) * math.log(eps) - math.log(dallavalle_drag(re))

    return math.exp(brentq(residual, math.log(1e-12), math.log(1e6), xtol=1e-14, rtol=1e-14))


def single_grain_rows():
    """(fluid, rho, mu, tau_p, Stokes u_t, Di Felice u_t, Re_p on the latter) for the slides' three fluids."""
    d, rho_p = GRAIN["d"], GRAIN["rho_p"]
    rows = []
    for name, fluid in FLUIDS.items():
        rho, mu = fluid["rho"], fluid["mu"]
        re = hindered_re(archimedes(rho_p, rho, d, mu), 1.0, 1)
        stokes = stokes_velocity(rho_p, rho, d, mu)
        rows.append((name, rho, mu, relaxation_time(rho_p, d, mu), stokes, re * mu / (rho * d), re))
    return rows


def hindered_rows():
    """(fluid, eps, v and Re with eps^(1+chi), v and Re with eps^chi), eps = 0.6 ... 1."""
    d, rho_p = GRAIN["d"], GRAIN["rho_p"]
    rows = []
    for name, fluid in FLUIDS.items():
        ar = archimedes(rho_p, fluid["rho"], d, fluid["mu"])
        for eps in (0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0):
            full, bare = hindered_re(ar, eps, 1), hindered_re(ar, eps, 0)
            speed = fluid["mu"] / (fluid["rho"] * d)
            rows.append((name, eps, full * speed, full, bare * speed, bare))
    return rows
