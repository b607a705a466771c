"""Measured speeds of Mordant & Pinton (2000) and the equation of motion, solved independently of the solver (README.md)."""

import math
import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from drag_laws.drag_laws import ONE_SPHERE  # noqa: E402
from tables import table as data_table  # noqa: E402
from theory import released_sphere, water  # noqa: E402

MEASURED = data_table("mordant_pinton_2000/terminal_velocity.csv")
PUBLISHED = data_table("mudcake_ddpm_dem/terminal_velocity.csv")["u_simulated"]
NAMES = [f"{material} {1e3 * d:g} mm" for material, d in zip(MEASURED["material"], MEASURED["d"])]
TIMED = slice(0, 2)  # spheres with a measured 95 % time
ROWS = {  # spheres of each quantity; small: Re < 800
    "terminal": slice(0, 5), "terminal_published": slice(0, 5), "terminal_small": slice(0, 3), "terminal_large": slice(3, 5),
}
UNITS = dict.fromkeys(ROWS, "m/s") | {"time_95": "s", "deviation_above_re_300": "1"}

# Half widths of the measurement's unknowns; each is taken as a rectangular distribution (divided by sqrt 3).
CELSIUS, CELSIUS_HALF = 25.0, 2.5  # water temperature, from the printed Reynolds numbers
DENSITY_HALF = 5.0  # kg/m3, printed 2560 and 7710
DIAMETER_HALF = 0.05e-3  # m, printed to 0.1 mm


# --- the measurement's uncertainty ---


def sensitive_speed(row, celsius=CELSIUS, rho_p=0.0, d=0.0):
    """Terminal speed under Brown & Lawler at changed conditions; only its differences are used."""
    grain = (MEASURED["rho_p"][row] + rho_p, MEASURED["d"][row] + d)
    fluid = (water.density(celsius), water.viscosity(celsius))
    return released_sphere.Sphere(ONE_SPHERE["brown_lawler"], *grain, *fluid).terminal_speed()


@lru_cache(maxsize=None)
def budget(row):
    """Standard uncertainties of the measured speed by cause, m/s."""
    change = {
        "temperature": sensitive_speed(row, CELSIUS + CELSIUS_HALF) - sensitive_speed(row, CELSIUS - CELSIUS_HALF),
        "density": sensitive_speed(row, rho_p=DENSITY_HALF) - sensitive_speed(row, rho_p=-DENSITY_HALF),
        "diameter": sensitive_speed(row, d=DIAMETER_HALF) - sensitive_speed(row, d=-DIAMETER_HALF),
    }
    parts = {cause: abs(value) / 2.0 / math.sqrt(3.0) for cause, value in change.items()}
    parts["digits"] = MEASURED["u_t_half_digit"][row] / math.sqrt(3.0)
    return parts


def uncertainty(row, without=()):
    """Combined standard uncertainty of the measured speed, m/s."""
    return math.sqrt(sum(value**2 for cause, value in budget(row).items() if cause not in without))


# --- the equation of motion ---


def law_of(name):
    """The drag law a scene means; a planted fault is named <law>_<fault>."""
    return max((law for law in ONE_SPHERE if name.startswith(law)), key=len)


@lru_cache(maxsize=None)
def solved(law, rho_p, d, rho, mu, forces, end, count):
    """Speed downwards of one sphere at `count` even times up to `end`, m/s."""
    sphere = released_sphere.Sphere(ONE_SPHERE[law], rho_p, d, rho, mu)
    times = np.linspace(0.0, end, count)
    if "basset" in forces:
        return released_sphere.speed_with_history(sphere, times)
    return released_sphere.speed_without_history(sphere, times, "virtual_mass" in forces)


def speeds(scene, t):
    """Speeds downwards [nt, 5] of the scene's spheres. Forces without their own equation here are refused."""
    forces, fluid = tuple(sorted(scene["coupling"]["forces"])), scene["fluid"]
    if set(forces) - {"buoyancy", "virtual_mass", "basset"} or "buoyancy" not in forces:
        raise ValueError(f"no reference for the forces {forces}")
    law, common = law_of(scene["coupling"]["drag"]), (fluid["density"], fluid["viscosity"], forces, float(t[-1]), len(t))
    return np.array([solved(law, group["density"], group["diameter"], *common) for group in scene["grains"]]).T


# --- the judge's interface ---


def measure(quantity, run):
    if quantity == "velocity":
        t, v = run.series("velocity")
        return t, -v
    t, v = run.series("velocity")
    if quantity == "time_95":
        return t[-1:], np.array([[released_sphere.time_to_share(t, -v[:, row]) for row in range(5)]])[:, TIMED]
    final = -v[-1:]
    if quantity == "deviation_above_re_300":
        return t[-1:], final[:, 1:] / MEASURED["u_t"][1:] - 1.0
    return t[-1:], final[:, ROWS[quantity]]


def reference(quantity, scene, t):
    if quantity == "velocity":
        return speeds(scene, t)
    if quantity == "time_95":
        return MEASURED["time_95"][None, TIMED]
    if quantity == "terminal_published":
        return PUBLISHED[None, :]
    rows = ROWS[quantity]
    return {"value": MEASURED["u_t"][None, rows], "uncertainty": np.array([[uncertainty(row) for row in range(5)]])[:, rows]}


# --- what the page says ---

LAWS = tuple(ONE_SPHERE)
TRANSIENT = {"": "drag only", "_added_mass": "with virtual mass", "_history": "with virtual mass and Basset force"}


def finest(runs):
    """{variant: its finest run}."""
    return {run.variant: run for run in runs}  # runs are ordered coarse to fine


