"""The dispersion cell as both its cases, wet and dry, measure it: shape, grains, and when the jet comes in."""

import math

import numpy as np

G = 9.81


def cell_of(scene):
    """Axis, radius and height of the cell, m."""
    wall = next(w for w in scene["wall"] if w["shape"] == "cylinder")
    return np.array(wall["point"][:2]), wall["radius"], scene["domain"]["size"][2]


def area(scene):
    return math.pi * cell_of(scene)[1] ** 2


def grain_volume(scene):
    return math.pi / 6.0 * scene["grains"]["diameter"] ** 3


def weight(scene, surrounding):
    """Of all grains in a fluid of density `surrounding` (kg/m3), over the cell's area, Pa."""
    grains = scene["grains"]
    return (grains["density"] - surrounding) * G * grains["arrange"]["count"] * grain_volume(scene) / area(scene)


def times(run):
    """Of the snapshots, s."""
    return np.arange(len(run.snapshot_files())) * run.scene["time"]["output_interval"]


def settled(run):
    """Number of the last snapshot before the jet."""
    return int(np.nonzero(times(run) <= run.scene["inlet"][0]["opens"]["from"])[0][-1])


def mass_in(run, k):
    """Mass of water in the cell, kg. A row at the inlet (side 0) counts more and more over its last spacing before the plane, the layer of an even outlet (side 1) over one about it."""
    scene, snapshot = run.scene, run.snapshot(k)
    _, _, height = cell_of(scene)
    dx, fluid, walls = scene["fluid"]["spacing"], snapshot["fluid"], snapshot.get("walls")
    mass = float(np.sum(fluid["mass"])) if "mass" in fluid else 0.0
    if walls is None:
        return mass
    z, part = walls["x"][:, 2] / dx, np.zeros(len(walls["side"]))
    at_inlet, at_outlet = walls["side"] == 0, walls["side"] == 1
    part[at_inlet] = np.clip(1.0 + z[at_inlet], 0.0, 1.0)
    if at_outlet.any():
        above = z - height / dx
        first = at_outlet & (above < np.min(above[at_outlet]) + 0.5)
        part[first] = 0.5 - above[first]
    return mass + float(np.sum(part * walls["mass"]))


def beyond_walls(run, ceiling):
    """How deep the grains' surfaces are behind walls at most, in diameters; behind a sieve at the top, too, where there is one."""
    scene, d = run.scene, run.scene["grains"]["diameter"]
    axis, radius, height = cell_of(scene)
    worst = -math.inf
    for k in range(len(run.snapshot_files())):
        x = run.snapshot(k)["grains"]["x"]
        above = np.max(x[:, 2]) - height if ceiling else -math.inf
        worst = max(worst, np.max(np.hypot(*(x[:, :2] - axis).T)) - radius, -np.min(x[:, 2]), above)
    return float(max(worst / d + 0.5, 0.0))


def grains_lost(run):
    return float(run.scene["grains"]["arrange"]["count"] - len(run.snapshot(len(run.snapshot_files()) - 1)["grains"]["id"]))
