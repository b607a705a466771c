"""Water sinks out of a pool into a dry bed that it wets: the law of Green and Ampt, with the bed as the kernel smooths it (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import LAWS  # noqa: E402
from theory.plane_kernel import plane_average  # noqa: E402

UNITS = {"way": "m", "depth": "m"}


def capillary_constant(scene):
    """kappa = 6 gamma cos(theta)/d, Pa."""
    wetting = scene["coupling"].get("wetting", {"law": "none"})
    if wetting["law"] == "none":
        return 0.0
    return 6.0 * wetting["tension"] * math.cos(wetting["contact_angle"]) / scene["grains"]["diameter"]


class Column:
    """The bed and the pool of a scene along z; fields on `z` (m)."""

    def __init__(self, scene, panels=6000):
        fluid, grains, coupling = scene["fluid"], scene["grains"], scene["coupling"]
        self.rho, self.mu, self.d = fluid["density"], fluid["viscosity"], grains["diameter"]
        self.g = -scene["domain"]["gravity"][2]
        self.kappa, self.law = capillary_constant(scene), LAWS[coupling["drag"]]
        self.h = fluid["smoothing"] * fluid["spacing"]
        h_porosity = coupling["porosity_width"]["times_diameter"] * self.d
        pitch, low, high = (grains["arrange"][key] for key in ("spacing", "lower", "upper"))
        self.layers = np.arange(low[2], high[2] + 1e-9, pitch)
        self.top = self.layers[-1] + 0.5 * pitch
        self.per_area, self.volume = 1.0 / pitch**2, math.pi * self.d**3 / 6.0
        self.z = np.linspace(low[2] - 0.5 * pitch, scene["domain"]["size"][2], panels)
        self.dz = self.z[1] - self.z[0]
        self.eps = 1.0 - self.per_area * self.volume * sum(plane_average(self.z - q, h_porosity) for q in self.layers)
        integral = lambda field: np.concatenate([[0.0], np.cumsum(0.5 * (field[1:] + field[:-1]) * self.dz)])
        self.room, self.inertia = integral(self.eps), integral(1.0 / self.eps)
        rows = np.arange(0.5, 1e4) * fluid["spacing"]
        filled = rows[(rows >= fluid["fill"]["lower"][2]) & (rows < fluid["fill"]["upper"][2])]
        self.front = filled[0] - 0.5 * fluid["spacing"]
        self.amount = self.between(self.front, filled[-1] + 0.5 * fluid["spacing"])
        self.tabulate_drag()

    def between(self, a, b):
        """Water per area between two heights, m."""
        return np.interp(b, self.z, self.room) - np.interp(a, self.z, self.room)

    def surface(self, front):
        """Height of the pool's surface, m."""
        return np.interp(np.interp(front, self.z, self.room) + self.amount, self.room, self.z)

    def pressure_lost(self, u_s, front):
        """By drag, Pa: grains gather eps and eps u where there is water, and count as far as water is around them."""
        wet = (self.z >= front).astype(float)
        lost = 0.0
        for q in self.layers:
            weight = plane_average(self.z - q, self.h) * wet * self.dz
            share = np.sum(weight)
            if share < 1e-9:
                continue
            eps = np.sum(weight * self.eps) / share
            slip = eps * np.sum(weight * u_s / self.eps) / share
            force = 3.0 * math.pi * self.mu * self.d * slip * self.law(eps, self.rho * self.d * abs(slip) / self.mu)
            lost += self.per_area * min(share, 1.0) * force * np.sum(weight / share / self.eps)
        return lost

    def tabulate_drag(self):
        """Ergun's law is linear and quadratic in the velocity: both factors, by the front."""
        self.fronts = np.linspace(self.z[0] + 3.0 * self.d, self.top + 2.0 * self.h, 90)
        small, large = 1e-3, 6e-3
        rows = []
        for front in self.fronts:
            a, b = self.pressure_lost(small, front) / small, self.pressure_lost(large, front) / large
            rows.append((a - (b - a) / (large - small) * small, (b - a) / (large - small)))
        self.linear, self.quadratic = np.array(rows).T

    def driving(self, front):
        """Head and capillary pressure, Pa."""
        eps = np.interp(front, self.z, self.eps)
        return self.rho * self.g * (self.surface(front) - front) + self.kappa * (1.0 - eps) / eps

    def rates(self, _t, state):
        u_s, front = state
        eps, top = np.interp(front, self.z, self.eps), self.surface(front)
        drag = (np.interp(front, self.fronts, self.linear) + np.interp(front, self.fronts, self.quadratic) * abs(u_s)) * u_s
        entering = 0.5 * self.rho * u_s * abs(u_s) * (1.0 / eps**2 - 1.0)
        mass = self.rho * (np.interp(top, self.z, self.inertia) - np.interp(front, self.z, self.inertia))
        return [(self.driving(front) - entering - drag) / mass, -u_s / eps]

    def sink(self, times):
        """Heights of the front at times (s), m."""
        run = solve_ivp(self.rates, (0.0, times[-1]), [0.0, self.front], t_eval=times, rtol=1e-7, method="LSODA")
        return run.y[1]

    def rest(self):
        """Height of the front where the bed's edge carries the pool, m."""
        return brentq(self.driving, self.top - 2.0 * self.d, self.top + 2.0 * self.d)


def times_of(scene):
    return np.arange(0.0, scene["time"]["end"] + 1e-9, scene["time"]["output_interval"])


def front_of(run, k, column):
    """Height of the front in snapshot k, m: from where the surface is and how much water there is."""
    fluid, dx = run.snapshot(k)["fluid"], run.scene["fluid"]["spacing"]
    size = run.scene["domain"]["size"]
    row = round(size[0] / dx) ** 2
    upper = np.argsort(fluid["x"][:, 2])[-row:]
    room = np.mean(fluid["mass"][upper] / fluid["rho"][upper]) * row / (size[0] * size[1])
    surface = np.mean(fluid["x"][upper, 2]) + 0.5 * room
    return float(np.interp(np.interp(surface, column.z, column.room) - column.amount, column.room, column.z))


def measure(quantity, run):
    column, last = Column(run.scene), len(run.snapshot_files()) - 1
    if quantity == "way":
        return column.front - front_of(run, last, column)
    if quantity == "depth":
        return column.top - front_of(run, last, column)
    return NotImplemented


def reference(quantity, scene, t):
    column = Column(scene)
    if quantity == "way":
        return float(column.front - column.sink(times_of(scene))[-1])
    return float(column.top - column.rest())


def figures(runs):
    """Depth of the front over time, and the theory."""
    from matplotlib.figure import Figure

    runs = [run for run in runs if run.failure is None]
    if not runs:
        return []
    figure = Figure(figsize=(6.5, 4.2), layout="constrained")
    axes = figure.subplots()
    for run in runs:
        column = Column(run.scene)
        t = times_of(run.scene)
        numbers = range(len(run.snapshot_files()))
        (line,) = axes.plot(t[: len(numbers)], [1e3 * (column.top - front_of(run, k, column)) for k in numbers], "o", ms=3, label=run.variant)
        axes.plot(t, 1e3 * (column.top - column.sink(t)), color=line.get_color(), lw=0.8)
    axes.set(xlabel="time (s)", ylabel="depth of the front in the bed (mm)")
    axes.legend(fontsize=7)
    return [("fronts", figure, "Runs (dots) and theory (lines).")]
