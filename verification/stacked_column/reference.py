"""A column of spheres at rest: every contact carries the weight above it.

The numbers are stated here and not read from the scene, so that a scene which says something else fails.
`python3 reference.py` writes column.csv, the initial state.
"""

from pathlib import Path

import numpy as np

GRAINS = 20
DENSITY = 2500.0    # kg/m3
GRAVITY = 9.81      # m/s2
STIFFNESS = 1000.0  # N/m
YOUNG = 5e7         # Pa
POISSON = 0.3
GAP = 1e-9          # m, at the start
GOLDEN = 0.6180339887498949  # fractional parts of its multiples are evenly spread
UNITS = {"overlaps": "m"}


def initial_state():
    """x [n, 3] and diameter [n] of grains that all but touch."""
    diameter = 1e-3 * (1 + 0.4 * (np.arange(1, GRAINS + 1) * GOLDEN % 1))
    z = np.cumsum(diameter + GAP) - diameter / 2
    return np.column_stack([np.full(GRAINS, 5e-3), np.full(GRAINS, 5e-3), z]), diameter


def diameters():
    """Diameters [n] from the floor upwards as the solver reads them."""
    return np.loadtxt(Path(__file__).parent / "column.csv", delimiter=",", skiprows=1)[:, 3]


def loads():
    """Force [n] of the contact below each grain: the weight of that grain and of all above it."""
    weight = GRAVITY * DENSITY * np.pi / 6 * diameters()**3
    return np.cumsum(weight[::-1])[::-1]


def hertz_stiffness():
    """k_h [n] in N/m^1.5 of the contact below each grain; R* is R against the floor."""
    radius = diameters() / 2
    curvature = 1 / radius
    curvature[1:] += 1 / radius[:-1]
    return 4 / 3 * YOUNG / (2 * (1 - POISSON**2)) / np.sqrt(curvature)


def overlaps(law):
    """Overlap [n] of the contact below each grain."""
    if law == "hertz_mindlin":
        return (loads() / hertz_stiffness())**(2 / 3)
    return loads() / STIFFNESS


def reference(quantity, scene, t):
    """Overlaps [n] in m; force on the floor and contact force on the lowest grain in N; elastic energy in J."""
    law = scene["grains"]["contact"]["law"]
    if quantity == "overlaps":
        return overlaps(law)
    if quantity == "floor_force":
        return -loads()[0]  # of the grains on the floor: downwards
    if quantity == "lowest_force":
        return loads()[0] - loads()[1]  # what holds its own weight
    if quantity == "elastic_energy":
        share = 2 / 5 if law == "hertz_mindlin" else 1 / 2
        return share * np.sum(loads() * overlaps(law))
    raise KeyError(quantity)


def measure(quantity, run):
    """Overlaps from the positions of the last snapshot, from the floor upwards."""
    if quantity not in UNITS:
        return NotImplemented
    grains = run.snapshot(-1)["grains"]
    z = grains["x"][np.argsort(grains["id"]), 2]
    radius = diameters() / 2
    distance = np.diff(z, prepend=0.0)
    touch = radius + np.concatenate([[0.0], radius[:-1]])
    return np.arange(GRAINS), touch - distance


def figures(runs):
    """Overlaps along the column."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.0, 4.4), layout="constrained")
    axes = figure.subplots()
    finest = {run.variant: run for run in runs if not run.failure}
    for number, (variant, run) in enumerate(finest.items()):
        contact, measured = measure("overlaps", run)
        axes.plot(contact, measured, "o", ms=4, color=f"C{number}", label=variant)
        axes.plot(contact, reference("overlaps", run.scene, contact), "-", lw=1, color=f"C{number}")
    axes.set_xlabel("contact, counted from the floor [-]")
    axes.set_ylabel("overlap [m]")
    axes.legend()
    return [("overlaps", figure, "Symbols: the solver at rest. Lines: the weight above, by each law.")]


def write_column():
    """Writes column.csv; the numbers keep every bit."""
    x, diameter = initial_state()
    with open(Path(__file__).parent / "column.csv", "w", encoding="utf-8") as file:
        file.write("x [m],y [m],z [m],diameter [m]\n")
        for row in np.column_stack([x, diameter]):
            file.write(",".join(repr(float(value)) for value in row) + "\n")


if __name__ == "__main__":
    write_column()
