"""Small motions of a lattice of smoothed particles at rest across steps of porosity: equations (1) to (4) of the README.

Planes of particles along x, a wave exp(i (k_y y + k_z z)) across. A plane has five unknowns: xi (displacement along x, the only one that
changes eps), v (three) and s (rate of density summed up); particles of the same plane differ by the wave's phase only.
"""

import math

import numpy as np
from scipy.special import j0

from theory.sph_operators import KERNELS, support

GAUSS = np.polynomial.legendre.leggauss(48)


def column(x, h, kernel, k):
    """1/m: kernel at distance x from a plane, integrated over the plane with exp(i k.y)."""
    reach, chosen = support(kernel) * h, KERNELS[kernel]
    x = np.abs(np.asarray(x, float))
    top = np.sqrt(np.maximum(reach**2 - x**2, 0.0))
    rho = 0.5 * top[..., None] * (GAUSS[0] + 1.0)
    w = chosen.sigma[3] / h**3 * chosen.w(np.minimum(np.hypot(x[..., None], rho) / h, support(kernel)))
    return math.pi * top * np.sum(w * j0(k * rho) * rho * GAUSS[1], axis=-1)


class Step:
    """A bed of planes of grains at `planes`, each with the volume `share` per area, m, in a column of `count` planes of particles."""

    def __init__(self, count, spacing, h, kernel, width, planes, share, c, mu, rho, handed_on=True, shared=False):
        self.count, self.dx, self.h, self.kernel, self.width = count, spacing, h, kernel, width
        self.share, self.c, self.mu, self.rho, self.handed_on, self.shared = share, c, mu, rho, handed_on, shared
        self.x = (np.arange(count) + 0.5) * spacing
        length = count * spacing
        apart = self.x[:, None] - np.asarray(planes)
        self.apart = apart - length * np.round(apart / length)
        self.eps = 1.0 - share * column(self.apart, width, kernel, 0.0).sum(axis=1)
        small = 1e-5 * spacing
        change = column(self.apart + small, width, kernel, 0.0) - column(self.apart - small, width, kernel, 0.0)
        self.slope = -share * change.sum(axis=1) / (2.0 * small)  # d eps/dx

    def sums(self, k):
        """Over the sites of each plane, with exp(-i k.y): gradient of the kernel [planes, 3], F = W'/r [planes]; sum of F over all."""
        chosen, reach = KERNELS[self.kernel], support(self.kernel) * self.h
        axis = np.arange(-int(reach / self.dx) - 1, int(reach / self.dx) + 2) * self.dx
        x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
        q = np.sqrt(x**2 + y**2 + z**2) / self.h
        inside = (q > 0.0) & (q < support(self.kernel))
        safe = np.where(inside, q, 1.0)
        f = np.where(inside, chosen.sigma[3] / self.h**5 * chosen.slope(safe) / safe, 0.0)
        wave = f * np.exp(-1j * (k[0] * y + k[1] * z))
        return np.stack([(wave * part).sum(axis=(1, 2)) for part in (x, y, z)], axis=-1), wave.sum(axis=(1, 2)), f.sum()

    def handed(self, k):
        """[count, count]: what the grains take of the force of the fluid and hand back, by planes (with the wave's aliases on the lattice)."""
        if self.shared or not self.handed_on:
            return np.zeros((self.count, self.count))
        whole = (column(self.apart, self.width, self.kernel, 0.0) * self.dx).sum(axis=0)
        total = np.zeros((self.count, self.count))
        for p in (-1, 0, 1):
            for q in (-1, 0, 1):
                wave = math.hypot(k[0] + 2.0 * math.pi * p / self.dx, k[1] + 2.0 * math.pi * q / self.dx)
                weight = column(self.apart, self.width, self.kernel, wave) * self.dx / whole
                total += self.share / self.dx * weight @ weight.T
        return total

    def matrix(self, k):
        """d/dt of (xi, v_x, v_y, v_z, s), each for all planes."""
        n, volume = self.count, self.dx**3
        gradient, friction, all_f = self.sums(k)
        spread = np.zeros((4, n, n), complex)
        middle = len(friction) // 2
        for apart in range(-middle, middle + 1):
            for a in range(n):
                spread[:3, a, (a - apart) % n] += gradient[apart + middle]
                spread[3, a, (a - apart) % n] += friction[apart + middle]
        part = [slice(i * n, (i + 1) * n) for i in range(5)]
        pressure = np.zeros((n, 5 * n), complex)
        pressure[:, part[4]] = self.c**2 * np.eye(n)
        pressure[:, part[0]] = -np.diag(self.c**2 * self.rho * self.slope / self.eps)
        kept = np.eye(n) - self.handed(k)
        matrix = np.zeros((5 * n, 5 * n), complex)
        matrix[part[0], part[1]] = np.eye(n)
        for i in range(3):
            force = -volume * spread[i] @ (self.eps[:, None] * pressure if self.shared else pressure)
            if self.shared and i == 0:
                force += self.slope[:, None] * pressure  # p grad eps: equation (6)
            force[:, part[1 + i]] += 2.0 * self.mu * volume * (all_f * np.eye(n) - spread[3])
            matrix[part[1 + i]] = kept @ force / (self.rho * self.eps)[:, None]
            matrix[part[4], part[1 + i]] = -self.rho * volume * spread[i]
        return matrix

    def growth_rate(self, k):
        """1/s of the fastest wave."""
        return float(np.linalg.eigvals(self.matrix(k)).real.max())

    def energy(self, t, v):
        """Mean v^2/2 at times t from velocities v [count, ny, nz, 3] of the sites, no displacement and no pressure."""
        _, ny, nz, _ = v.shape
        amplitude = np.fft.fft2(v, axes=(1, 2)) / (ny * nz)
        energy = np.zeros(len(t))
        for j in range(ny):
            for l in range(nz // 2 + 1):
                twice = 1.0 if (2 * l) % nz == 0 else 2.0  # the wave and its conjugate
                k = [2.0 * math.pi * (m if 2 * m <= n else m - n) / (n * self.dx) for m, n in ((j, ny), (l, nz))]
                start = np.zeros(5 * self.count, complex)
                start[self.count:4 * self.count] = amplitude[:, j, l].T.ravel()
                rates, modes = np.linalg.eig(self.matrix(k))
                share = np.linalg.solve(modes, start)
                now = modes[self.count:4 * self.count] @ (np.exp(np.outer(rates, t)) * share[:, None])
                energy += twice * 0.5 * np.sum(np.abs(now) ** 2, axis=0) / self.count
        return energy
