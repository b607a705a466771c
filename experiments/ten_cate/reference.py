"""ten Cate's sphere in a box, unresolved on a grid: linear theory where there is one, measurement, what the walls do (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import ONE_SPHERE  # noqa: E402
from tables import table as data_table  # noqa: E402
from theory import grid_fall, released_sphere  # noqa: E402

MEASURED = data_table("ten_cate_2002/settling.csv")
LAW = ONE_SPHERE["schiller_naumann"]
FORCES = ("buoyancy", "pressure_gradient", "virtual_mass")  # of the case, which a twin may break
IMAGING, OF_LAW = 0.01, 0.02  # standard uncertainties: of the measured u_max, of a drag law at Re 1 to 40 in speed
SHARE, FLOOR = 0.10, 0.005  # of the grain's own wake, of the terminal speed: the larger of both is the bound
OPEN = (0.6, 0.6, 0.64)  # m: a box whose images are 40 diameters away
UNITS = {"speed": "m/s", "u_max": "m/s", "without_wake": "m/s", "off_theory": "1", "walls": "1", "near_bottom": "1", "time_95": "s"}


def row_of(scene):
    return int(np.argmin(np.abs(MEASURED["mu"] / scene["fluid"]["viscosity"] - 1.0)))


def sphere(scene):
    grain, fluid = scene["grains"], scene["fluid"]
    return released_sphere.Sphere(LAW, grain["density"], grain["diameter"], fluid["density"], fluid["viscosity"])


def width(run):
    """Of the kernel as the variant means it, m; a twin may break it."""
    return 0.01 if "narrow" in run.variant else 0.015


@lru_cache(maxsize=None)
def fall(one, size, cell, kernel, times):
    return grid_fall.two_way(one, grid_fall.Box(size, cell, kernel), FORCES, np.array(times), steps=400)


def theory(run, t, size=None):
    """Linear theory of a two-way sphere in a box that is periodic sideways: the run's own, or `size`."""
    scene = run.scene
    return fall(sphere(scene), size or tuple(scene["domain"]["size"]), scene["fluid"]["spacing"], width(run), tuple(np.asarray(t, float)))


@lru_cache(maxsize=None)
def law_alone(one, times):
    return released_sphere.speed_without_history(one, np.array(times), True)


def by_law(scene, t):
    """v [nt] with drag, buoyancy and virtual mass in unbounded fluid at rest."""
    return law_alone(sphere(scene), tuple(np.asarray(t, float)))


@lru_cache(maxsize=None)
def with_history(one, end):
    """(t, v) with the history kernel of Mei & Adrian (1992), unbounded."""
    t = np.linspace(0.0, end, 801)
    return t, released_sphere.speed_with_history(one, t, released_sphere.mei_adrian_weights)


def plane_wall_factor(height):
    """Drag of a sphere that approaches a plane over Stokes' drag; height of its centre in radii. Brenner (1961), Chem. Eng. Sci. 16, 242;
    at cosh(1) = 1.5431 radii it is 3.036 (his Table)."""
    alpha = math.acosh(height)
    n = np.arange(1, 200)
    odd = 2.0 * n + 1.0
    small = odd * alpha < 300.0
    n, odd = n[small], odd[small]
    term = (2.0 * np.sinh(odd * alpha) + odd * math.sinh(2.0 * alpha)) / (4.0 * np.sinh(0.5 * odd * alpha) ** 2 - odd**2 * math.sinh(alpha) ** 2) - 1.0
    return 4.0 / 3.0 * math.sinh(alpha) * float((n * (n + 1.0) / ((odd - 2.0) * (odd + 2.0))) @ term)


def speed(run):
    t, v = run.series("velocity")
    return t, -np.ravel(v)


def falling(run):
    """(t, v) while the sphere falls: before it touches the bottom."""
    (t, v), (_, z) = speed(run), run.series("height")
    before = np.ravel(z) > 0.5 * run.scene["grains"]["diameter"] + 1e-4
    last = int(np.argmin(before)) if not before.all() else len(t)
    return t[:last], v[:last]


def wake(run, t):
    """What two-way coupling adds in open fluid, by theory, m/s: nothing when one-way."""
    if run.scene["coupling"]["direction"] == "one_way":
        return np.zeros(len(t))
    return theory(run, t, OPEN).v - by_law(run.scene, t)


def without_wake(run):
    """(t, v): what the coupling adds in open fluid taken out, so that the law and the walls are left."""
    t, v = falling(run)
    return t, v - wake(run, t)


def when_halfway(run):
    """Time at which the sphere has fallen half of its way to the bottom: later than wake and walls need to build up, well before the bottom."""
    (t, _), (_, z) = falling(run), run.series("height")
    z = np.ravel(z)[: len(t)]
    return float(np.interp(-0.5 * (z[0] + 0.5 * run.scene["grains"]["diameter"]), -z, t))


def halfway(run):
    """Speed without the wake at that time."""
    return float(np.interp(when_halfway(run), *without_wake(run)))


def missing_history(run):
    """What Mei and Adrian's history still takes off the law's speed at that time, by theory in open fluid, m/s."""
    t, v = with_history(sphere(run.scene), run.scene["time"]["end"])
    return float(np.interp(when_halfway(run), t, by_law(run.scene, t) - v))


def at_gap(run, gap):
    """Speed at `gap` diameters above the bottom over the greatest."""
    (t, v), (_, z) = falling(run), run.series("height")
    d = run.scene["grains"]["diameter"]
    return float(np.interp(-(0.5 + gap) * d, -np.ravel(z)[: len(t)], v)) / float(v.max())


