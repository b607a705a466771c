"""The clean channel's pressure by the paper, by unit-cell theory row by row, and by Richardson's limit of the runs (README.md)."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import clean_channel  # noqa: E402
from theory.clean_channel import DEPTH, MEAN, REFERENCE_PRESSURE, Array  # noqa: E402

UNITS = {"pressure": "Pa", "limit": "Pa", "ratio_limit": "1", "interval": "1", "order": "1", "creeping_drop": "Pa", "mass": "1", "drift": "1",
         "over_half": "1", "width_ratio": "1", "excess": "1"}
BASE = "channel_12_3"


def rows_wall(scene):
    return next(wall for wall in scene["wall"] if wall["shape"] == "cylinder_rows")


def cylinders(scene):
    """How many a full row of the whole channel has: those with the diameter of 12 or of 16."""
    wall = rows_wall(scene)
    return round(clean_channel.WIDTH / ((wall["upper"][0] - wall["lower"][0]) / wall["per_row"]))


def flow(scene):
    """m3/s, that the inlet brings through the scene's width."""
    profile = scene["inlet"][0]["profile"]
    speed = profile["speed"] if profile["law"] == "uniform" else profile["mean_speed"]
    return speed * scene["domain"]["size"][0] * DEPTH


def reference(quantity, scene, t):
    if quantity in ("interval", "mass", "drift"):
        return 0.0
    if quantity == "creeping_drop" or (quantity == "limit" and scene["fluid"]["advection"] == "none"):
        return clean_channel.creeping_drop(Array(12))
    if quantity == "width_ratio":
        return clean_channel.creeping_drop(Array(12, clean_channel.CHANNEL)) / clean_channel.creeping_drop(Array(12))
    if quantity in ("limit", "pressure"):
        return REFERENCE_PRESSURE
    if quantity == "ratio_limit":
        return clean_channel.clean_pressure_ratio().value
    raise KeyError(quantity)


def last(run, probe):
    return float(np.ravel(run.series(probe)[1])[-1])


def pressure(run):
    """At the top of the channel, the greatest there is, Pa."""
    return last(run, "pressure")


def spacing(run):
    """Along the flow, m."""
    return float(np.ravel(run.scene["fluid"]["spacing"])[-1])


def family(run):
    """The runs that differ from this one in their cells only, coarse to fine."""
    name = run.variant.rsplit("_", 1)[0]
    same = [one for one in run.judged_with if one.variant.rsplit("_", 1)[0] == name and one.failure is None]
    return sorted(same, key=lambda one: -spacing(one))


def extrapolated(run):
    """Richardson's limit of the pressure over the run's family."""
    runs = family(run)
    return clean_channel.richardson([spacing(one) for one in runs], [pressure(one) for one in runs])


def limit_of(run, name):
    """The same of the family with a member `name`."""
    return extrapolated(run.other(name))


def over_base(run):
    """Pressure over that of the channel of three cells to a throat; the whole channel has its half's."""
    return pressure(run) / pressure(run.other(BASE))


def measure(quantity, run):
    known = {
        "pressure": pressure,
        "creeping_drop": pressure,
        "limit": lambda r: extrapolated(r).value,
        "interval": lambda r: extrapolated(r).half / extrapolated(r).value,
        "order": lambda r: extrapolated(r).order,
        "ratio_limit": lambda r: extrapolated(r).value / limit_of(r, "column_12_24").value,
        "mass": lambda r: max(abs(last(r, name) / last(r, "flow_in") - 1.0) for name in ("flow_throat", "flow_out")),
        "drift": lambda r: float(np.ravel(r.series("pressure")[1])[-1] / np.ravel(r.series("pressure")[1])[-2] - 1.0),
        "over_half": over_base,
        "width_ratio": over_base,
        "excess": lambda r: pressure(r) / limit_of(r, "column_12_24").value - 1.0,
    }
    return known[quantity](run) if quantity in known else NotImplemented


def table(runs):
    """Every run: pressure, permeability by the paper's equation (5), and its distance from the limit of its family."""
    rows = []
    for run in (run for run in runs if run.failure is None):
        drop = last(run, "above") - last(run, "below")
        rows.append([run.variant, f"{run.info['updates'] / run.info['steps']:.0f}", f"{1e-3 * pressure(run):.3f}", f"{1e-3 * drop:.3f}",
                     f"{1e9 * clean_channel.darcy(drop):.3f}", distance(run), f"{run.info['cpu_s']:.1f}"])
    theory = [clean_channel.creeping_drop(Array(n), law) for n, law in ((12, "exact"), (12, "gebart"), (16, "exact"), (16, "gebart"))]
    names = ["unit cells, creeping, 12", "Gebart, creeping, 12", "unit cells, creeping, 16", "Gebart, creeping, 16"]
    rows += [[name, "", "", f"{1e-3 * drop:.3f}", f"{1e9 * clean_channel.darcy(drop):.3f}", "", ""] for name, drop in zip(names, theory)]
    rows += limits(runs)
    columns = ["variant", "cells", "pressure (kPa)", "drop 250 to 150 mm (kPa)", "K by (5), 1e-9 m2", "from the limit (%)", "CPU (s)"]
    return {"columns": columns, "rows": rows, "caption": CAPTION}


