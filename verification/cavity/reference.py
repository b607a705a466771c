"""Lid-driven square cavity: published and recomputed profiles on the centre lines, and comparison with them (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import tables  # noqa: E402
from theory.local_fit import fitted  # noqa: E402

EXTREMES = ("u_min", "v_max", "v_min")
UNITS = {name: "1" for name in ("u_vertical", "v_horizontal", "u_ghia", "v_ghia", "drift", *EXTREMES)}
AXES = {"u_vertical": "node", "v_horizontal": "node", "u_ghia": "row", "v_ghia": "row"}

FILES = {"u": ("u_on_vertical_line.csv", "y"), "v": ("v_on_horizontal_line.csv", "x")}
# (component, Re, place): not comparable. The first is known; the second stands out by 1.1e-3 against neighbours right to 1e-4.
MISPRINTS = {("v", 400, 0.9063), ("u", 100, 0.0703)}
FIT_RADIUS = 3.0  # spacings; some 28 particles inside, 14 beside a wall, for the six coefficients of a parabola
VOID = 2.0  # in place of u/U and v/U, more than U away from everything in the cavity but the lid
NODES = 33  # places of u_vertical and v_horizontal: j/32, walls included

# Botella & Peyret (1998), Computers & Fluids 27, 421, spectral, lid +x; values as quoted by several public codes: (value, place).
BOTELLA_PEYRET_1000 = {"u_min": (-0.3885698, 0.1717), "v_max": (0.3769447, 0.1578), "v_min": (-0.5270771, 0.9092)}
SPECTRAL_100 = {"u_min": -0.2140424, "v_max": 0.1795728, "v_min": -0.2538030}  # quoted in the same places, origin not seen


def reynolds(scene):
    """Re = U L/nu, a whole number; L = size[0], U the speed of the wall that moves."""
    fluid = scene["fluid"]
    speed = lid_speed(scene)
    return round(speed * scene["domain"]["size"][0] * fluid["density"] / fluid["viscosity"])


def lid_speed(scene):
    """m/s; the one wall with a velocity is the lid, y = size[1]."""
    return max(abs(wall["velocity"][0]) for wall in scene["wall"] if "velocity" in wall)


def ghia(component, re, exclude=True):
    """(places, values) of Ghia, Ghia & Shin (1982), from the far wall down, walls included, without the misprints."""
    file, place = FILES[component]
    rows = tables.table(f"ghia_1982/{file}")
    s, values = rows[place], rows[f"{component}_re_{re}"]
    keep = np.array([not exclude or (component, re, float(x)) not in MISPRINTS for x in s])
    grid = np.round(s[keep] * 128.0) / 128.0  # the printed places are these, rounded to four digits
    return grid, values[keep]


def profile(component, re):
    """Spline through the recomputed profile (reference_data/cavity_flow), a function of the place in [0, 1]."""
    file, place = FILES[component]
    rows = tables.table(f"cavity_flow/{file}")
    return CubicSpline(rows[place], rows[f"{component}_re_{re}"])


def extreme(name, re):
    """(value, place) of u_min, v_max or v_min of the recomputed profile."""
    spline = profile(name[0], re)
    turns = spline.derivative().roots(extrapolate=False)
    values = spline(turns)
    best = int(np.argmin(values) if name.endswith("min") else np.argmax(values))
    return float(values[best]), float(turns[best])


def profile_norms(component, re, s, values):
    """{"l1", "l2", "linf"} of values [n] (over U) on a centre line at places s [n] (over L) against the recomputed profile."""
    error = np.abs(np.asarray(values, float) - profile(component, re)(np.asarray(s, float)))
    if not np.all(np.isfinite(error)):
        return {"l1": math.inf, "l2": math.inf, "linf": math.inf}
    return {"l1": float(np.mean(error)), "l2": float(np.sqrt(np.mean(error**2))), "linf": float(np.max(error))}


def on_line(x, v, axis, length, width):
    """(s, component) of the particles within `width` of the centre line along `axis` (1: u on x = L/2, 0: v on y = L/2), sorted.

    No smoothing: the slope across the line times width is the error, so width is about half a spacing.
    """
    x, v = np.asarray(x, float), np.asarray(v, float)
    near = np.abs(x[:, 1 - axis] - 0.5 * length) <= width
    order = np.argsort(x[near, axis])
    return x[near, axis][order] / length, v[near, 1 - axis][order]


def reference(quantity, scene, t):
    re = reynolds(scene)
    if quantity in ("u_vertical", "v_horizontal"):
        return profile(quantity[0], re)(np.linspace(0.0, 1.0, NODES))
    if quantity in ("u_ghia", "v_ghia"):
        return ghia(quantity[0], re)[1]
    if quantity in EXTREMES:
        return extreme(quantity, re)[0]
    if quantity in ("drift", "lines_rms"):
        return 0.0
    raise KeyError(quantity)


def at_places(scene, snapshot, component, s):
    """u (v) over U at the places s [n] over L of the vertical (horizontal) centre line: from a grid by splines, from particles
    by local_fit.

    A place in a void, with too few particles to fit, has no velocity: what is there is not the flow, and VOID stands for it.
    """
    if "grid" in snapshot:
        return grid_line(scene, snapshot["grid"], component, s)
    fluid = snapshot["fluid"]
    length, spacing = scene["domain"]["size"][0], scene["fluid"]["spacing"]
    middle = np.full(len(s), 0.5)
    places = np.stack((middle, s) if component == "u" else (s, middle), axis=1) * length
    values = np.asarray(fluid["v"])[:, "uv".index(component)] / lid_speed(scene)
    return np.array([fitted_or_void(fluid["x"], values, place, FIT_RADIUS * spacing) for place in places])


def fitted_or_void(x, values, place, radius):
    """local_fit at one place, VOID where it has too few particles."""
    try:
        return fitted(x, values, place[None, :], radius)[0]
    except ValueError:
        return VOID


def grid_line(scene, grid, component, s):
    """The same from velocities on faces: splines across the line, then along it with the walls' own velocities at its ends."""
    length, speed = scene["domain"]["size"][0], lid_speed(scene)
    faces, values = grid["nodes_" + "xy"["uv".index(component)]], grid["u_" + "xy"["uv".index(component)]][0]
    other = grid["nodes_y" if component == "u" else "nodes_x"]
    middle = CubicSpline(faces, values, axis=1 if component == "u" else 0)(0.5 * length)
    places = np.concatenate(([0.0], 0.5 * (other[1:] + other[:-1]), [length])) / length
    ends = (0.0, speed) if component == "u" else (0.0, 0.0)
    return CubicSpline(places, np.concatenate(([ends[0]], middle, [ends[1]])))(s) / speed


