"""Mordant and Pinton's spheres in a fluid on a grid that they push: linear theory of the scheme, measurement, the law alone (README.md)."""

import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import verification_case  # noqa: E402
from drag_laws.drag_laws import ONE_SPHERE  # noqa: E402
from theory import grid_fall, released_sphere  # noqa: E402

PRESCRIBED = verification_case.case("mordant_pinton")  # the measurement, its uncertainty, the published column
MEASURED, PUBLISHED, NAMES = PRESCRIBED.MEASURED, PRESCRIBED.PUBLISHED, PRESCRIBED.NAMES
FORCES = ("buoyancy", "pressure_gradient", "virtual_mass")  # of the case, which a twin may break, as its direction and its kernel
LAW = ONE_SPHERE["morsi_alexander"]
SHARE, FLOOR = 0.10, 0.002  # of the grain's own wake, of the terminal speed: the larger of both is the bound
UNITS = {"off_theory": "1", "excess": "1", "terminal": "m/s", "time_95": "s", "published": "m/s", "speed": "m/s"}


def row_of(scene):
    """The sphere's row in the measurement."""
    grain = scene["grains"]
    return int(np.argmin(np.hypot(MEASURED["d"] / grain["diameter"] - 1.0, MEASURED["rho_p"] / grain["density"] - 1.0)))


def sphere(scene):
    grain, fluid = scene["grains"], scene["fluid"]
    return released_sphere.Sphere(LAW, grain["density"], grain["diameter"], fluid["density"], fluid["viscosity"])


@lru_cache(maxsize=None)
def fall(one, size, cell, start, times):
    """With kernels one cell wide, as this case means them."""
    return grid_fall.two_way(one, grid_fall.Box(size, cell, cell), FORCES, np.array(times), start)


def theory(scene, t):
    start = -scene["grains"]["velocity"][2]
    return fall(sphere(scene), tuple(scene["domain"]["size"]), scene["fluid"]["spacing"], start, tuple(np.asarray(t, float)))


@lru_cache(maxsize=None)
def law_alone(one, start, times):
    """v [nt], m/s, in fluid at rest, by the drag law, buoyancy and virtual mass."""
    if start == 0.0:
        return released_sphere.speed_without_history(one, np.array(times), True)
    return np.full(len(times), start)  # starts at its terminal speed


def by_law(scene, t):
    return law_alone(sphere(scene), -scene["grains"]["velocity"][2], tuple(np.asarray(t, float)))


def speed(run):
    """(t, v), v downwards."""
    t, v = run.series("velocity")
    return t, -np.ravel(v)


# --- the judge's interface ---


def measure(quantity, run):
    t, v = speed(run)
    if quantity == "speed":
        return t, v
    if quantity in ("terminal", "published"):
        return t[-1:], v[-1:]
    if quantity == "time_95":
        return released_sphere.time_to_share(t, v)
    u_t = sphere(run.scene).terminal_speed()
    if quantity == "excess":
        return float(v[-1] - by_law(run.scene, t)[-1]) / u_t
    expected = theory(run.scene, t)
    return float(np.max(np.abs(v - expected.v))) / max(SHARE * float(np.max(np.abs(expected.u))), FLOOR * u_t)


def reference(quantity, scene, t):
    row = row_of(scene)
    if quantity == "speed":
        return by_law(scene, t)
    if quantity == "terminal":
        return {"value": MEASURED["u_t"][row], "uncertainty": PRESCRIBED.uncertainty(row)}
    if quantity == "published":
        return PUBLISHED[row]
    if quantity == "time_95":
        return MEASURED["time_95"][row]
    if quantity == "excess":
        end = np.linspace(0.0, scene["time"]["end"], 101)
        return float(theory(scene, end).v[-1] - by_law(scene, end)[-1]) / sphere(scene).terminal_speed()
    return 0.0


# --- the page ---


