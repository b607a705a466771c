"""The wake of a grain's own push on a staggered grid of cubes: the waves of a periodic box as the grid knows them.

A box of N cells of width a along each side knows the waves k_i = 2 pi n_i/(N_i a), |n_i| < N_i/2. The grid's second differences,
gradient and divergence make of each

    K_i = (2/a) sin(k_i a/2):    friction nu K^2,   pressure takes KK/K^2 of a push,                                          (1)

while what a grain's move does is still the turn by k. A grain is spread over the nodes, and gathers from them, by w of the distance,
the weights made to sum to one: in the limit of kernels as wide as a cell the transform of w, over its value at k = 0. Sampling adds
w^(k + 2 pi n/a), 2.7e-9 of it for a Gaussian of deviation a and 2e-5 at 0.75 a. The filter counts twice, in the push and in what is gathered.

All in SI units. Theory: Harlow & Welch (1965), Phys. Fluids 8, 2182, for the grid; `self_disturbance` for the rest.
"""

import math
from typing import NamedTuple

import numpy as np

from theory import self_disturbance, self_disturbance_history, sph_operators

GAUSSIAN_REACH = 3.5  # deviations: where the solver's Gaussian is cut off


class GridScheme(NamedTuple):
    """Spread and gathered by one kernel ("gaussian", of deviation `width`, or a name of sph_operators.KERNELS, of h = `width`), cells of `cell`."""

    kernel: str
    width: float
    cell: float

    @property
    def viscosity(self):
        """The friction is nu k^2 of the modes, whose k is K."""
        return None


def transform(kernel, kw):
    """w^(k width) in three dimensions, 1 at 0."""
    kw = np.asarray(kw, float)
    if kernel != "gaussian":
        return sph_operators.transform(kernel, 3, kw)
    node, weight = np.polynomial.legendre.leggauss(64)
    q, dq = 0.5 * GAUSSIAN_REACH * (node + 1.0), 0.5 * GAUSSIAN_REACH * weight
    mass = dq * q**2 * np.exp(-0.5 * q**2)
    return np.sinc(np.multiply.outer(kw, q) / math.pi) @ mass / mass.sum()


class GridModes(NamedTuple):
    """As self_disturbance.Modes, with K for k and the cosine of K to the motion; turn: phase per metre."""

    k: np.ndarray
    cosine: np.ndarray
    share: np.ndarray
    turn: np.ndarray


class Waves(NamedTuple):
    """One entry for each set of mirrored waves: k_i and K_i [n, 3] of (1), and the share of the box of each, the filter squared in it."""

    k: np.ndarray
    grid: np.ndarray
    share: np.ndarray


def box_waves(scheme, size, least):
    """Of a periodic box (size [3]); those whose filter squared is below `least` are left out."""
    size = np.asarray(size, float)
    cells = np.rint(size / scheme.cell).astype(int)
    n = np.stack(np.meshgrid(*[np.arange((count + 1) // 2) for count in cells], indexing="ij"), axis=-1).reshape(-1, 3)[1:]
    wave = 2.0 * math.pi * n / size
    modulus = np.sqrt((wave**2).sum(axis=1))
    table = np.linspace(0.0, modulus.max(), 4000)
    product = np.interp(modulus, table, transform(scheme.kernel, table * scheme.width)) ** 2
    kept = product > least
    wave, n, product = wave[kept], n[kept], product[kept]
    return Waves(wave, 2.0 / scheme.cell * np.sin(0.5 * wave * scheme.cell), 2.0 ** (n > 0).sum(axis=1) / size.prod() * product)


def box_modes(scheme, size, axis=2, least=1e-9):
    """Modes of a periodic box (size [3]) around one grain that moves along `axis`; those whose filter squared is below `least` are left out."""
    waves = box_waves(scheme, size, least)
    k = np.sqrt((waves.grid**2).sum(axis=1))
    return GridModes(k, waves.grid[:, axis] / k, waves.share, waves.k[:, axis])


class Memory(self_disturbance_history.Memory):
    """The fading sums of a grain on a grid."""

    def __init__(self, modes, scheme, fluid):
        super().__init__(modes, scheme, fluid)
        self.turn = modes.turn


def own_volume_fraction(modes, d):
    """Share of its own volume that a grain sees in the box."""
    return math.pi / 6.0 * d**3 * float(modes.share.sum())


def backflow(modes, d):
    """Share of the grain's speed with which the fluid that makes room flows the other way: the grid's divergence is exact."""
    return math.pi / 6.0 * d**3 * float(modes.share @ modes.cosine**2)


def steady_velocity(modes, scheme, fluid, force):
    """u_self, m/s, under a constant force in creeping flow; without k = 0."""
    return self_disturbance.steady_velocity(modes, scheme, fluid, force)
