"""Liquid bridges: their force over the separation, where they break, which impacts and which weights they hold.

The numbers of the materials are stated here and not read from the scene, so that a scene which says something else
fails. `python3 reference.py` writes meeting.csv, parting.csv and hanging.csv, the initial states.
"""

import sys
from functools import lru_cache
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from young_laplace import stable_branch  # noqa: E402

DENSITY = 2500.0     # kg/m3
STIFFNESS = 1000.0   # k, N/m
TENSION = 0.072      # gamma, N/m
ANGLE = 0.35         # theta, rad
VOLUME = 1.25e-13    # V, m3
GRAVITY = 9.81       # m/s2, of the variant that hangs
CEILING = 0.1        # m

PARTING, NEAR = 200, 56  # pairs well above the sticking speed, and pairs around it
PAIRS = PARTING + NEAR
NEAREST = 0.02           # the latter are within 2 % of it
CELL = 6e-3              # room of a pair, m

PULLED = {"equal": (5e-4, 5e-4), "unequal": (5e-4, 1.5e-3), "wall": (5e-4, np.inf)}  # radii, m
PULL_SPEED = 0.5         # m/s at first
TOUCH = 1e-9             # overlap at the start of the pulled pairs, m

BOND = np.array([0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.995, 0.999,
                 1.001, 1.005, 1.01, 1.02, 1.05, 1.1, 1.2, 1.4, 1.7, 2.0])  # of the grains under the ceiling
HUNG = 1e-10             # their overlap at the start, m

UNITS = {"force_equal": "N", "force_unequal": "N", "force_wall": "N", "young_laplace": "N", "rupture": "m",
         "parting_speed": "m/s", "sticking_speed": "1", "error_size": "1", "hangs": "1", "hanging_overlap": "m",
         "fall_work": "1"}
AXES = {name: "separation (m)" for name in ("force_equal", "force_unequal", "force_wall", "young_laplace")}
AXES |= {"hangs": "Bo (-)", "hanging_overlap": "Bo (-)", "fall_work": "Bo (-)"}


def reduced(first, second):
    """Derjaguin's radius 2 R1 R2/(R1 + R2) in m; R2 = inf is a plane."""
    return 2 / (1 / first + 1 / second)


def attraction(s, radius):
    """Equation (1) of the README without rupture [N]."""
    scaled = s * np.sqrt(radius / VOLUME)
    return 2 * np.pi * radius * TENSION * np.cos(ANGLE) / (1 + 1.05 * scaled + 2.5 * scaled**2)


def rupture():
    """Separation at which a bridge breaks, equation (2) [m]."""
    return (1 + ANGLE / 2) * VOLUME**(1 / 3)


def work(radius, s=None):
    """Work of pulling a bridge from contact to the separation s, or to rupture: equation (3) [J]."""
    scale = np.sqrt(radius / VOLUME)
    root = np.sqrt(4 * 2.5 - 1.05**2)
    reach = scale * (rupture() if s is None else s)
    turn = np.arctan((5 * reach + 1.05) / root) - np.arctan(1.05 / root)
    return 2 * np.pi * radius * TENSION * np.cos(ANGLE) * 2 / root * turn / scale


def read(name):
    """Centres [n, 3], diameters [n] and velocities [n, 3] of an initial state."""
    table = np.loadtxt(Path(__file__).parent / f"{name}.csv", delimiter=",", skiprows=1)
    return table[:, :3], table[:, 3], table[:, 4:]


def mass(radius):
    return DENSITY * 4 / 3 * np.pi * radius**3


def quasi_random(count, dimensions):
    """Evenly spread numbers in [0, 1): multiples of square roots of primes, modulo 1 (Weyl 1916)."""
    return np.outer(np.arange(1, count + 1), np.sqrt([2, 3, 5, 7, 11][:dimensions])) % 1.0


# Meeting pairs --------------------------------------------------------------------------------------------------------

def approach_over_sticking():
    """Speed of approach over the sticking speed [n]: 1.15 to 2.15, then both sides of 1."""
    far = 1.15 + (np.arange(PARTING) * 0.6180339887498949) % 1
    near = 1 + NEAREST * (2 * (np.arange(NEAR) + 0.5) / NEAR - 1)
    return np.concatenate([far, near])


