"""The fourteen drag laws of the conformance kit, each from its paper's own form.

One convention for all (see README.md for the derivations):

    f_d  = 3 pi mu d u_s F(eps, Re)      drag on one grain of diameter d, N
    u_s  = eps |u - v|                   superficial slip, m/s
    Re   = rho d u_s / mu                on the superficial slip
    eps                                  fluid fraction, 0 < eps <= 1

f_d is the part of the fluid's force that stays when the pressure gradient and the stress of the locally averaged flow
have been taken out: the grain also receives V (-grad p + div tau). In a steady uniform bed the whole force is f_d / eps.

Every function takes numbers or NumPy arrays `eps`, `re` (re = 0 is the creeping limit, not an error) and returns F.
This module is independent of any solver and needs NumPy alone.
"""

import numpy as np

# Morsi & Alexander (1972), J. Fluid Mech. 55, 193, Table 1: C_D = a1 + a2/Re + a3/Re^2, upper end of each interval
MORSI_ALEXANDER = (
    (0.1, 0.0, 24.0, 0.0),
    (1.0, 3.690, 22.73, 0.0903),
    (10.0, 1.222, 29.1667, -3.8889),
    (100.0, 0.6167, 46.50, -116.67),
    (1000.0, 0.3644, 98.33, -2778.0),
    (5000.0, 0.357, 148.62, -4.75e4),
    (10000.0, 0.46, -490.546, 57.87e4),
    (np.inf, 0.5191, -1662.5, 5.4167e6),
)


def _arrays(eps, re):
    return np.broadcast_arrays(np.asarray(eps, dtype=float), np.asarray(re, dtype=float))


def _power(re, exponent):
    """re ** exponent for a negative exponent, with +inf at re = 0 and no warning."""
    with np.errstate(divide="ignore"):
        return np.power(re, exponent)


# --- one sphere: f(Re_i) = C_D Re_i / 24 on the interstitial slip ------------------------------------------------------
# f_d = 3 pi mu d |u - v| f(Re_i) and |u - v| = u_s / eps, Re_i = Re / eps, hence F = f(Re / eps) / eps.


def one_sphere_stokes(re_i):
    """Stokes (1851): C_D = 24/Re."""
    return np.ones_like(re_i)


def one_sphere_schiller_naumann(re_i):
    """Schiller & Naumann (1935): C_D = 24/Re (1 + 0.15 Re^0.687) below 1000; the customary Newton value 0.44 from there."""
    return np.where(re_i < 1000.0, 1.0 + 0.15 * re_i**0.687, 0.44 * re_i / 24.0)


def one_sphere_morsi_alexander(re_i):
    """Morsi & Alexander (1972), Table 1, eight intervals closed on the left; a1 Re + a2 + a3/Re over 24."""
    upper = np.array([row[0] for row in MORSI_ALEXANDER])
    coefficient = np.array([row[1:] for row in MORSI_ALEXANDER])
    a1, a2, a3 = np.moveaxis(coefficient[np.searchsorted(upper, re_i, side="right")], -1, 0)
    inverse = np.divide(1.0, re_i, out=np.zeros_like(re_i), where=re_i > 0.0)  # a3 = 0 in the first interval
    return (a1 * re_i + a2 + a3 * inverse) / 24.0


def one_sphere_brown_lawler(re_i):
    """Brown & Lawler (2003), eq. 19: C_D = 24/Re (1 + 0.150 Re^0.681) + 0.407/(1 + 8710/Re)."""
    return 1.0 + 0.150 * re_i**0.681 + 0.407 * re_i**2 / (re_i + 8710.0) / 24.0


def one_sphere_haider_levenspiel(re_i):
    """Haider & Levenspiel (1989), eq. 10: C_D = 24/Re (1 + 0.1806 Re^0.6459) + 0.4251/(1 + 6880.95/Re)."""
    return 1.0 + 0.1806 * re_i**0.6459 + 0.4251 * re_i**2 / (re_i + 6880.95) / 24.0


