"""Plane standing and travelling sound waves: physics, second harmonic, and the dispersion of SPH (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators, tait  # noqa: E402

UNITS = {
    "velocity_amplitude": "m/s",
    "density_amplitude": "kg/m3",
    "frequency": "rad/s",
    "frequency_operator": "rad/s",
    "frequency_lattice": "rad/s",
    "damping": "1/s",
    "damping_operator": "1/s",
    "second_harmonic": "1",
    "velocity_l2": "1",
}

# Longitudinal over shear viscosity: what nu lap v makes of a plane sound wave, and what a fluid without bulk viscosity does.
LAPLACIAN, STOKES_FLUID = 1.0, 4.0 / 3.0


class Mode:
    """One Fourier mode: u = a(t) sin(kx), s = rho'/rho_0 = b(t) cos(kx) with a' = k c^2 b - 2 damping a, b' = -k a.

    stiffness = k^2 c^2 (1/s2) and damping (1/s) may be those of physics or of an operator; g: its factor of gradients.
    """

    def __init__(self, k, stiffness, damping, g=1.0):
        if damping**2 >= stiffness:
            raise ValueError("an overdamped wave does not oscillate")
        self.k, self.damping, self.g = k, damping, g
        self.frequency = math.sqrt(stiffness - damping**2)

    def standing(self, t, speed):
        """(a, b) for a(0) = speed, b(0) = 0."""
        t = np.asarray(t, float)
        decay, phase = speed * np.exp(-self.damping * t), self.frequency * t
        velocity = decay * (np.cos(phase) - self.damping / self.frequency * np.sin(phase))
        return velocity, -self.k * self.g / self.frequency * decay * np.sin(phase)

    def travelling(self, x, t, speed):
        """(u, s) at x, t of the wave that runs towards +x, u = speed cos(kx) at t = 0."""
        omega = self.frequency - 1j * self.damping
        wave = speed * np.exp(1j * (self.k * np.asarray(x, float) - omega * t))
        return wave.real, (self.k * self.g / omega * wave).real


class Sound:
    """initial = {law = "sound_wave", speed = U, waves = m, kind = "standing" | "travelling"}, along x.

    fluid.background_pressure (default 0) is added to Tait's pressure by some schemes; it matters only to SPH's operator.
    """

    def __init__(self, scene, longitudinal=LAPLACIAN):
        fluid, initial = scene["fluid"], scene["fluid"]["initial"]
        self.fluid, self.speed = fluid, initial["speed"]
        self.kind = initial.get("kind", "standing")
        self.k = 2.0 * math.pi * initial.get("waves", 1) / scene["domain"]["size"][0]
        self.rho, self.c = fluid["density"], fluid["sound_speed"]
        self.nu = fluid["viscosity"] / self.rho
        self.mach = self.speed / self.c
        self.damping = 0.5 * longitudinal * self.nu * self.k**2

    def mode(self):
        """The wave of the linearised equations."""
        return Mode(self.k, (self.k * self.c) ** 2, self.damping)

    def operator_mode(self, dimension):
        """The wave of SPH with many neighbours: README, equation (4); Morris' viscosity, Tait's pressure."""
        kh = self.k * self.fluid["smoothing"] * self.fluid["spacing"]
        kernel = self.fluid["kernel"]
        g = float(sph_operators.transform(kernel, dimension, kh))
        background = 2.0 * self.fluid.get("background_pressure", 0.0) / self.rho * g * (1.0 - g)
        damping = 0.5 * self.nu * self.k**2 * float(sph_operators.viscosity_ratio(kernel, dimension, kh))
        return Mode(self.k, self.k**2 * (self.c**2 * g**2 + background), damping, g)

    def lattice_mode(self, dimension):
        """The same for the sums over a square or cubic lattice, the wave along x; no background pressure."""
        if self.fluid.get("background_pressure", 0.0) != 0.0:
            raise ValueError("lattice_mode has no background pressure")
        spacing = self.fluid["spacing"]
        h, k = self.fluid["smoothing"] * spacing, np.zeros(dimension)
        k[0] = self.k
        g = float(sph_operators.lattice_gradient(self.fluid["kernel"], k, h, spacing)[0]) / self.k
        damping = 0.5 * self.nu * self.k**2 * sph_operators.lattice_viscosity(self.fluid["kernel"], k, h, spacing)
        return Mode(self.k, (self.k * self.c * g) ** 2, damping, g)

    def fields(self, x, t):
        """(u [n], rho [n], p [n]) at x [n], m, of the linear wave; the initial state of a scene at t = 0."""
        x = np.asarray(x, float)
        if self.kind == "travelling":
            u, s = self.mode().travelling(x, t, self.speed)
        else:
            a, b = self.mode().standing(t, self.speed)
            u, s = a * np.sin(self.k * x), b * np.cos(self.k * x)
        rho = self.rho * (1.0 + s)
        return u, rho, tait.pressure(rho, self.rho, self.c)

    def second_harmonic(self, t, gamma=tait.GAMMA):
        """Amplitude of sin(2kx) (or of cos(2kx) turned by the phase) over U: README, equation (3). The error of linear theory."""
        t = np.asarray(t, float)
        share = 1.0 if self.kind == "travelling" else 0.5  # each of the two running waves has half the amplitude
        lasting = -np.expm1(-2.0 * self.damping * t) * np.exp(-2.0 * self.damping * t) / (2.0 * self.damping) if self.damping else t
        return 0.25 * (gamma + 1.0) * share * self.k * self.speed * lasting


def amplitudes(x, values, k, volume=None):
    """(sine, cosine): least-squares amplitudes of sin(kx) and cos(kx), with a constant, in values [n]."""
    x = np.asarray(x, float)
    weight = np.sqrt(np.ones(len(x)) if volume is None else np.asarray(volume, float))[:, None]
    shapes = np.stack([np.sin(k * x), np.cos(k * x), np.ones_like(x)], axis=1)
    found, *_ = np.linalg.lstsq(weight * shapes, weight[:, 0] * np.asarray(values, float), rcond=None)
    return float(found[0]), float(found[1])


def shock_distance(k, mach, gamma=tait.GAMMA):
    """Path after which an undamped travelling wave breaks, m: 1/((gamma+1)/2 Ma k)."""
    return 2.0 / ((gamma + 1.0) * mach * k)


def reference(quantity, scene, t):
    sound = Sound(scene)
    if quantity == "velocity_amplitude":  # of sin(kx) in a standing wave; modulus in a travelling one
        if sound.kind == "travelling":
            return sound.speed * np.exp(-sound.damping * np.asarray(t, float))
        return sound.mode().standing(t, sound.speed)[0]
    if quantity == "density_amplitude":
        if sound.kind == "travelling":
            return sound.rho * sound.mach * np.exp(-sound.damping * np.asarray(t, float))
        return sound.rho * sound.mode().standing(t, sound.speed)[1]
    if quantity in ("frequency", "damping"):
        return getattr(sound.mode(), quantity)
    if quantity in ("frequency_operator", "damping_operator"):
        return getattr(sound.operator_mode(sph_operators.dimension(scene["domain"]["size"])), quantity.removesuffix("_operator"))
    if quantity == "frequency_lattice":
        return sound.lattice_mode(sph_operators.dimension(scene["domain"]["size"])).frequency
    if quantity == "second_harmonic":
        return sound.second_harmonic(t)
    if quantity == "velocity_l2":
        return 0.0
    raise KeyError(quantity)


def fitted_mode(t, a):
    """(frequency, damping) of a(t) = exp(-damping t)(p cos + q sin)(frequency t), by least squares."""
    from scipy.optimize import least_squares

    def residual(numbers):
        frequency, damping, p, q = numbers
        return np.exp(-damping * t) * (p * np.cos(frequency * t) + q * np.sin(frequency * t)) - a / a[0]

    crossings = np.nonzero(np.diff(np.sign(a)))[0]
    guess = math.pi * (len(crossings) - 1) / (t[crossings[-1]] - t[crossings[0]])
    found = least_squares(residual, [guess, 0.01, 1.0, 0.0], xtol=1e-14, ftol=1e-14, gtol=1e-14)
    return float(found.x[0]), float(found.x[1])


def measure(quantity, run):
    if quantity.startswith(("frequency", "damping")):
        return fitted_mode(*run.series("velocity_amplitude"))[0 if quantity.startswith("frequency") else 1]
    return NotImplemented
