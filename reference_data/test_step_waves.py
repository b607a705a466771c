"""Small motions of a lattice across a step of porosity (verification/porosity_step): with one energy none grows."""

import math
import sys

import numpy as np
import pytest
from verification_case import ROOT

sys.path.insert(0, str(ROOT / "verification" / "porosity_step"))
from step_waves import Step  # noqa: E402

C, SPACING = 50.0, 0.1


def step(fraction, mu, shared):
    """A bed of 14 planes in a column of 16 particles; its step of eps is `fraction`."""
    planes = 0.45 + 0.05 * (np.arange(14) + 0.5)
    return Step(16, SPACING, 0.15, "wendland_c2", 0.15, planes, 0.05 * fraction, C, mu, 1000.0, shared=shared)


def fastest(one):
    waves = [2.0 * math.pi * n / 0.7 for n in range(4)]
    return max(one.growth_rate((a, b)) for a in waves for b in waves)


@pytest.mark.parametrize("fraction", [0.1, 0.36, 0.64, 0.72])
@pytest.mark.parametrize("mu", [1e-6, 5.0, 50.0])
def test_one_energy_lets_no_wave_grow(fraction, mu):
    assert fastest(step(fraction, mu, shared=True)) < 1e-7 * C / SPACING


def test_gathered_and_handed_on_they_do():
    assert fastest(step(0.64, 5.0, shared=False)) > 10.0


def test_one_energy_is_kept_without_friction():
    """d/dt of sum eps |v|^2 + eps p^2/(rho c)^2 is zero for any state, as equation (7) says."""
    one, rng = step(0.64, 0.0, shared=True), np.random.default_rng(1)
    k = (2.0 * math.pi / 0.7, 4.0 * math.pi / 0.7)
    n = one.count
    state = rng.normal(size=5 * n) + 1j * rng.normal(size=5 * n)
    rate = one.matrix(k) @ state
    xi, v, s = state[:n], state[n:4 * n].reshape(3, n), state[4 * n:]
    pressure = lambda xi, s: C**2 * (s - 1000.0 * one.slope / one.eps * xi)  # noqa: E731
    p, dp = pressure(xi, s), pressure(rate[:n], rate[4 * n:])
    kinetic = np.sum(one.eps * np.real(np.conj(v) * rate[n:4 * n].reshape(3, n)))
    stored = np.sum(one.eps * np.real(np.conj(p) * dp)) / (1000.0 * C) ** 2
    size = np.sum(one.eps * np.abs(p * dp)) / (1000.0 * C) ** 2
    assert abs(kinetic + stored) < 1e-8 * size
