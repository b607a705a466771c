"""Weights of grains on a grid, and the waves that their places make there."""

import math

import numpy as np
import pytest

from theory import grid_suspension, grid_weights

SIDE, CELLS = 1.0, 8
BED = grid_suspension.Bed(side=SIDE, cells=CELLS, width=0.13, volume=1e-3, weight=2.0, rho=1.0, rho_p=2.0, mu=0.5, slip=0.3, slope=0.0, held=0.0)


def places(count):
    return np.random.default_rng(1).random((count, 3))


@pytest.mark.parametrize("width", [0.05, 0.13, 0.3])
def test_columns_sum_to_one_and_hold_the_grains(width):
    x = places(20)
    weights = grid_weights.gaussian_weights(grid_weights.nodes(SIDE, CELLS), x, width, SIDE)
    assert np.allclose(weights.sum(axis=0), 1.0, rtol=1e-14)
    eps = grid_weights.cell_porosity(weights, 1e-3, (SIDE / CELLS) ** 3)
    assert math.isclose((1.0 - eps).mean(), 20e-3, rel_tol=1e-13)


def test_images_in_reach_count_once():
    x, at = places(5), grid_weights.nodes(SIDE, CELLS, 2)
    near = grid_weights.gaussian_weights(at, x, 0.14, SIDE)
    assert np.allclose(near, grid_weights.folded_weights(at, x, 0.14, SIDE), rtol=1e-13)


def test_the_mean_over_places_is_the_transform():
    at, width = grid_weights.nodes(SIDE, CELLS), 0.13
    x = at[:1] + np.random.default_rng(2).random((400, 3)) * SIDE / CELLS
    weights = grid_weights.gaussian_weights(at, x, width, SIDE)
    k = 2.0 * math.pi / SIDE
    found = np.mean(np.sum(weights * np.cos(k * (at[:, :1] - x[None, :, 0])), axis=0))
    assert math.isclose(found, grid_weights.transform(k, width), rel_tol=7e-3)  # of what is cut off


def test_a_wave_across_the_weight_obeys_second_differences():
    s = grid_suspension.symbols(SIDE, CELLS, BED.width)
    x = grid_weights.nodes(SIDE, CELLS, 2)[:, 0]
    n = np.cos(2.0 * math.pi * x / SIDE).reshape(CELLS, CELLS, CELLS)
    u = grid_suspension.wakes(BED, s, np.fft.fftn(n), 0.0, 1e9)
    a = SIDE / CELLS
    friction = BED.mu * (np.roll(u, 1, axis=2) - 2.0 * u + np.roll(u, -1, axis=2)) / a**2
    assert np.allclose(friction, BED.weight * n / a**3, atol=1e-9 * BED.weight / a**3)


def test_the_hold_slows_waves_down():
    s, free = grid_suspension.symbols(SIDE, CELLS, BED.width), np.fft.fftn(places(CELLS**3)[:, 0].reshape(CELLS, CELLS, CELLS))
    loose = grid_suspension.wakes(BED, s, free, 0.1, 1e9)
    assert np.abs(grid_suspension.wakes(BED._replace(held=1.0), s, free, 0.1, 1e9)).max() < np.abs(loose).max()


def test_backflow_makes_room_for_a_layer_that_falls():
    """A layer of grains across z: fluid has to flow up through it by the slip times what eps lacks, at long waves."""
    bed, cells = BED._replace(cells=64, rho_p=1e9), 64  # heavy grains: the fluid's own share of the slip is all, momentum zero
    n = np.cos(2.0 * math.pi * (np.arange(cells) + 0.5) / cells)[:, None, None] * np.ones((cells, cells, cells))
    s = grid_suspension.symbols(SIDE, cells, bed.width)
    u = grid_suspension.backflow(bed, s, np.fft.fftn(n * 1e-6), 1e-9)
    assert math.isclose(u.max(), bed.slip * bed.volume * cells**3 * 1e-6, rel_tol=5e-3)
