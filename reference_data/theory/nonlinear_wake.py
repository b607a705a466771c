"""The steady wake of a smoothed force with its own advection kept: Navier-Stokes in a periodic cube, by Fourier series.

In the frame of a grain that moves at V e through fluid whose mean is at rest, and pushes with F e spread as s(x),

    (u - V e).grad u = -grad p + D u + F s/rho,   div u = 0,   D -> -lambda(k),   u_self = Int g u.e dV,   V = slip + u_self,

solved by relaxed fixed-point iteration; products by the two-thirds rule. Without u.grad u this is Oseen's equation with U = V
("path" of `self_disturbance`). It decides between the two linearisations there, which differ at second order of the disturbance:
the one with U = the slip is the nearer (table self_disturbance/nonlinear.csv). One kernel for everything.
"""

import numpy as np

from theory import self_disturbance


class Cube:
    """Wave vectors of a cube of side `cell` (in h) with n points a side, and the symbols on them; h = nu = rho = 1."""

    def __init__(self, scheme, cell, n):
        side = 2.0 * np.pi / cell * np.fft.fftfreq(n, 1.0 / n)
        self.k = np.stack(np.meshgrid(side, side, np.abs(side[: n // 2 + 1]), indexing="ij"))
        modulus, where = np.unique(np.sqrt((self.k**2).sum(axis=0)).round(10), return_inverse=True)
        spread = lambda values: values[where].reshape(self.k.shape[1:])  # noqa: E731
        self.square = spread(modulus**2)
        self.square[0, 0, 0] = 1.0  # the mean is kept zero
        self.decay = spread(modulus**2 * self_disturbance.viscosity_ratio(scheme, modulus))
        self.decay[0, 0, 0] = 1.0
        self.filter = spread(np.sqrt(np.abs(self_disturbance.filter_product(scheme, modulus)))) / cell**3
        self.kept = np.abs(self.k).max(axis=0) < 2.0 * np.pi / cell * n / 3.0
        self.filter[~self.kept] = 0.0
        self.copies = np.full(self.square.shape, 2.0)  # of a coefficient in the half space of a real transform
        self.copies[..., 0] = 1.0
        self.cell, self.n = cell, n

    def gathered(self, u):
        """Int g u.e dV, e along x."""
        return float(np.sum(self.copies * self.filter * self.cell**3 * u[0].real))

    def advection(self, u):
        """div (u u) of the series u [3, ...]."""
        field = [np.fft.irfftn(part, s=(self.n,) * 3) * self.n**3 for part in u]
        result = np.zeros_like(u)
        for i in range(3):
            for j in range(i, 3):
                product = 1j * self.kept * np.fft.rfftn(field[i] * field[j]) / self.n**3
                result[i] += self.k[j] * product
                if i != j:
                    result[j] += self.k[i] * product
        return result


def steady_wake(scheme, slip, force, cell, n=48, advection=True, tolerance=1e-6):
    """u_self of the steady state, all in units of h, nu and rho (slip = Re_h, force = F/(rho nu^2)).

    `scheme`: one kernel with h = 1. Good to 1e-3 with cell/n = 1/3. Raises ArithmeticError if the iteration does not settle.
    """
    cube = Cube(scheme, cell, n)
    u, u_self = np.zeros((3,) + cube.square.shape, complex), 0.0
    push = np.zeros_like(u)
    push[0] = force * cube.filter
    for _ in range(80):
        right = push - cube.advection(u) if advection else push
        right = right - cube.k * (cube.k * right).sum(axis=0) / cube.square
        fresh = right / (cube.decay - 1j * cube.k[0] * (slip + u_self))
        fresh[:, 0, 0, 0] = 0.0
        change = cube.gathered(fresh) - u_self
        settled = abs(change) < tolerance * abs(slip) and np.abs(fresh - u).max() < tolerance * np.abs(fresh).max() * 10.0
        u = 0.5 * (u + fresh)
        u_self += 0.5 * change
        if settled:
            return u_self
    raise ArithmeticError(f"the wake at Re_h = {slip} does not settle")
