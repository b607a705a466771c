"""A random bed on a floor: its weight on the floor, its packing fraction and its contacts per grain.

Bounds on the packing come from experiments and simulations of others, named in the README; this file measures.
"""

import numpy as np
from scipy.spatial import cKDTree

DENSITY = 2500.0   # kg/m3
GRAVITY = 9.81     # m/s2
FLOOR_LAYER = 2e-3    # m, left out: two grains
BULK_SHARE = 0.8      # of the grains have their centres below the upper end of the bulk
UNITS = {"floor_force": "1", "packing_fraction": "1", "coordination": "1"}


def reference(quantity, scene, t):
    """The force on the floor is the weight, downwards; the other quantities are judged by ranges."""
    if quantity == "floor_force":
        return -np.ones_like(np.asarray(t, dtype=float))
    raise KeyError(quantity)


def bulk(run):
    """(centres [n, 3], radii [n], lower and upper height of the bulk) in the last snapshot."""
    grains = run.snapshot(-1)["grains"]
    x, radius = grains["x"], grains["diameter"] / 2
    return x, radius, FLOOR_LAYER, float(np.quantile(x[:, 2], BULK_SHARE))


def layer_fraction(x, radius, lower, upper, area):
    """Share of the slab lower < z < upper that the spheres fill: exact slices of spheres."""
    low = np.clip(lower - x[:, 2], -radius, radius)
    high = np.clip(upper - x[:, 2], -radius, radius)
    volume = np.pi * (radius**2 * (high - low) - (high**3 - low**3) / 3)
    return float(np.sum(volume) / (area * (upper - lower)))


def coordination(x, radius, lower, upper, sides):
    """Contacts per grain of the slab, leaving out rattlers (fewer than two contacts: they carry nothing)."""
    box = np.array([sides[0], sides[1], 1.0])  # only z is open, and far smaller than 1 m
    wrapped = np.column_stack([x[:, 0] % sides[0], x[:, 1] % sides[1], x[:, 2]])
    pairs = cKDTree(wrapped, boxsize=box).query_pairs(2 * radius.max(), output_type="ndarray")
    apart = wrapped[pairs[:, 0]] - wrapped[pairs[:, 1]]
    apart[:, :2] -= box[:2] * np.round(apart[:, :2] / box[:2])
    touching = np.linalg.norm(apart, axis=1) < radius[pairs[:, 0]] + radius[pairs[:, 1]]
    contacts = np.bincount(pairs[touching].ravel(), minlength=len(x))
    counted = (x[:, 2] > lower) & (x[:, 2] < upper) & (contacts > 1)
    return float(np.mean(contacts[counted]))


def measure(quantity, run):
    """(t, force on the floor over the weight), packing fraction and contacts per grain of the bulk."""
    if quantity not in UNITS:
        return NotImplemented
    x, radius, lower, upper = bulk(run)
    sides = run.scene["domain"]["size"]
    if quantity == "packing_fraction":
        return layer_fraction(x, radius, lower, upper, sides[0] * sides[1])
    if quantity == "coordination":
        return coordination(x, radius, lower, upper, sides)
    t, force = run.series("floor_force")
    return t, force / (GRAVITY * DENSITY * 4 / 3 * np.pi * np.sum(radius**3))


def figures(runs):
    """Force on the floor over time and packing fraction over height."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(7.0, 6.4), layout="constrained")
    force, profile = figure.subplots(2, 1)
    for run in runs:
        if run.failure:
            continue
        label = run.variant if run.value is None else f"{run.variant}, {run.value:g} grains"
        t, ratio = measure("floor_force", run)
        force.plot(t, -ratio, lw=0.8, label=label)
        x, radius, _, upper = bulk(run)
        edges = np.arange(0, upper, 2.5e-4)
        area = run.scene["domain"]["size"][0] * run.scene["domain"]["size"][1]
        profile.plot(edges[:-1] + 1.25e-4,
                     [layer_fraction(x, radius, a, b, area) for a, b in zip(edges, edges[1:])], lw=0.8, label=label)
    force.set_xlabel("time [s]")
    force.set_ylabel("force on the floor over weight [-]")
    force.legend(fontsize="small")
    profile.set_xlabel("height [m]")
    profile.set_ylabel("packing fraction [-]")
    return [("bed", figure, "Above: the fall, the impact (more than the weight), rest. Below: the floor orders the first "
             "layers, which the judged bulk leaves out.")]
