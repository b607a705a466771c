"""The block of grains that the slides let fall: box, lattice, displacement of the lattice, widths of the kernels.

Robinson, Luding & Ramaioli (2014); places, counts and the displacement are those of the authors' public code. A lattice of
n = (1 - eps)/V grains per volume would have n^(1/3) grains per length; the code puts the whole number below that into the
width and keeps the spacing in all directions, so the lattice's porosity is a little above the nominal one and the layers end a
little below the block's top.
"""

import math
from typing import NamedTuple

import numpy as np

from .settling import GRAIN

WIDTH = 4.0e-3  # m, periodic in x and y
DEPTH = 6.0e-3  # m of fluid above the floor; the box is 8 mm high
BLOCK = (3.6e-3, 5.2e-3)  # m, the slides' block; in the authors' code at 10 particles across, see block_as_code
GRAIN_VOLUME = math.pi / 6.0 * GRAIN["d"] ** 3


class Lattice(NamedTuple):
    """A cubic lattice that fills x and y: `columns` grains along x and along y, `layers` along z from `bottom` upwards."""

    nominal: float
    columns: int
    layers: int
    spacing: float
    bottom: float

    @property
    def eps(self):
        """Porosity of the lattice, 1 - V/spacing^3."""
        return 1.0 - GRAIN_VOLUME / self.spacing**3

    @property
    def top(self):
        return self.bottom + self.layers * self.spacing

    @property
    def heights(self):
        """z of the layers, m."""
        return self.bottom + (np.arange(self.layers) + 0.5) * self.spacing

    @property
    def grains(self):
        return self.columns**2 * self.layers


def lattice(nominal, block=BLOCK):
    """The authors' lattice for a nominal porosity in `block` = (bottom, top), m."""
    per_length = ((1.0 - nominal) / GRAIN_VOLUME) ** (1.0 / 3.0)
    if per_length * GRAIN["d"] > 1.0:
        raise ValueError(f"nominal porosity {nominal}: the grains of a cubic lattice would overlap")
    columns, layers = int(per_length * WIDTH), int(per_length * (block[1] - block[0]))
    return Lattice(nominal, columns, layers, WIDTH / columns, block[0])


def block_as_code(across):
    """(bottom, top) in the authors' code for `across` fluid particles in 4 mm: one spacing below 4 mm to two below 6 mm.

    Only across = 10 gives the 3.6 to 5.2 mm of BLOCK; at 20 it is 3.8 to 5.6 mm, at 40 3.9 to 5.8 mm.
    """
    spacing = WIDTH / across
    return 4.0e-3 - spacing, DEPTH - 2.0 * spacing


def smoothing_length(across):
    """h = 1.5 spacings, m: 6 d for 10 particles across, 2 d for 30, 1.5 d for 40."""
    return 1.5 * WIDTH / across


def coupling_width(h, nominal):
    """h_c = h eps^(-1/3), the width that spreads grains over the fluid; eps the nominal porosity."""
    return h * nominal ** (-1.0 / 3.0)


def displacement(x, y):
    """Rayleigh-Taylor scene, m: -(d/8) (1 - cos k1 x)(1 - cos k1 y), k1 = 2 pi/WIDTH; the lowest grain is d/2 down.

    Multiplied out it is -(d/8) [1 - cos k1 x - cos k1 y + cos k1 x cos k1 y]: amplitude d/8 in each of the two modes of k1
    and d/8 in the product, whose wave number is sqrt(2) k1.
    """
    k = 2.0 * math.pi / WIDTH
    return -GRAIN["d"] / 8.0 * (1.0 - np.cos(k * np.asarray(x))) * (1.0 - np.cos(k * np.asarray(y)))


def wave_numbers():
    """The two wave numbers of `displacement`, 1/m: 2 pi/WIDTH and sqrt(2) times that."""
    k = 2.0 * math.pi / WIDTH
    return k, math.sqrt(2.0) * k
