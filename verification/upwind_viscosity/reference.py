"""Damping of a weak vortex by the discrete advection that carries it: waves of the scheme, step by step (README.md)."""

import cmath
import math

import numpy as np

UNITS = {name: "1" for name in ("along", "across", "along_modified", "across_modified", "speed", "over_fluid")}
UNITS |= {"along_viscosity": "m2/s", "across_viscosity": "m2/s", "numerical": "m2/s"}


class Waves:
    """The waves (1, 1) along the flow and (1, -1) across it of a scene."""

    def __init__(self, scene):
        fluid, time = scene["fluid"], scene["time"]
        self.size, self.h = scene["domain"]["size"][0], fluid["spacing"]
        self.k, self.nu = 2.0 * math.pi / self.size, fluid["viscosity"] / fluid["density"]
        self.advection, self.push = fluid["advection"], np.array(fluid["body_force"])
        self.dt, self.second_order = time["step"], time["integrator"] == "bdf2"
        self.end, self.steps = time["end"], round(time["end"] / time["step"])

    @property
    def mean_speed(self):
        """Of each component over the run, m/s."""
        return float(self.push[0]) * self.end / 2.0

    def carried(self, kh):
        """u d/dx of a wave over u/h, for flow in the direction of x: README, equation (2)."""
        back = cmath.exp(-1j * kh)
        return {"upwind": 1.0 - back, "linear_upwind": 1.5 - 2.0 * back + 0.5 * back**2, "central": 0.5 * (1.0 / back - back)}[self.advection]

    def rate(self, signs, speed):
        """Damping and frequency, 1/s, of the wave k (signs) in the flow (speed, speed)."""
        friction = 2.0 * self.nu * (2.0 - 2.0 * math.cos(self.k * self.h)) / self.h**2
        return friction + speed / self.h * sum(self.carried(s * self.k * self.h) for s in signs)

    def amplitude(self, signs):
        """What is left of the wave at the end, complex: README, equation (3)."""
        before, now, speed_of = None, 1.0 + 0.0j, lambda n: float(self.push[0]) * n * self.dt
        for n in range(self.steps):
            if self.second_order and before is not None:
                now, before = (2.0 * now - 0.5 * before) / (1.5 + self.dt * self.rate(signs, speed_of(n + 1))), now
            else:
                now, before = now / (1.0 + self.dt * self.rate(signs, speed_of(n))), now
        return now

    def viscosity(self, left):
        """That takes so much of a wave, m2/s."""
        return -math.log(abs(left)) / (2.0 * self.k**2 * self.end)

    def modified(self, signs):
        """The fluid's, |u| h/2 of upwind and the time's first-order error: README, equation (4)."""
        along = sum(signs) ** 2 / 2.0
        carriers = self.push[0] * self.dt * np.array([0, *range(2, self.steps + 1)] if self.second_order else range(self.steps))
        square = float(np.mean(carriers**2))
        space = float(np.mean(carriers)) * self.h / 2.0 if self.advection == "upwind" else 0.0
        return self.nu + space + (0.0 if self.second_order else 0.5 * self.dt * square * along)


SIGNS = {"along": (1, 1), "across": (1, -1)}


def left_of(run, signs):
    """Complex amplitude at the end over that at the start, of u on its faces."""
    ends = []
    for k in (0, -1):
        u = run.snapshot(k)["grid"]["u_x"][0]
        spectrum = np.fft.fft2(u) / u.size
        ends.append(spectrum[signs[1], signs[0]])
    return ends[1] / ends[0]


