"""A manufactured flow among a porosity that is a moving wave, on a periodic square in the plane (verification/mms_grid).

    eps = a + b sin(theta),  theta = K.x - w t,  K = 2 pi (m, n)/L,  w = 2 pi/period
    eps u = curl psi + c (eps - a),  c = w K/K^2

keeps mass exactly, d(eps)/dt + div(eps u) = 0: c.grad(eps) = -d(eps)/dt. psi and p are those of verification/mms. Derivatives
are taken by Fourier series on a fine grid and by differences in time, never by hand: they serve tests and bounds.
"""

import math

import numpy as np


class ManufacturedMedium:
    """`law` is the scene's table {speed, porosity = {mean, amplitude, waves, period}}; the box is a square of side `length`."""

    def __init__(self, law, length, density, viscosity):
        self.speed, self.length, self.density, self.viscosity = law["speed"], length, density, viscosity
        wave = law["porosity"]
        self.mean, self.amplitude = wave["mean"], wave["amplitude"]
        self.number = 2.0 * math.pi * np.asarray(wave["waves"], float) / length
        self.omega = 2.0 * math.pi / wave["period"]
        self.k = 2.0 * math.pi / length

    def porosity(self, x, y, t):
        return self.mean + self.amplitude * np.sin(self.number[0] * x + self.number[1] * y - self.omega * t)

    def velocity(self, x, y, t):
        """(u, v), m/s, between the solid."""
        eps, wt = self.porosity(x, y, t), self.k * self.speed * t
        a, b = self.k * x, self.k * y
        c = self.omega * self.number / np.sum(self.number**2)
        # psi k/U = sin X sin Y + cos(wt) cos(2X + Y)/2
        along = np.sin(a) * np.cos(b) - 0.5 * np.cos(wt) * np.sin(2.0 * a + b)
        across = -np.cos(a) * np.sin(b) + np.cos(wt) * np.sin(2.0 * a + b)
        return tuple((self.speed * flux + c[i] * (eps - self.mean)) / eps for i, flux in enumerate((along, across)))

    def pressure(self, x, y, t):
        """Pa; its mean over the box is 0."""
        a, b, wt = self.k * x, self.k * y, self.k * self.speed * t
        shape = 0.25 * (np.cos(2.0 * a) + np.cos(b)) + 0.5 * np.sin(wt) * np.sin(a + 2.0 * b)
        return self.density * self.speed**2 * shape

    def grid(self, n):
        """Places x, y [n, n] of a periodic grid, the first index along x."""
        middles = (np.arange(n) + 0.5) * self.length / n
        return np.meshgrid(middles, middles, indexing="ij")

    def along(self, field, axis, order):
        """Derivative of a periodic field [n, n] by x (axis 0) or y (1)."""
        n = field.shape[axis]
        numbers = 2.0 * math.pi * np.fft.fftfreq(n, self.length / n)
        numbers = numbers[:, None] if axis == 0 else numbers[None, :]
        return np.real(np.fft.ifft((1j * numbers) ** order * np.fft.fft(field, axis=axis), axis=axis))

    def rate(self, field, t, order=1, step=1e-3):
        """Time derivative of field(t), by central differences of fourth order (order 1) or second (2, 3)."""
        f = [field(t + k * step) for k in (-2, -1, 0, 1, 2)]
        weights = {1: (1 / 12, -2 / 3, 0, 2 / 3, -1 / 12), 2: (-1 / 12, 4 / 3, -5 / 2, 4 / 3, -1 / 12), 3: (-0.5, 1.0, 0, -1.0, 0.5)}
        return sum(w * g for w, g in zip(weights[order], f)) / step**order


def ergun(diameter):
    """beta(eps, speed, density, viscosity) [kg/(m3 s)] of -eps grad p = beta u (Ergun 1952)."""

    def beta(eps, speed, density, viscosity):
        phi = 1.0 - eps
        return 150.0 * viscosity * phi**2 / (eps * diameter**2) + 1.75 * density * phi * speed / diameter

    return beta


