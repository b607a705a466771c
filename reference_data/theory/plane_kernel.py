"""The Wendland C2 kernel of space, integrated over planes: what it makes of fields that vary along z, alone or as w(z) exp(i k x).

    w(z) = Int W(sqrt(r^2 + z^2)) 2 pi r dr           w(z; k) = Int W(sqrt(r^2 + z^2)) J0(k r) 2 pi r dr

The first is a polynomial: with s = 1 - |z|/(2h), h w = s^5 (10.5 - 15.75 s + 6 s^2); 3/4 at the centre, 1 in all.
"""

import math

import numpy as np
from scipy.special import j0

from .sph_operators import KERNELS

KERNEL = "wendland_c2"


def plane_average(z, h):
    """w(z), 1/m; zero beyond 2 h."""
    s = np.maximum(1.0 - 0.5 * np.abs(z) / h, 0.0)
    return s**5 * (10.5 - 15.75 * s + 6.0 * s**2) / h


def plane_share(z, h):
    """Int_-inf^z w: the smoothed step, 0 to 1."""
    s = np.maximum(1.0 - 0.5 * np.abs(z) / h, 0.0)
    tail = s**6 * (3.5 - 4.5 * s + 1.5 * s**2)
    return np.where(np.asarray(z) < 0.0, tail, 1.0 - tail)


def wave_average(z, h, k, points=48):
    """w(z; k), 1/m, by Gauss' rule over the chord of the support at height z (a smooth integrand: good to 1e-10)."""
    node, weight = np.polynomial.legendre.leggauss(points)
    z = np.asarray(z, float)
    # with q = |x|/h from |z|/h to 2: r dr = h^2 q dq, r = h sqrt(q^2 - z^2/h^2); a square root of q - |z|/h is smoothed by
    # q = |z|/h + (2 - |z|/h) t^2
    low = np.minimum(np.abs(z) / h, 2.0)
    t = 0.5 * (node + 1.0)
    q = low[..., None] + (2.0 - low[..., None]) * t**2
    dq = (2.0 - low[..., None]) * t * weight
    r = h * np.sqrt(np.maximum(q**2 - low[..., None] ** 2, 0.0))
    chosen = KERNELS[KERNEL]
    return np.sum(2.0 * math.pi * chosen.sigma[3] * chosen.w(q) * q * j0(k * r) * dq, axis=-1) / h
