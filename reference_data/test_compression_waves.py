"""Waves of compression among free grains on a grid (verification/near_zero_void): where the step's theory is stable, and its limits."""

import math
import sys

import numpy as np
import pytest
from verification_case import ROOT

sys.path.insert(0, str(ROOT / "verification" / "near_zero_void"))
import compression_waves as waves  # noqa: E402

LAWS = ("exponential", "implicit")


def diameter(phi, h=1e-3):
    """Of the grains of a cubic lattice, m."""
    return h * (6.0 * phi / math.pi) ** (1.0 / 3.0)


def beds():
    for law in LAWS:
        for phi in (0.05, 0.2, 0.4, 0.6, 0.8, 0.95):
            for z in np.geomspace(1e-4, 1e4, 9):
                for ratio in (1.05, 2.0, 1000.0):
                    for gradient in (True, False):
                        for virtual in (0.0, 0.5 / ratio):
                            yield waves.Bed(law, z, phi, ratio, gradient, z * diameter(phi) ** 2 / 18.0, virtual)


@pytest.mark.parametrize("width", [None, 0.35e-3, 1e-3, 1.9e-3])
def test_foreseen_steps_are_stable(width):
    """Friction too: mu dt/rho_p = z d^2/18 by Stokes' relaxation time."""
    symbols = [waves.LongWave] if width is None else [waves.Symbols(width, 1e-3, 2.0 * math.pi * m / 16e-3) for m in (1, 4, 7)]
    assert max(waves.factor(bed, one) for bed in beds() for one in symbols) < 1.0


@pytest.mark.parametrize("phi, ratio", [(0.6, 2.0), (0.8, 2.0), (0.8, 4.0)])
def test_explicit_steps_have_the_added_mass_of_the_step_before(phi, ratio):
    """README, equation (7), for short steps of long waves; one half of phi/eps rho/rho_p is the boundary."""
    share = phi / (1.0 - phi) / ratio
    roots = np.abs(np.roots([1.0, 1.5 * share, -0.5 * share])).max()
    assert waves.factor(waves.Bed("explicit", 1e-4, phi, ratio), waves.LongWave) == pytest.approx(max(roots, 1.0), rel=1e-3)
    bound = 0.5 * (1.0 - phi) / phi  # of rho/rho_p
    assert waves.factor(waves.Bed("explicit", 1e-4, phi, 1.0 / (1.02 * bound)), waves.LongWave) > 1.001
    assert waves.factor(waves.Bed("explicit", 1e-4, phi, 1.0 / (0.98 * bound)), waves.LongWave) < 1.0 + 1e-6


@pytest.mark.parametrize("law", LAWS)
def test_long_waves_keep_the_mixture_volume(law):
    """eps u + phi (mean velocity of the way) = 0 at every step, and the debts of exponential exchange are rounding."""
    for virtual in (0.0, 0.25):
        bed = waves.Bed(law, 3.0, 0.6, 2.0, virtual=virtual)
        matrix = waves.step_matrix(bed, waves.LongWave)
        state = np.array([1.0, 0, 0, 0, 0, 0])
        for _ in range(5):
            state = matrix @ state
            assert (1.0 - bed.phi) * state[2] + bed.phi * state[4] == pytest.approx(0.0, abs=1e-12)
            assert state[3] == pytest.approx(0.0, abs=1e-12)