def meeting_state():
    """Centres [2, n, 3], diameters [2, n] and velocities [2, n, 3] of the pairs."""
    u = quasi_random(PAIRS, 5)
    diameter = np.array([1e-3 * (1 + 0.3 * u[:, 0]), 1.5e-3 * (1 + 0.3 * u[:, 1])])
    radius = diameter / 2
    speed = approach_over_sticking() * sticking_speed(radius)
    gap = speed * (3e-5 + 5e-5 * u[:, 2])
    height, azimuth = 2 * u[:, 3] - 1, 2 * np.pi * u[:, 4]
    ring = np.sqrt(1 - height**2)
    axis = np.stack([ring * np.cos(azimuth), ring * np.sin(azimuth), height], axis=1)  # from the first to the second
    place = np.stack(np.unravel_index(np.arange(PAIRS), (8, 8, 4)), axis=1)
    middle = CELL * (place + 0.5)
    apart = (gap + radius.sum(axis=0))[:, None] * axis
    share = (mass(radius) / mass(radius).sum(axis=0))[:, :, None]  # the pair's centre of mass stays where it is
    approach = speed[:, None] * axis
    return (np.stack([middle - share[1] * apart, middle + share[0] * apart]), diameter,
            np.stack([share[1] * approach, -share[0] * approach]))


def effective(radius):
    """m* [n] in kg of pairs with these radii [2, n]."""
    m = mass(radius)
    return m[0] * m[1] / m.sum(axis=0)


def sticking_speed(radius):
    """sqrt(2 W/m*) [n] of pairs with these radii [2, n]: equation (4)."""
    return np.sqrt(2 * work(reduced(*radius)) / effective(radius))


@lru_cache
def meeting():
    """Radii [2, n], speed of approach [n] and sticking speed [n] as the solver reads them."""
    x, diameter, v = (part.reshape(PAIRS, 2, -1).transpose(1, 0, 2) for part in read("meeting"))
    radius = diameter[..., 0] / 2
    return radius, np.linalg.norm(v[1] - v[0], axis=1), sticking_speed(radius)


def meeting_end(run):
    """Separation [n] and speed of parting [n] at the end."""
    grains = run.snapshot(-1)["grains"]
    order = np.argsort(grains["id"])
    x, v = (grains[name][order].reshape(PAIRS, 2, 3).transpose(1, 0, 2) for name in ("x", "v"))
    apart = x[1] - x[0]
    distance = np.linalg.norm(apart, axis=1)
    return distance - meeting()[0].sum(axis=0), np.sum((v[1] - v[0]) * apart, axis=1) / distance


def measured_sticking(run):
    """Sticking speed over the predicted one: between the fastest pair that sticks and the slowest that parts."""
    parted = (meeting_end(run)[0] > rupture())[PARTING:]
    factor = (meeting()[1] / meeting()[2])[PARTING:]
    if parted.all() or not parted.any():
        return np.nan
    return float((factor[~parted].max() + factor[parted].min()) / 2)


def predicted_errors(dt):
    """Error of the parting speed that one step makes at each end of the bridge's life [n], root mean square over the
    phases in the step: equation (9) of the README, in m/s."""
    radius, speed, sticking = (part[..., :PARTING] for part in meeting())
    m, r = effective(radius), reduced(*radius)
    parting = np.sqrt(speed**2 - sticking**2)
    first, last = attraction(0.0, r) / m * speed / parting, attraction(rupture(), r) / m
    return dt * np.sqrt((first**2 + last**2) / 12)


def parting_error(run):
    """Root mean square of the error of the parting speed over that of the speed."""
    speed, expected = measure("parting_speed", run)[1], reference("parting_speed", run.scene, None)
    return float(np.linalg.norm(speed - expected) / np.linalg.norm(expected))


def predicted_parting_error(dt):
    return float(np.linalg.norm(predicted_errors(dt)) / np.linalg.norm(reference("parting_speed", None, None)))


# Pulled pairs ---------------------------------------------------------------------------------------------------------