def in_u(row, v):
    return (v - MEASURED["u_t"][row]) / PRESCRIBED.uncertainty(row)


def table_row(run):
    row, (t, v) = row_of(run.scene), speed(run)
    law = sphere(run.scene).terminal_speed()
    expected = theory(run.scene, t)
    cells = "one-way" if run.scene["coupling"]["direction"] == "one_way" else f"{run.scene['fluid']['spacing'] / run.scene['grains']['diameter']:g} d"
    adds = ["", ""] if cells == "one-way" else [f"{100 * (v[-1] / law - 1.0):+.2f} %", f"{100 * (expected.v[-1] / law - 1.0):+.2f} %"]
    timed = run.scene["grains"]["velocity"][2] == 0.0
    when = f"{released_sphere.time_to_share(t, v):.3f} ({MEASURED['time_95'][row]:.3f})" if timed else ""
    return [NAMES[row], run.variant, cells, f"{v[-1]:.4f}", f"{MEASURED['u_t'][row]:g}", f"{in_u(row, v[-1]):+.1f} u", f"{100 * (v[-1] / MEASURED['u_t'][row] - 1.0):+.1f} %",
            *adds, f"{PUBLISHED[row]:.3f}", f"{100 * (v[-1] / PUBLISHED[row] - 1.0):+.1f} %", when]


def table(runs):
    return {
        "columns": ["sphere", "run", "cells, kernel", "speed, m/s", "measured", "off, uncertainties", "off", "two-way adds", "by theory", "published simulation", "off it", "95 % time, s (measured)"],
        "rows": [table_row(run) for run in sorted(runs, key=lambda run: row_of(run.scene))],
        "caption": "Morsi and Alexander's law. What two-way coupling adds is the last speed over the law's own terminal speed; by theory: linear theory of "
        "the scheme. Published is another group's simulation, not truth.",
    }


def figures(runs):
    return [added_figure(runs), transient_figure(runs)]


def added_figure(runs):
    """The speed over the law's terminal speed, theory and runs, for each sphere."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 6.4), layout="constrained")
    panels = figure.subplots(2, 3)
    panels[1, 2].set_axis_off()
    for row, axes in enumerate(panels.ravel()[:5]):
        for run in runs:
            if row_of(run.scene) != row or run.scene["coupling"]["direction"] == "one_way" or run.variant.endswith("20C"):
                continue
            t, v = speed(run)
            u_t, width = sphere(run.scene).terminal_speed(), run.scene["fluid"]["spacing"] / run.scene["grains"]["diameter"]
            colour = {1: "C3", 2: "C1", 4: "C0"}[round(width)]
            law = by_law(run.scene, t)
            axes.plot(t, 100.0 * (v - law) / u_t, colour, label=f"kernel and cells {width:g} d")
            axes.plot(t, 100.0 * (theory(run.scene, t).v - law) / u_t, colour, ls="--")
        axes.axhline(0.0, color="0.5", lw=0.8)
        axes.set(title=NAMES[row], xlabel="time [s]", ylabel="speed over the law's [% of $u_t$]")
    panels[0, 0].legend(fontsize="small")
    caption = "What two-way coupling adds to the speed under the drag law alone. Lines: runs; dashed: linear theory of the scheme."
    return "added", figure, caption


def transient_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    for row, axes in enumerate(figure.subplots(1, 2)):
        for run in runs:
            if row_of(run.scene) == row and not run.variant.endswith("20C"):
                axes.plot(*speed(run), label=run.variant)
        axes.errorbar(MEASURED["time_95"][row], 0.95 * MEASURED["u_t"][row], yerr=0.95 * PRESCRIBED.uncertainty(row), fmt="o", color="0.3", label="measured 95 % time")
        axes.set(xlabel="time [s]", ylabel="speed [m/s]", title=NAMES[row])
        axes.legend(fontsize="small")
    return "transients", figure, "The two glass spheres from rest: no run has the history force that the measured transient shows."
