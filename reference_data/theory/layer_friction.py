"""Morris' friction of a wave (-Dc/k, c)(z) between two plates where the viscosity mu(z) varies.

Particles a and b rub each other with the sum of their viscosities (sph_operators, equation 2). In the limit of many neighbours,
for every test function e,

    F(c, e) = sum over c e and Dc De/k^2 of  Int Int (mu_a + mu_b) [M(z_ab; 0) c_a - M(z_ab; k) c_b] e_a dz_a dz_b            (1)

with M(z; k) = Int (-W'(r)/r) J0(k s) 2 pi s ds over the plane at height z. Behind a wall the velocity is continued antisymmetrically
and mu_b = mu_a, as for a wall's particles. For long waves (1) becomes

    Int mu grad u : grad v = Int mu [2 Dc De + k^2 c e + D2c D2e/k^2]                                                        (2)

which is Newton's friction, Int 2 mu E(u) : E(v), only where mu is uniform: the term grad(u).grad(mu), which lets a normal velocity that
varies along an edge pull on the edge sideways, is missing from pair friction of this kind.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.special import j0

from .sph_operators import KERNELS, support

SIDEWAYS = {"no_slip": -1.0, "free_slip": 1.0}  # of the velocity along a wall, continued behind it


class Operator(NamedTuple):
    """The fluid's kernel and its h, the walls at 0 and `height`, m."""

    kernel: str
    h: float
    height: float
    floor: str


def morris_average(z, kernel, h, k, points=48):
    """M(z; k) of (1), 1/m3."""
    node, weight = np.polynomial.legendre.leggauss(points)
    chosen, z = KERNELS[kernel], np.abs(np.asarray(z, float)) / h
    total = np.zeros_like(z)
    for low, high in zip(chosen.knots[:-1], chosen.knots[1:]):
        low = np.clip(z, low, high)
        q = 0.5 * ((high + low)[..., None] + (high - low)[..., None] * node)
        r = h * np.sqrt(np.maximum(q**2 - z[..., None] ** 2, 0.0))
        total += np.sum(-chosen.slope(q) * j0(k * r) * weight, axis=-1) * 0.5 * (high - low)
    return 2.0 * math.pi * chosen.sigma[3] * total / h**3


@lru_cache(maxsize=64)
def _table(kernel, h, k):
    reach = np.linspace(0.0, support(kernel) * h, 1201)
    return CubicSpline(reach, morris_average(reach, kernel, h, k))


def _average(z, kernel, h, k):
    """M from a table."""
    z, reach = np.abs(z), support(kernel) * h
    return np.where(z < reach, _table(kernel, h, k)(np.minimum(z, reach)), 0.0)


def form(x, mu, k, operator):
    """The matrix of (1) for mu at the points of the spline space x (layered_rayleigh_taylor.Space)."""
    kernel, h = operator.kernel, operator.h
    apart, sums = np.subtract.outer(x.z, x.z), np.add.outer(x.z, x.z)
    near, images = _average(apart, kernel, h, k), _average(sums, kernel, h, k) + _average(2.0 * operator.height - sums, kernel, h, k)
    whole = 2.0 * _table(kernel, h, 0.0).integrate(0.0, support(kernel) * h)
    alike = _average(apart, kernel, h, 0.0) * x.weight
    # Int (mu_a + mu_b) M(z_ab; 0) dz_b, mu_b = mu_a behind the walls
    own = 2.0 * mu * whole + alike @ mu - mu * alike.sum(axis=1)
    both = np.add.outer(mu, mu) * near
    total = np.zeros((x.value.shape[1],) * 2)
    for field, scale, sign in ((x.value.toarray(), 1.0, -1.0), (x.first.toarray(), 1.0 / k**2, SIDEWAYS[operator.floor])):
        weighted = field * x.weight[:, None]
        total += scale * (field.T @ (own[:, None] * weighted) - weighted.T @ (both + 2.0 * sign * mu[:, None] * images) @ weighted)
    return total


def limit_form(x, mu, k):
    """The matrix of (2)."""
    return (2.0 * x.gram(mu, x.first, x.first) + k**2 * x.gram(mu, x.value, x.value) + x.gram(mu, x.second, x.second) / k**2).toarray()