def one_sphere_dallavalle(re_i):
    """Dallavalle (1948): C_D = (0.63 + 4.8/sqrt(Re))^2, the single-sphere limit of Di Felice and Rong."""
    return (0.63 * np.sqrt(re_i) + 4.8) ** 2 / 24.0


def _unhindered(one_sphere):
    def law(eps, re):
        eps, re = _arrays(eps, re)
        return one_sphere(re / eps) / eps

    law.__doc__ = one_sphere.__doc__
    return law


stokes = _unhindered(one_sphere_stokes)
schiller_naumann = _unhindered(one_sphere_schiller_naumann)
morsi_alexander = _unhindered(one_sphere_morsi_alexander)
brown_lawler = _unhindered(one_sphere_brown_lawler)
haider_levenspiel = _unhindered(one_sphere_haider_levenspiel)


# --- suspensions -------------------------------------------------------------------------------------------------------


def di_felice(eps, re):
    """Di Felice (1994), Int. J. Multiphase Flow 20, 153: f_d = (pi/8) C_D rho d^2 u_s^2 eps^-chi."""
    eps, re = _arrays(eps, re)
    with np.errstate(divide="ignore"):
        chi = 3.7 - 0.65 * np.exp(-((1.5 - np.log10(re)) ** 2) / 2.0)
    return one_sphere_dallavalle(re) * eps**-chi


def wen_yu(eps, re):
    """Wen & Yu (1966) in the form of Gidaspow (1994): beta = (3/4) C_D eps (1 - eps) rho |u - v| eps^-2.65 / d."""
    eps, re = _arrays(eps, re)
    return one_sphere_schiller_naumann(re) * eps**-3.65


def ergun(eps, re):
    """Ergun (1952): -dp/dx = 150 mu (1-eps)^2 u_s/(eps^3 d^2) + 1.75 rho (1-eps) u_s^2/(eps^3 d)."""
    eps, re = _arrays(eps, re)
    return (150.0 * (1.0 - eps) + 1.75 * re) / (18.0 * eps**2)


def gidaspow(eps, re):
    """Gidaspow (1994): Ergun up to eps = 0.8, Wen-Yu above."""
    eps, re = _arrays(eps, re)
    return np.where(eps > 0.8, wen_yu(eps, re), ergun(eps, re))


def _van_der_hoef(eps):
    """van der Hoef, Beetstra & Kuipers (2005), J. Fluid Mech. 528, 233: creeping flow, f_d without the mean gradient."""
    phi = 1.0 - eps
    return 10.0 * phi / eps**2 + eps**2 * (1.0 + 1.5 * np.sqrt(phi))


def beetstra(eps, re):
    """Beetstra, van der Hoef & Kuipers (2007), AIChE J. 53, 489, eq. 21."""
    eps, re = _arrays(eps, re)
    phi = 1.0 - eps
    numerator = (1.0 / eps + 3.0 * phi * eps) * re + 8.4 * re**0.657  # Re times the bracket: 1 - 0.343 = 0.657
    denominator = 1.0 + 10.0 ** (3.0 * phi) * _power(re, -(1.0 + 4.0 * phi) / 2.0)
    return _van_der_hoef(eps) + 0.413 / (24.0 * eps**2) * numerator / denominator


def tang(eps, re):
    """Tang, Peters, Kuipers, Kriebitzsch & van der Hoef (2015), AIChE J. 61, 688, eq. 21."""
    eps, re = _arrays(eps, re)
    phi = 1.0 - eps
    linear = 0.11 * phi * (1.0 + phi) - 0.00456 / eps**4
    return _van_der_hoef(eps) + linear * re + (0.169 * eps + 0.0644 / eps**4) * re**0.657


def tenneti(eps, re):
    """Tenneti, Garg & Subramaniam (2011), Int. J. Multiphase Flow 37, 1072; their F is the whole force: times eps."""
    eps, re = _arrays(eps, re)
    phi = 1.0 - eps
    total = one_sphere_schiller_naumann(re) / eps**3  # F_isol, the drag of an isolated sphere
    total = total + 5.81 * phi / eps**3 + 0.48 * np.cbrt(phi) / eps**4
    total = total + phi**3 * re * (0.95 + 0.61 * phi**3 / eps**2)
    return eps * total


