"""The waves of a grid (theory/grid_wake.py) against closed forms."""

import math

import numpy as np
import pytest

from theory import grid_wake, hasimoto, self_disturbance

FLUID = self_disturbance.Fluid(rho=1.0, mu=1.0)


def cubic_cell(width, side):
    """mu u/F of one Gaussian per cubic cell of exact friction: 1/(6 pi^1.5 width), the lattice of images, and the moments of both
    Gaussians, 3 width^2 each (hasimoto, 1)."""
    return 1.0 / (6.0 * math.pi**1.5 * width) - hasimoto.POINT_LATTICE / (6.0 * math.pi * side) + 6.0 * width**2 / (9.0 * side**3)


def steady(width, cell, side):
    modes = grid_wake.box_modes(grid_wake.GridScheme("gaussian", width, cell), (side,) * 3)
    return grid_wake.steady_velocity(modes, grid_wake.GridScheme("gaussian", width, cell), FLUID, 1.0)


def test_fine_cells_tend_to_the_cubic_cell(monkeypatch):
    monkeypatch.setattr(grid_wake, "GAUSSIAN_REACH", 7.0)
    expected = cubic_cell(1.0, 12.0)
    errors = [steady(1.0, cell, 12.0) / expected - 1.0 for cell in (1.0, 0.5, 0.25)]
    assert abs(errors[-1]) < 5e-3
    assert all(3.5 < coarse / fine < 4.5 for coarse, fine in zip(errors, errors[1:]))
    assert errors[0] > 0.0  # second differences resist short waves less


def test_own_volume_of_a_gaussian(monkeypatch):
    monkeypatch.setattr(grid_wake, "GAUSSIAN_REACH", 7.0)
    modes = grid_wake.box_modes(grid_wake.GridScheme("gaussian", 1.0, 0.5), (16.0,) * 3)
    volume = math.pi / 6.0
    fraction = grid_wake.own_volume_fraction(modes, 1.0)
    assert fraction == pytest.approx(volume / (8.0 * math.pi**1.5) - volume / 16.0**3, rel=1e-6)  # without the mean
    assert grid_wake.backflow(modes, 1.0) == pytest.approx(fraction / 3.0, rel=1e-9)


def test_cut_gaussian_is_narrower():
    kw = np.array([0.0, 0.05])
    one, cut = grid_wake.transform("gaussian", kw)
    q = np.linspace(0.0, grid_wake.GAUSSIAN_REACH, 20001)
    w = np.exp(-0.5 * q**2)
    assert one == pytest.approx(1.0, rel=1e-12)
    assert 2.0 * (1.0 - cut) / 0.05**2 == pytest.approx((w * q**4).sum() / (w * q**2).sum() / 3.0, rel=1e-3)