def distance(run):
    """Of the pressure from the limit of column_12 or of the run's own family, per cent; empty where there is none."""
    names = {one.variant for one in run.judged_with}
    if run.variant.startswith("upwind") and "column_12_24" in names:
        return f"{100.0 * measure('excess', run):+.2f}"
    return f"{100.0 * (pressure(run) / extrapolated(run).value - 1.0):+.2f}" if len(family(run)) > 2 else ""


def limits(runs):
    """A row for every family of three and more."""
    rows, done = [], set()
    for run in (run for run in runs if run.failure is None):
        name = run.variant.rsplit("_", 1)[0]
        if name not in done and len(family(run)) > 2:
            found = extrapolated(run)
            rows.append([f"{name}: limit, order {found.order:.2f}", "", f"{1e-3 * found.value:.3f} +- {1e-3 * found.half:.3f}", "", "", "", ""])
            done.add(name)
    return rows


CAPTION = (f"Pressure at the top; the paper has {1e-3 * REFERENCE_PRESSURE:.1f} kPa for 12 cylinders a row. K by the paper's equation (5) with {MEAN:g} m/s. "
           "OpenFOAM needed 10 CPU seconds for 96 thousand cells of the same channel and 102 for 385 thousand.")


def figures(runs):
    """Speed and pressure of the finest whole channel of each array (Figure 3), and the pressure against the spacing."""
    runs = [run for run in runs if run.failure is None]
    channels = {cylinders(run.scene): run for run in sorted(runs, key=lambda one: -spacing(one)) if run.variant.startswith("channel_")}
    drawn = []
    if channels:
        drawn.append(("fields", fields_figure(list(channels.values())), "Speed and pressure in the channel's left half, as in the paper's Figure 3: 12 and 16 cylinders a row."))
    drawn.append(("convergence", convergence_figure(runs), "Pressure over the cells to a throat; crosses are Richardson's limits, the line is the paper's 17.8 kPa."))
    return drawn


def plane(run, lower=0.14, upper=0.26):
    """(x nodes, y nodes, speed, pressure) of the cells between two heights, mm, m/s and kPa; NaN in the cylinders."""
    shot = run.snapshot(-1)
    x, y = shot["grid"]["nodes_x"], shot["grid"]["nodes_y"]
    fluid = shot["fluid"]
    speed, p = np.full((len(y) - 1, len(x) - 1), np.nan), np.full((len(y) - 1, len(x) - 1), np.nan)
    open_ = fluid["open"] > 0.5
    i, j = np.searchsorted(x, fluid["x"][open_, 0]) - 1, np.searchsorted(y, fluid["x"][open_, 1]) - 1
    speed[j, i], p[j, i] = np.linalg.norm(fluid["v"][open_], axis=1), 1e-3 * fluid["p"][open_]
    rows = np.flatnonzero((y[:-1] >= lower) & (y[1:] <= upper))
    return 1e3 * x, 1e3 * y[rows[0]:rows[-1] + 2], speed[rows[0]:rows[-1] + 1], p[rows[0]:rows[-1] + 1]


def fields_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.4 * len(runs), 7.5), layout="constrained")
    axes = figure.subplots(1, 2 * len(runs), sharey=True, squeeze=False)[0]
    for k, run in enumerate(runs):
        x, y, speed, p = plane(run)
        for axis, value, label in zip(axes[2 * k:2 * k + 2], (speed, p), ("speed (m/s)", "pressure (kPa)")):
            drawn = axis.pcolormesh(x, y, value, cmap="viridis", rasterized=True)
            axis.set(aspect="equal", title=run.variant, xlabel="x (mm)")
            figure.colorbar(drawn, ax=axis, shrink=0.5, location="bottom", label=label)
    axes[0].set_ylabel("y (mm)")
    return figure


def convergence_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes, done = figure.subplots(), set()
    for run in runs:
        name = run.variant.rsplit("_", 1)[0]
        members = family(run)
        if name in done or len(members) < 2:
            continue
        done.add(name)
        throat = Array(cylinders(run.scene)).throat(0.2)
        line, = axes.plot([throat / spacing(one) for one in members], [1e-3 * pressure(one) for one in members], "o-", label=name)
        if len(members) > 2:
            found = extrapolated(run)
            axes.errorbar(60.0, 1e-3 * found.value, yerr=1e-3 * found.half, fmt="x", color=line.get_color())
    axes.axhline(1e-3 * REFERENCE_PRESSURE, color="k", ls="--", lw=0.8)
    axes.set(xscale="log", xlabel="cells to the narrowest throat (limits at 60)", ylabel="pressure (kPa)")
    axes.legend(fontsize=7)
    return figure