def rong(eps, re):
    """Rong, Dong & Yu (2013), Chem. Eng. Sci. 99, 44: Di Felice's form with chi(eps, Re)."""
    eps, re = _arrays(eps, re)
    with np.errstate(divide="ignore"):
        bell = np.exp(-((1.5 - np.log10(re)) ** 2) / 2.0)
    return one_sphere_dallavalle(re) * eps ** -(2.65 * (eps + 1.0) - (5.3 - 3.5 * eps) * eps**2 * bell)


def koch_hill(eps, re):
    """Koch & Hill (2001), Annu. Rev. Fluid Mech. 33, 619: whole force F0 + F3 Re_a, Re_a = Re/2 on the radius; times eps."""
    eps, re = _arrays(eps, re)
    phi = 1.0 - eps
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.where(phi > 0.0, phi * np.log(phi), 0.0)
    dilute = 1.0 + 3.0 * np.sqrt(phi / 2.0) + 135.0 / 64.0 * logarithm + 16.14 * phi
    dilute = dilute / (1.0 + 0.681 * phi - 8.48 * phi**2 + 8.16 * phi**3)
    f0 = np.where(phi < 0.4, dilute, 10.0 * phi / eps**3)
    f3 = 0.0673 + 0.212 * phi + 0.0232 / eps**5
    return eps * (f0 + 0.5 * f3 * re)


LAWS = {
    "stokes": stokes,
    "schiller_naumann": schiller_naumann,
    "morsi_alexander": morsi_alexander,
    "brown_lawler": brown_lawler,
    "haider_levenspiel": haider_levenspiel,
    "di_felice": di_felice,
    "wen_yu": wen_yu,
    "ergun": ergun,
    "gidaspow": gidaspow,
    "beetstra": beetstra,
    "tang": tang,
    "tenneti": tenneti,
    "rong": rong,
    "koch_hill": koch_hill,
}

ONE_SPHERE = {
    "stokes": one_sphere_stokes,
    "schiller_naumann": one_sphere_schiller_naumann,
    "morsi_alexander": one_sphere_morsi_alexander,
    "brown_lawler": one_sphere_brown_lawler,
    "haider_levenspiel": one_sphere_haider_levenspiel,
    "di_felice": one_sphere_dallavalle,
}

# Range of each law: (least eps, greatest eps, greatest Re as a function of eps). The one-sphere laws hold at any eps by
# construction of the table (they carry no hindrance), so only Re_i limits them. Sources in README.md.
RANGES = {
    "stokes": (0.0, 1.0, lambda eps: 0.1 * eps),
    "schiller_naumann": (0.0, 1.0, lambda eps: 800.0 * eps),
    "morsi_alexander": (0.0, 1.0, lambda eps: 5.0e4 * eps),
    "brown_lawler": (0.0, 1.0, lambda eps: 2.0e5 * eps),
    "haider_levenspiel": (0.0, 1.0, lambda eps: 2.6e5 * eps),
    "di_felice": (0.4, 1.0, lambda eps: 1.0e4),
    "wen_yu": (0.4, 1.0, lambda eps: 1.0e3),
    "ergun": (0.35, 0.8, lambda eps: 2.5e3 * (1.0 - eps)),
    "gidaspow": (0.4, 1.0, lambda eps: 1.0e3 if eps > 0.8 else 2.5e3 * (1.0 - eps)),
    "beetstra": (0.4, 0.9, lambda eps: 1.0e3),
    "tang": (0.4, 0.9, lambda eps: 1.0e3),
    "tenneti": (0.5, 0.9, lambda eps: 300.0),
    "rong": (0.37, 0.8, lambda eps: 3.0e3),
    "koch_hill": (0.36, 0.995, lambda eps: 200.0),
}


def in_range(law, eps, re):
    """True where the law's authors offer it (RANGES)."""
    least, greatest, re_limit = RANGES[law]
    return least <= eps <= greatest and re <= re_limit(eps)
