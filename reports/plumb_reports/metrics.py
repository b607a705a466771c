"""Error measures of one run. Arrays are [nt, n]: nt times by n components; the worst component counts."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .sampling import block_mean, half_width


TIME_AXIS = "time (s)"


class NotComparable(Exception):
    """Measured and expected data that cannot be compared: no points, other shapes, not finite, division by zero."""


@dataclass(frozen=True)
class Comparison:
    """What is compared in one check and one run.

    t [nt] in s; measured and expected [nt, n] in `units`; uncertainty [nt, n] (one standard uncertainty) or None;
    `is_series` is False when a single number stands for the whole run. `expected` is None for a range, which has no
    reference. `axis` labels t where that is something else than time.
    """
    t: np.ndarray
    measured: np.ndarray
    expected: np.ndarray = None
    uncertainty: np.ndarray = None
    units: str = ""
    is_series: bool = True
    axis: str = TIME_AXIS

    def within(self, window):
        """The part with window[0] <= t <= window[1]; the whole when window is None. A single number has no window."""
        if window is None or not self.is_series:
            return self
        slack = 1e-9 * max(abs(window[0]), abs(window[1]))  # round-off in the time of an output must not drop it
        keep = (self.t >= window[0] - slack) & (self.t <= window[1] + slack)
        expected, uncertainty = (None if a is None else a[keep] for a in (self.expected, self.uncertainty))
        return Comparison(self.t[keep], self.measured[keep], expected, uncertainty, self.units, axis=self.axis)


@dataclass(frozen=True)
class Measurement:
    """One error (or value) with its 95 % sampling error bar (None when nothing was averaged).

    `component` is the worst column, `points` the number of compared numbers. `deviation` is (measured - expected) /
    expected and `sigma` (measured - expected) / uncertainty of that column, None where they have no meaning. `settled`
    is False when the window is too short for its blocks to become independent, so that the bar is a lower bound.
    """
    value: float
    error_bar: float = None
    component: int = 0
    points: int = 0
    deviation: float = None
    sigma: float = None
    settled: bool = True


class Errors(NamedTuple):
    """Errors by component [n], their error bars [n] or None."""
    values: np.ndarray
    bars: np.ndarray = None
    settled: bool = True


def measurement(metric, data, window=None):
    """The Measurement of the error `metric` on a Comparison. Raises NotComparable; never returns nan or inf."""
    if data.expected is None or data.measured.shape != data.expected.shape:
        raise NotComparable("there is no reference of the shape of the measured values")
    data = data.within(window)
    refuse_unusable(data)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        errors = ERRORS[metric](data, window)
    if not np.all(np.isfinite(errors.values)):
        worst = int(np.argmin(np.isfinite(errors.values)))
        raise NotComparable(f"{metric} of component {worst} is {errors.values[worst]}: "
                            "its reference or uncertainty is zero")
    worst = int(np.argmax(errors.values if errors.bars is None else errors.values + errors.bars))
    bar = None if errors.bars is None else float(errors.bars[worst])
    deviation, sigma = signed_deviations(metric, data, window, worst)
    return Measurement(float(errors.values[worst]), bar, worst, int(data.measured.size), deviation, sigma,
                       errors.settled)


def value_measurement(data, window, interval):
    """The measured value itself; of several components the one farthest from the middle of `interval`."""
    data = data.within(window)
    refuse_unusable(data)
    mean = means(data.measured) if is_average(data, window) else Errors(data.measured[-1])
    bars = np.zeros_like(mean.values) if mean.bars is None else mean.bars
    worst = int(np.argmax(np.abs(mean.values - 0.5 * sum(interval)) + bars))
    bar = None if mean.bars is None else float(bars[worst])
    return Measurement(float(mean.values[worst]), bar, worst, int(data.measured.size), settled=mean.settled)


def refuse_unusable(data):
    """Raises NotComparable for empty or non-finite data."""
    if data.measured.size == 0:
        raise NotComparable("no points to compare")
    for name, values in (("measured", data.measured), ("expected", data.expected), ("uncertainty", data.uncertainty)):
        if values is not None and not np.all(np.isfinite(values)):
            raise NotComparable(f"{name} values are not finite")


def relative_l2(data, window):
    """||m - r||_2 / ||r||_2 over time."""
    return Errors(np.linalg.norm(data.measured - data.expected, axis=0) / np.linalg.norm(data.expected, axis=0))


def relative_linf(data, window):
    """max |m - r| / max |r| over time."""
    return Errors(np.max(np.abs(data.measured - data.expected), axis=0) / np.max(np.abs(data.expected), axis=0))


def absolute_linf(data, window):
    """max |m - r| over time, in the quantity's units."""
    return Errors(np.max(np.abs(data.measured - data.expected), axis=0))


