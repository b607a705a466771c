"""The wake of a grain that sinks through a lattice of smoothed particles, by sums over that lattice: equations (3) to (5) of the README.

Linear theory for the whole periodic box. The grain moves by a fiftieth of a spacing in a run, so its weights on the particles are those of the start.
"""

import math
from typing import NamedTuple

import numpy as np

from theory.sph_operators import KERNELS

GRAVITY = 9.81  # m/s2


class Felt(NamedTuple):
    """What the grain gathers of its own: u [nt], m/s downwards, its wake less the backflow of its moving porosity; own volume in eps."""

    t: np.ndarray
    u: np.ndarray
    own: float


def operators(kernel, h, mu, rho, c, count, dx):
    """(g [3, n, n, n], lambda): gradients are i g q, friction is -lambda v, for every wave of the box; 1/m, 1/s."""
    axis = np.arange(count) * dx
    axis -= count * dx * np.round(axis / (count * dx))
    places = np.meshgrid(axis, axis, axis, indexing="ij")
    q = np.sqrt(sum(x * x for x in places)) / h
    inside = (q > 0.0) & (q < 2.0)
    safe = np.where(inside, q, 1.0)
    f = np.where(inside, kernel.sigma[3] / h**5 * kernel.slope(safe) / safe, 0.0)
    volume = dx**3
    gradients = np.array([np.fft.fftn(volume * f * x).imag for x in places])
    friction = 2.0 * mu / rho * volume * (np.fft.fftn(f).real - f.sum())
    return gradients, friction


def felt(s, spacing, at, speed, steps=120):
    """Felt of a grain at `at`, m, whose speed and push rise as 1 - exp(-t/tau); `s` as in reference.py."""
    kernel, count, width = KERNELS[s.kernel], round(s.box[0] / spacing), s.width * s.h
    volume, places = spacing**3, []
    for side, x in zip(s.box, at):
        apart = (np.arange(count) + 0.5) * spacing - x
        places.append(apart - side * np.round(apart / side))
    x, y, z = np.meshgrid(*places, indexing="ij")
    r = np.sqrt(x * x + y * y + z * z)
    q = np.minimum(r / width, 2.0)
    w = kernel.sigma[3] / width**3 * kernel.w(q)
    share = w / w.sum()  # of the gathering and the spreading
    slope = np.fft.fftn(kernel.sigma[3] / width**4 * kernel.slope(q) * z / np.maximum(r, 1e-30))
    (gx, gy, gz), friction = operators(kernel, s.h, s.mu, s.rho, s.c, count, spacing)
    size_sq = gx**2 + gy**2 + gz**2
    size = np.sqrt(np.where(size_sq > 1e-12 * size_sq.max(), size_sq, np.inf))
    along = gz / size  # component of the wave's direction along z
    size = np.where(np.isfinite(size), size, 0.0)
    gathered = np.fft.fftn(share)
    push = -(s.rho_p - s.rho) * s.volume * GRAVITY * gathered / (s.rho * volume)
    room = s.volume * speed * slope  # of d(density)/dt, by the porosity that moves downwards
    dt = s.end / steps
    across, parallel, sound = (np.zeros_like(gathered) for _ in range(3))
    inverse = 1.0 / (1.0 + dt * friction + (dt * s.c * size) ** 2)
    u = np.zeros(steps)
    for n in range(steps):
        ramp = 1.0 - math.exp(-(n + 0.5) * dt / s.tau)
        across = ((1.0 - 0.5 * dt * friction) * across + dt * ramp * push * (1.0 - along**2)) / (1.0 + 0.5 * dt * friction)
        changed = sound + dt * ramp * room
        parallel = (parallel + dt * ramp * push * along - 1j * dt * s.c**2 * size * changed) * inverse
        sound = changed - 1j * dt * size * parallel
        u[n] = -np.vdot(gathered, across + along * parallel).real / count**3
    return Felt(dt * np.arange(1, steps + 1), u, s.volume * float((w * share).sum()))