def parting_state():
    """Two grains that touch along x and part, for each pair of PULLED; then one grain at the ceiling."""
    rows = []
    for k, (first, second) in enumerate((PULLED["equal"], PULLED["unequal"])):
        y = 0.02 + 0.02 * k
        apart = first + second - TOUCH
        rows.append([0.05, y, 0.05, 2 * first, -PULL_SPEED / 2, 0.0, 0.0])
        rows.append([0.05 + apart, y, 0.05, 2 * second, PULL_SPEED / 2, 0.0, 0.0])
    radius = PULLED["wall"][0]
    rows.append([0.05, 0.07, CEILING - radius + TOUCH, 2 * radius, 0.0, 0.0, -PULL_SPEED])
    return np.array(rows)


def pulled(run, name):
    """Separation [t] in m and attraction [t] in N of one of PULLED."""
    force = run.series(f"force_{name}")[1]
    if name == "wall":
        return CEILING - run.series("z4")[1] - PULLED["wall"][0], force
    near, far = ("x0", "x1") if name == "equal" else ("x2", "x3")
    return run.series(far)[1] - run.series(near)[1] - sum(PULLED[name]), force


def young_laplace():
    """Separations [m] up to rupture and forces [N] of the equal pair, without a fit."""
    radius = PULLED["equal"][0]
    s, force = stable_branch(VOLUME / radius**3, ANGLE)
    return s * radius, force * 2 * np.pi * radius * TENSION


# Grains under the ceiling ---------------------------------------------------------------------------------------------

def hanging_radius():
    """Radii [n] with the Bond numbers BOND: m g = Bo 4 pi R gamma cos(theta)."""
    return np.sqrt(3 * TENSION * np.cos(ANGLE) * BOND / (DENSITY * GRAVITY))


def hanging_state():
    radius = hanging_radius()
    row, column = np.unravel_index(np.arange(len(BOND)), (5, 4))
    z = CEILING - radius + HUNG
    still = np.zeros_like(radius)
    return np.column_stack([0.012 + 0.018 * row, 0.012 + 0.02 * column, z, 2 * radius, still, still, still])


def hanging_end(run):
    """Separation from the ceiling [n] and speed downwards [n] at the end."""
    grains = run.snapshot(-1)["grains"]
    order = np.argsort(grains["id"])
    return CEILING - grains["x"][order, 2] - read("hanging")[1] / 2, -grains["v"][order, 2]


def fall_work(run):
    """Work that the bridges took from the falling grains over equation (3) [n]."""
    fell = BOND > 1
    depth, speed = (part[fell] for part in hanging_end(run))
    radius = read("hanging")[1][fell] / 2
    lost = mass(radius) * (GRAVITY * (depth + HUNG) - speed**2 / 2)
    start = attraction(0.0, 2 * radius) * HUNG - STIFFNESS * HUNG**2 / 2  # out of the overlap they start with
    return lost / (work(2 * radius) + start)


# What the judge asks for ----------------------------------------------------------------------------------------------

def reference(quantity, scene, t):
    """Expected values; for forces t is the separation."""
    if quantity.startswith("force_"):
        s = np.asarray(t)
        pull = attraction(np.maximum(s, 0), reduced(*PULLED[quantity.removeprefix("force_")]))
        return np.where(s <= rupture(), pull, 0.0) - STIFFNESS * np.maximum(-s, 0)
    if quantity == "young_laplace":
        return np.interp(t, *young_laplace())
    if quantity == "rupture":
        return np.full(len(PULLED), rupture())
    if quantity == "parting_speed":
        _, speed, sticking = meeting()
        return np.sqrt(speed[:PARTING]**2 - sticking[:PARTING]**2)
    if quantity == "sticking_speed":
        return 1.0
    if quantity == "total_energy":
        radius, speed, _ = meeting()
        return float(np.sum(effective(radius) * speed**2 / 2 - work(reduced(*radius))))
    if quantity == "bridges":
        return float(np.sum(meeting()[1] < meeting()[2]))
    if quantity == "hangs":
        return (BOND < 1).astype(float)
    radius = read("hanging")[1] / 2
    if quantity == "hanging_overlap":
        return ((attraction(0.0, 2 * radius) - mass(radius) * GRAVITY) / STIFFNESS)[BOND < 1]
    if quantity == "ceiling_force":
        return -float(np.sum(mass(radius)[BOND < 1])) * GRAVITY
    if quantity == "fall_work":
        return np.ones(np.sum(BOND > 1))
    raise KeyError(quantity)


