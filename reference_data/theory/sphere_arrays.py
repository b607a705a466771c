"""Creeping flow through a simple cubic array of fixed spheres: the drag on one, by fundamental solutions.

Lengths in periods of the array. The flow is that of periodic Stokeslets, each with the uniform counter force that makes the field periodic
(Hasimoto 1959, J. Fluid Mech. 5, 317), on a sphere inside the solid one; their strengths make the velocity on the solid surface that of
a body at rest in the mean flow U, in the sense of least squares. The flux through any plane is U, so U is the superficial velocity, and the force
on a sphere, its share of the mean pressure gradient included, is the sum of the strengths. Lattice sums after Ewald, split as Hasimoto's
(Lindbo & Tornberg 2010, J. Comput. Phys. 229, 8994, equations 6 to 9).
"""

import math
from functools import lru_cache

import numpy as np
from scipy.special import erfc

SPLIT = 3.5  # per period: with it the sums below leave 1e-9
WAVES, IMAGES = 10, 2
DENSEST = math.pi / 6.0


def radius(c):
    """Of the spheres at the solid fraction c."""
    return (3.0 * c / (4.0 * math.pi)) ** (1.0 / 3.0)


def on_sphere(n):
    """n points [n, 3] spread evenly over the unit sphere along a spiral."""
    k = np.arange(n) + 0.5
    z, angle = 1.0 - 2.0 * k / n, math.pi * (1.0 + math.sqrt(5.0)) * k
    r = np.sqrt(1.0 - z * z)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


def near(x):
    """The quickly falling part [n, 3, 3] at x [n, 3], images summed."""
    total = np.zeros((len(x), 3, 3))
    shifts = np.arange(-IMAGES, IMAGES + 1)
    for shift in np.array(np.meshgrid(shifts, shifts, shifts)).reshape(3, -1).T:
        y = x + shift
        r2 = np.sum(y * y, axis=1)
        r = np.sqrt(r2)
        gauss = SPLIT / math.sqrt(math.pi) * np.exp(-SPLIT**2 * r2)
        factor = 2.0 * (gauss / r2 + erfc(SPLIT * r) / (2.0 * r * r2))
        total += factor[:, None, None] * (r2[:, None, None] * np.eye(3) + y[:, :, None] * y[:, None, :]) - (4.0 * gauss)[:, None, None] * np.eye(3)
    return total


def far(x, y):
    """The smooth part [n, m, 3, 3] from y [m, 3] to x [n, 3] as a sum over waves."""
    waves = np.arange(-WAVES, WAVES + 1)
    k = 2.0 * math.pi * np.array(np.meshgrid(waves, waves, waves)).reshape(3, -1).T
    k2 = np.sum(k * k, axis=1)
    k, k2 = k[(k2 > 0.0) & (k2 < (2.0 * math.pi * WAVES) ** 2)], k2[(k2 > 0.0) & (k2 < (2.0 * math.pi * WAVES) ** 2)]
    size = 8.0 * math.pi * (1.0 + k2 / (4.0 * SPLIT**2)) * np.exp(-k2 / (4.0 * SPLIT**2)) / k2
    across = size[:, None, None] * (np.eye(3) - k[:, :, None] * k[:, None, :] / k2[:, None, None])
    to, back, total = np.exp(1j * x @ k.T), np.exp(-1j * y @ k.T).T, np.empty((len(x), len(y), 3, 3))
    for i in range(3):
        for j in range(i + 1):
            total[:, :, i, j] = total[:, :, j, i] = ((to * across[:, i, j]) @ back).real
    return total


def stokeslets(x, y):
    """Velocity [n, m, 3, 3] times 8 pi mu at x [n, 3] from a unit force on each of the points y [m, 3] and all its images; mean 0."""
    return near((x[:, None, :] - y[None, :, :]).reshape(-1, 3)).reshape(len(x), len(y), 3, 3) + far(x, y)


@lru_cache(maxsize=None)
def drag(c, sources=240, depth=0.6):
    """F/(6 pi mu r U): the force on a sphere of radius r over Stokes' at the superficial velocity U, for the solid fraction c."""
    if not 0.0 < c < 0.9 * DENSEST:
        raise ValueError(f"solid fraction {c} outside (0, {0.9 * DENSEST:.3f})")
    r = radius(c)
    y, x = depth * r * on_sphere(sources), r * on_sphere(2 * sources)
    matrix = stokeslets(x, y).transpose(0, 2, 1, 3).reshape(3 * len(x), 3 * len(y)) / (8.0 * math.pi)
    at_rest = np.tile([1.0, 0.0, 0.0], len(x))
    strengths, *_ = np.linalg.lstsq(matrix, at_rest, rcond=1e-13)
    return float(strengths.reshape(-1, 3)[:, 0].sum() / (6.0 * math.pi * r))


def dilute(c):
    """The same by its expansion, for small c (Sangani & Acrivos 1982, Int. J. Multiphase Flow 8, 343)."""
    return 1.0 / (1.0 - 1.7601 * c ** (1 / 3) + c - 1.5593 * c**2 + 3.9799 * c ** (8 / 3) - 3.0734 * c ** (10 / 3))


def permeability(c):
    """K over the square of the period: mu U/G for the mean pressure gradient G."""
    return 1.0 / (6.0 * math.pi * radius(c) * drag(c))
