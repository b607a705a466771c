"""Small standing gravity wave in a basin of finite depth: frequency, damping, first nonlinear corrections (README.md)."""

import cmath
import math

import numpy as np
from scipy.optimize import least_squares, root

UNITS = {
    "elevation": "m",
    "frequency": "rad/s",
    "damping": "1/s",
    "damping_operator": "1/s",
    "frequency_inviscid": "rad/s",
    "frequency_finite": "rad/s",
    "damping_estimate": "1/s",
    "kinetic_energy": "J/m2",
}


class Wave:
    """fill = {law = "wave", depth = H, amplitude = a, wave_length = 2 pi/k} over a floor, from rest; sides periodic or walls.

    eta = a cos(kx) at t = 0; x along axis 0, z up from the still surface. Side walls, if any, stand at crests, x = 0 and
    pi/k. `free_surface`: what the viscous term makes of a surface left alone, "stress" (no stress: physics) or "gradient"
    (p = mu du/dn: the natural condition of nu lap u; README).
    """

    def __init__(self, scene, free_surface="stress"):
        fluid, fill = scene["fluid"], scene["fluid"]["fill"]
        self.g = max(abs(value) for value in scene["domain"]["gravity"])
        self.rho, self.nu = fluid["density"], fluid["viscosity"] / fluid["density"]
        self.c = fluid.get("sound_speed", math.inf)
        self.amplitude, self.depth = fill["amplitude"], fill["depth"]
        self.k = 2.0 * math.pi / fill["wave_length"]
        walls = {wall["name"]: wall["slip"] == "no_slip" for wall in scene.get("wall", [])}
        self.no_slip, self.side_walls = walls.get("floor", False), walls.get("sides", False)
        self.surface_share = {"stress": 2.0, "gradient": 1.0}[free_surface]
        self.shear_share = self.surface_share - 1.0
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
        """Rate of the amplitude, 1/s: 2 nu k^2 (half of it with "gradient") plus the Stokes layers on no-slip floor and side walls (README, equation 2)."""
        layer = math.sqrt(0.5 * self.nu * self.frequency)
        rate = self.surface_share * self.nu * self.k**2
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
            normal = s / k**2 * (nu * (q**3 - k**2 * q) - s * q) - g - self.surface_share * nu * s * q
            shear = q**2 + self.shear_share * k**2
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


FREE_SURFACE = {"morris": "gradient", "monaghan_gingold": "stress"}  # what each viscous term does there (README)


def fit(run):
    """(damping, frequency), 1/s, of the swing A exp(-rate t) sin(w t + phase), least squares after the first period."""
    wave = Wave(run.scene)
    t, swing = run.series("swing")
    late = t > 2.0 * math.pi / wave.frequency
    t, swing = t[late], swing[late]

    def misfit(parts):
        return parts[0] * np.exp(-parts[1] * t) * np.sin(parts[2] * t + parts[3]) - swing

    found = least_squares(misfit, [np.abs(swing).max(), wave.damping_estimate(), wave.frequency, 0.0], x_scale="jac")
    return float(found.x[1]), float(found.x[2])


def mean_square_share(wave, end):
    """Mean of exp(2 s t) over the fitted times: what is left of the square of the amplitude, and of its effect on frequency."""
    rate, start = -2.0 * wave.exponent().real, 2.0 * math.pi / wave.frequency
    return (math.exp(-rate * start) - math.exp(-rate * end)) / (rate * (end - start))


def reference(quantity, scene, t):
    wave = Wave(scene)
    operator = Wave(scene, FREE_SURFACE[scene["fluid"]["viscous_term"]]) if wave.nu > 0.0 else wave
    if quantity == "elevation":
        return wave.elevation(t)
    if quantity == "frequency":
        bend = (wave.finite_frequency() / wave.frequency - 1.0) * mean_square_share(operator, scene["time"]["end"])
        return operator.exponent().imag * (1.0 + bend)
    if quantity == "damping":
        return -wave.exponent().real
    if quantity == "damping_operator":
        return -operator.exponent().real
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


def measure(quantity, run):
    if quantity in ("damping", "damping_operator"):
        return fit(run)[0]
    if quantity == "frequency":
        return fit(run)[1]
    return NotImplemented


def figures(runs):
    """The swing over time with the viscous theory's envelopes, and the damping against the spacing."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.5, 3.8), layout="constrained")
    swing, damping = figure.subplots(1, 2)
    good = [run for run in runs if not run.failure]
    for number, name in enumerate(dict.fromkeys(run.variant for run in good)):
        own = [run for run in good if run.variant == name]
        wave = Wave(own[-1].scene)
        t, v = own[-1].series("swing")
        swing.plot(t, v / (wave.amplitude * wave.frequency), lw=1.0, color=f"C{number}", label=name)
        points = sorted((run.scene["fluid"]["spacing"], fit(run)[0] / (wave.nu * wave.k**2)) for run in own)
        damping.semilogx(*zip(*points), "o-", ms=4, lw=1.0, color=f"C{number}", label=name)
        damping.axhline(reference("damping_operator", own[-1].scene, 0.0) / (wave.nu * wave.k**2), lw=0.8, ls="--", color=f"C{number}")
    swing.set_xlabel("time [s]")
    swing.set_ylabel("mean of 2 u sin kx, over a omega")
    spacings = sorted({run.scene["fluid"]["spacing"] for run in good})
    damping.set_xticks(spacings, [f"{spacing:.3g}" for spacing in spacings], fontsize="small")
    damping.minorticks_off()
    damping.set_xlabel("spacing [m]")
    damping.set_ylabel("damping/(nu k^2)")
    damping.legend(fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return [("wave", figure, "The swing at the finest spacing (left). Fitted damping (points) and the exact one of the fluid whose surface "
             "each viscous term makes (dashed): no stress with `monaghan_gingold`, no gradient with `morris`.")]
