"""The elasticity that a lattice of smoothed particles has under pressure.

A particle of a simple cubic lattice that is displaced by A exp(i k.x) gets from the symmetric pressure sum the acceleration -2 m P D(k) A,
D = sum over the neighbours r of (1 - cos k.r) grad grad W, P = p/rho^2 (verification/negative_pressure, equation 2). In space filled
with fluid the sum is an integral and vanishes for A across k; over a lattice it does not, and shear waves swing at omega,

    omega^2 = (p/rho) 2 dx^3 A.D A,    |A| = 1, A.k = 0,                                                               (1)

or grow where it is negative; under tension the other way round. It is of the order (k dx)^2 times what the sum misses.
"""

import numpy as np

from .sph_operators import KERNELS, support


def curvature(kernel, smoothing):
    """(r, grad grad W) of the neighbours on a lattice of spacing 1 with h = `smoothing`: [n, 3], [n, 3, 3]."""
    chosen, reach = KERNELS[kernel], int(support(kernel) * smoothing) + 1
    axis = np.arange(-reach, reach + 1.0)
    r = np.array(np.meshgrid(axis, axis, axis)).reshape(3, -1).T
    distance = np.linalg.norm(r, axis=1)
    inside = (distance > 0.0) & (distance < support(kernel) * smoothing - 1e-9)
    r, distance = r[inside], distance[inside]
    q, scale = distance / smoothing, chosen.sigma[3] / smoothing**3
    first = scale * chosen.slope(q) / smoothing
    small = 1e-6
    second = scale * (chosen.slope(q + small) - chosen.slope(q - small)) / (2.0 * small) / smoothing**2
    along = r[:, :, None] * r[:, None, :] / distance[:, None, None] ** 2
    return r, second[:, None, None] * along + (first / distance)[:, None, None] * (np.eye(3) - along)


def stiffness(kernel, smoothing, k_dx, direction):
    """omega^2 rho/p of (1) times dx^2, for the wave vector k_dx (over 1/dx) and displacements along `direction`."""
    r, hessian = curvature(kernel, smoothing)
    unit = np.asarray(direction, float) / np.linalg.norm(direction)
    matrix = np.einsum("n,nij->ij", 1.0 - np.cos(r @ np.asarray(k_dx, float)), hessian)
    return float(2.0 * unit @ matrix @ unit)
