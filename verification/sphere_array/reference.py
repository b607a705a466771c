"""Permeability of a simple cubic array of spheres in creeping flow (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sphere_arrays  # noqa: E402

UNITS = {"permeability": "1", "flux_balance": "1", "cross_flow": "1"}
NOMINAL = (0.064, 0.125, 0.216, 0.343)  # solid fractions of this case: a scene's radius is under test
VISCOSITY = 0.1  # m2/s, of all scenes: that of a scene is under test


def solid_fraction(scene):
    """The nominal one next to the scene's."""
    c = 4.0 / 3.0 * math.pi * scene["wall"][0]["radius"] ** 3
    return min(NOMINAL, key=lambda value: abs(value - c))


def direction(scene):
    """Unit vector of the force, and the force per mass, m/s2."""
    force = np.asarray(scene["fluid"]["body_force"], float)
    size = float(np.linalg.norm(force))
    return force / size, size


def reference(quantity, scene, t):
    """K over the square of the period, 1 m2."""
    if quantity != "permeability":
        raise KeyError(quantity)
    return sphere_arrays.permeability(solid_fraction(scene))


def flow(run):
    """(superficial velocity along x, m/s, at the plane between the spheres, at the one through them; along y)."""
    return tuple(float(np.ravel(run.series(name)[1])[-1]) for name in ("flow", "flow_middle", "flow_across"))


def measure(quantity, run):
    along, middle, across = flow(run)
    unit, size = direction(run.scene)
    if quantity == "permeability":  # by the component along x, whose force is unit[0] size
        return along * VISCOSITY / (unit[0] * size)
    if quantity == "flux_balance":
        return middle / along - 1.0
    if quantity == "cross_flow":  # over that along x; with a diagonal force what it differs from that
        return across / along - unit[1] / unit[0]
    return NotImplemented


def table(runs):
    rows = []
    for run in runs:
        if run.failure is None:
            found, expected = measure("permeability", run), reference("permeability", run.scene, None)
            drag = 1.0 / (6.0 * math.pi * sphere_arrays.radius(solid_fraction(run.scene)) * found)
            rows.append([run.variant, f"1/{round(1.0 / run.scene['fluid']['spacing'])}", f"{found:.5g}", f"{expected:.5g}", f"{100.0 * (found / expected - 1.0):.2f}",
                         f"{drag:.4g}", f"{sphere_arrays.drag(solid_fraction(run.scene)):.4g}"])
    columns = ["variant", "h", "K", "theory", "error (%)", "drag over Stokes'", "theory"]
    return {"columns": columns, "rows": rows, "caption": "Permeability over the square of the period, and the drag on a sphere over 6 pi mu r U with the superficial velocity U."}


def figures(runs):
    """Speed in the plane through the sphere's middle, finest run of each array."""
    import matplotlib.pyplot as plt

    finest = {run.variant: run for run in runs if run.failure is None}
    figure, axes = plt.subplots(1, len(finest), figsize=(2.4 * len(finest), 3.0), squeeze=False)
    for axis, (name, run) in zip(axes[0], finest.items()):
        fluid, wall = run.snapshot(-1)["fluid"], run.scene["wall"][0]
        h = run.scene["fluid"]["spacing"]
        near = (np.abs(fluid["x"][:, 2] - wall["centre"][2] - 0.01 * h) < 0.5 * h) & (fluid["open"] > 0.0)
        speed = np.linalg.norm(fluid["v"][near], axis=1)
        dots = axis.scatter(fluid["x"][near, 0], fluid["x"][near, 1], c=speed / np.max(speed), s=(120.0 * h) ** 2, marker="s", cmap="viridis")
        axis.add_patch(plt.Circle(wall["centre"][:2], wall["radius"], fill=False, color="k", lw=0.8))
        axis.set(title=name, aspect="equal", xlim=(0, 1), ylim=(0, 1), xticks=[], yticks=[])
        axis.title.set_fontsize(8)
    figure.colorbar(dots, ax=axes[0], shrink=0.7, label="speed / greatest")
    return [("speed", figure, "Every cell of a layer through the middle of the sphere by its speed, finest run of each array; the sphere's surface as a circle.")]