def final_relative(data, window):
    """|m - r| / |r| at the last time."""
    return Errors(np.abs(data.measured[-1] - data.expected[-1]) / np.abs(data.expected[-1]))


def final_absolute(data, window):
    """|m - r| at the last time, in the quantity's units."""
    return Errors(np.abs(data.measured[-1] - data.expected[-1]))


def mean_relative(data, window):
    """|<m - r>| / |<r>| over the window, with the sampling error of <m - r>. A single number is its own mean."""
    if not is_average(data, window):
        return final_relative(data, window)
    mean = means(data.measured - data.expected)
    scale = np.abs(np.mean(data.expected, axis=0))
    return Errors(np.abs(mean.values) / scale, mean.bars / scale, mean.settled)


def in_sigma(data, window):
    """|m - r| / u: the error in units of the reference's standard uncertainty; averaged when a window is given."""
    if data.uncertainty is None:
        raise NotComparable("the reference states no uncertainty")
    if not is_average(data, window):
        return Errors(np.abs(data.measured[-1] - data.expected[-1]) / data.uncertainty[-1])
    mean, scale = means(data.measured - data.expected), np.mean(data.uncertainty, axis=0)
    return Errors(np.abs(mean.values) / scale, mean.bars / scale, mean.settled)


def ensemble_relative(data, window):
    """|<m - r>| / |<r>| over the independent members of an ensemble, one row each, with the sampling error of <m - r>."""
    difference, count = data.measured - data.expected, len(data.measured)
    scale = np.abs(np.mean(data.expected, axis=0))
    error = np.abs(np.mean(difference, axis=0)) / scale
    if count < 2:  # one member alone, as a twin's run
        return Errors(error)
    return Errors(error, half_width(np.std(difference, axis=0, ddof=1) / np.sqrt(count), count) / scale)


ERRORS = {"relative_l2": relative_l2, "relative_linf": relative_linf, "absolute_linf": absolute_linf,
          "final_relative": final_relative, "final_absolute": final_absolute, "mean_relative": mean_relative,
          "in_sigma": in_sigma, "ensemble_relative": ensemble_relative}
ENSEMBLE = "ensemble_relative"  # judged once, on the runs of all variants of the check
METRICS = (*ERRORS, "value")
AT_ONE_POINT = ("final_relative", "final_absolute", "mean_relative", "in_sigma", ENSEMBLE)


def is_average(data, window):
    """True when a window asks for an average of a series."""
    return window is not None and data.is_series


def means(values):
    """Block means of every column of values [nt, n] with their 95 % error bars."""
    if values.shape[0] < 2:
        raise NotComparable("a mean needs at least two points")
    averages = [block_mean(column) for column in values.T]
    return Errors(np.array([a.value for a in averages]), np.array([a.error_bar for a in averages]),
                  all(a.settled for a in averages))


def signed_deviations(metric, data, window, component):
    """(relative deviation, deviation in units of the uncertainty) where one point stands for the run, else None."""
    if metric not in AT_ONE_POINT:
        return None, None
    averaged = metric == ENSEMBLE or is_average(data, window) and metric in ("mean_relative", "in_sigma")
    rows = slice(None) if averaged else slice(-1, None)
    expected = np.mean(data.expected[rows, component])
    difference = np.mean(data.measured[rows, component]) - expected
    scale = 0.0 if data.uncertainty is None else np.mean(data.uncertainty[rows, component])
    return ratio(difference, expected), ratio(difference, scale)


def ratio(a, b):
    """a / b as a float, or None where that is not finite."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        value = float(np.divide(a, b))
    return value if np.isfinite(value) else None
