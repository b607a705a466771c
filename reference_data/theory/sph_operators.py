"""What the smoothed-particle operators make of a plane wave: kernels, their Fourier transforms, Morris' viscosity.

In the limit of many neighbours the sums over particles are convolutions, and each multiplies exp(i k.x) by a number:

    gradients   grad q -> i k What(k) q,            What(k) = Int W(r) S(kr) dV                                (1)
    viscosity   nu lap v -> -lambda(k) v,           lambda(k) = 2 nu Int (-W'(r)/r) (1 - S(kr)) dV             (2)

with S the mean of exp(i k.x) over directions: sin(kr)/(kr) in space, J0(kr) in the plane, cos(kr) on a line, and dV =
4 pi r^2 dr, 2 pi r dr, 2 dr. (2) is Morris, Fox & Zhu (1997), J. Comput. Phys. 136, 214, eq. 22 (number from memory), at constant viscosity,

    dv_a/dt = sum_b m_b (mu_a + mu_b)/(rho_a rho_b) (x_ab . grad W_ab)/|x_ab|^2 v_ab,   x_ab . grad W = r W'(r),

with v_b = v_a exp(i k.(x_b - x_a)). For small k, by parts, lambda = nu k^2 [1 - k^2 <r^2>/(4 d) + ...], <r^2> the kernel's
second moment and d the dimension. `lattice_viscosity` and `lattice_gradient` are the same sums over a lattice instead.
"""

import math
from functools import lru_cache
from typing import Callable, NamedTuple

import numpy as np
from scipy.special import j0, spherical_jn


class Kernel(NamedTuple):
    """W(r, h) = sigma_d/h^d w(r/h), zero beyond r = support h. `knots`: where a derivative of w jumps."""

    w: Callable
    slope: Callable  # dw/dq
    sigma: dict  # {dimension: normalisation}
    knots: tuple


def _spline(q, terms, power):
    """sum c (a - q)_+^power over terms (c, a)."""
    return sum(c * np.maximum(a - q, 0.0) ** power for c, a in terms)


def _wendland_c2(q):
    s = np.maximum(1.0 - 0.5 * q, 0.0)
    return s**4 * (2.0 * q + 1.0)


def _wendland_c2_slope(q):
    return -5.0 * q * np.maximum(1.0 - 0.5 * q, 0.0) ** 3


def _wendland_c4(q):
    s = np.maximum(1.0 - 0.5 * q, 0.0)
    return s**6 * (35.0 / 12.0 * q**2 + 3.0 * q + 1.0)


def _wendland_c4_slope(q):
    return -7.0 / 6.0 * q * (2.0 + 5.0 * q) * 2.0 * np.maximum(1.0 - 0.5 * q, 0.0) ** 5


CUBIC = ((0.25, 2.0), (-1.0, 1.0))
QUINTIC = ((1.0, 3.0), (-6.0, 2.0), (15.0, 1.0))

# Normalisations: Dehnen & Aly (2012), MNRAS 425, 1068, table 1, for the Wendland functions (there over the support, here over
# h); Monaghan (1992), ARAA 30, 543, for the cubic spline; Morris et al. (1997) for the quintic in the plane. All are checked by
# quadrature. For the quintic in space some books print 3/(359 pi), which is 0.28 % too much; the integral gives 1/(120 pi).
KERNELS = {
    "wendland_c2": Kernel(_wendland_c2, _wendland_c2_slope, {2: 7 / (4 * math.pi), 3: 21 / (16 * math.pi)}, (0.0, 2.0)),
    "wendland_c4": Kernel(_wendland_c4, _wendland_c4_slope, {2: 9 / (4 * math.pi), 3: 495 / (256 * math.pi)}, (0.0, 2.0)),
    "cubic_spline": Kernel(
        lambda q: _spline(q, CUBIC, 3),
        lambda q: -3.0 * _spline(q, CUBIC, 2),
        {1: 2 / 3, 2: 10 / (7 * math.pi), 3: 1 / math.pi},
        (0.0, 1.0, 2.0),
    ),
    "quintic_spline": Kernel(
        lambda q: _spline(q, QUINTIC, 5),
        lambda q: -5.0 * _spline(q, QUINTIC, 4),
        {1: 1 / 120, 2: 7 / (478 * math.pi), 3: 1 / (120 * math.pi)},
        (0.0, 1.0, 2.0, 3.0),
    ),
}
SHELL = {1: lambda q: 2.0 + 0.0 * q, 2: lambda q: 2.0 * math.pi * q, 3: lambda q: 4.0 * math.pi * q**2}


