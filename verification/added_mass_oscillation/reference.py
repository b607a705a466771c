"""Grains with virtual mass in a standing sound wave and on springs: exact linear theory, textbook limits (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.linalg import expm

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators  # noqa: E402

UNITS = {"grain_wave": "m/s", "fluid_wave": "m/s", "following": "1", "frequency": "rad/s", "spring": "m/s"}


class Grain:
    """A grain's numbers; the pressure gradient and virtual mass act on it."""

    def __init__(self, scene):
        grain = scene["grains"][0] if isinstance(scene["grains"], list) else scene["grains"]
        fluid = scene["fluid"]
        self.d, self.rho_p, self.rho = grain["diameter"], grain["density"], fluid["density"]
        self.volume = math.pi / 6.0 * self.d**3
        self.inertia = (self.rho_p + 0.5 * self.rho) * self.volume
        self.drag = 3.0 * math.pi * fluid["viscosity"] * self.d if scene["coupling"]["drag"] == "stokes" else 0.0
        self.mobility = 1.5 * self.rho / (self.rho_p + 0.5 * self.rho)  # of a lone sphere: v' = mobility (-grad p)/rho



def between(kernel, h, spacing, k):
    """Sums over a cubic lattice seen from the middle of its cells, a wave k along x: (sum V W cos kx, sum V (-dW/dx) sin kx)."""
    reach = math.ceil(sph_operators.support(kernel) * h / spacing) + 1
    side = spacing * (np.arange(-reach, reach) + 0.5)
    x = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
    r = np.linalg.norm(x, axis=1)
    x, r = x[r < sph_operators.support(kernel) * h], r[r < sph_operators.support(kernel) * h]
    chosen, volume = sph_operators.KERNELS[kernel], spacing**3
    w = chosen.sigma[3] / h**3 * chosen.w(r / h)
    slope = chosen.sigma[3] / h**4 * chosen.slope(r / h)
    return volume * np.sum(w * np.cos(k * x[:, 0])), volume * np.sum(-slope / r * x[:, 0] * np.sin(k * x[:, 0]))


class Suspension:
    """A lattice of grains in a lattice of fluid, a sound wave along x: README, equation (1)."""

    def __init__(self, scene):
        fluid, coupling = scene["fluid"], scene["coupling"]
        self.grain, self.speed, self.c = Grain(scene), fluid["initial"]["speed"], fluid["sound_speed"]
        self.dx, kernel = fluid["spacing"], fluid["kernel"]
        h = fluid["smoothing"] * self.dx
        h_c = coupling["kernel_width"]["times_smoothing"] * h
        self.k = 2.0 * math.pi * fluid["initial"]["waves"] / scene["domain"]["size"][0]
        wave = np.array([self.k, 0.0, 0.0])
        self.gradient = sph_operators.lattice_gradient(kernel, wave, h, self.dx)[0]
        self.damping = fluid["viscosity"] / fluid["density"] * self.k**2 * sph_operators.lattice_viscosity(kernel, wave, h, self.dx)
        whole, _ = between(coupling["kernel"], h_c, self.dx, 0.0)
        shared, self.porosity_gradient = between(coupling["kernel"], h_c, self.dx, self.k)
        self.share = shared / whole
        self.phi = self.grain.volume / self.dx**3
        self.eps = 1.0 - self.phi * whole

    def rates(self):
        """[4, 4]: d/dt of (u, v, s, xi), amplitudes of sin kx, s of cos kx."""
        g, rho = self.grain, self.grain.rho
        # Rows of what the unknowns make: pressure gradient and viscous force per volume, without the grains' force.
        density = np.array([0.0, 0.0, 1.0, -self.phi * self.porosity_gradient / self.eps])
        stress = rho * self.c**2 * self.gradient * density - rho * self.damping * np.array([1.0, 0.0, 0.0, 0.0])
        force_of_flow = 1.5 * g.volume * self.share * stress + g.drag * np.array([self.share, -1.0, 0.0, 0.0])
        v = force_of_flow / g.inertia
        on_grain = g.rho_p * g.volume * v
        u = (stress - self.share * on_grain / self.dx**3) / (self.eps * rho)
        return np.array([u, v, [-self.gradient, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]])

    def amplitudes(self, t):
        """[nt, 4] of (u, v, s, xi) after a start with u = U sin kx, everything else zero; evenly spaced times."""
        t = np.asarray(t, float)
        step = expm(self.rates() * (t[1] - t[0]))
        state, out = expm(self.rates() * t[0]) @ np.array([self.speed, 0.0, 0.0, 0.0]), []
        for _ in t:
            out.append(state)
            state = step @ state
        return np.array(out)

    @property
    def sound(self):
        """Frequency of long waves in the suspension, rad/s: README, equation (3)."""
        g, phi = self.grain, self.phi
        return self.k * self.c * math.sqrt((1.0 + phi * g.mobility * (1.0 - g.rho_p / g.rho)) / (1.0 - phi))

    @property
    def following(self):
        """Grains' over fluid's acceleration in long waves: README, equation (2)."""
        g, phi = self.grain, self.phi
        return (1.0 - phi) * g.mobility / (1.0 - phi * g.mobility * g.rho_p / g.rho)


