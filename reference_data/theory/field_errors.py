"""Errors of a vector field on particles, component by component.

A norm of the magnitude only is blind to direction: a field turned by any angle, or of the wrong sign, has no error at all,
and an error e across the flow shows only as e^2/(2 |v|). The largest speed is one particle of thousands, is insensitive (to
first order) to where that particle is, and does not see a pattern that has moved, nor one half of the box at rest.
"""

import numpy as np


def component_norms(measured, exact, scale, volume=None):
    """{"l1", "l2", "linf"}: arrays [d] of mean |e|, root of mean e^2 and largest |e| over `scale`, e = measured - exact.

    measured, exact: [n, d] in the same units as scale; volume [n]: weights of the means (m/rho of the particles; equal
    without). Anything not finite makes every norm of that component infinite, so that it cannot pass a bound.
    """
    error = np.abs(np.asarray(measured, float) - np.asarray(exact, float)) / scale
    error = error[:, None] if error.ndim == 1 else error
    weight = np.ones(len(error)) if volume is None else np.asarray(volume, float)
    share = (weight / weight.sum())[:, None]
    norms = {
        "l1": (share * error).sum(axis=0),
        "l2": np.sqrt((share * error**2).sum(axis=0)),
        "linf": error.max(axis=0),
    }
    broken = ~np.isfinite(error).all(axis=0)
    return {name: np.where(broken, np.inf, value) for name, value in norms.items()}


def without_mean(values, volume=None):
    """values [n] less their (weighted) mean: pressures of a closed box are fixed only up to a constant."""
    return values - np.average(values, weights=volume)
