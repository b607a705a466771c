"""Water up through a bed on a floor: pressure drop and flow (README.md)."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import LAWS  # noqa: E402
from theory.bed_on_floor import LayeredBed  # noqa: E402

UNITS = {"drop": "Pa", "flux_missed": "1"}


def bed(scene):
    """The lattice's layers, as the kernel smooths them."""
    arrange, h = scene["grains"]["arrange"], kernel_width(scene)
    a = arrange["spacing"]
    return LayeredBed(np.arange(arrange["lower"][2], arrange["upper"][2], a), 1.0 / a**2, scene["grains"]["diameter"], h)


def kernel_width(scene):
    fluid = scene["fluid"]
    return scene["coupling"]["kernel_width"]["times_smoothing"] * fluid["smoothing"] * fluid["spacing"]


def law(scene):
    return LAWS[scene["coupling"]["drag"]]


def inflow(scene, t):
    """Superficial velocity at time t, m/s."""
    inlet = scene["inlet"][0]
    opens = inlet["opens"]
    return inlet["profile"]["speed"] * float(np.clip((t - opens["from"]) / opens["over"], 0.0, 1.0))


def drop_of(scene, u):
    """Pa, of the bed at rest by theory."""
    fluid = scene["fluid"]
    return bed(scene).pressure_drop(law(scene), u, fluid["density"], fluid["viscosity"])


def measured_drop(run, k):
    """Pa, of snapshot k: the pressure continued to the floor from the three lowest slices of a spacing, less that of the upper quarter."""
    snapshot, dx = run.snapshot(k), run.scene["fluid"]["spacing"]
    z, p = snapshot["fluid"]["x"][:, 2], snapshot["fluid"]["p"]
    low = z < 3.0 * dx
    slope, floor = np.polyfit(z[low], p[low], 1)
    return float(floor - np.mean(p[z > 0.75 * run.scene["domain"]["size"][2]]))


def late(run):
    """Numbers of the snapshots of the last half."""
    count = len(run.snapshot_files())
    return range(count // 2, count)


def flux_missed(run):
    """Of the mass that passes slices of four spacings, averaged over the last half of the run, from the inflow's: the greatest, relative."""
    scene = run.scene
    size, dx, rho = scene["domain"]["size"], scene["fluid"]["spacing"], scene["fluid"]["density"]
    edges = np.arange(0.0, size[2] + 0.5 * dx, 4.0 * dx)
    passing = np.zeros(len(edges) - 1)
    for k in late(run):
        fluid = run.snapshot(k)["fluid"]
        passing += np.histogram(fluid["x"][:, 2], edges, weights=fluid["mass"] * fluid["v"][:, 2])[0]
    per_area = passing / len(late(run)) / (rho * size[0] * size[1] * 4.0 * dx)
    return float(np.max(np.abs(per_area / inflow(scene, 1e9) - 1.0)))


def measure(quantity, run):
    if quantity == "drop":
        return float(np.mean([measured_drop(run, k) for k in late(run)]))
    return flux_missed(run) if quantity == "flux_missed" else NotImplemented


def reference(quantity, scene, t):
    if quantity == "drop":
        return drop_of(scene, inflow(scene, 1e9))
    return 0.0


def figures(runs):
    """Drop over superficial velocity of the runs, and the theory."""
    from matplotlib.figure import Figure

    runs = [run for run in runs if run.failure is None]
    if not runs:
        return []
    figure = Figure(figsize=(6.0, 4.0), layout="constrained")
    axes = figure.subplots()
    for run in runs:
        axes.plot(1e3 * inflow(run.scene, 1e9), measure("drop", run), "o", label=run.variant)
    scene = runs[0].scene
    u = np.linspace(0.0, max(inflow(run.scene, 1e9) for run in runs), 60)
    axes.plot(1e3 * u, [drop_of(scene, one) for one in u], color="black", lw=0.8, label="theory")
    axes.set(xlabel="superficial velocity (mm/s)", ylabel="pressure drop (Pa)")
    axes.legend(fontsize=7)
    return [("drop", figure, "Pressure drop over superficial velocity.")]