class Spring:
    """The optical oscillation of a chain of touching grains: README, equation (4)."""

    def __init__(self, scene):
        g, first = Grain(scene), scene["grains"][0]
        self.speed = first["velocity"][0]
        self.decay = 0.5 * g.drag / g.inertia
        self.frequency = math.sqrt(4.0 * first["contact"]["stiffness"] / g.inertia - self.decay**2)

    def velocity(self, t):
        phase = self.frequency * np.asarray(t, float)
        return self.speed * np.exp(-self.decay * np.asarray(t, float)) * (np.cos(phase) - self.decay / self.frequency * np.sin(phase))


def reference(quantity, scene, t):
    if quantity == "spring":
        return Spring(scene).velocity(t)
    bed = Suspension(scene)
    if quantity in ("following", "frequency"):
        return bed.following if quantity == "following" else bed.sound
    return bed.amplitudes(t)[:, {"fluid_wave": 0, "grain_wave": 1}[quantity]]


def grain_wave(run):
    """(t, amplitude of sin kx in the grains' velocity); a grain's phase is that of its place at the start."""
    t, v = run.series("grains_x")
    k = 2.0 * math.pi * run.scene["fluid"]["initial"]["waves"] / run.scene["domain"]["size"][0]
    first = run.snapshot(0)["grains"]
    shape = np.sin(k * first["x"][np.argsort(first["id"]), 0])
    return t, 2.0 * (v @ shape) / len(shape)


def following(run):
    """Slope of the grains' velocity against the fluid's over the run, both as amplitudes of the wave."""
    (_, u), (_, v) = run.series("fluid_wave"), grain_wave(run)
    return float(np.polyfit(u.ravel(), v, 1)[0])


def frequency(run):
    """rad/s, of the fluid's velocity: least squares of a decaying oscillation about zero."""
    from scipy.optimize import least_squares

    t, a = run.series("fluid_wave")
    a = a.ravel() / a.ravel()[0]

    def residual(numbers):
        omega, decay, p, q, mean = numbers
        return np.exp(-decay * t) * (p * np.cos(omega * t) + q * np.sin(omega * t)) + mean - a

    guess = Suspension(run.scene).sound
    return float(least_squares(residual, [guess, 0.0, 1.0, 0.0, 0.0], x_scale=[guess, 1.0, 1.0, 1.0, 1.0]).x[0])


def measure(quantity, run):
    if quantity == "spring":
        t, v = run.series("grains_x")
        first = run.snapshot(0)["grains"]
        sign = np.where(first["group"][np.argsort(first["id"])] == 0, 1.0, -1.0)
        return t, v @ sign / len(sign)
    return {"grain_wave": grain_wave, "following": following, "frequency": frequency}.get(quantity, lambda _: NotImplemented)(run)


def following_figure(runs):
    """Velocities of grains and fluid over time, runs and equation (1)."""
    from matplotlib.figure import Figure

    waves = [run for run in runs if not run.failure and "waves" in run.scene["fluid"]["initial"]]
    finest = min((run.value for run in waves), default=None)
    shown = [run for run in waves if run.value == finest and run.variant in ("light", "neutral", "heavy", "drag")]
    figure = Figure(figsize=(7.5, 3.8), layout="constrained")
    axes = figure.subplots()
    for n, run in enumerate(shown):
        bed = Suspension(run.scene)
        t, v = grain_wave(run)
        exact = bed.amplitudes(t) / bed.speed
        axes.plot(1e3 * t, exact[:, 1], "-", color=f"C{n}", lw=0.8)
        axes.plot(1e3 * t[::2], v[::2] / bed.speed, "o", ms=3, mfc="none", color=f"C{n}", label=f"grains, {run.variant}")
        axes.plot(1e3 * t, exact[:, 0], ":", color=f"C{n}", lw=0.8)
    axes.set_xlabel("time [ms]")
    axes.set_ylabel("amplitude of the velocity over U [-]")
    axes.legend(fontsize="x-small", loc="lower right")
    return figure


def figures(runs):
    return [("following", following_figure(runs), "Grains at rest at the start in a standing wave: circles runs (finest step), lines "
             "equation (1); dotted the fluid's velocity.")]