# --- the judge's interface ---


def measure(quantity, run):
    t, v = falling(run)
    if quantity == "speed":
        return t, v
    if quantity == "u_max":
        return float(v.max())
    if quantity == "without_wake":
        return halfway(run)
    if quantity == "near_bottom":
        return at_gap(run, 0.5)
    if quantity == "time_95":
        return released_sphere.time_to_share(t, np.append(v[: int(v.argmax())], v.max()))
    u_t = sphere(run.scene).terminal_speed()
    if quantity == "walls":
        return 1.0 - halfway(run) / u_t
    expected = theory(run, t)
    return float(np.max(np.abs(v - expected.v))) / max(SHARE * float(np.max(np.abs(expected.u))), FLOOR * u_t)


def reference(quantity, scene, t):
    row = row_of(scene)
    if quantity == "speed":
        return by_law(scene, t)
    if quantity in ("u_max", "without_wake"):
        return {"value": MEASURED["u_max"][row], "uncertainty": math.hypot(IMAGING, OF_LAW) * MEASURED["u_max"][row]}
    if quantity == "near_bottom":
        return 1.0 / plane_wall_factor(2.0)
    if quantity == "time_95":
        return released_sphere.time_to_share(*with_history(sphere(scene), scene["time"]["end"]))
    return 0.0


# --- the page ---


def table_row(run):
    row, (t, v) = row_of(run.scene), falling(run)
    u_t, measured = sphere(run.scene).terminal_speed(), MEASURED["u_max"][row]
    closed = not any(run.scene["domain"]["periodic"])
    two_way = run.scene["coupling"]["direction"] == "two_way"
    cleaned = halfway(run) if closed else 0.0
    rising = np.append(v[: int(v.argmax())], v.max())
    return [
        MEASURED["experiment"][row], run.variant, f"{1e3 * run.scene['fluid']['spacing']:g}", f"{1e3 * width(run):g}" if two_way else "",
        f"{v.max():.4f}", f"{v.max() / u_t:.3f}", f"{100 * (v.max() / measured - 1.0):+.1f} %" if closed or not two_way else "",
        f"{100 * (theory(run, t).v.max() / u_t - 1.0):+.1f} %" if two_way and not closed else "",
        f"{cleaned:.4f}" if closed and two_way else "", f"{100 * (cleaned / measured - 1.0):+.1f} %" if closed and two_way else "",
        f"{100 * ((cleaned - missing_history(run)) / measured - 1.0):+.1f} %" if closed and two_way else "",
        f"{released_sphere.time_to_share(t, rising):.2f}", f"{at_gap(run, 0.5):.2f}" if closed and two_way else "",
    ]


def table(runs):
    known = [f"{MEASURED['experiment'][k]}: measured u_max {MEASURED['u_max'][k]:g} m/s, u_infinity of its correlation {MEASURED['u_infinity'][k]:g} m/s" for k in (0, 1)]
    return {
        "columns": ["", "run", "cells, mm", "kernel, mm", "greatest speed, m/s", "over the law's", "off measured", "theory, over the law's", "own wake taken out, halfway, m/s", "off measured", "and history by theory, off measured", "95 % time, s", "at d/2 above the bottom, over the greatest"],
        "rows": [table_row(run) for run in runs],
        "caption": "; ".join(known) + f". Schiller and Naumann's law alone: {', '.join(f'{law_speed(k):.4f}' for k in (0, 1))} m/s. Near the bottom "
        f"quasi-steady creeping flow has {1.0 / plane_wall_factor(2.0):.2f} (Brenner 1961).",
    }


def law_speed(row):
    return released_sphere.Sphere(LAW, 1120.0, 0.015, MEASURED["rho"][row], MEASURED["mu"][row]).terminal_speed()


def figures(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 4.2), layout="constrained")
    styles = {"": ("C3", "-", "two-way in the box"), "_one_way": ("0.5", "-", "one-way"), "_slip": ("C1", "-", "two-way, walls that slip"), "_wide": ("C0", "-", "two-way, wide box")}
    for row, axes in enumerate(figure.subplots(1, 2)):
        name, chosen = MEASURED["experiment"][row], {run.variant: run for run in runs if row_of(run.scene) == row}
        for suffix, (colour, line, label) in styles.items():
            run = chosen.get(name.lower() + suffix)
            if run is None:
                continue
            axes.plot(*falling(run), colour, ls=line, label=label)
            if suffix in ("_slip", "_wide"):
                t = falling(run)[0]
                axes.plot(t, theory(run, t).v, colour, ls="--", label="linear theory of it")
            if suffix == "":
                axes.plot(*without_wake(run), "C2", label="in the box, own wake taken out")
                axes.plot(*with_history(sphere(run.scene), run.scene["time"]["end"]), "k:", label="law with Mei-Adrian history, unbounded")
        axes.axhline(MEASURED["u_max"][row], color="k", lw=0.8)
        axes.axhspan(*(MEASURED["u_max"][row] * (1.0 + s * IMAGING) for s in (-2, 2)), color="0.85", label="measured greatest speed")
        axes.set(xlabel="time [s]", ylabel="speed [m/s]", title=name, ylim=(0.0, None))
    figure.axes[0].legend(fontsize="x-small", loc="lower right")
    return [("speed", figure, "Speed of the falling sphere until it touches the bottom; cells of 10 mm, kernel 15 mm.")]
