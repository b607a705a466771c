"""Permeability of arrays of cylinders with inertia from spectral elements (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import tables  # noqa: E402

UNITS = {"permeability": "1", "drift": "1"}
# what a variant means, whatever a scene under test says: array, solid fraction, force rho g L^3/mu^2
MEANT = {"square_02_re_9": ("square", 0.2, 1e3), "square_02_re_47": ("square", 0.2, 6e3), "square_04_re_9": ("square", 0.4, 3e3),
         "square_04_re_52": ("square", 0.4, 2e4), "hexagonal_04_re_9": ("hexagonal", 0.4, 3e3), "hexagonal_04_re_42": ("hexagonal", 0.4, 2e4)}


def lattice(scene):
    """(array, lattice constant L, m) of a scene's box: square, or two cylinders in a x sqrt(3) a."""
    sides = scene["domain"]["size"]
    return ("square" if math.isclose(sides[0], sides[1]) else "hexagonal"), sides[0]


def dimensionless_force(scene):
    """rho g L^3/mu^2 with g = rho f, the force per volume."""
    fluid = scene["fluid"]
    return fluid["density"] ** 2 * fluid["body_force"][0] * lattice(scene)[1] ** 3 / fluid["viscosity"] ** 2


def meant(scene):
    """The entry of MEANT whose array and force the scene has; the radius is under test."""
    array, force = lattice(scene)[0], dimensionless_force(scene)
    return next(entry for entry in MEANT.values() if entry[0] == array and math.isclose(entry[2], force, rel_tol=1e-6))


def row(scene):
    array, fraction, force = meant(scene)
    table = tables.table("inertial_arrays/table.csv")
    rows = zip(table["array"], table["solid_fraction"], table["force"])
    mine = next(k for k, found in enumerate(rows) if found == (array, fraction, force))
    return {name: column[mine] for name, column in table.items()}


def reference(quantity, scene, t):
    if quantity == "permeability":  # over L^2
        return float(row(scene)["permeability"])
    if quantity == "drift":
        return 0.0
    raise KeyError(quantity)


def permeabilities(run):
    """(t, mu U/(g L^2)), U = (1 - c) times the mean velocity of the fluid."""
    t, mean = run.series("mean_velocity")
    fluid, fraction = run.scene["fluid"], meant(run.scene)[1]
    force = fluid["density"] * fluid["body_force"][0] * lattice(run.scene)[1] ** 2
    return t, fluid["viscosity"] * (1.0 - fraction) * np.ravel(mean) / force


def measure(quantity, run):
    if quantity == "permeability":
        return permeabilities(run)
    if quantity == "drift":
        _, k = permeabilities(run)
        return float(k[-1] / k[-2] - 1.0)
    return NotImplemented


def table(runs):
    """Every run: permeability, its error, drift."""
    rows = []
    for run in (run for run in runs if run.failure is None):
        k, expected = permeabilities(run)[1][-1], reference("permeability", run.scene, None)
        spacing = np.ravel(run.scene["fluid"]["spacing"])[0] / lattice(run.scene)[1]
        values = (row(run.scene)["re"], k, expected, 100.0 * (k / expected - 1.0), 100.0 * measure("drift", run))
        rows.append([run.variant, f"1/{round(1.0 / spacing)}", *(f"{value:.4g}" for value in values)])
    columns = ["variant", "spacing/L", "Re", "K/L2", "spectral elements", "error (%)", "drift (%)"]
    return {"columns": columns, "rows": rows, "caption": "Permeability at the end of the run; drift is its change in the last tenth."}


def figures(runs):
    """The speed in the finest run of every variant."""
    import matplotlib.pyplot as plt

    finest = {run.variant: run for run in runs if run.failure is None}
    figure, axes = plt.subplots(1, len(finest), figsize=(2.4 * len(finest), 3.2), squeeze=False, layout="constrained")
    for axis, (name, run) in zip(axes[0], finest.items()):
        fluid, size = run.snapshot(-1)["fluid"], run.scene["domain"]["size"]
        speed = np.linalg.norm(fluid["v"][:, :2], axis=1)
        places = [np.unique(fluid["x"][:, axis_number], return_inverse=True) for axis_number in (0, 1)]
        shown = np.full((len(places[1][0]), len(places[0][0])), np.nan)
        shown[places[1][1], places[0][1]] = speed / speed.max()
        dots = axis.pcolormesh(places[0][0], places[1][0], shown, cmap="viridis", shading="nearest")
        for wall in run.scene["wall"]:
            axis.add_patch(plt.Circle(wall["point"], wall["radius"], color="w", ec="k", lw=0.8))
        axis.set(title=name, aspect="equal", xlim=(0, size[0]), ylim=(0, size[1]), xticks=[], yticks=[])
        axis.title.set_fontsize(8)
    figure.colorbar(dots, ax=axes[0], shrink=0.7, label="speed / greatest")
    return [("speed", figure, "Cells of the finest run of every variant by their speed; the flow is from left to right.")]