def measure(quantity, run):
    """Forces over the separation, numbers of pairs or grains, or one number."""
    if quantity not in UNITS:
        return NotImplemented
    if quantity.startswith("force_"):
        return pulled(run, quantity.removeprefix("force_"))
    if quantity == "young_laplace":
        s, force = pulled(run, "equal")
        held = (s >= 0) & (s <= young_laplace()[0][-1])
        return s[held], force[held]
    if quantity == "rupture":
        last = [np.flatnonzero(pulled(run, name)[1] > 0)[-1] for name in PULLED]
        return np.arange(len(PULLED)), np.array([pulled(run, name)[0][[k, k + 1]].mean()
                                                 for name, k in zip(PULLED, last)])
    if quantity == "parting_speed":
        return np.arange(PARTING), meeting_end(run)[1][:PARTING]
    if quantity == "sticking_speed":
        return measured_sticking(run)
    if quantity == "error_size":
        return parting_error(run) / predicted_parting_error(run.scene["time"]["step"])
    depth = hanging_end(run)[0]
    if quantity == "hangs":
        return BOND, (depth < rupture()).astype(float)
    if quantity == "hanging_overlap":
        return BOND[BOND < 1], -depth[BOND < 1]
    return BOND[BOND > 1], fall_work(run)


def force_figure(run):
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    for number, (name, label) in enumerate((("equal", "R, R"), ("unequal", "R, 3R"), ("wall", "R, wall"))):
        s, force = pulled(run, name)
        line = np.linspace(0, 1.3 * rupture(), 600)
        axes.plot(1e6 * line, 1e3 * reference(f"force_{name}", None, line), "-", color=f"C{number}", lw=1)
        axes.plot(1e6 * s[::4], 1e3 * force[::4], "o", ms=3.5, color=f"C{number}", label=label)
    s, force = young_laplace()
    axes.plot(1e6 * s, 1e3 * force, "k--", lw=1, label="Young-Laplace: R, R")
    axes.set_xlim(-2, 1.3e6 * rupture())
    axes.set_xlabel("separation [um]")
    axes.set_ylabel("attraction [mN]")
    axes.legend()
    return figure


def impact_figure(run):
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    _, speed, sticking = meeting()
    gap, leaving = meeting_end(run)
    parted = gap > rupture()
    ratio = (speed / sticking)**2
    line = np.linspace(1, 4.7, 200)
    axes.plot(line, line - 1, "-", color="C0", lw=1, label="closed form")
    axes.plot([0.85, 1], [0, 0], "-", color="C0", lw=1)
    axes.plot(ratio[parted], (leaving / sticking)[parted]**2, "o", ms=3, color="C1", label="parted")
    axes.plot(ratio[~parted], np.zeros(np.sum(~parted)), "s", ms=3, color="C2", label="stuck")
    axes.set_xlabel("(speed of approach / sticking speed)$^2$ [-]")
    axes.set_ylabel("(speed of parting / sticking speed)$^2$ [-]")
    axes.legend()
    return figure


def figures(runs):
    """Force over the separation, and speed after over speed before."""
    sound = [run for run in runs if not run.failure]
    made = []
    for run in [run for run in sound if run.variant == "pulled"][-1:]:
        made.append(("force", force_figure(run), "Symbols: the solver. Lines: the closed form up to its rupture. Dashed: "
                     "the meniscus of the equation of Young and Laplace up to where it has none."))
    for run in [run for run in sound if run.variant == "meeting"][-1:]:
        made.append(("impact", impact_figure(run), "256 impacts of unequal pairs at the finest step: those that part have "
                     "lost the work of their bridge, the others stick."))
    return made


def write(name, rows):
    """Writes an initial state; the numbers keep every bit."""
    with open(Path(__file__).parent / f"{name}.csv", "w", encoding="utf-8") as file:
        file.write("x [m],y [m],z [m],diameter [m],vx [m/s],vy [m/s],vz [m/s]\n")
        for row in rows:
            file.write(",".join(repr(float(value)) for value in row) + "\n")


if __name__ == "__main__":
    x, diameter, v = meeting_state()
    write("meeting", np.concatenate([x, diameter[..., None], v], axis=2).transpose(1, 0, 2).reshape(-1, 7))
    write("parting", parting_state())
    write("hanging", hanging_state())
