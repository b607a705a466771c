"""Viscosity that a scheme adds to an under-resolved Taylor-Green vortex, and its noise (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory.field_errors import component_norms  # noqa: E402

UNITS = {"numerical_viscosity": "m2/s", "viscosity_ratio": "1", "artificial_ratio": "1", "noise": "1", "velocity_l2": "1"}


class Vortex:
    """initial = {law = "taylor_green", speed = U} on a square, one wavelength to the box."""

    def __init__(self, scene):
        fluid, size = scene["fluid"], scene["domain"]["size"]
        if size[0] != size[1]:
            raise ValueError("the Taylor-Green box is a square")
        self.fluid, self.speed = fluid, fluid["initial"]["speed"]
        self.k = 2.0 * math.pi / size[0]
        self.nu = fluid["viscosity"] / fluid["density"]
        self.rate = 2.0 * self.nu * self.k**2

    def velocity(self, x, t=0.0):
        """[n, 2], m/s."""
        a, b = self.k * x[:, 0], self.k * x[:, 1]
        u = np.stack([-np.cos(a) * np.sin(b), np.sin(a) * np.cos(b)], axis=1)
        return self.speed * math.exp(-self.rate * t) * u

    def artificial_viscosity(self):
        """nu of the artificial term in the plane, alpha c h/8 for all pairs and half of it for approaching ones: README, (2)."""
        h = self.fluid["smoothing"] * self.fluid["spacing"]
        return self.fluid.get("artificial_viscosity", 0.0) * self.fluid["sound_speed"] * h / 16.0


def vortex_amplitude(vortex, x, v):
    """Projection of velocities on the vortex, over U: what is left of it, noise of other shapes left aside."""
    shape = vortex.velocity(x) / vortex.speed
    return float((v * shape).sum() / (shape**2).sum()) / vortex.speed


def effective_viscosity(run):
    """nu that would damp the vortex as the run did, m2/s: amplitude exp(-2 nu k^2 t)."""
    vortex, last = Vortex(run.scene), run.snapshot(-1)
    left = vortex_amplitude(vortex, last["fluid"]["x"][:, :2], last["fluid"]["v"][:, :2])
    return -math.log(max(left, 1e-6)) / (2.0 * vortex.k**2 * last["time"])


def rest_of(vortex, fluid):
    """(root mean square of what is no vortex, the worse component; amplitude of the vortex), both over U."""
    x, v = fluid["x"][:, :2], fluid["v"][:, :2]
    left = vortex_amplitude(vortex, x, v)
    return float(component_norms(v, left * vortex.velocity(x), vortex.speed)["l2"].max()), left


def measure(quantity, run):
    vortex, last = Vortex(run.scene), run.snapshot(-1)
    if quantity == "numerical_viscosity":
        return effective_viscosity(run) - vortex.nu
    if quantity == "viscosity_ratio":
        return effective_viscosity(run) / vortex.nu
    if quantity == "artificial_ratio":
        return effective_viscosity(run) / (vortex.nu + vortex.artificial_viscosity())
    if quantity == "noise":
        return rest_of(vortex, last["fluid"])[0]
    if quantity == "velocity_l2":
        x, v = last["fluid"]["x"][:, :2], last["fluid"]["v"][:, :2]
        return float(component_norms(v, vortex.velocity(x, last["time"]), vortex.speed)["l2"].max())
    return NotImplemented


def reference(quantity, scene, t):
    if quantity in ("numerical_viscosity", "noise", "velocity_l2"):
        return 0.0
    if quantity in ("viscosity_ratio", "artificial_ratio"):
        return 1.0
    if quantity == "kinetic_energy":
        vortex = Vortex(scene)
        return 0.25 * vortex.speed**2 * np.exp(-2.0 * vortex.rate * np.asarray(t, float))
    raise KeyError(quantity)


def figures(runs):
    return [("particles", _particles(runs), "Particles at the end, coloured by their speed."),
            ("viscosity", _viscosity(runs), "Viscosity that the vortex feels, over the fluid's own.")]


def _particles(runs):
    from matplotlib.figure import Figure

    chosen = [run for run in runs if run.scene["fluid"]["spacing"] == 0.02]
    columns = math.ceil(len(chosen) / 2)
    figure = Figure(figsize=(2.7 * columns, 5.8), layout="constrained")
    panels = figure.subplots(2, columns, squeeze=False).ravel()
    for axes in panels[len(chosen):]:
        axes.remove()
    for axes, run in zip(panels, chosen):
        fluid = run.snapshot(-1)["fluid"]
        x = np.mod(fluid["x"][:, :2], run.scene["domain"]["size"])
        points = axes.scatter(x[:, 0], x[:, 1], c=np.linalg.norm(fluid["v"], axis=1), s=2, cmap="viridis", vmin=0.0, vmax=1.0)
        axes.set(xlim=(0, 1), ylim=(0, 1), aspect="equal", title=run.variant, xticks=[], yticks=[])
        axes.grid(False)
    figure.colorbar(points, ax=figure.axes, label="speed (m/s)", shrink=0.7)
    return figure


def _viscosity(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 3.6), layout="constrained")
    axes = figure.subplots()
    for number, variant in enumerate(sorted({run.variant for run in runs})):
        chosen = [run for run in runs if run.variant == variant]
        axes.loglog([run.scene["fluid"]["spacing"] for run in chosen],
                    [max(measure("viscosity_ratio", run), 1e-2) for run in chosen], "o", color=f"C{number}", label=variant)
    axes.axhline(1.0, color="black", linestyle="--", linewidth=1.0)
    axes.set(xlabel="spacing (m)", ylabel="effective over physical viscosity (-)")
    axes.legend()
    return figure
