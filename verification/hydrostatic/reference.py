"""A column at rest under gravity: compressible (Tait) and incompressible profiles (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import tait  # noqa: E402

UNITS = {
    "bottom_pressure": "Pa",
    "bottom_density": "kg/m3",
    "height": "m",
    "mass": "kg",
    "pressure_error": "1",
    "surface_error": "1",
    "pressure_drift": "1",
    "speed": "1",
    "height_drift": "1",
    "energy_growth": "1",
    "period": "s",
}


class Column:
    """fill = {law = "box", ...}: fluid of density rho_0 filled to the height H over the floor, then left to its own weight.

    Along the axis of gravity; the sides of the box give the base (size of the other axes; 1 m along z for a plane scene).
    """

    def __init__(self, scene):
        fluid, gravity = scene["fluid"], scene["domain"]["gravity"]
        self.axis = int(np.argmax(np.abs(gravity)))
        self.g = abs(gravity[self.axis])
        self.filled = fluid["fill"]["upper"][self.axis] - fluid["fill"]["lower"][self.axis]
        self.floor = fluid["fill"]["lower"][self.axis]
        self.rho, self.c = fluid["density"], fluid["sound_speed"]
        sides = [s for n, s in enumerate(scene["domain"]["size"]) if n != self.axis and s > 0.0]
        self.base = math.prod(sides)
        self.mass = self.rho * self.filled * self.base
        self.bottom_pressure = self.rho * self.g * self.filled  # weight over base, whatever the equation of state
        self.height = self.depth_of_pressure(self.bottom_pressure)

    def density(self, depth):
        """rho, kg/m3, at a depth below the surface, m: c^2/(gamma-1) [(rho/rho_0)^(gamma-1) - 1] = g depth."""
        exponent = tait.GAMMA - 1.0
        return self.rho * np.exp(np.log1p(exponent * self.g * np.asarray(depth, float) / self.c**2) / exponent)

    def pressure(self, depth):
        """p, Pa, at a depth below the surface."""
        return tait.pressure(self.density(depth), self.rho, self.c)

    def incompressible_pressure(self, depth):
        return self.rho * self.g * np.asarray(depth, float)

    def carried(self, weight):
        """p, Pa, that carries the weight above, Pa, between particles that lie as they were filled in (README, equation 2)."""
        p = np.asarray(weight, float)
        for _ in range(50):  # each round gains a factor 2 p/(rho_0 c^2)
            p = weight * (tait.density(p, self.rho, self.c) / self.rho) ** 2
        return p

    def depth_of_pressure(self, p):
        """Depth, m, at which the pressure is p: the inverse of `pressure`."""
        return tait.enthalpy(tait.density(p, self.rho, self.c), self.rho, self.c) / self.g

    def settled(self, z):
        """Height at rest, m, of the fluid that lay at height z of the uniform column: what is above weighs the same."""
        above = self.rho * self.g * (self.filled - np.asarray(z, float))
        return self.height - self.depth_of_pressure(above)

    def periods(self, count=3):
        """Periods, s, of the first standing sound waves of the column (closed below, p = 0 above), uniform c: 4H/((2n+1) c)."""
        return 4.0 * self.filled / ((2.0 * np.arange(count) + 1.0) * self.c)


def pressure_error(column, height, p):
    """(relative L2 error, bias) of pressures p [n] at heights [n], m, above the floor; over the bottom pressure."""
    exact = column.pressure(column.height - np.minimum(np.asarray(height, float), column.height))
    error = (np.asarray(p, float) - exact) / column.bottom_pressure
    return float(np.sqrt(np.mean(error**2))), float(np.mean(error))


def errors_at(column, run, k):
    """(relative L2 error, bias) of the k-th snapshot's pressures against the exact ones at the particles' own heights."""
    fluid = run.snapshot(k)["fluid"]
    return pressure_error(column, fluid["x"][:, column.axis] - column.floor, fluid["p"])


def surface_error(column, run):
    """Root mean square of the last pressures less what the lattice of the start carries, over rho g H, of the particles that
    were filled in within the kernel's reach of the surface."""
    fluid, first = run.snapshot(-1)["fluid"], run.snapshot(0)["fluid"]
    filled = dict(zip(first["id"], first["x"][:, column.axis]))
    height = np.array([filled[number] for number in fluid["id"]]) - column.floor
    depth, settings = column.filled - height, run.scene["fluid"]
    carried = column.carried(column.rho * column.g * depth)
    near = depth < 2.0 * settings["smoothing"] * settings["spacing"]
    return float(np.sqrt(np.mean((fluid["p"] - carried)[near] ** 2)) / column.bottom_pressure)