def with_finite_re_history(law, row, times):
    """Speed with the history kernel of Mei & Adrian (1992), which the solver does not have, m/s."""
    sphere = released_sphere.Sphere(ONE_SPHERE[law], MEASURED["rho_p"][row], MEASURED["d"][row], 997.05, 9.01333e-4)
    return released_sphere.speed_with_history(sphere, times, released_sphere.mei_adrian_weights)


def deviations(speed):
    """(relative, in standard uncertainties) deviations of five speeds from the measured ones."""
    difference = np.asarray(speed) - MEASURED["u_t"]
    return difference / MEASURED["u_t"], difference / np.array([uncertainty(row) for row in range(5)])


def root_mean_square(values):
    return math.sqrt(float(np.mean(np.square(values))))


def speed_row(name, speed):
    """One row of the table: speed, error in per cent and in standard uncertainties for every sphere, and their means."""
    relative, sigma = deviations(speed)
    cells = [f"{v:.4f} ({100 * r:+.1f} %, {s:+.1f} u)" for v, r, s in zip(speed, relative, sigma)]
    return [name, *cells, f"{100 * root_mean_square(relative):.1f} %", f"{root_mean_square(sigma):.1f} u"]


def time_row(law, last):
    """95 % times under one law with the three sets of forces."""
    cells = []
    for row in range(5):
        series = [last[law + suffix].series("velocity") for suffix in TRANSIENT if law + suffix in last]
        cells.append(" / ".join(f"{released_sphere.time_to_share(t, -v[:, row]):.3f}" for t, v in series))
    return [f"95 % time, {law}, s", *cells, "", ""]


def table(runs):
    last = finest(runs)
    laws = [law for law in LAWS if law in last]
    final = {law: -last[law].series("velocity")[1][-1] for law in laws}
    times = np.linspace(0.0, 1.5, 1501)
    measured = [f"{u:g} +- {uncertainty(i):.2g}" for i, u in enumerate(MEASURED["u_t"])]
    narrow = [f"+- {uncertainty(i, without=('diameter',)):.2g}" for i in range(5)]
    modern = [with_finite_re_history("brown_lawler", i, times) for i in range(5)]
    modern = [f"{released_sphere.time_to_share(times, v):.3f}" for v in modern]
    known = ["" if np.isnan(time) else f"{time:.3f}" for time in MEASURED["time_95"]]
    rows = [
        ["Reynolds number, measured", *(f"{re:g}" for re in MEASURED["re"]), "", ""],
        ["measured, m/s", *measured, "", ""],
        ["its uncertainty if the diameter were exact", *narrow, "", ""],
        speed_row("published simulation", PUBLISHED),
        *(speed_row(law, final[law]) for law in laws),
        ["95 % time, measured, s", *known, "", ""],
        *(time_row(law, last) for law in laws if law != "stokes"),
        ["95 % time, brown_lawler, Mei-Adrian history, s", *modern, "", ""],
    ]
    caption = verdict({law: final[law] for law in laws if law != "stokes"})
    return {"columns": ["", *NAMES, "rms", "rms"], "rows": rows, "caption": caption}


def verdict(final):
    """Which law wins, and by how much, as two sentences."""
    per_cent = sorted((100.0 * root_mean_square(deviations(v)[0]), law) for law, v in final.items())
    in_u = sorted((root_mean_square(deviations(v)[1]), law) for law, v in final.items())
    without = sorted((100.0 * root_mean_square(deviations(v)[0][1:]), law) for law, v in final.items())
    return (
        f"In units of the measurement's uncertainty u, {in_u[0][1]} wins: {in_u[0][0]:.1f} u root mean square over the five "
        f"spheres, against {in_u[1][0]:.1f} u for {in_u[1][1]}, the second. In per cent {per_cent[0][1]} has "
        f"{per_cent[0][0]:.1f} % and {per_cent[1][1]} {per_cent[1][0]:.1f} %; without the 0.5 mm sphere, whose diameter is "
        f"known to one digit, {without[0][1]} has {without[0][0]:.1f} % and {without[1][1]} {without[1][0]:.1f} %. "
        "Published means another group's simulation, not truth. "
        "95 % times: drag only / with virtual mass / with virtual mass and Basset's force. Stokes' row holds the speeds at "
        "1.5 s, when the larger spheres are still far from Stokes' terminal speed."
    )


def figures(runs):
    """The transients of the two glass spheres under Brown & Lawler."""
    from matplotlib.figure import Figure

    last = finest(runs)
    figure = Figure(figsize=(9.0, 3.8), layout="constrained")
    for row, axes in enumerate(figure.subplots(1, 2)):
        for suffix, label in TRANSIENT.items():
            if "brown_lawler" + suffix in last:
                t, v = last["brown_lawler" + suffix].series("velocity")
                axes.plot(t, -v[:, row], label=label)
        t = np.linspace(0.0, 1.5, 1501)
        axes.plot(t, with_finite_re_history("brown_lawler", row, t), "k--", label="with Mei-Adrian history (theory)")
        speed = 0.95 * MEASURED["u_t"][row]
        when, bar = MEASURED["time_95"][row], 0.95 * uncertainty(row)
        axes.errorbar(when, speed, yerr=bar, fmt="o", color="0.3", label="measured 95 % time")
        axes.set(xlabel="time [s]", ylabel="speed [m/s]", title=NAMES[row], xlim=(0.0, 4.0 * when))
    axes.legend(fontsize="small")
    caption = "Brown and Lawler's drag with three sets of forces, and with the history kernel of Mei and Adrian."
    return [("transients", figure, caption)]
