"""A bed of grains in a cell full of water, hit by a jet from below: what a run shows (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import LAWS  # noqa: E402
from theory import dispersion_cell  # noqa: E402
from theory.bed_on_floor import part_below  # noqa: E402
from theory.dispersion_cell import G, area, beyond_walls, cell_of, grain_volume, grains_lost, mass_in, settled, times  # noqa: E402

OPEN = 0.75  # porosity above which the axis counts as cavity: half way from a settled bed to clear water
NEAR_AXIS = 1.5  # spacings around the axis
CORE = 1.0 / 3.0  # of the cell's radius: a ninth of its area
UNITS = {
    "porosity": "1",
    "carried": "1",
    "water_missed": "1",
    "beyond_walls": "1",
    "grains_lost": "1",
    "height": "m",
    "cavity": "m",
    "swing": "m",
    "top": "m",
    "core_flow": "1",
    "raised": "1",
    "height_change": "1",
}


# --- the scene ---


def jet_start(scene):
    opens = scene["inlet"][0]["opens"]
    return opens["from"] + opens["over"]


def weight(scene):
    """Of all grains in water, over the cell's area, Pa."""
    return dispersion_cell.weight(scene, scene["fluid"]["density"])


def jet_reynolds(scene):
    """On the bore's diameter and mean speed."""
    bore = next(w["radius"] for w in scene["wall"] if w["shape"] == "bored_plane")
    fluid = scene["fluid"]
    return 2.0 * scene["inlet"][0]["flow_rate"] / (math.pi * bore) * fluid["density"] / fluid["viscosity"]


def expanded_height(scene):
    """Mean height of the grains of a uniform bed that the flow carries, m: drag law = weight; none below minimum fluidisation."""
    grains, fluid = scene["grains"], scene["fluid"]
    d, mu, rho = grains["diameter"], fluid["viscosity"], fluid["density"]
    u = scene["inlet"][0]["flow_rate"] / area(scene)
    law = LAWS[scene["coupling"]["drag"]]
    lift = lambda eps: 3.0 * math.pi * mu * d * u * law(eps, rho * d * u / mu) / eps - (grains["density"] - rho) * G * grain_volume(scene)
    if lift(0.38) < 0.0:
        return None
    eps = brentq(lift, 0.38, 0.999)
    return 0.5 * grains["arrange"]["count"] * grain_volume(scene) / ((1.0 - eps) * area(scene))


# --- a run ---


def late(run):
    """Numbers of the snapshots of the last half of the time with the full jet."""
    t, start = times(run), jet_start(run.scene)
    return np.nonzero(t >= start + 0.5 * (t[-1] - start))[0]


def porosity(run):
    """Of the settled bed, two diameters off its floor and top and one off the wall."""
    scene, d = run.scene, run.scene["grains"]["diameter"]
    axis, radius, _ = cell_of(scene)
    x = run.snapshot(settled(run))["grains"]["x"]
    low, high = 2.0 * d, np.quantile(x[:, 2], 0.95) - 2.0 * d
    r, inner = np.hypot(*(x[:, :2] - axis).T), radius - 2.0 * d
    inside = r < inner  # spheres that the cylinder cuts: as many stick out as in
    volume = np.sum(part_below(x[inside, 2], d, high) - part_below(x[inside, 2], d, low)) * grain_volume(scene)
    return 1.0 - volume / (math.pi * inner**2 * (high - low))


def floor_pressure(run, k):
    """Mean pressure on the floor away from the jet, less that below the outlet, Pa: continued from the two lowest slices of a spacing."""
    scene, fluid = run.scene, run.snapshot(k)["fluid"]
    axis, radius, height = cell_of(scene)
    dx, x, p = scene["fluid"]["spacing"], fluid["x"], fluid["p"]
    volume = fluid["mass"] / fluid["rho"]
    away = np.hypot(*(x[:, :2] - axis).T) > 0.4 * radius

    def mean(low, high):
        there = away & (x[:, 2] >= low) & (x[:, 2] < high)
        return np.sum((p * volume)[there]) / np.sum(volume[there])

    first, second = mean(0.0, dx), mean(dx, 2.0 * dx)
    return first + 0.5 * (first - second) - mean(height - 3.0 * dx, height)


def carried(run):
    """Pressure under the bed over its weight, mean of the last half of the jet's time."""
    return float(np.mean([floor_pressure(run, k) for k in late(run)])) / weight(run.scene)


def water_missed(run):
    """Greatest change of the mass of water in the cell, relative."""
    mass = over_time(run, mass_in)
    return float(np.max(np.abs(mass / mass[0] - 1.0)))


