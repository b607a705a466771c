"""Metrics on numbers worked by hand."""

import numpy as np
import pytest
from plumb_reports.metrics import Comparison, NotComparable, measurement, value_measurement

T = np.array([0.0, 1.0, 2.0])


def data(measured, expected, uncertainty=None, t=T):
    def column(values):
        values = np.asarray(values, dtype=float)
        return values[:, None] if values.ndim == 1 else values
    return Comparison(t, column(measured), column(expected), None if uncertainty is None else column(uncertainty))


@pytest.mark.parametrize("metric, value", [
    ("relative_l2", 1 / 5),        # differences (0, 0, 1), norm 1; reference (0, 3, 4), norm 5
    ("relative_linf", 1 / 4), ("absolute_linf", 1.0), ("final_relative", 1 / 4), ("final_absolute", 1.0)])
def test_plain_errors(metric, value):
    assert measurement(metric, data([0, 3, 5], [0, 3, 4])).value == pytest.approx(value, rel=1e-15)


def test_norms_are_taken_by_component():
    # Both vectors have length 5 at every time, so that a norm of magnitudes would see no error at all.
    result = measurement("relative_linf", data([[3, 4], [3, 4], [3, 4]], [[4, 3], [4, 3], [4, 3]]))
    assert result.value == pytest.approx(1 / 3)
    assert result.component == 1


def test_worst_component_counts():
    result = measurement("relative_l2", data([[1.1, 100], [1.1, 100], [1.1, 100]], [[1, 100], [1, 100], [1, 100]]))
    assert (result.value, result.component, result.points) == (pytest.approx(0.1), 0, 6)


def test_window_limits_the_comparison():
    assert measurement("absolute_linf", data([9, 3, 4], [0, 3, 4]), window=(1.0, 2.0)).value == 0.0


def test_mean_of_the_difference():
    t = np.arange(16.0)
    noise = 0.1 * (-1.0)**np.arange(16)  # pairs cancel exactly: level 1 of the blocks has no spread
    result = measurement("mean_relative", data(2.2 + noise, np.full(16, 2.0), t=t), window=(0, 15))
    assert result.value == pytest.approx(0.1)
    assert result.error_bar > 0


def test_in_sigma():
    result = measurement("in_sigma", data([0, 0, 1.2], [1, 1, 1], [0.1, 0.1, 0.1]))
    assert result.value == pytest.approx(2.0)
    assert result.sigma == pytest.approx(2.0)
    assert result.deviation == pytest.approx(0.2)


def test_deviation_keeps_its_sign():
    assert measurement("final_relative", data([1, 1, 0.9], [1, 1, 1])).deviation == pytest.approx(-0.1)


def test_value_is_the_last_or_the_mean():
    last = Comparison(T, np.array([[1.0], [2.0], [4.0]]))
    assert value_measurement(last, None, (0, 5)).value == 4.0
    assert value_measurement(last, (0.9, 2.0), (0, 5)).value == 3.0


def test_value_shows_the_component_farthest_out():
    vector = Comparison(T[:1], np.array([[0.4, 0.9, 0.5]]))
    assert value_measurement(vector, None, (0, 1)).value == 0.9


@pytest.mark.parametrize("metric", ["relative_l2", "relative_linf", "absolute_linf", "final_relative", "final_absolute",
                                    "mean_relative", "in_sigma"])
@pytest.mark.parametrize("measured, expected, uncertainty, t, window", [
    ([0, np.nan, np.nan], [1, 1, 1], [1, 1, 1], T, (0, 2)),
    ([0, 1, np.inf], [1, 1, 1], [1, 1, 1], T, (0, 2)),
    ([0, 1, 1], [1, np.nan, np.nan], [1, 1, 1], T, (0, 2)),
    ([], [], [], T[:0], (0, 2)),
    ([1, 1, 1], [1, 1, 1], [1, 1, 1], T, (5, 6)),
    ([1, 1, 1], [1, 1], [1, 1], T, (0, 2))])
def test_unusable_data_are_refused(metric, measured, expected, uncertainty, t, window):
    with pytest.raises(NotComparable):
        measurement(metric, data(measured, expected, uncertainty, t), window)


@pytest.mark.parametrize("metric", ["relative_l2", "relative_linf", "final_relative", "mean_relative"])
def test_a_relative_error_needs_a_reference_other_than_zero(metric):
    with pytest.raises(NotComparable):
        measurement(metric, data([1, 1, 1], [0, 0, 0]), window=(0, 2))


def test_sigma_needs_an_uncertainty():
    with pytest.raises(NotComparable):
        measurement("in_sigma", data([1, 1, 1], [1, 1, 1]))
    with pytest.raises(NotComparable):
        measurement("in_sigma", data([1, 1, 1], [1, 1, 1], [0, 0, 0]))


def test_a_mean_of_one_point_is_refused():
    with pytest.raises(NotComparable):
        measurement("mean_relative", data([1, 1, 1], [1, 1, 1]), window=(0.5, 1.5))


def test_ensemble_counts_its_members_as_independent():
    # differences 0.1, -0.1, 0.3: mean 0.1, deviation 0.2; Student's t of two degrees of freedom is 4.3027 at 95 %
    result = measurement("ensemble_relative", data([2.1, 1.9, 2.3], [2.0, 2.0, 2.0]))
    assert result.value == pytest.approx(0.05) and result.deviation == pytest.approx(0.05)
    assert result.error_bar == pytest.approx(4.3027 * 0.2 / 3**0.5 / 2.0, rel=1e-4)


def test_one_member_alone_has_no_error_bar():
    result = measurement("ensemble_relative", data([2.1], [2.0], t=T[:1]))
    assert result.value == pytest.approx(0.05) and result.error_bar is None
