"""Orders of convergence: the slope of log(error) against log(parameter), with interval and plateau detection."""

from dataclasses import dataclass

import numpy as np

from .sampling import student_factor

FEWEST_POINTS = 3  # two points leave no residual, hence no interval
PLATEAU_SLOPE = 0.5  # slower than half an order is a floor; a change from second to first order must not pass for one
CLEAR_OF_FLOOR = 3.0  # nearer to the floor than this, the floor bends the line noticeably


@dataclass(frozen=True)
class OrderFit:
    """error = exp(intercept) parameter^order; [lower, upper] is the 95 % interval of the order.

    `used` points (the coarsest ones) entered the fit; `plateau` others lie on a floor (round-off, sampling noise, or an
    error that the parameter does not control).
    """
    order: float
    lower: float
    upper: float
    intercept: float
    used: int
    plateau: int


class NoOrder(Exception):
    """No order can be fitted to these errors; the text says why."""


def order_fit(parameters, errors, error_bars=None):
    """The OrderFit of errors [n] against parameters [n], coarse to fine. Raises NoOrder.

    The interval comes from the residuals (Student's t with used - 2 degrees of freedom) and, for noisy errors, from
    their 95 % error bars [n] as well, added in quadrature.
    """
    x, errors = np.log(np.asarray(parameters, dtype=float)), np.asarray(errors, dtype=float)
    if not np.all(np.isfinite(errors)) or np.any(errors < 0):
        raise NoOrder("an error is negative or not finite")
    usable = int(np.argmin(errors > 0)) if np.any(errors == 0) else len(errors)  # a zero error is below round-off
    if usable < FEWEST_POINTS:
        raise NoOrder(f"only {usable} coarse points have an error above zero; an order needs {FEWEST_POINTS}")
    y = np.log(errors[:usable])
    used = points_before_plateau(x[:usable], y)
    bars = np.zeros(used) if error_bars is None else np.asarray(error_bars, dtype=float)[:used] / errors[:used]
    slope, intercept, reach = line(x[:used], y[:used], bars)
    return OrderFit(slope, slope - reach, slope + reach, intercept, used, len(errors) - used)


def points_before_plateau(x, y):
    """How many of the points, coarse to fine, lie clearly above the floor of the error; at least FEWEST_POINTS.

    The plateau starts at the first point that no later one undercuts by PLATEAU_SLOPE orders (by that fraction of the
    order seen so far, for schemes of less than first order). Points before it that the floor contributes to, being less
    than CLEAR_OF_FLOOR times the plateau's median, are left out, too. A plateau is looked for only behind FEWEST_POINTS
    points: a shorter run-up shows no slope to compare with.
    """
    for start in range(FEWEST_POINTS - 1, len(x) - 1):
        run_up = (y[start] - y[0]) / (x[start] - x[0])
        slopes = (y[start + 1:] - y[start]) / (x[start + 1:] - x[start])
        if np.all(slopes * np.sign(run_up) < PLATEAU_SLOPE * min(1.0, abs(run_up))):
            clear = y[:start + 1] > np.median(y[start + 1:]) + np.log(CLEAR_OF_FLOOR)
            return max(FEWEST_POINTS, start + 1 if np.all(clear) else int(np.argmin(clear)))
    return len(x)


def line(x, y, bars):
    """(slope, intercept, half width of the slope's 95 % interval) of the least-squares line; `bars` [n] on y."""
    centred = x - np.mean(x)
    weights = centred / np.sum(centred**2)
    slope = float(np.sum(weights * y))
    intercept = float(np.mean(y) - slope * np.mean(x))
    freedom = len(x) - 2
    scatter = np.sqrt(np.sum((y - intercept - slope * x)**2) / freedom / np.sum(centred**2))
    return slope, intercept, float(np.hypot(student_factor(freedom) * scatter, np.sqrt(np.sum((weights * bars)**2))))
