"""Small standing gravity wave in a basin of finite depth: frequency, damping, first nonlinear corrections (README.md)."""

import cmath
import math

import numpy as np
from scipy.optimize import root

UNITS = {
    "elevation": "m",
    "frequency": "rad/s",
    "damping": "1/s",
    "frequency_inviscid": "rad/s",
    "frequency_finite": "rad/s",
    "damping_estimate": "1/s",
    "kinetic_energy": "J/m2",
}


class Wave:
    """initial = {law = "standing_wave", amplitude = a, depth = H, wave_length = 2 pi/k, floor = "free_slip" | "no_slip"}.

    eta = a cos(kx) at t = 0, at rest; x along axis 0, z up from the still surface; `basin`: the no-slip walls, if any, stand at
    crests, x = 0 and pi/k (walls_slip = false adds their layers to the estimate).
    """

    def __init__(self, scene):
        fluid, initial = scene["fluid"], scene["fluid"]["initial"]
        self.g = max(abs(value) for value in scene["domain"]["gravity"])
        self.rho, self.nu = fluid["density"], fluid["viscosity"] / fluid["density"]
        self.c = fluid.get("sound_speed", math.inf)
        self.amplitude, self.depth = initial["amplitude"], initial["depth"]
        self.k = 2.0 * math.pi / initial["wave_length"]
        self.no_slip = initial.get("floor", "free_slip") == "no_slip"
        self.side_walls = not initial.get("walls_slip", True)
        self.frequency = math.sqrt(self.g * self.k * math.tanh(self.k * self.depth))

    def potential_flow(self, x, z, t):
        """(u, w, p) of the linear inviscid wave at x, z <= 0, t: m/s, m/s, Pa (with the hydrostatic part, p = 0 at z = 0)."""
        k, phase = self.k, self.frequency * t
        x, z = np.asarray(x, float), np.asarray(z, float)
        scale = self.amplitude * self.g * k / self.frequency / math.cosh(k * self.depth)
        u = scale * np.cosh(k * (z + self.depth)) * np.sin(k * x) * math.sin(phase)
        w = -scale * np.sinh(k * (z + self.depth)) * np.cos(k * x) * math.sin(phase)
        swing = self.amplitude * np.cosh(k * (z + self.depth)) / math.cosh(k * self.depth) * np.cos(k * x) * math.cos(phase)
        return u, w, self.rho * self.g * (swing - z)

    def damping_estimate(self):
        """Rate of the amplitude, 1/s: 2 nu k^2 plus the Stokes layers on no-slip floor and side walls (README, equation 2)."""
        layer = math.sqrt(0.5 * self.nu * self.frequency)
        rate = 2.0 * self.nu * self.k**2
        depth = 2.0 * self.k * self.depth
        if self.no_slip:
            rate += self.k * layer / math.sinh(depth)
        if self.side_walls:
            rate += self.k * layer / math.pi * (1.0 - depth / math.sinh(depth))
        return rate

    def exponent(self):
        """s, 1/s (complex), of exp(s t): the exact root of the linearised viscous equations (README, equation 3)."""
        start = complex(-self.damping_estimate(), self.frequency)
        unit = self.frequency

        def residual(parts):
            value = self._determinant(complex(*parts) * unit)
            return [value.real, value.imag]

        found = root(residual, [start.real / unit, start.imag / unit], tol=1e-14)
        s = complex(*found.x) * unit
        if abs(self._determinant(s)) > 1e-8 or abs(s - start) > 0.3 * abs(start):
            raise ArithmeticError("no viscous wave near the inviscid one")
        return s

    def _determinant(self, s):
        """Of the four boundary conditions on w = e^kz, e^-k(z+H), e^mz, e^-m(z+H); m^2 = k^2 + s/nu. Scaled rows and columns."""
        k, nu, g = self.k, self.nu, self.g
        m = cmath.sqrt(k * k + s / nu)
        fall, sink = math.exp(-k * self.depth), cmath.exp(-m * self.depth)
        rows = []
        for q, top, bottom in ((k, 1.0, fall), (-k, fall, 1.0), (m, 1.0, sink), (-m, sink, 1.0)):
            normal = s / k**2 * (nu * (q**3 - k**2 * q) - s * q) - g - 2.0 * nu * s * q
            shear = q**2 + k**2
            floor = q if self.no_slip else q * q
            rows.append([normal * top / g, shear * top / k**2, bottom, floor * bottom / (m if self.no_slip else m * m)])
        return np.linalg.det(np.array(rows))

    def finite_frequency(self):
        """Frequency of the inviscid standing wave of finite amplitude, rad/s, to order (ka)^2 (README, equation 4)."""
        w = math.sqrt(math.tanh(self.k * self.depth))
        second = (9.0 * w**-7 - 12.0 * w**-3 - 3.0 * w - 2.0 * w**5) / 32.0
        return self.frequency * (1.0 + 0.5 * (self.k * self.amplitude) ** 2 * second / w)

    def second_harmonic(self, t):
        """Amplitude of cos(2kx) in the surface, m, at second order, of the start at rest from a pure cosine (README, equation 5)."""
        w2 = math.tanh(self.k * self.depth)
        own = math.sqrt(2.0 * self.g * self.k * math.tanh(2.0 * self.k * self.depth))
        bound = lambda time: (w2 + 1.0 / w2) - (1.0 / w2 - 3.0 / w2**3) * np.cos(2.0 * self.frequency * time)  # noqa: E731
        t = np.asarray(t, float)
        return self.k * self.amplitude**2 / 8.0 * (bound(t) - bound(0.0) * np.cos(own * t))

    def elevation(self, t):
        """Amplitude of cos(kx), m, at first order with the exact viscous exponent (its slow start, README, left out)."""
        s = self.exponent()
        t = np.asarray(t, float)
        return self.amplitude * np.exp(s.real * t) * np.cos(s.imag * t)


def surface_mode(x, eta, k):
    """Least-squares amplitude of cos(kx) in the surface heights eta [n] at x [n], m, with sin, cos 2kx and a constant beside it."""
    x = np.asarray(x, float)
    shapes = np.stack([np.cos(k * x), np.sin(k * x), np.cos(2.0 * k * x), np.ones_like(x)], axis=1)
    return float(np.linalg.lstsq(shapes, np.asarray(eta, float), rcond=None)[0][0])


def reference(quantity, scene, t):
    wave = Wave(scene)
    if quantity == "elevation":
        return wave.elevation(t)
    if quantity == "frequency":
        return wave.exponent().imag
    if quantity == "damping":
        return -wave.exponent().real
    if quantity == "frequency_inviscid":
        return wave.frequency
    if quantity == "frequency_finite":
        return wave.finite_frequency()
    if quantity == "damping_estimate":
        return wave.damping_estimate()
    if quantity == "kinetic_energy":  # per area of still surface, first order, without the damping inside a period
        s = wave.exponent()
        t = np.asarray(t, float)
        return 0.25 * wave.rho * wave.g * wave.amplitude**2 * np.exp(2.0 * s.real * t) * np.sin(s.imag * t) ** 2
    raise KeyError(quantity)