def dimension(size):
    """2 for a box whose size has two numbers or a third of zero, else 3."""
    return 2 if len(size) == 2 or size[2] == 0.0 else 3


def support(kernel):
    """Radius of the support over h."""
    return KERNELS[kernel].knots[-1]


def wave_mean(z, dimension):
    """S(z), the mean of exp(i z n.e) over all directions n."""
    return {1: np.cos, 2: j0, 3: lambda s: np.sinc(s / math.pi)}[dimension](z)


def _one_less_mean(z, dimension):
    """1 - S(z), from its series where the difference would cancel (terms to z^6: below 1e-13 relative at z = 0.03)."""
    d = dimension
    small = z**2 / (2 * d) * (1.0 - z**2 / (4 * (d + 2)) * (1.0 - z**2 / (6 * (d + 4))))
    return np.where(np.abs(z) < 0.03, small, 1.0 - wave_mean(z, dimension))


@lru_cache(maxsize=None)
def _nodes(kernel, points=96):
    """Gauss points q and weights over the smooth pieces of the kernel."""
    node, weight = np.polynomial.legendre.leggauss(points)
    knots = KERNELS[kernel].knots
    pieces = list(zip(knots[:-1], knots[1:]))
    q = np.concatenate([a + (b - a) * (node + 1.0) / 2.0 for a, b in pieces])
    return q, np.concatenate([(b - a) / 2.0 * weight for a, b in pieces])


def moment(kernel, dimension, power=2):
    """<r^power>/h^power = Int W r^power dV; power 0 is the normalisation."""
    q, weight = _nodes(kernel)
    chosen = KERNELS[kernel]
    return float(weight @ (chosen.sigma[dimension] * chosen.w(q) * q**power * SHELL[dimension](q)))


def transform(kernel, dimension, kh):
    """What(k) of equation (1) for k h, a number or an array (good to kh of about 50)."""
    q, weight = _nodes(kernel)
    chosen = KERNELS[kernel]
    density = weight * chosen.sigma[dimension] * chosen.w(q) * SHELL[dimension](q)
    return wave_mean(np.multiply.outer(np.asarray(kh, float), q), dimension) @ density


def viscosity_ratio(kernel, dimension, kh):
    """lambda(k)/(nu k^2) of equation (2) for k h > 0, a number or an array."""
    q, weight = _nodes(kernel)
    chosen = KERNELS[kernel]
    density = weight * 2.0 * chosen.sigma[dimension] * -chosen.slope(q) / q * SHELL[dimension](q)
    kh = np.asarray(kh, float)
    return _one_less_mean(np.multiply.outer(kh, q), dimension) @ density / kh**2


def central_shear_ratio(kernel, kh):
    """lambda_c(k)/(nu k^2) in space for k h > 0 of a viscous force along the line of centres, on a shear wave:

        lambda_c = 10 nu Int (-W'(r)/r) r^2/(r^2 + 0.01 h^2) <(1 - cos k.x) (x.e)^2/r^2> dV,   k.e = 0,

    Monaghan & Gingold (1983) with K = 10 (Monaghan 2005, Rep. Prog. Phys. 68, 1703: 2 (d + 2)); the mean over directions is 1/3 -
    j1(z)/z, z = k r. The artificial viscosity has this form with nu = alpha c h/10, half of it if it acts on approaching pairs only.
    """
    q, weight = _nodes(kernel)
    chosen = KERNELS[kernel]
    density = weight * 10.0 * chosen.sigma[3] * -chosen.slope(q) / q * q**2 / (q**2 + 0.01) * SHELL[3](q)
    kh = np.asarray(kh, float)
    z = np.multiply.outer(kh, q)
    small = z**2 / 30.0 * (1.0 - z**2 / 28.0)  # the next term, z^4/2268 of it, is below 1e-9 at z = 0.03
    mean = np.where(z < 0.03, small, 1.0 / 3.0 - spherical_jn(1, np.maximum(z, 1e-9)) / np.maximum(z, 1e-9))
    return mean @ density / kh**2


