"""The velocity that a two-way coupled grain gathers across a shear flow from its own wake: Saffman's lift, resolved by the scheme.

A grain in u = G y e_x pushes the fluid with F, spread as s(x - X), and gathers with g. Linearised about the shear, the waves of the
disturbance are carried by it, k_x and k_z constant, k_y' = -G k_x (Kelvin 1887), and d(k^2)/dt = -2 G k_x k_y, so that the equation of
the transverse component is one of k^2 u_y alone,

    d(k^2 u_y)/dt = -lambda(k) k^2 u_y + [(k_x^2 + k_z^2) F_y - k_x k_y F_x] s^(k)/rho,                                      (1)

lambda the symbol of the viscous operator. With the wave k at the end and k(tau) = k + e_y k_x Gamma(tau) a time tau before, Gamma the
strain since,

    u_y = (1/rho) (2 pi)^-3 Int g^(k)/k^2 Int_0^t [(k_x^2 + k_z^2) F_y - k_x k_y(tau) F_x] s^(k(tau)) cos(k_x X(tau)) e^-L(tau) dtau d3k,  (2)

L = Int lambda(k(tau)) dtau, X the way along x that the grain has slipped since. Without shear the part of F_x is odd and nothing. For kernels
much narrower than sqrt(nu/G), times much longer than 1/G and X = 0 this is the velocity behind Saffman's lift: he gives the force 3 pi mu d
u_y (1965, J. Fluid Mech. 22, 385). So (2) -> -[1.615/(3 pi)] d sqrt(|G|/nu) F_x/(3 pi mu d), which checks both.

Left out: walls, images, curvature of the profile over the wake, and what the grain's path across the flow changes.
"""

import math

import numpy as np

from theory import self_disturbance, sph_operators

TABLE = np.linspace(0.0, 50.0, 5001)  # k h


def _table(kernel, function):
    values = np.ones_like(TABLE)
    values[1:] = function(kernel, 3, TABLE[1:])
    return values


class Wake:
    """Quadrature nodes and tables of one scheme (self_disturbance.Scheme) in a fluid of rho, mu. narrow: point force and exact operator."""

    def __init__(self, scheme, rho, mu, waves=(1e-3, 14.0), nodes=(40, 14, 16, 120), narrow=False):
        self.rho, self.nu, self.scheme, self.narrow = rho, mu / rho, scheme, narrow
        self.h = scheme.gather.h
        if not narrow:
            self.filters = [(_table(part.kernel, sph_operators.transform), part.h) for part in (scheme.spread, scheme.gather)]
            self.ratio = None if scheme.viscosity is None else (_table(scheme.viscosity.kernel, sph_operators.viscosity_ratio),
                                                                scheme.viscosity.h)
        radial, polar, around, self.past = nodes
        a, b = math.log(waves[0] / self.h), math.log(waves[1] / self.h)
        node, weight = np.polynomial.legendre.leggauss(radial)
        self.k = np.exp(0.5 * (b - a) * (node + 1.0) + a)
        self.radial = 0.5 * (b - a) * weight * self.k**3  # k^2 dk
        node, weight = np.polynomial.legendre.leggauss(polar)
        self.cosines, self.polar = 0.5 * (node + 1.0), 0.5 * weight  # of k to z; the other half is alike
        self.angles = (np.arange(around) + 0.5) * math.pi / around  # half a turn; k and -k are alike
        self.turn = math.pi / around

    def filter(self, which, k):
        if self.narrow:
            return np.ones_like(k)
        table, h = self.filters[which]
        return np.interp(k * h, TABLE, table, right=0.0)

    def decay(self, k):
        if self.narrow or self.ratio is None:
            return self.nu * k**2
        return self.nu * k**2 * np.interp(k * self.ratio[1], TABLE, self.ratio[0], right=0.0)

    def across(self, t, force_x, force_y, strain, way):
        """u_y, m/s, at time t after fluid without disturbance. Functions of the time t': forces on the fluid, N; `strain` and `way` [m]

        are those from t' to t."""
        total = 0.0
        k = self.k[:, None, None]
        top = np.minimum(t, 40.0 / np.maximum(self.decay(self.k), 1e-300))
        tau = top[:, None, None] * np.linspace(0.0, 1.0, self.past + 1) ** 2
        f_x, f_y, gamma, x = (function(t - tau) for function in (force_x, force_y, strain, way))
        dt = np.diff(tau, axis=-1)
        for cosine, share in zip(self.cosines, self.polar):
            sine = math.sqrt(1.0 - cosine**2)
            angle = self.angles[None, :, None]
            k_x, k_z = k * sine * np.cos(angle), k * cosine
            k_y = k * sine * np.sin(angle) + k_x * gamma
            size = np.sqrt(k_x**2 + k_y**2 + k_z**2)
            rate = self.decay(size)
            fading = np.concatenate([np.zeros(rate.shape[:-1] + (1,)), np.cumsum(0.5 * (rate[..., 1:] + rate[..., :-1]) * dt, axis=-1)], axis=-1)
            source = ((k_x**2 + k_z**2) * f_y - k_x * k_y * f_x) * self.filter(0, size) * np.cos(k_x * x) * np.exp(-fading)
            whole = np.sum(0.5 * (source[..., 1:] + source[..., :-1]) * dt, axis=-1)
            total += 4.0 * self.turn * share * np.sum(self.radial[:, None] * self.filter(1, self.k)[:, None] / self.k[:, None] ** 2 * whole)
        return total / (2.0 * math.pi) ** 3 / self.rho


def of_constant_push(scheme, rho, mu, shear, force_x, t, **options):
    """u_y, m/s, under a constant force along x in a constant shear; the grain does not slip far (X = 0)."""
    wake = Wake(scheme, rho, mu, **options)
    return wake.across(t, lambda s: np.full_like(s, force_x), np.zeros_like, lambda s: shear * (t - s), np.zeros_like)


def saffman_share(force_x, rho, mu, shear):
    """-[1.615/(3 pi)] sqrt(|G|/nu) F_x/(3 pi mu) sign(G): the velocity that Saffman's lift gives a grain that pushes with F_x, m/s."""
    return -6.46 / 4.0 / (3.0 * math.pi) * math.sqrt(abs(shear) * rho / mu) * force_x / (3.0 * math.pi * mu) * math.copysign(1.0, shear)
