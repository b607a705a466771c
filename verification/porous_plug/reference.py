"""Velocity across and pressure along a channel that a porous medium fills (README.md)."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import porous_flow  # noqa: E402

UNITS = {"velocity_l2": "1", "pressure_linf": "1"}
# what the case means, whatever a scene under test says
PERMEABILITY, POROSITY, ACROSS, DIAMETER = 0.005, 0.5, (0.3, 0.7), 1.5
ALONG, PLUG_DIAMETER, SPEED = (0.9, 0.4), 0.5, 1.0


def exact_velocity(variant, scene, y):
    """u(y) between the plates, m/s."""
    height, force = scene["domain"]["size"][1], scene["fluid"]["body_force"][0]
    density, viscosity = scene["fluid"]["density"], scene["fluid"]["viscosity"]
    if variant == "uniform":
        return porous_flow.brinkman(y, height, force, density, viscosity, PERMEABILITY, POROSITY)
    law = porous_flow.kozeny_carman(DIAMETER)
    eps = lambda at: ACROSS[0] + (ACROSS[1] - ACROSS[0]) * at / height  # noqa: E731
    return porous_flow.Layered(height, force, density, viscosity, eps, law).velocity(y)


def plug(scene):
    fluid = scene["fluid"]
    return porous_flow.Plug(scene["domain"]["size"][0], *ALONG, ALONG[0] * SPEED, fluid["density"], fluid["viscosity"],
                            porous_flow.ergun(PLUG_DIAMETER))


def profile(run):
    """(y, u, exact) at the middles of the faces across x in one column."""
    grid = run.snapshot(-1)["grid"]
    y = 0.5 * (grid["nodes_y"][1:] + grid["nodes_y"][:-1])
    return y, grid["u_x"][0][:, 0], exact_velocity(run.variant, run.scene, y)


def pressures(run):
    """(x, p, exact) at the middles of the cells of one row, Pa, both less their mean."""
    fluid = run.snapshot(-1)["fluid"]
    row = fluid["x"][:, 1] == fluid["x"][0, 1]
    x, p = fluid["x"][row, 0], fluid["p"][row]
    exact = plug(run.scene).pressure(x)
    return x, p - p.mean(), exact - exact.mean()


def reference(quantity, scene, t):
    if quantity in UNITS:
        return 0.0  # norms of errors; judged by absolute metrics
    if quantity == "flow_rate":
        return ALONG[0] * SPEED * scene["domain"]["size"][1]
    raise KeyError(quantity)


def measure(quantity, run):
    if quantity == "velocity_l2":
        _, u, exact = profile(run)
        return float(np.sqrt(np.mean((u - exact) ** 2)) / exact.max())
    if quantity == "pressure_linf":
        _, p, exact = pressures(run)
        drop = -plug(run.scene).pressure([run.scene["domain"]["size"][0]])[0]
        return float(np.abs(p - exact).max() / drop)
    return NotImplemented


def table(runs):
    """The error of every run."""
    rows = []
    for run in sorted((run for run in runs if run.failure is None), key=lambda run: (run.variant, -run.scene["fluid"]["spacing"])):
        name = "pressure_linf" if run.variant == "plug" else "velocity_l2"
        rows.append([run.variant, f"1/{round(1.0 / run.scene['fluid']['spacing'])}", f"{100.0 * measure(name, run):.3g}"])
    columns = ["variant", "spacing (m)", "error (%)"]
    return {"columns": columns, "rows": rows, "caption": "Velocity: root mean square over the greatest; pressure: greatest over the drop."}


def figures(runs):
    """Profiles of the coarsest and the finest run of each variant, with the exact ones."""
    import matplotlib.pyplot as plt

    good = [run for run in runs if run.failure is None]
    figure, axes = plt.subplots(1, 3, figsize=(11.0, 3.4), layout="constrained")
    for axis, name in zip(axes, ("uniform", "across", "plug")):
        mine = sorted((run for run in good if run.variant == name), key=lambda run: -run.scene["fluid"]["spacing"])
        for run, mark in zip((mine[0], mine[-1]), ("o", ".")):
            at, found, exact = pressures(run) if name == "plug" else profile(run)
            label = f"spacing 1/{round(1.0 / run.scene['fluid']['spacing'])} m"
            axis.plot(at, found, mark, ms=4 if mark == "o" else 3, label=label)
        axis.plot(at, exact, "k-", lw=0.8, label="exact")
        axis.set(title=name, xlabel="x (m)" if name == "plug" else "y (m)", ylabel="p less its mean (Pa)" if name == "plug" else "u (m/s)")
        axis.legend(fontsize=7)
    return [("profiles", figure, "Velocity across the channel, pressure along the plug.")]