def _lattice(reach, dimension):
    """Integer points [n, d] within `reach` of the origin (square or cubic lattice), without the origin."""
    side = np.arange(-math.floor(reach), math.floor(reach) + 1)
    points = np.stack(np.meshgrid(*[side] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension)
    length = np.linalg.norm(points, axis=1)
    return points[(length > 0) & (length < reach)]


def lattice_viscosity(kernel, k, h, spacing):
    """lambda/(nu |k|^2) of Morris' sum over a square or cubic lattice at rest; k [d], 1/m, may point anywhere."""
    k = np.asarray(k, float)
    d = len(k)
    x = spacing * _lattice(support(kernel) * h / spacing, d)
    r = np.linalg.norm(x, axis=1)
    chosen = KERNELS[kernel]
    slope = chosen.sigma[d] / h ** (d + 1) * chosen.slope(r / h)
    return float(2.0 * spacing**d * np.sum(-slope / r * 2.0 * np.sin(0.5 * x @ k) ** 2) / (k @ k))


def lattice_gradient(kernel, k, h, spacing):
    """[d] factors g with grad q -> i g q for q = exp(i k.x), from the sum V grad W q_b over a lattice; -> What k."""
    k = np.asarray(k, float)
    d = len(k)
    x = spacing * _lattice(support(kernel) * h / spacing, d)  # x_a - x_b
    r = np.linalg.norm(x, axis=1)
    chosen = KERNELS[kernel]
    slope = chosen.sigma[d] / h ** (d + 1) * chosen.slope(r / h)
    return spacing**d * np.sum((-slope / r * np.sin(x @ k))[:, None] * x, axis=0)


def lattice_stiffness(kernel, k, along, h, spacing):
    """K(k) [n], 1/m2, with which a cubic lattice under a pressure p takes particles back to it: dv/dt = -(p/rho) K xi of shear waves

    xi along e_perp exp(i k.x), e_perp the part of the unit vector `along` across k [n, 3], 1/m. Linearised pair force
    -sum m (p_a + p_b)/rho^2 grad W: K = 2 sum V e.(grad grad W).e (1 - cos k.x), zero in the limit of many neighbours, where no
    shear wave feels a pressure. `step_limits`, equation (6), has the same sum.
    """
    x = spacing * _lattice(support(kernel) * h / spacing, 3)
    r = np.linalg.norm(x, axis=1)
    chosen, q, small = KERNELS[kernel], r / h, 1e-5
    slope = chosen.sigma[3] / h**4 * chosen.slope(q)
    curve = chosen.sigma[3] / h**5 * (chosen.slope(q + small) - chosen.slope(q - small)) / (2.0 * small)
    k, along = np.asarray(k, float), np.asarray(along, float)
    across = along - k * (k @ along / np.sum(k**2, axis=1))[:, None]
    length = np.linalg.norm(across, axis=1)
    across = across / np.where(length > 1e-9, length, 1.0)[:, None]
    found = np.zeros(len(k))
    for place, distance, first, second in zip(x, r, slope, curve):
        squared = (across @ place / distance) ** 2
        found += 4.0 * np.sin(0.5 * k @ place) ** 2 * (second * squared + first / distance * (1.0 - squared))
    return np.where(length > 1e-9, spacing**3 * found, 0.0)
