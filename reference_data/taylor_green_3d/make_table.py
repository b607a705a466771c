#!/usr/bin/env python3
"""Decay of the Taylor-Green vortex in space by a Fourier method; writes decay.csv (96^3, two minutes).

    make_table.py [points] [step]     default 96 0.04; another size prints its table and its difference from the committed one

u = sin x cos y cos z, v = -cos x sin y cos z, w = 0 on [0, 2 pi]^3 at t = 0, nu = 1/Re (Taylor & Green 1937). Rotational form
du/dt = P(u x omega) - nu k^2 u with P the projection on solenoidal fields, products on the grid, 2/3 of the wave numbers kept (Orszag
1971), classical Runge-Kutta of fourth order.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from scipy.fft import irfftn, rfftn

HERE = Path(__file__).resolve().parent
REYNOLDS, END, INTERVAL = 100.0, 10.0, 0.2


class Box:
    """Wave numbers [3, n, n, n/2+1], the mask of those that are kept, and sums over the half spectrum."""

    def __init__(self, n):
        self.n, self.shape = n, (n, n, n)
        whole, half = np.fft.fftfreq(n, 1.0 / n), np.fft.rfftfreq(n, 1.0 / n)
        self.k = np.stack(np.meshgrid(whole, whole, half, indexing="ij"))
        self.k2 = (self.k**2).sum(axis=0)
        self.over = 1.0 / np.where(self.k2 == 0.0, 1.0, self.k2)
        self.kept = np.all(np.abs(self.k) < n / 3.0, axis=0)
        self.share = np.where((self.k[2] == 0.0) | (self.k[2] == n // 2), 1.0, 2.0) / n**6  # |sum|^2 -> mean square

    def start(self):
        """Spectrum [3, ...] of the Taylor-Green vortex."""
        s = 2.0 * np.pi * np.arange(self.n) / self.n
        x, y, z = np.meshgrid(s, s, s, indexing="ij")
        u = np.stack([np.sin(x) * np.cos(y) * np.cos(z), -np.cos(x) * np.sin(y) * np.cos(z), np.zeros(self.shape)])
        return self.spectrum(u)

    def spectrum(self, field):
        return np.stack([rfftn(part) for part in field])

    def field(self, spectrum):
        return np.stack([irfftn(part, s=self.shape) for part in spectrum])

    def curl(self, u):
        k = self.k
        return 1j * np.stack([k[1] * u[2] - k[2] * u[1], k[2] * u[0] - k[0] * u[2], k[0] * u[1] - k[1] * u[0]])

    def rate(self, u, nu):
        """du/dt of the spectrum u."""
        v, w = self.field(u), self.field(self.curl(u))
        product = np.stack([v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]])
        force = self.spectrum(product) * self.kept
        force -= self.k * ((self.k * force).sum(axis=0) * self.over)
        return force - nu * self.k2 * u

    def energy(self, u):
        """Mean of |u|^2/2."""
        return float(0.5 * (self.share * (np.abs(u) ** 2).sum(axis=0)).sum())

    def dissipation(self, u, nu):
        """nu times the mean of |omega|^2."""
        return float(nu * (self.share * self.k2 * (np.abs(u) ** 2).sum(axis=0)).sum())


def decay(n=96, step=0.04, end=END, interval=INTERVAL, reynolds=REYNOLDS):
    """[(t, energy, dissipation)] every `interval`, in units of U and L = box/(2 pi)."""
    box, nu, rows = Box(n), 1.0 / reynolds, []
    u, every = box.start(), round(interval / step)
    for number in range(round(end / step) + 1):
        if number % every == 0:
            rows.append((number * step, box.energy(u), box.dissipation(u, nu)))
        a = box.rate(u, nu)
        b = box.rate(u + 0.5 * step * a, nu)
        c = box.rate(u + 0.5 * step * b, nu)
        u = u + step / 6.0 * (a + 2.0 * b + 2.0 * c + box.rate(u + step * c, nu))
    return rows


def committed():
    with open(HERE / "decay.csv", newline="", encoding="utf-8") as stream:
        return [tuple(float(value) for value in row) for row in list(csv.reader(stream))[1:]]


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 96
    step = float(sys.argv[2]) if len(sys.argv) > 2 else 0.04
    rows = decay(n, step)
    if len(sys.argv) == 1:
        with open(HERE / "decay.csv", "w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow(["t [1]", "energy [1]", "dissipation [1]"])
            writer.writerows([f"{t:.1f}", f"{e:.8f}", f"{d:.9f}"] for t, e, d in rows)
        return
    table = committed()
    for column, name in ((1, "energy"), (2, "dissipation")):
        worst = max(abs(mine[column] / theirs[column] - 1.0) for mine, theirs in zip(rows, table))
        print(f"{n}^3, step {step}: {name} differs by at most {worst:.1e} of its value")


if __name__ == "__main__":
    main()
