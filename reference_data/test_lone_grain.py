"""The lone grain of smoothed particles: its speed, and the limits of its backflow."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from theory import lone_grain, self_disturbance, settling

WATER = SimpleNamespace(rho=1000.0, mu=8.9e-4, rho_p=2500.0, d=1e-4, kernel="wendland_c2", h=2e-4, c=1.0, end=1.0, volume=math.pi / 6.0 * 1e-12)


def test_terminal_speed_is_that_of_the_settling_tables():
    re = settling.hindered_re(settling.archimedes(WATER.rho_p, WATER.rho, WATER.d, WATER.mu, 9.81), 1.0, 1)
    assert lone_grain.terminal_speed(WATER) == pytest.approx(re * WATER.mu / (WATER.rho * WATER.d), rel=1e-9)


def test_a_grain_from_rest_ends_at_its_terminal_speed():
    tau = settling.relaxation_time(WATER.rho_p, WATER.d, WATER.mu)
    v = lone_grain.by_law(WATER, [0.0, 0.01 * tau, 40.0 * tau])
    assert v[0] == 0.0
    assert v[1] == pytest.approx(0.01 * tau * 9.81 * (1.0 - WATER.rho / WATER.rho_p), rel=0.02)
    assert v[2] == pytest.approx(lone_grain.terminal_speed(WATER), rel=1e-8)


def test_backflow_becomes_a_third_of_the_kernels_peak_over_the_grain():
    """V W(0)/3 once the pressure has answered, W(0) = 21/(16 pi h^3); nothing before."""
    scheme = self_disturbance.one_kernel("wendland_c2", WATER.h)
    modes = self_disturbance.unbounded_modes(scheme, self_disturbance.Fluid(WATER.rho, WATER.mu))
    late = lone_grain.backflow(scheme, modes, SimpleNamespace(**{**vars(WATER), "end": 1e6}))
    assert late == pytest.approx(WATER.volume * 21.0 / (16.0 * math.pi * WATER.h**3) / 3.0, rel=5e-3)
    assert lone_grain.backflow(scheme, modes, SimpleNamespace(**{**vars(WATER), "end": 0.0})) == 0.0


def test_own_volume_changes_inertia_and_weight_only():
    plain = lone_grain.sphere(WATER)
    grain = lone_grain.OwnVolume(*plain)
    grain.b, grain.share_of_box = 0.01, 0.02
    assert grain.inertia(False) == pytest.approx(plain.inertia(False) / 1.01)
    assert grain.weight() == pytest.approx(plain.weight() * 0.98)
    assert np.all(grain.drag(np.array([1e-3, 1e-2])) == plain.drag(np.array([1e-3, 1e-2])))
