"""A result as a film or as pictures side by side: a slab of grains and fluid around the middle, seen along one axis."""

from pathlib import Path

import numpy as np

from .plan import Plan
from .results import Run
from .strict import CaseError

AXES = "xyz"
GRAINS = "#8c5a2b"
FAST = 0.995  # quantile of the speeds that ends the colour scale: a few splashes would darken the rest


def result_in(folder):
    """The run whose results are in a folder; raises CaseError where there are none to show."""
    folder = Path(folder)
    if not (folder / "run.json").is_file():
        raise CaseError(f"{folder}: no run.json; expected the folder of a result")
    run = Run(Plan(variant=folder.name, value=None, overrides={}, folder=folder), None, 0, None)
    if not whole_snapshots(run):
        raise CaseError(f"{folder}: no snapshots (time.snapshots = true)")
    return run


def whole_snapshots(run):
    """Numbers of the snapshots, without that of a divergence."""
    return [k for k, file in enumerate(run.snapshot_files()) if file.stem.isdigit()]


def greatest_speed(run):
    """Where the colours of the fluid end, m/s."""
    ends, numbers = [], whole_snapshots(run)
    for k in numbers[:: max(1, len(numbers) // 10)]:
        fluid = run.snapshot(k).get("fluid")
        if fluid is not None and len(fluid["v"]):
            ends.append(np.quantile(np.linalg.norm(fluid["v"], axis=1), FAST))
    return max(ends, default=0.0) or 1.0


def side_view(axes, snapshot, scene, fastest, along="y", share=0.5):
    """Draws the slab of half-width `share` spacings of the fluid (or grain diameters) around the middle, seen along an axis; lengths in mm."""
    from matplotlib.collections import EllipseCollection

    size = np.asarray(scene["domain"]["size"], float)
    depth = AXES.index(along)
    across, up = [c for c in range(3) if c != depth]
    middle = 0.5 * size[depth]
    if "fluid" in snapshot:
        fluid, half = snapshot["fluid"], share * scene["fluid"]["spacing"]
        near = np.abs(fluid["x"][:, depth] - middle) <= half
        x, v = fluid["x"][near], fluid["v"][near]
        speed = np.linalg.norm(v, axis=1)
        axes.quiver(1e3 * x[:, across], 1e3 * x[:, up], v[:, across], v[:, up], speed, cmap="viridis", clim=(0.0, fastest),
                    scale=8.0 * fastest, width=0.004, zorder=2)
    if "grains" in snapshot:
        grains = snapshot["grains"]
        d = grains["diameter"]
        off = np.abs(grains["x"][:, depth] - middle)
        cut = off < 0.5 * d
        width = 1e3 * np.sqrt(d[cut] ** 2 - 4.0 * off[cut] ** 2)  # of the discs that the middle plane cuts
        axes.add_collection(EllipseCollection(width, width, np.zeros(len(width)), units="x", facecolors=GRAINS, lw=0.0, zorder=1,
                                              offsets=1e3 * grains["x"][cut][:, [across, up]], offset_transform=axes.transData))
    axes.set(xlim=(0.0, 1e3 * size[across]), ylim=(0.0, 1e3 * size[up]), aspect="equal")


def extents(run, along):
    """Width and height of what is seen along an axis, m."""
    size = run.scene["domain"]["size"]
    return [size[c] for c in range(3) if c != AXES.index(along)]


def sequence(run, numbers, along="y"):
    """Figure of snapshots side by side."""
    from matplotlib.figure import Figure

    across, up = extents(run, along)
    figure = Figure(figsize=(2.2 * len(numbers), 2.2 * up / across + 0.5), layout="constrained")
    fastest = greatest_speed(run)
    for axes, k in zip(np.atleast_1d(figure.subplots(1, len(numbers), sharey=True)), numbers, strict=True):
        snapshot = run.snapshot(k)
        side_view(axes, snapshot, run.scene, fastest, along)
        axes.set_title(f"{snapshot['time']:.2f} s", fontsize=8)
        axes.tick_params(labelsize=6)
    return figure


def write_film(folder, path, along="y", frames_per_second=10.0):
    """All snapshots of a result as an animated picture (.gif, .webp, .png)."""
    from matplotlib.animation import FuncAnimation, PillowWriter
    from matplotlib.figure import Figure

    run = result_in(folder)
    across, up = extents(run, along)
    figure = Figure(figsize=(4.0, 4.0 * up / across + 0.4), dpi=100)
    axes = figure.add_axes((0.1, 0.08, 0.86, 0.86))
    fastest = greatest_speed(run)

    def draw(k):
        snapshot = run.snapshot(k)
        axes.clear()
        side_view(axes, snapshot, run.scene, fastest, along)
        axes.set_title(f"{snapshot['time']:.2f} s", fontsize=9)

    FuncAnimation(figure, draw, frames=whole_snapshots(run)).save(path, writer=PillowWriter(fps=frames_per_second))
