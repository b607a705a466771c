"""Two flows with too low a speed of sound: the Taylor-Green vortex as a weakly compressible fluid has it, and a compression
that viscosity holds up (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sph_operators, tait  # noqa: E402
from theory.field_errors import component_norms  # noqa: E402

POINTS = 32  # to a side; 48 differs by 1e-5 of U at c = 3 U
COURANT = 0.5  # step of the Runge-Kutta method over (box/POINTS)/(c + U)
UNITS = {name: "1" for name in ("velocity_l2", "compressible_l2", "compressibility", "density_rms", "held_up", "held_up_error")}


class Vortex:
    """initial = {law = "taylor_green", speed = U} on a square, one wavelength to the box."""

    def __init__(self, scene):
        fluid, size = scene["fluid"], scene["domain"]["size"]
        if size[0] != size[1]:
            raise ValueError("the Taylor-Green box is a square")
        self.size, self.speed = size[0], fluid["initial"]["speed"]
        self.k = 2.0 * math.pi / self.size
        self.rho, self.c = fluid["density"], fluid["sound_speed"]
        self.nu = fluid["viscosity"] / self.rho
        self.rate = 2.0 * self.nu * self.k**2

    def velocity(self, x, t):
        """[n, 2], m/s, of the incompressible flow."""
        a, b = self.k * x[..., 0], self.k * x[..., 1]
        u = np.stack([-np.cos(a) * np.sin(b), np.sin(a) * np.cos(b)], axis=-1)
        return self.speed * math.exp(-self.rate * t) * u

    def pressure(self, x, t):
        waves = np.cos(2.0 * self.k * x[..., 0]) + np.cos(2.0 * self.k * x[..., 1])
        return -0.25 * self.rho * self.speed**2 * math.exp(-2.0 * self.rate * t) * waves

    def density_rms(self, t):
        """Root of the mean of (rho/rho_0 - 1)^2 = (p/(rho c^2))^2 for the incompressible pressure: Ma^2/4 at the start."""
        return 0.25 * (self.speed / self.c) ** 2 * math.exp(-2.0 * self.rate * t)


class CompressibleVortex:
    """The equations that SPH solves, by a Fourier method with classical Runge-Kutta steps: README, equation (1)."""

    def __init__(self, vortex, end):
        self.vortex = vortex
        side = np.arange(POINTS) * vortex.size / POINTS
        self.x = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1)
        wave = 2.0 * math.pi * np.fft.fftfreq(POINTS, vortex.size / POINTS)
        half = 2.0 * math.pi * np.fft.rfftfreq(POINTS, vortex.size / POINTS)
        self.waves = np.stack(np.meshgrid(wave, half, indexing="ij"))
        self.kept = np.all(np.abs(self.waves) < 2.0 * math.pi / vortex.size * POINTS / 3.0, axis=0)
        rho = tait.density(vortex.pressure(self.x, 0.0), vortex.rho, vortex.c)
        self.state = np.stack([*np.moveaxis(vortex.velocity(self.x, 0.0), -1, 0), rho])
        self._advance(end)

    def _spectrum(self, field):
        return np.fft.rfft2(field) * self.kept

    def _field(self, spectrum):
        return np.fft.irfft2(spectrum, s=(POINTS, POINTS))

    def _gradient(self, field):
        spectrum = self._spectrum(field)
        return [self._field(1j * k * spectrum) for k in self.waves]

    def _rate(self, state):
        u, v, rho = state
        vortex, k2 = self.vortex, (self.waves**2).sum(axis=0)
        push = self._gradient(tait.pressure(rho, vortex.rho, vortex.c))
        rates = []
        for component, part in zip((u, v), push):
            slope = self._gradient(component)
            viscous = vortex.rho * vortex.nu / rho * self._field(-k2 * self._spectrum(component))
            rates.append(viscous - part / rho - u * slope[0] - v * slope[1])
        flux = self._gradient(rho * u)[0] + self._gradient(rho * v)[1]
        return np.stack([*rates, -flux])

    def _advance(self, end):
        longest = COURANT * self.vortex.size / POINTS / (self.vortex.c + self.vortex.speed)
        steps = math.ceil(end / longest)
        dt = end / steps
        for _ in range(steps):
            a = self._rate(self.state)
            b = self._rate(self.state + 0.5 * dt * a)
            c = self._rate(self.state + 0.5 * dt * b)
            self.state = self.state + dt / 6.0 * (a + 2.0 * b + 2.0 * c + self._rate(self.state + dt * c))

    def velocity(self, x):
        """[n, 2], m/s, at the end, at positions x [n, 2]: the Fourier series itself."""
        out = np.empty((len(x), 2))
        whole = 2.0 * math.pi * np.fft.fftfreq(POINTS, self.vortex.size / POINTS)
        first, second = (np.exp(1j * np.outer(x[:, c], whole)) for c in (0, 1))
        for c in (0, 1):
            series = np.fft.fft2(self.state[c]) / POINTS**2
            out[:, c] = np.einsum("ni,ij,nj->n", first, series, second, optimize=True).real
        return out


@lru_cache(maxsize=None)
def _solved(size, speed, viscosity, density, sound_speed, end):
    scene = {"domain": {"size": [size, size]},
             "fluid": {"initial": {"speed": speed}, "density": density, "viscosity": viscosity, "sound_speed": sound_speed}}
    return CompressibleVortex(Vortex(scene), end)


def solved(scene, end):
    """The compressible flow of a scene at `end`; kept, because several quantities ask for it."""
    fluid = scene["fluid"]
    return _solved(scene["domain"]["size"][0], fluid["initial"]["speed"], fluid["viscosity"], fluid["density"],
                   fluid["sound_speed"], float(end))


def compressibility(scene, t):
    """Root mean square of the compressible less the incompressible velocity over the decayed speed, the worse component."""
    flow, vortex = solved(scene, t), Vortex(scene)
    exact = vortex.velocity(flow.x, t).reshape(-1, 2)
    mine = np.moveaxis(flow.state[:2], 0, -1).reshape(-1, 2)
    return float(component_norms(mine, exact, vortex.speed * math.exp(-vortex.rate * t))["l2"].max())


class HeldUp:
    """initial = sound_wave, standing, so viscous that it may not oscillate: README, equation (3), with the sums of the lattice."""

    def __init__(self, scene, physical=False):
        fluid = scene["fluid"]
        self.fluid, self.speed, self.rho = fluid, fluid["initial"]["speed"], fluid["density"]
        self.k, self.c = 2.0 * math.pi / scene["domain"]["size"][0], fluid["sound_speed"]
        self.nu = fluid["viscosity"] / self.rho
        h, wave = fluid["smoothing"] * fluid["spacing"], np.array([self.k, 0.0])
        kernel, spacing = fluid["kernel"], fluid["spacing"]
        self.g = 1.0 if physical else float(sph_operators.lattice_gradient(kernel, wave, h, spacing)[0]) / self.k
        self.damping = 0.5 * self.nu * self.k**2
        if not physical:
            self.damping *= sph_operators.lattice_viscosity(kernel, wave, h, spacing)

    def held_up(self, t):
        """-b nu k/U with rho = rho_0 (1 + b cos kx): 1 is the whole compression of a fluid without pressure."""
        stiffness = (self.k * self.c * self.g) ** 2
        root = np.sqrt(complex(self.damping**2 - stiffness))
        wave = np.exp(-self.damping * t) * (np.sinh(root * t) / root if abs(root) > 0.0 else t)
        return float(self.nu * self.k**2 * self.g * np.real(wave))

    def measured(self, snapshot):
        """The same from positions and densities of particles."""
        shape = np.cos(self.k * snapshot["x"][:, 0])
        return float(-2.0 * np.mean(shape * (snapshot["rho"] / self.rho - 1.0)) * self.nu * self.k / self.speed)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    last = run.snapshot(-1)
    fluid, t = last["fluid"], last["time"]
    if quantity == "held_up":
        return HeldUp(run.scene).measured(fluid)
    if quantity == "held_up_error":
        held = HeldUp(run.scene)
        return held.measured(fluid) - held.held_up(t)
    if quantity == "density_rms":
        return float(np.std(fluid["rho"]) / run.scene["fluid"]["density"])
    vortex, x = Vortex(run.scene), fluid["x"][:, :2]
    exact = solved(run.scene, t).velocity(x) if quantity == "compressible_l2" else vortex.velocity(x, t)
    return float(component_norms(fluid["v"][:, :2], exact, vortex.speed * math.exp(-vortex.rate * t))["l2"].max())


def reference(quantity, scene, t):
    if quantity in ("velocity_l2", "compressible_l2", "held_up_error"):
        return 0.0
    if quantity == "density_rms":
        return Vortex(scene).density_rms(float(t)) if scene["fluid"]["initial"]["law"] == "taylor_green" else 0.0
    if quantity == "held_up":
        return 0.0  # what an incompressible fluid does
    raise KeyError(quantity)


def figures(runs):
    vortices = [run for run in runs if run.scene["fluid"]["initial"]["law"] == "taylor_green"]
    waves = [run for run in runs if run.scene["fluid"]["initial"]["law"] == "sound_wave"]
    return [("mach", _mach(vortices), "First criterion: density follows Ma squared; the velocity hardly notices."),
            ("acoustic_reynolds", _acoustic(waves), "Second criterion: the compression that viscosity still holds up after t = 3.9/(nu k²).")]


def _mach(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.8), layout="constrained")
    axes = figure.subplots()
    preset = [run for run in runs if run.variant.startswith("plumb")]
    runs = sorted((run for run in runs if run.variant == "vortex"), key=lambda run: run.scene["fluid"]["sound_speed"])
    c = _over_speed(runs)
    for name, mark, colour in (("density_rms", "o", "C0"), ("velocity_l2", "s", "C1"), ("compressible_l2", "x", "C2")):
        axes.loglog(c, [measure(name, run) for run in runs], mark, color=colour, label=name)
        if preset and name != "velocity_l2":
            label = f"{name}, preset plumb"
            axes.loglog(_over_speed(preset), [measure(name, run) for run in preset], "^", color=colour, mfc="none", ms=9, label=label)
    t = runs[0].snapshot(-1)["time"]
    axes.loglog(c, [Vortex(run.scene).density_rms(t) for run in runs], "-", label="density: Ma²/4 exp(-2 rate t)")
    axes.loglog(c, [compressibility(run.scene, t) for run in runs], "--", label="compressible less incompressible velocity")
    axes.set(xlabel="c/U (-)", ylabel="relative to rho_0, or to the decayed speed (-)")
    axes.legend(fontsize=7)
    return figure


def _over_speed(runs):
    """[n] c/U of vortices."""
    return np.array([run.scene["fluid"]["sound_speed"] / run.scene["fluid"]["initial"]["speed"] for run in runs])


def _acoustic(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.8), layout="constrained")
    axes = figure.subplots()
    first = HeldUp(runs[0].scene, physical=True)
    t = runs[0].snapshot(-1)["time"]
    curve = []
    ratios = np.geomspace(0.02, 100.0, 2000)
    for ratio in ratios:
        first.c = ratio * first.nu * first.k
        curve.append(first.held_up(t))
    axes.semilogx(ratios, curve, "-", label="theory")
    for run in runs:
        held = HeldUp(run.scene)
        mark = {"marker": "o", "mfc": "none", "ms": 10} if run.variant.startswith("plumb") else {"marker": "o"}
        axes.semilogx(held.c / (held.nu * held.k), held.measured(run.snapshot(-1)["fluid"]), linestyle="", label=run.variant, **mark)
    axes.set(xlabel="c/(nu k) (-)", ylabel="compression left (-)")
    axes.legend()
    return figure
