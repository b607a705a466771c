"""Flow through a smoothed bed on a floor: its room, and the law's pressure gradient in the middle of a tall one."""

import math

import numpy as np
import pytest
from drag_laws.drag_laws import LAWS
from theory.bed_on_floor import LayeredBed
from theory.packed_beds import pressure_gradient

D, RHO, MU = 1.1e-3, 997.0, 8.93e-4
EPS = 1.0 - math.pi / 6.0  # of touching grains on a cubic lattice


def bed(layers, h=1.5):
    return LayeredBed((np.arange(layers) + 0.5) * D, 1.0 / D**2, D, h * D)


def test_no_room_is_lost_at_the_floor():
    one = bed(8)
    assert np.sum(1.0 - one.eps) * one.dz == pytest.approx(8 * (1.0 - EPS) * D, rel=1e-6)
    assert one.eps[0] == pytest.approx(EPS, rel=2e-3)


@pytest.mark.parametrize("u", [1e-4, 3e-3, 0.03])
def test_ten_layers_more_have_the_law_s_drop(u):
    law = LAWS["ergun"]
    more = bed(30).pressure_drop(law, u, RHO, MU) - bed(20).pressure_drop(law, u, RHO, MU)
    assert more == pytest.approx(10 * D * pressure_gradient(law, EPS, u, D, RHO, MU), rel=2e-3)


def test_water_slows_down_where_it_leaves_the_bed():
    """Without drag the drop is negative: Bernoulli's, less what the grains' share of the gradient takes."""
    one, u = bed(8), 0.1
    assert one.pressure_drop(lambda eps, re: 0.0, u, RHO, MU) < 0.0
    assert one.pressure_drop(lambda eps, re: 0.0, u, RHO, MU) > -RHO * u**2 / EPS**2
