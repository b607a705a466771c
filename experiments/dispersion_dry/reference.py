"""Water that comes in below a dry bed of grains: does it rise in the pores, or does it lift the bed (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import dispersion_cell  # noqa: E402
from theory.dispersion_cell import area, beyond_walls, cell_of, grains_lost, mass_in, settled, times  # noqa: E402

UNITS = {"lift": "1", "water_missed": "1", "beyond_walls": "1", "grains_lost": "1", "wet_top": "m"}


# --- the scene ---


def volume_let_in(scene, t):
    """Water that the inlet has let in at time t (s), m3."""
    inlet = scene["inlet"][0]
    start, over = inlet["opens"]["from"], inlet["opens"]["over"]
    since = max(t - start, 0.0)
    return inlet["flow_rate"] * (since - 0.5 * over if since > over else 0.5 * since**2 / over)


def weight(scene):
    """Of the dry bed over the cell's area, Pa."""
    return dispersion_cell.weight(scene, 0.0)


def wetting(scene):
    """Tension (N/m) and cosine of the contact angle; none is 90 degrees."""
    law = scene["coupling"]["wetting"]
    return (law["tension"], math.cos(law["contact_angle"])) if law["law"] == "wetted_surface" else (0.072, 0.0)


def entry_pressure(scene, eps):
    """That a pore asks for before it lets water in, Pa: equation (1)."""
    tension, cosine = wetting(scene)
    return -6.0 * tension * cosine / scene["grains"]["diameter"] * (1.0 - eps) / eps


def lifting_ratio(scene, eps):
    """Entry pressure over the dry bed's weight: equation (2)."""
    return entry_pressure(scene, eps) / weight(scene)


# --- a run ---


def underside(run, k):
    """Height of the bed's underside, m: a twentieth of the grains' centres are below it."""
    return float(np.quantile(run.snapshot(k)["grains"]["x"][:, 2], 0.05))


def lift(run, k):
    """Rise of the bed's underside over that of a piston which all the water lifts."""
    risen = underside(run, k) - underside(run, settled(run))
    return risen * area(run.scene) / max(volume_let_in(run.scene, times(run)[k]), 1e-12)


def water_missed(run):
    """Greatest difference between the water in the cell and what was let in, over the cell's volume."""
    scene = run.scene
    before = mass_in(run, settled(run))  # the row that waits at the plane
    missed = [(mass_in(run, k) - before) / scene["fluid"]["density"] - volume_let_in(scene, t) for k, t in enumerate(times(run))]
    return float(np.max(np.abs(missed))) / (area(scene) * cell_of(scene)[2])


def wet_top(run, k):
    """Height that 95 % of the water is below, m."""
    z = run.snapshot(k)["fluid"]["x"][:, 2]
    return float(np.quantile(z, 0.95)) if len(z) else 0.0


def measure(quantity, run):
    last = len(run.snapshot_files()) - 1
    of_run = {
        "lift": lambda: lift(run, last),
        "water_missed": lambda: water_missed(run),
        "beyond_walls": lambda: beyond_walls(run, ceiling=False),
        "grains_lost": lambda: grains_lost(run),
        "wet_top": lambda: wet_top(run, last),
    }.get(quantity)
    return of_run() if of_run else NotImplemented


def reference(quantity, scene, t):
    return 0.0


def figures(runs):
    """The underside and the water's front over time, lift over the ratio that decides, and the runs as pictures."""
    from matplotlib.figure import Figure
    from plumb_reports import film

    runs = [run for run in runs if run.failure is None]
    if not runs:
        return []
    figure = Figure(figsize=(10.0, 4.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    for run in runs:
        t, numbers = times(run), range(len(run.snapshot_files()))
        (line,) = left.plot(t, [1e3 * underside(run, k) for k in numbers], label=run.variant)
        left.plot(t, [1e3 * wet_top(run, k) for k in numbers], ":", color=line.get_color())
        right.plot(lifting_ratio(run.scene, 0.42), measure("lift", run), "o", color=line.get_color())
    left.set(xlabel="time (s)", ylabel="underside of the bed, front of the water (dotted) (mm)")
    left.legend(fontsize=6)
    right.axvline(1.0, color="black", lw=0.8)
    right.set(xlabel="entry pressure over the dry bed's weight, at eps 0.42", ylabel="rise of the underside over a piston's")
    shown = [("lift", figure, "Left: underside of the bed and front of the water. Right: lift over the ratio of equation (2); at 1 theory changes from no to yes.")]
    for run in runs:
        numbers = np.unique(np.linspace(settled(run), len(run.snapshot_files()) - 1, 6).astype(int))
        shown.append((f"sequence_{run.variant}", film.sequence(run, numbers), f"{run.variant}: grains that the middle plane cuts, and the water beside it."))
    return shown
