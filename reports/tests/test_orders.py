"""The order fit on synthetic errors."""

import numpy as np
import pytest
from plumb_reports.orders import NoOrder, order_fit

H = 0.1 * 0.5**np.arange(8)


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0, 4.0, -1.0])
def test_exact_power_law(order):
    fit = order_fit(H, 3.0 * H**order)
    assert fit.order == pytest.approx(order, abs=1e-12)
    assert fit.upper - fit.lower < 1e-10
    assert np.exp(fit.intercept) == pytest.approx(3.0)
    assert (fit.used, fit.plateau) == (8, 0)


@pytest.mark.parametrize("order, floor", [(1.0, 3e-3), (2.0, 1e-5), (4.0, 1e-9)])
def test_plateau_is_left_out(order, floor):
    fit = order_fit(H, np.maximum(H**order, floor))
    assert fit.plateau > 0
    assert fit.order == pytest.approx(order, abs=0.2)


def test_round_off_noise_below_the_floor():
    errors = np.array([1e-2, 2.5e-3, 6.25e-4, 1.6e-4, 2e-4, 1.1e-4, 1.9e-4])
    fit = order_fit(0.5**np.arange(7), errors)
    assert (fit.used, fit.plateau) == (3, 4)  # the fourth point is on the floor already
    assert fit.order == pytest.approx(2.0, abs=0.02)


def test_change_to_first_order_is_no_plateau():
    fit = order_fit(H, H**2 + 0.02 * H)  # second order first, in the end first order: not to be taken for second
    assert fit.plateau == 0
    assert fit.order < 1.7


def test_zero_errors_lie_below_round_off():
    fit = order_fit(H[:5], [1.0, 0.25, 0.0625, 0.0, 0.0])
    assert (fit.used, fit.plateau) == (3, 2)
    assert fit.order == pytest.approx(2.0)


def test_interval_from_residuals_by_hand():
    # x = log 4, log 2, log 1; y = log 16 + d, log 4 - 2 d, log 1 + d: residuals (d, -2d, d), one degree of freedom,
    # s = sqrt(6) d, sum of squares of x about its mean = 2 log(2)^2, t(0.975, 1) = 12.706.
    d = 0.01
    fit = order_fit([4.0, 2.0, 1.0], np.exp(np.log([16.0, 4.0, 1.0]) + d * np.array([1.0, -2.0, 1.0])))
    assert fit.order == pytest.approx(2.0)
    assert fit.upper - fit.order == pytest.approx(12.7062 * np.sqrt(6) * d / (np.sqrt(2) * np.log(2)), rel=1e-4)


def test_interval_covers_the_true_order():
    rng = np.random.default_rng(5)
    fits = [order_fit(H[:5], H[:5]**2 * np.exp(0.05 * rng.standard_normal(5))) for _ in range(300)]
    hits = sum(fit.lower <= 2.0 <= fit.upper for fit in fits)
    assert 0.91 <= hits / 300 <= 0.99


def test_error_bars_widen_the_interval():
    # Exact law: the scatter is zero, so the width is that of the bars alone, 0.1 of each error:
    # sqrt(sum (x - mean)^2)^-1 * 0.1 with x = log 2 (1, 0, -1).
    fit = order_fit([4.0, 2.0, 1.0], [16.0, 4.0, 1.0], [1.6, 0.4, 0.1])
    assert fit.upper - fit.order == pytest.approx(0.1 / (np.sqrt(2) * np.log(2)), rel=1e-9)


@pytest.mark.parametrize("errors", [[1.0, np.nan, 0.1], [1.0, np.inf, 0.1], [1.0, 0.1, 0.0], [1.0, -0.1, 0.01]])
def test_no_order(errors):
    with pytest.raises(NoOrder):
        order_fit([4.0, 2.0, 1.0], errors)
