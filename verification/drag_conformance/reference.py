"""Drag of every law on a row of fixed grains, from the conformance kit reference_data/drag_laws (independent of the solver).

`python3 reference.py` writes grains.csv again.
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import LAWS  # noqa: E402

# eps and Re of the grains. Like the kit's own grid they avoid every point where a law jumps, and eps stays below 1 because
# eps = 1 is the far side of the box; the variants `..._dilute` have eps = 1 everywhere.
EPS = (0.4, 0.45, 0.5, 0.55, 0.62, 0.7, 0.78, 0.82, 0.9, 0.97, 0.995)
RE = (1.0e-3, *(float(f"{m}e{k}") for k in range(-3, 4) for m in (1.3, 3.2, 6.8)), 1.3e4)
LENGTH, LOWER, UPPER = 2.6, 0.35, 1.0  # scene.toml: domain.size[0] and coupling.porosity
SPEED, NU = 1.0, 1.0e-6  # scene.toml: fluid velocity m/s, viscosity/density m2/s


def lattice():
    """[(x, y, z, d)]: x gives eps through the linear porosity, d gives Re = eps |u| d/nu; y only keeps grains apart."""
    return [
        (LENGTH * (eps - LOWER) / (UPPER - LOWER), 0.05 * (1 + row), 0.05, re * NU / (eps * SPEED))
        for eps in EPS
        for row, re in enumerate(RE)
    ]


def grains(scene):
    """x [n] and d [n] of the grains file of the scene, in its order."""
    with open(HERE / scene["grains"]["arrange"]["path"], newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    return (np.array([float(row[name]) for row in rows]) for name in ("x [m]", "diameter [m]"))


def porosity(scene, x):
    """Fluid fraction at x, from the scene's prescribed porosity."""
    law = scene["coupling"]["porosity"]
    if law["law"] == "uniform":
        return np.full_like(x, law["value"])
    share = x / scene["domain"]["size"][0]
    return law["lower"] + (law["upper"] - law["lower"]) * share


def true_law(name):
    """The law a scene's drag stands for; a planted fault is named <law>_<fault>."""
    return LAWS[max((law for law in LAWS if name.startswith(law)), key=len)]


def drag(scene):
    """Drag [n] along x, N: f_d = 3 pi mu d u_s F(eps, Re), u_s = eps |u|, Re = rho d u_s/mu."""
    x, d = grains(scene)
    fluid = scene["fluid"]
    rho, mu = fluid["density"], fluid["viscosity"]
    eps = porosity(scene, x)
    speed = 0.0 if fluid["flow"]["law"] == "rest" else fluid["flow"]["velocity"][0]
    superficial = eps * speed
    factor = true_law(scene["coupling"]["drag"])(eps, rho * d * superficial / mu)
    return 3.0 * math.pi * mu * d * superficial * factor


def reference(quantity, scene, t):
    assert quantity == "drag"
    return np.tile(drag(scene), (len(t), 1))


def figures(runs):
    """F of every law against Re, solver (points) on reference (lines), for a dense, a middle and a dilute porosity."""
    from matplotlib.figure import Figure

    last = {run.variant: run for run in runs}
    shown = [law for law in LAWS if law in last]
    figure = Figure(figsize=(10.0, 7.5), layout="constrained")
    panels = figure.subplots(3, 5, sharex=True)
    for law, axes in zip(shown, panels.flat):
        scene = last[law].scene
        x, d = grains(scene)
        eps = porosity(scene, x)
        rho, mu, speed = scene["fluid"]["density"], scene["fluid"]["viscosity"], scene["fluid"]["flow"]["velocity"][0]
        scale = 3.0 * math.pi * mu * d * eps * speed
        measured, expected, re = last[law].series("drag")[1][-1] / scale, drag(scene) / scale, rho * d * eps * speed / mu
        for value, colour in ((EPS[0], "C3"), (EPS[4], "C1"), (EPS[-1], "C0")):
            row = np.isclose(eps, value)
            axes.loglog(re[row], expected[row], "-", color=colour, label=f"eps = {value:g}")
            axes.loglog(re[row], measured[row], ".", color=colour)
        axes.set_title(law, fontsize="small")
    for axes in panels[-1]:
        axes.set_xlabel("Re (superficial)")
    for axes in panels[:, 0]:
        axes.set_ylabel("F = f_d/(3 pi mu d u_s)")
    handles, labels = panels.flat[0].get_legend_handles_labels()
    for axes in list(panels.flat)[len(shown):]:
        axes.axis("off")
        axes.legend(handles, labels, loc="center")
    return [("laws", figure, "Drag factor of every law: solver (points) on the reference (lines).")]


def table(runs):
    """Largest relative deviation of every law over the grains, and where."""
    rows = []
    for run in runs:
        if run.variant not in LAWS:
            continue
        x, d = grains(run.scene)
        expected = drag(run.scene)
        deviation = np.abs(run.series("drag")[1][-1] / expected - 1.0)
        worst = int(np.argmax(deviation))
        eps = porosity(run.scene, x)[worst]
        rows.append([run.variant, f"{deviation[worst]:.1e}", f"{eps:.3g}", f"{eps * SPEED * d[worst] / NU:.3g}"])
    agree = all(float(row[1]) < 1e-10 for row in rows)
    caption = "All laws agree with the kit to round-off." if agree else "Not all laws agree with the kit."
    return {"columns": ["law", "largest deviation", "at eps", "at Re"], "rows": rows, "caption": caption}


if __name__ == "__main__":
    with open(HERE / "grains.csv", "w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["x [m]", "y [m]", "z [m]", "diameter [m]"])
        writer.writerows([repr(value) for value in row] for row in lattice())