def cavity_height(run, k):
    """To where the axis is open from the bore on, m."""
    scene, fluid = run.scene, run.snapshot(k)["fluid"]
    axis, _, height = cell_of(scene)
    dx, x = scene["fluid"]["spacing"], fluid["x"]
    near = np.hypot(*(x[:, :2] - axis).T) < NEAR_AXIS * dx
    edges = np.arange(0.0, height + 0.5 * dx, dx)
    sums, counts = (np.histogram(x[near, 2], edges, weights=w)[0] for w in (fluid["eps"][near], np.ones(np.sum(near))))
    closed = (counts > 0) & (sums < OPEN * counts)
    return float(edges[np.argmax(closed)]) if closed.any() else height


def bed_top(run, k):
    """Height that 95 % of the grains are below, m."""
    return float(np.quantile(run.snapshot(k)["grains"]["x"][:, 2], 0.95))


def over_time(run, of):
    return np.array([of(run, k) for k in range(len(run.snapshot_files()))])


def late_mean(run, of):
    return float(np.mean([of(run, k) for k in late(run)]))


def mean_height(run, k):
    return float(np.mean(run.snapshot(k)["grains"]["x"][:, 2]))


def core_flow(run):
    """Part of the water through the bed's top (a diameter up and down) that goes through the inner third of the radius; 1/9 where it is even."""
    scene, d = run.scene, run.scene["grains"]["diameter"]
    axis, radius, _ = cell_of(scene)
    core = whole = 0.0
    for k in late(run):
        fluid, top = run.snapshot(k)["fluid"], bed_top(run, k)
        there = np.abs(fluid["x"][:, 2] - top) < d
        momentum = (fluid["mass"] * fluid["v"][:, 2])[there]
        core += np.sum(momentum[np.hypot(*(fluid["x"][there, :2] - axis).T) < CORE * radius])
        whole += np.sum(momentum)
    return float(core / whole)


def raised(run):
    """Of the grains' mean height by the jet, over that of the settled bed."""
    return late_mean(run, mean_height) / mean_height(run, settled(run)) - 1.0


def regime(run):
    """`packed`: the bed lies; `breakthrough`: more than half of the water leaves it through a ninth of its top; `impregnation`: it is lifted and the jet stays within."""
    if len(late(run)) == 0:
        return "no jet yet"
    if raised(run) < 0.02:
        return "packed"
    return "breakthrough" if core_flow(run) > 0.5 else "impregnation"


def measure(quantity, run):
    of_run = {
        "porosity": porosity,
        "carried": carried,
        "water_missed": water_missed,
        "beyond_walls": lambda run: beyond_walls(run, ceiling=True),
        "grains_lost": grains_lost,
        "core_flow": core_flow,
        "raised": raised,
        "height_change": lambda run: late_mean(run, mean_height) / late_mean(run.other("seeds_22"), mean_height) - 1.0,
        "height": lambda run: late_mean(run, mean_height),
        "cavity": lambda run: late_mean(run, cavity_height),
        "top": lambda run: late_mean(run, bed_top),
        "swing": lambda run: float(np.std([mean_height(run, k) for k in late(run)])),
    }.get(quantity)
    return of_run(run) if of_run else NotImplemented


def reference(quantity, scene, t):
    return {"carried": 1.0}.get(quantity, 0.0)


def figures(runs):
    """Heights and pressure over time, and the run as pictures."""
    from matplotlib.figure import Figure
    from plumb_reports import film

    runs = [run for run in runs if run.failure is None]
    if not runs:
        return []
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for run in runs:
        t = times(run)
        (line,) = left.plot(t, 1e3 * over_time(run, mean_height), label=f"{run.variant}: grains ({regime(run)})")
        left.plot(t, 1e3 * over_time(run, cavity_height), color=line.get_color(), ls=":")
        left.plot(t, 1e3 * over_time(run, bed_top), color=line.get_color(), ls="--")
        right.plot(t, over_time(run, floor_pressure) / weight(run.scene), color=line.get_color())
        expanded = expanded_height(run.scene)
        if expanded is not None:
            left.axhline(1e3 * expanded, color=line.get_color(), lw=0.5)
    left.set(xlabel="time (s)", ylabel="height (mm)")
    left.legend(fontsize=7)
    right.set(xlabel="time (s)", ylabel="pressure under the bed over its weight")
    shown = [("heights", figure, "Mean height of the grains, their top (dashed), the cavity (dotted), a uniform bed that the flow carries (thin); pressure under the bed.")]
    for run in runs:
        numbers = np.unique(np.linspace(0, len(run.snapshot_files()) - 1, 6).astype(int))
        shown.append((f"sequence_{run.variant}", film.sequence(run, numbers), f"{run.variant}: grains that the middle plane cuts, and the water beside it."))
    return shown
