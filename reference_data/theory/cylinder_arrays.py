"""Transverse Stokes flow through arrays of cylinders: force per length F/(mu U), U the superficial velocity.

`force` solves the creeping flow in the lattice's Wigner-Seitz cell with the eigenfunctions of the biharmonic operator and
boundary collocation, the way of Sangani & Acrivos (1982), Int. J. Multiphase Flow 8, 193; `gebart` is the lubrication
formula of Gebart (1992), J. Composite Materials 26, 1100.
"""

import math
from functools import lru_cache

import numpy as np

SIDES = {"square": 4, "hexagonal": 6}


def permeability_from_force(force, solid_fraction, radius=1.0):
    """K = mu U / (-dp/dx) with -dp/dx = F c/(pi r^2): K = pi r^2 / (c F/(mu U)), in units of radius^2."""
    return math.pi * radius**2 / (solid_fraction * force)


def gebart(solid_fraction, array, radius=1.0):
    """K = C r^2 (sqrt(c_m/c) - 1)^2.5; square C = 16/(9 pi sqrt 2), c_m = pi/4; hexagonal 16/(9 pi sqrt 6), pi/(2 sqrt 3)."""
    constant, densest = {
        "square": (16.0 / (9.0 * math.pi * math.sqrt(2.0)), math.pi / 4.0),
        "hexagonal": (16.0 / (9.0 * math.pi * math.sqrt(6.0)), math.pi / (2.0 * math.sqrt(3.0))),
    }[array]
    return constant * radius**2 * (math.sqrt(densest / solid_fraction) - 1.0) ** 2.5


def _modes(order):
    """(n, p) of the radial functions of mode sin(n theta), each already obeying no slip at r = 1 (two per n).

    A mode is a list of (coefficient, power, with_log): f(r) = sum c r^power (ln r). From {r^n, r^-n, r^(n+2), r^(2-n)}
    (n = 1: {r, 1/r, r ln r, r^3}) the two combinations with f(1) = f'(1) = 0.
    """
    modes = [
        (1, [(1.0, 1, True), (-0.5, 1, False), (0.5, -1, False)]),
        (1, [(1.0, 3, False), (-2.0, 1, False), (1.0, -1, False)]),
    ]
    for n in range(3, 2 * order, 2):
        # r^n + a r^-n + b r^(2-n): 1 + a + b = 0 and n - n a + (2-n) b = 0
        modes.append((n, [(1.0, n, False), (n - 1.0, -n, False), (-float(n), 2 - n, False)]))
        # r^(n+2) + a r^-n + b r^(2-n): 1 + a + b = 0 and n+2 - n a + (2-n) b = 0
        modes.append((n, [(1.0, n + 2, False), (float(n), -n, False), (-(n + 1.0), 2 - n, False)]))
    return modes


def _fields(mode, z):
    """u (complex u_x + i u_y), vorticity and p/mu of one mode psi = f(r) sin(n theta) at the points z = x + i y.

    u_r = n f cos(n theta)/r, u_theta = -f' sin(n theta); the vorticity is -Laplacian(psi) and p/mu the harmonic function
    with dp/dx = d(Laplacian psi)/dy, so r^n sin(n theta) -> r^n cos(n theta) and r^-n sin(n theta) -> -r^-n cos(n theta).
    """
    n, terms = mode
    r, theta = np.abs(z), np.angle(z)
    f, slope, laplacian, pressure = (np.zeros_like(r) for _ in range(4))
    for c, power, with_log in terms:
        if with_log:  # r ln r sin(theta), Laplacian (2/r) sin(theta)
            f += c * r * np.log(r)
            slope += c * (np.log(r) + 1.0)
            laplacian += 2.0 * c / r
            pressure -= 2.0 * c / r
            continue
        strength = c * (power**2 - n**2) * r ** (power - 2)
        f += c * r**power
        slope += c * power * r ** (power - 1)
        laplacian += strength
        pressure += strength if power - 2 == n else -strength
    u_r, u_theta = n * f / r * np.cos(n * theta), -slope * np.sin(n * theta)
    return (u_r + 1j * u_theta) * np.exp(1j * theta), -laplacian * np.sin(n * theta), pressure * np.cos(n * theta)


def _edge_rows(modes, normal, along, apothem, s):
    """Conditions on one edge (matrix, one column per mode) and each mode's share of the integral of x u.n over it."""
    centre = apothem * normal * np.ones(1)
    one_half, other_half = centre + s[0] * along, centre - s[0] * along
    columns, fluxes = [], []
    for mode in modes:
        a, b, m = (_fields(mode, z) for z in (one_half, other_half, centre))
        difference = a[0] - b[0]
        columns.append(np.concatenate([difference.real, difference.imag, a[1] + b[1], a[2] + b[2] - 2.0 * m[2]]))
        through = one_half.real * (a[0] * normal.conjugate()).real + other_half.real * (b[0] * normal.conjugate()).real
        fluxes.append(s[1] @ through)
    return np.array(columns).T, np.array(fluxes)


@lru_cache(maxsize=None)
def force(solid_fraction, array, order=24, points=60):
    """F/(mu U) per unit length of cylinder for flow along a face normal of the cell; `order` odd harmonics, radius 1.

    Each edge midpoint of the cell is a centre of inversion of the lattice: velocities are even about it, the vorticity and
    p - p(midpoint) are odd. These are linear conditions on the coefficients of the modes, met by least squares with the
    coefficient of r ln r sin(theta) set to one, which is a force 4 pi mu. U is the cell mean of u_x, by the divergence
    theorem (1/A) times the boundary integral of x u.n.
    """
    sides = SIDES[array]
    area = math.pi / solid_fraction
    apothem = math.sqrt(area / (sides * math.tan(math.pi / sides)))
    node, weight = np.polynomial.legendre.leggauss(points)
    half = apothem * math.tan(math.pi / sides)
    s = (half * (node + 1.0) / 2.0, half * weight / 2.0)
    modes = _modes(order)
    edges = [np.exp(2j * math.pi * side / sides) for side in range(sides)]
    parts = [_edge_rows(modes, normal, 1j * normal, apothem, s) for normal in edges]
    matrix = np.concatenate([part[0] for part in parts])
    flux = sum(part[1] for part in parts)
    scale = np.abs(matrix).max(axis=0)
    solution, *_ = np.linalg.lstsq(matrix[:, 1:] / scale[1:], -matrix[:, 0], rcond=None)
    coefficient = np.concatenate([[1.0], solution / scale[1:]])
    return 4.0 * math.pi / abs(flux @ coefficient / area)


def rows():
    """(array, c, F/(mu U), K/r^2, Gebart K/r^2, Gebart/exact) for the fractions quoted in the literature."""
    result = []
    dilute_to_dense = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6)
    for array, fractions in (("square", dilute_to_dense), ("hexagonal", (*dilute_to_dense, 0.7))):
        for c in fractions:
            exact = permeability_from_force(force(c, array), c)
            result.append((array, c, force(c, array), exact, gebart(c, array), gebart(c, array) / exact))
    return result