def last_third(run):
    """Numbers of the snapshots, from the end, that are judged."""
    return range(-(len(run.snapshot_files()) // 3), 0)


def mean_at_places(run, component, s):
    """at_places averaged over the last third of the run's outputs: the noise of disordered particles never dies."""
    return np.mean([at_places(run.scene, run.snapshot(k), component, s) for k in last_third(run)], axis=0)


def nodes_of(run, k):
    """[2, NODES]: u and v over U at the nodes of their centre lines in the k-th snapshot."""
    s, snapshot = np.linspace(0.0, 1.0, NODES), run.snapshot(k)
    return np.array([at_places(run.scene, snapshot, component, s) for component in "uv"])


def drift(run):
    """Greatest change of an inner node's value, over U, in any tenth of the run that ends in its last third.

    Nodes on the walls are left out: there the fluid's velocity is given, and the parabola extrapolates from one side.
    """
    tenth = len(run.snapshot_files()) // 10
    return max(float(np.max(np.abs(nodes_of(run, k) - nodes_of(run, k - tenth))[:, 1:-1])) for k in last_third(run))


def measure(quantity, run):
    if quantity == "drift":
        return drift(run)
    if quantity == "lines_rms":
        return root_mean_square_error(run)
    if quantity in ("u_vertical", "v_horizontal"):
        return np.arange(NODES), mean_at_places(run, quantity[0], np.linspace(0.0, 1.0, NODES))
    if quantity in ("u_ghia", "v_ghia"):
        s = ghia(quantity[0], reynolds(run.scene))[0]
        return np.arange(len(s)), mean_at_places(run, quantity[0], s)
    if quantity in EXTREMES:
        values = mean_at_places(run, quantity[0], np.linspace(0.02, 0.98, 193))  # parabolas between these are good to 1e-5
        return float(np.min(values) if quantity.endswith("min") else np.max(values))
    return NotImplemented


def root_mean_square_error(run):
    """Of u and v over U at the nodes against the recomputed profiles."""
    nodes = np.linspace(0.0, 1.0, NODES)
    errors = [mean_at_places(run, c, nodes) - profile(c, reynolds(run.scene))(nodes) for c in "uv"]
    return float(np.sqrt(np.mean(np.square(errors))))


def table(runs):
    """Accuracy, steadiness and cost of every run."""
    rows = []
    for run in runs:
        if run.failure is None:
            side = 1.0 / run.scene["fluid"]["spacing"]
            rows.append([run.variant, f"{side:.0f}", f"{root_mean_square_error(run):.4f}", f"{drift(run):.4f}", f"{run.info['cpu_s']:.1f}"])
    columns = ["variant", "particles to a side", "error (rms, of U)", "drift (of U)", "CPU (s)"]
    return {"columns": columns, "rows": rows, "caption": "Error of the mean over the last third of the run on both centre lines; drift is the greatest change in a tenth of the run there."}


def figures(runs):
    """Both centre lines of the finest run of every Reynolds number, with the recomputed profile and Ghia's tables."""
    import matplotlib.pyplot as plt

    swept = [run for run in runs if run.variant.startswith("re_")]
    finest = {reynolds(run.scene): run for run in sorted(swept, key=lambda run: -run.scene["fluid"]["spacing"]) if run.failure is None}
    figure, axes = plt.subplots(2, len(finest), figsize=(3.2 * len(finest), 5.6), squeeze=False)
    s, fine = np.linspace(0.0, 1.0, NODES), np.linspace(0.0, 1.0, 201)
    for column, (re, run) in enumerate(sorted(finest.items())):
        for row, component in enumerate("uv"):
            axis, places = axes[row][column], ghia(component, re)
            axis.plot(fine, profile(component, re)(fine), "k-", lw=0.8, label="recomputed")
            axis.plot(*places, "o", mfc="none", ms=4, color="C1", label="Ghia et al.")
            axis.plot(s, mean_at_places(run, component, s), ".", ms=4, color="C0", label=f"{1.0 / run.scene['fluid']['spacing']:.0f} to a side")
            axis.set(xlabel="$y/L$" if component == "u" else "$x/L$", title=f"Re {re}: ${component}/U$")
            axis.legend(fontsize=6)
    figure.tight_layout()
    return [("centre_lines", figure, "u on the vertical and v on the horizontal centre line, finest run of each Reynolds number.")]
