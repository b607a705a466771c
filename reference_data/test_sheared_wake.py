"""The sheared wake against Saffman's lift, against the wake without shear, and its signs."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent))

from theory import self_disturbance, self_disturbance_history, sheared_wake  # noqa: E402

SCHEME = self_disturbance.one_kernel("wendland_c2", 0.5)  # h sqrt(G/nu) = 1/2 for nu = G = 1


def test_point_force_in_steady_shear_is_saffmans_lift():
    # 6.46 is good to its digits (0.1 %); what is missing at G t = 100 falls as 1/t.
    found = sheared_wake.of_constant_push(SCHEME, 1.0, 1.0, 1.0, 1.0, 100.0, waves=(5e-4, 500.0), nodes=(96, 24, 24, 300), narrow=True)
    assert found == pytest.approx(sheared_wake.saffman_share(1.0, 1.0, 1.0, 1.0), rel=3e-3)


def test_without_shear_the_wake_is_that_of_self_disturbance():
    wake, fluid = sheared_wake.Wake(SCHEME, 1.0, 1.0), self_disturbance.Fluid(1.0, 1.0)
    found = wake.across(0.5, np.zeros_like, np.ones_like, np.zeros_like, np.zeros_like)
    modes = self_disturbance.unbounded_modes(SCHEME, fluid)
    assert found == pytest.approx(self_disturbance_history.unsteady(modes, SCHEME, fluid, np.linspace(0, 0.5, 3), np.ones(3))[-1], rel=1e-3)
    assert abs(wake.across(0.5, np.ones_like, np.zeros_like, np.zeros_like, np.zeros_like)) < 1e-12 * found


def test_signs_and_nodes():
    one = sheared_wake.of_constant_push(SCHEME, 1.0, 1.0, 1.0, 1.0, 2.0)
    assert one < 0.0  # the grain leads, pushes the fluid on and goes to the slower side
    assert sheared_wake.of_constant_push(SCHEME, 1.0, 1.0, -1.0, 1.0, 2.0) == pytest.approx(-one, rel=1e-9)
    assert sheared_wake.of_constant_push(SCHEME, 1.0, 1.0, 1.0, 1.0, 2.0, nodes=(80, 28, 32, 240)) == pytest.approx(one, rel=2e-3)