def pressure_drift(column, run):
    """Change of the mean error of the pressure from half time to the end, over rho g H."""
    return errors_at(column, run, -1)[1] - errors_at(column, run, len(run.snapshot_files()) // 2)[1]


def bottom_pressure(column, run):
    """Pressure on the floor, Pa: of the lowest layer, and the weight of half a spacing."""
    fluid, spacing = run.snapshot(-1)["fluid"], run.scene["fluid"]["spacing"]
    height = fluid["x"][:, column.axis] - column.floor
    lowest = height < spacing
    return float(np.mean(fluid["p"][lowest] + column.rho * column.g * height[lowest]))


def top(column, run, k):
    """Mean height, m, of the particles of the k-th snapshot that were the top layer at first."""
    first, now = run.snapshot(0)["fluid"], run.snapshot(k)["fluid"]
    layer = first["x"][:, column.axis] > first["x"][:, column.axis].max() - 0.5 * run.scene["fluid"]["spacing"]
    return float(np.mean(now["x"][np.isin(now["id"], first["id"][layer]), column.axis]))


def height_drift(column, run):
    """Change of the top layer's height from half time to the end, over H."""
    count = len(run.snapshot_files())
    return (top(column, run, -1) - top(column, run, count // 2)) / column.filled


def energy_growth(run):
    """Mean kinetic energy of the last quarter of the run over that of the second."""
    t, energy = run.series("kinetic_energy")
    end = t[-1]
    return float(energy[t > 0.75 * end].mean() / energy[(t > 0.25 * end) & (t <= 0.5 * end)].mean())


def reference(quantity, scene, t):
    column = Column(scene)
    if quantity in ("bottom_pressure", "height", "mass"):
        return getattr(column, quantity)
    if quantity == "bottom_density":
        return float(column.density(column.height))
    if quantity == "period":
        return float(column.periods(1)[0])
    if quantity == "speed":
        return np.zeros_like(np.asarray(t, float))
    if quantity in ("pressure_error", "surface_error", "pressure_drift", "height_drift"):
        return 0.0
    raise KeyError(quantity)


def measure(quantity, run):
    column = Column(run.scene)
    if quantity == "pressure_error":
        return errors_at(column, run, -1)[0]
    if quantity == "surface_error":
        return surface_error(column, run)
    if quantity == "pressure_drift":
        return pressure_drift(column, run)
    if quantity == "bottom_pressure":
        return bottom_pressure(column, run)
    if quantity == "speed":
        t, speed = run.series("greatest_speed")
        return t, speed / math.sqrt(column.g * column.filled)
    if quantity == "height_drift":
        return height_drift(column, run)
    if quantity == "energy_growth":
        return energy_growth(run)
    return NotImplemented


def figures(runs):
    """Error of the pressure over the height, and the greatest speed over time."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.4), layout="constrained")
    profile, speed = figure.subplots(1, 2)
    good = [run for run in runs if not run.failure]
    names = list(dict.fromkeys(run.variant for run in good))
    for run in good:
        number = names.index(run.variant)
        colour, dash = f"C{number % 10}", "--" if number >= 10 else "-"
        width = 0.03 / run.scene["fluid"]["spacing"]  # finer spacings are drawn wider
        column, fluid = Column(run.scene), run.snapshot(-1)["fluid"]
        label = f"{run.variant}, H/spacing = {column.filled / run.scene['fluid']['spacing']:.0f}"
        height = fluid["x"][:, column.axis] - column.floor
        layer = np.floor(height / run.scene["fluid"]["spacing"]).astype(int)
        error = (fluid["p"] - column.pressure(column.height - np.minimum(height, column.height))) / column.bottom_pressure
        layers = np.unique(layer)
        mean = lambda values: [np.mean(values[layer == n]) for n in layers]  # noqa: E731
        profile.plot(100.0 * np.array(mean(error)), np.array(mean(height)) / column.filled, dash, color=colour, lw=width, label=label)
        t, v = run.series("greatest_speed")
        speed.semilogy(t[1:], v[1:] / math.sqrt(column.g * column.filled), dash, color=colour, lw=0.8)
    profile.set_xlabel("error of the pressure [% of rho g H]")
    profile.set_ylabel("height/H")
    speed.legend(*profile.get_legend_handles_labels(), fontsize="x-small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    speed.set_xlabel("t sqrt(g/H)")
    speed.set_ylabel("greatest speed/sqrt(g H)")
    return [("column", figure, "Mean error of the pressure of each layer at the end (left); greatest speed of any particle (right).")]
