"""Steady flow in a channel as rows of smoothed particles see it, between walls that continue it antisymmetrically.

Morris' viscous sum over rows that slide on each other is, averaged over their places along the channel, a sum over the rows of
the kernel's marginal. A boundary row behind the wall carries minus the velocity of the linear least-squares fit, weighted with
the kernel's own marginal, at its mirror place. Both are linear in the rows' velocities: a small system gives the steady profile.
"""

import numpy as np
from scipy.interpolate import CubicSpline

MARGINAL_POINTS = 2001


def wendland_c2(q):
    return np.where(q < 2.0, (1.0 - 0.5 * q) ** 4 * (2.0 * q + 1.0), 0.0)


def wendland_c2_slope(q):
    """-W'/q."""
    return np.where(q < 2.0, 5.0 * (1.0 - 0.5 * q) ** 3, 0.0)


def marginal(function):
    """Integral of function(distance) along the other axis: a function of the distance across; lengths in units of h."""
    along = across = np.linspace(-2.0, 2.0, MARGINAL_POINTS)
    table = np.trapz(function(np.hypot(along[None, :], across[::4, None])), along, axis=1)
    spline = CubicSpline(across[::4], table)
    return lambda s: np.where(np.abs(s) < 2.0, spline(np.clip(s, -2.0, 2.0)), 0.0)


def fit_weights(y, place, h, kernel):
    """[n]: what each row at y [n] contributes to the linear fit at `place`, weighted with the marginal `kernel`."""
    s = (y - place) / h
    w = kernel(s)
    zeroth, first, second = np.sum(w), np.sum(w * s), np.sum(w * s * s)
    return w * (second - first * s) / (zeroth * second - first**2)


def steady_rows(rows, smoothing):
    """(y [rows] over the width, u [rows] over the parabola's peak) of plane Poiseuille flow; h = smoothing/rows widths."""
    spacing = 1.0 / rows
    h = smoothing * spacing
    y = (np.arange(rows) + 0.5) * spacing
    deep = (np.arange(int(np.ceil(2.0 * smoothing)) + 1) + 0.5) * spacing
    behind = np.concatenate((-deep, 1.0 + deep))
    kernel, slope = marginal(wendland_c2), marginal(wendland_c2_slope)
    mirrored = np.array([fit_weights(y, place, h, kernel) for place in np.concatenate((deep, 1.0 - deep))])
    fluid = slope((y[None, :] - y[:, None]) / h)
    wall = slope((behind[None, :] - y[:, None]) / h)
    s = np.linspace(-2.0, 2.0, MARGINAL_POINTS)
    viscosity = np.trapz(slope(s) * s**2 / 2.0, s)
    operator = (fluid - np.diag(np.sum(fluid, axis=1) + np.sum(wall, axis=1)) - wall @ mirrored) * spacing / (h**3 * viscosity)
    return y, np.linalg.solve(operator, np.full(rows, -8.0))  # u'' = -8: peak 1
