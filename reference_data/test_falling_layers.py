"""Tests of the linear theory of layers that fall through a gas."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from theory import falling_layers, rayleigh_taylor, released_layers, settling  # noqa: E402
from theory import sedimentation_scene as scene  # noqa: E402
from theory.released_layers import Setting  # noqa: E402


def setting(name, across, **changes):
    fluid, h = settling.FLUIDS[name], scene.smoothing_length(across)
    return Setting(fluid["rho"], fluid["mu"], h, scene.coupling_width(h, 0.8), h, **changes)


@pytest.mark.parametrize("mode", [0, 1])
def test_grains_that_follow_the_fluid_are_released_layers(mode):
    """Glycerol-water: n tau_p = 0.003; the start from rest costs the base 0.05 um."""
    s, k, times = setting("glycerol_water", 10), scene.wave_numbers()[mode], (0.0, 0.01, 0.02)
    moving, settled = falling_layers.history(s, k, times), released_layers.history(s, k, times)
    np.testing.assert_allclose(moving.rise, settled.rise, rtol=2e-3)
    np.testing.assert_allclose(moving.z, settled.z, atol=1e-7)


def test_falls_freely_at_first():
    t = 5e-4
    z, velocity = falling_layers.fall(setting("air", 10), 1e-3)(t)
    g = settling.GRAVITY * (1.0 - settling.FLUIDS["air"]["rho"] / settling.GRAIN["rho_p"])
    np.testing.assert_allclose(velocity, -g * t, rtol=0.02)


def test_ends_at_the_hindered_velocity():
    """A high layer in its middle, after dozens of relaxation times of the liquid."""
    s = setting("glycerol_water", 20, block=(3.6e-3, 8.6e-3), height=12e-3)
    velocity = falling_layers.fall(s, 1e-3)(1e-3)[1]
    assert -velocity[len(velocity) // 2] == pytest.approx(rayleigh_taylor.settling_slip(s.fluid, s.lattice.eps), rel=2e-3)


def test_change_of_slip_is_the_bases_own_for_a_flat_wave():
    """k -> 0: displacing one layer, or giving it a velocity, changes the slips as it does in the base."""
    s, small = setting("air", 10), 1e-8
    z, velocity = falling_layers.fall(s, 0.01)(0.01)
    now, n = falling_layers.base(s, z, velocity), len(z)
    nothing = np.zeros((n, 1))
    _, by_z, _, by_v, _ = falling_layers.slip_change(s, now, 1e-3, nothing, nothing)
    for layer in (0, n // 2):
        one = small * np.eye(n)[layer]
        moved = (falling_layers.base(s, z + one, velocity).slip - now.slip) / small
        faster = (falling_layers.base(s, z, velocity + one).slip - now.slip) / small
        np.testing.assert_allclose(by_z[:n, layer], moved, atol=1e-4 * np.abs(moved).max())
        np.testing.assert_allclose(by_v[:n, layer], faster, atol=1e-5)


def test_a_flat_displacement_stays():
    """k -> 0, all layers displaced alike: the same fall, elsewhere."""
    found = falling_layers.history(setting("air", 10), 1.0, (0.0, 0.01))
    np.testing.assert_allclose(found.rise[-1], 1.0, atol=2e-3)


def test_history_does_not_depend_on_its_steps():
    s, k = setting("air", 10), scene.wave_numbers()[1]
    coarse, fine = (falling_layers.history(s, k, (0.0, 0.02), most).rise[-1, 0] for most in (1e-3, 5e-4))
    assert coarse == pytest.approx(fine, rel=2e-3)


def test_falling_layer_grows_less_than_the_relation():
    """In air the dusty relation has 121 per second; e^(n t) is 11 after 20 ms."""
    s, k = setting("air", 10), scene.wave_numbers()[0]
    rise = falling_layers.history(s, k, (0.0, 0.02)).rise[-1, 0]
    assert 1.0 < rise < 0.2 * math.exp(121.0 * 0.02)
