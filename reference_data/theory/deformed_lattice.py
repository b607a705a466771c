"""Sums of smoothed particles over a lattice that a smooth flow has deformed.

A lattice carried by a flow is again a lattice near every particle, r = F n dx with the deformation F of the flow and whole
numbers n: its sums depend on F and on h/dx, however fine it is. With M = sum V (x_b - x_a) (x) grad_a W, which is the unit
matrix for many neighbours, the plain gradient of a linear field is M grad f; so the plain divergence of a flow is

    tr(M grad v) = div v + D,   D = tr[(M - 1) grad v]                                                          (1)

and D is the floor of the scheme at a fixed h/dx.
"""

import math

import numpy as np

from . import sph_operators


def carried(velocity, gradient, x, times):
    """Positions [m, n, 2] and deformations [m, n, 2, 2] at `times` [m] of particles that start at x [n, 2] (Runge-Kutta 4, one
    step between times); gradient(x, t)[n, i, j] = d v_i/d x_j."""
    x, f = np.array(x, float), np.broadcast_to(np.eye(2), (len(x), 2, 2))
    places, deformations = [x], [f]

    def rates(x, f, t):
        return velocity(x, t), gradient(x, t) @ f

    for t, later in zip(times[:-1], times[1:]):
        s = later - t
        x1, f1 = rates(x, f, t)
        x2, f2 = rates(x + s / 2 * x1, f + s / 2 * f1, t + s / 2)
        x3, f3 = rates(x + s / 2 * x2, f + s / 2 * f2, t + s / 2)
        x4, f4 = rates(x + s * x3, f + s * f3, later)
        x, f = x + s / 6 * (x1 + 2 * x2 + 2 * x3 + x4), f + s / 6 * (f1 + 2 * f2 + 2 * f3 + f4)
        places.append(x)
        deformations.append(f)
    return np.array(places), np.array(deformations)


def moments(kernel, deformation, smoothing):
    """M [n, 2, 2] of plane lattices deformed by `deformation` [n, 2, 2], h = smoothing spacings, V = spacing^2."""
    reach = sph_operators.support(kernel) * smoothing
    most = math.ceil(reach / np.linalg.svd(deformation, compute_uv=False).min())
    n = np.stack(np.meshgrid(*2 * [np.arange(-most, most + 1)]), axis=-1).reshape(-1, 2)
    r = np.einsum("pij,lj->pli", deformation, n[(n != 0).any(axis=1)]) / smoothing  # over h
    q = np.linalg.norm(r, axis=-1)
    law = sph_operators.KERNELS[kernel]
    weight = -law.sigma[2] * law.slope(q) / (q * smoothing**2)
    return np.einsum("pl,pli,plj->pij", weight, r, r)


def divergence_errors(kernel, smoothing, velocity, gradient, x, times):
    """D of (1), [m, n], at `times` for particles that start at x."""
    places, deformations = carried(velocity, gradient, x, times)
    return np.array([np.einsum("pij,pji->p", moments(kernel, f, smoothing) - np.eye(2), gradient(y, t))
                     for y, f, t in zip(places, deformations, times)])
