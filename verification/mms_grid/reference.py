"""A flow among a moving wave of porosity with its source (README.md): errors of the grid's velocities and pressure."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory.manufactured_medium import ManufacturedMedium  # noqa: E402

UNITS = {"velocity_l2": "m/s", "pressure_l2": "Pa"}


def made(scene):
    """The flow that the source keeps going, whatever medium the fluid itself is given."""
    fluid = scene["fluid"]
    return ManufacturedMedium(fluid["source"], scene["domain"]["size"][0], fluid["density"], fluid["viscosity"])


def face_errors(run):
    """Errors of u and v, m/s, [ny, nx] at the middles of their faces, and the places of those of u, at the last time."""
    snapshot, flow = run.snapshot(-1), made(run.scene)
    x, y = (np.asarray(snapshot["grid"][f"nodes_{axis}"]) for axis in "xy")
    middle = {0: 0.5 * (x[1:] + x[:-1]), 1: 0.5 * (y[1:] + y[:-1])}
    errors = []
    for c, (at_x, at_y) in enumerate(((x[:-1], middle[1]), (middle[0], y[:-1]))):
        places = np.meshgrid(at_x, at_y)
        exact = flow.velocity(*places, snapshot["time"])[c]
        errors.append(snapshot["grid"][f"u_{'xy'[c]}"][0] - exact)
    return errors, np.meshgrid(x[:-1], middle[1])


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0  # norms of errors; judged by absolute metrics
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "velocity_l2":
        return float(max(math.sqrt(np.mean(error**2)) for error in face_errors(run)[0]))
    if quantity == "pressure_l2":
        snapshot = run.snapshot(-1)
        fluid = snapshot["fluid"]
        error = fluid["p"] - made(run.scene).pressure(fluid["x"][:, 0], fluid["x"][:, 1], snapshot["time"])
        return float(np.std(error))  # a closed box fixes p up to a constant
    return NotImplemented


def table(runs):
    """Errors and their order from one run to the next finer one."""
    rows, before = [], {}
    for run in sorted((run for run in runs if run.failure is None), key=lambda run: (run.variant, -run.scene["fluid"]["spacing"])):
        h, errors = run.scene["fluid"]["spacing"], [measure(name, run) for name in UNITS]
        last = before.get(run.variant)
        orders = [f"{math.log(old / new) / math.log(last[0] / h):.2f}" for old, new in zip(last[1], errors)] if last else ["", ""]
        rows.append([run.variant, f"1/{round(1.0 / h)}", f"{errors[0]:.3g}", orders[0], f"{errors[1]:.3g}", orders[1]])
        before[run.variant] = (h, errors)
    columns = ["variant", "spacing (m)", "velocity error (m/s)", "order", "pressure error (Pa)", "order"]
    return {"columns": columns, "rows": rows, "caption": "Root mean square errors at the end, the worse component; order since the row above."}


def figures(runs):
    """The exact flow and porosity, and where the finest central run errs."""
    import matplotlib.pyplot as plt

    run = min((run for run in runs if run.failure is None and run.variant == "central"), key=lambda run: run.scene["fluid"]["spacing"])
    flow, t = made(run.scene), run.snapshot(-1)["time"]
    figure, axes = plt.subplots(1, 3, figsize=(11.0, 3.4), layout="constrained")
    x, y = flow.grid(96)
    image = axes[0].pcolormesh(x, y, flow.porosity(x, y, t), cmap="cividis", shading="nearest")
    figure.colorbar(image, ax=axes[0], label="eps")
    x, y = flow.grid(20)
    axes[0].quiver(x, y, *flow.velocity(x, y, t), color="w")
    axes[0].set_title("porosity and velocity")
    errors, (x, y) = face_errors(run)
    for axis, error, name in zip(axes[1:], errors, "uv"):
        most = np.abs(error).max()
        image = axis.pcolormesh(x, y, error, cmap="RdBu_r", vmin=-most, vmax=most, shading="nearest")
        figure.colorbar(image, ax=axis, label="m/s")
        axis.set_title(f"error of {name}, spacing {run.scene['fluid']['spacing']:g} m")
    for axis in axes:
        axis.set(aspect="equal", xlabel="x (m)")
    axes[0].set_ylabel("y (m)")
    return [("fields", figure, "The manufactured flow at the end, and the error of the finest run with central differences.")]