def reference(quantity, scene, t):
    waves = Waves(scene)
    if quantity in SIGNS or quantity == "speed" or quantity.endswith("_modified"):
        return 1.0
    if quantity == "numerical":
        return 0.0
    name = quantity.removesuffix("_viscosity")
    if name in SIGNS:
        return waves.viscosity(waves.amplitude(SIGNS[name]))
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity not in UNITS:
        return NotImplemented
    waves = Waves(run.scene)
    if quantity == "speed":  # of the wave over the fluid's: its phase over that of a wave carried by the flow
        u = run.snapshot(-1)["grid"]["u_x"][0]
        return float(u.mean() / (waves.push[0] * waves.end))
    if quantity == "over_fluid":
        return waves.viscosity(left_of(run, SIGNS["along"])) / waves.nu
    if quantity == "numerical":  # across the flow, where steps err little
        friction = Waves({**run.scene, "fluid": {**run.scene["fluid"], "body_force": [0.0, 0.0]}})
        return waves.viscosity(left_of(run, SIGNS["across"])) - friction.viscosity(friction.amplitude(SIGNS["across"]))
    name = quantity.split("_")[0]
    found = left_of(run, SIGNS[name])
    if quantity.endswith("_viscosity"):
        return waves.viscosity(found)
    if quantity.endswith("_modified"):
        return waves.viscosity(found) / waves.modified(SIGNS[name])
    return float(abs(found / waves.amplitude(SIGNS[name]) - 1.0)) + 1.0  # phase and size


def figures(runs):
    return [("viscosity", peclet_figure(runs), "Effective viscosity over the fluid's against the cell Peclet number, waves along the flow: runs and the scheme's own waves."),
            ("spacing", spacing_figure(runs), "Numerical viscosity across the flow against the spacing.")]


def peclet_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.subplots()
    numbers = np.geomspace(0.5, 200.0, 60)
    own = [run for run in runs if not run.failure and run.variant.startswith(("upwind", "linear", "central")) and "sweep" not in run.variant]
    seen = set()
    for colour, advection in zip(("C3", "C0", "C2"), ("upwind", "linear_upwind", "central")):
        for style, integrator in (("-", "implicit_euler"), ("--", "bdf2")):
            group = [run for run in own if run.scene["fluid"]["advection"] == advection and run.scene["time"]["integrator"] == integrator]
            for courant in sorted({run.scene["time"]["step"] for run in group}):
                same = [run for run in group if run.scene["time"]["step"] == courant]
                curve = []
                for number in numbers:
                    waves = Waves(same[0].scene)
                    waves.nu = waves.mean_speed * waves.h / number
                    curve.append(waves.viscosity(waves.amplitude((1, 1))) / waves.nu)
                first = Waves(same[0].scene)
                label = f"{advection}, {integrator}, Courant {first.mean_speed * courant / first.h:.2g}"
                axes.loglog(numbers, curve, style, color=colour, lw=1, alpha=1.0 if label not in seen else 0.5, label=label)
                axes.loglog([peclet(run) for run in same], [measure("over_fluid", run) for run in same], "o", mfc="none", color=colour, ms=5)
    axes.loglog(numbers, 1.0 + numbers / 2.0, "k:", lw=1, label="1 + Pe/2")
    axes.set(xlabel="cell Peclet number u h/nu [-]", ylabel="effective viscosity over the fluid's [-]")
    axes.legend(fontsize="xx-small")
    return figure


def peclet(run):
    waves = Waves(run.scene)
    return waves.mean_speed * waves.h / waves.nu


def spacing_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.6, 4.0), layout="constrained")
    axes = figure.subplots()
    for colour, name in zip(("C3", "C0"), ("sweep_upwind", "sweep_linear_upwind")):
        own = sorted((run for run in runs if run.variant == name and not run.failure), key=lambda run: run.scene["fluid"]["spacing"])
        h = np.array([run.scene["fluid"]["spacing"] for run in own])
        axes.loglog(h, [measure("numerical", run) for run in own], "o", color=colour, mfc="none", label=name.removeprefix("sweep_"))
        if own:
            waves, fine = Waves(own[0].scene), np.geomspace(h.min(), h.max(), 30)
            law = waves.mean_speed * fine / 2.0 if name == "sweep_upwind" else waves.mean_speed * waves.k**2 * fine**3 / 4.0
            axes.loglog(fine, law, color=colour, lw=1, label="u h/2" if name == "sweep_upwind" else "u k² h³/4")
    axes.set(xlabel="spacing [m]", ylabel="numerical viscosity [m2/s]")
    axes.legend(fontsize="x-small")
    return figure