def source(flow, beta, x, y, t):
    """What has to be added to the acceleration, m/s2, so that the flow solves
    eps rho (u_t + u.grad u) = -eps grad p + div(eps mu grad u) - beta u + eps rho s; x, y: flow.grid(n)."""
    eps, u, p = flow.porosity(x, y, t), flow.velocity(x, y, t), flow.pressure(x, y, t)
    resistance = beta(eps, np.hypot(*u), flow.density, flow.viscosity)
    out = []
    for i in (0, 1):
        slopes = [flow.along(u[i], axis, 1) for axis in (0, 1)]
        friction = sum(flow.along(eps * slope, axis, 1) for axis, slope in enumerate(slopes)) / eps
        carried = u[0] * slopes[0] + u[1] * slopes[1]
        force = flow.along(p, i, 1) - flow.viscosity * friction + resistance * u[i] / eps
        out.append(flow.rate(lambda s, i=i: flow.velocity(x, y, s)[i], t) + carried + force / flow.density)
    return tuple(out)


def truncation(flow, beta, t, third=1.0 / 6.0, n=96):
    """(acceleration, velocity) of the leading errors per spacing squared of a staggered grid's second-order differences, root
    mean square of the worse component: [1/(m s2)] and [1/(m s)].

    Acceleration: h^2 times third u_j d_j^3 u (1/6 for central differences, 1/3 for linear upwind ones), twice 1/8 of the carrier's
    curvature (means along and across) times grad u, d^3p/24, nu d^4u/12, and 1/8 of the resistance's curvature (a mean of two).
    Velocity: what keeps the mass of the grid, eps on faces as the mean of two cells (1/8) and differences of fluxes (1/24).
    """
    x, y = flow.grid(n)
    eps, u, p = flow.porosity(x, y, t), flow.velocity(x, y, t), flow.pressure(x, y, t)
    resistance = beta(eps, np.hypot(*u), flow.density, flow.viscosity) / eps / flow.density
    d, rms = flow.along, lambda field: math.sqrt(np.mean(field**2))
    curvature = lambda field: d(field, 0, 2) + d(field, 1, 2)  # noqa: E731
    acceleration, velocity = [], []
    for i in (0, 1):
        terms = (third * sum(u[j] * d(u[i], j, 3) for j in (0, 1)),
                 0.25 * sum(curvature(u[j]) * d(u[i], j, 1) for j in (0, 1)),
                 d(p, i, 3) / (24.0 * flow.density),
                 flow.viscosity / flow.density / 12.0 * (d(u[i], 0, 4) + d(u[i], 1, 4)),
                 d(resistance, i, 2) * u[i] / 8.0)
        acceleration.append(sum(rms(term) for term in terms))
        velocity.append(rms(d(eps, i, 2) * u[i] / (8.0 * eps)) + rms(d(eps * u[i], i, 2) / (24.0 * eps)))
    return max(acceleration), max(velocity)


def step_truncation(flow, t, n=96):
    """(two, one): rms acceleration error of a step per dt^2 and per dt, the worse component: u_ttt/3 of backward differences and
    the carrier's continuation u_tt . grad u over two steps; u_tt/2 and u_t . grad u over one."""
    x, y = flow.grid(n)
    u, d, rms = flow.velocity(x, y, t), flow.along, lambda field: math.sqrt(np.mean(field**2))
    rates = {k: [flow.rate(lambda s, i=i: flow.velocity(x, y, s)[i], t, k) for i in (0, 1)] for k in (1, 2, 3)}
    carried = {k: [sum(rates[k][j] * d(u[i], j, 1) for j in (0, 1)) for i in (0, 1)] for k in (1, 2)}
    two = max(rms(rates[3][i]) / 3.0 + rms(carried[2][i]) for i in (0, 1))
    one = max(rms(rates[2][i]) / 2.0 + rms(carried[1][i]) for i in (0, 1))
    return two, one
