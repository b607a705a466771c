"""Oblique impact of a sphere on a plane and on another sphere: slip and spin after the impact, tangential impulse.

The numbers of the materials are stated here and not read from the scene, so that a scene which says something else fails.
`python3 reference.py` writes wall.csv and pairs.csv, the initial states.
"""

from functools import cache
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

ON_PLANE, PAIRS = 1024, 256
DENSITY = 2500.0      # kg/m3
FRICTION = 0.3        # mu
RATIO = 0.8           # k_t/k of the linear spring
RESONANT_RATIO = 2 / 7
RESTITUTION = 0.7     # of the damped variants
POISSON = 0.3
YOUNG = 1e11          # Pa
SPEED = 1e-3          # normal, m/s
END = 5e-5            # s
SPIN = np.array([1.0, -1.5, 2.0])  # of the spinning variant, rad/s
CELL = 3e-3           # room of a grain or pair, m
SURFACE = 3.5         # 1/m + R^2/I in units of 1/m*: rotation makes the surface of solid spheres 7/2 times as mobile
STEPS = 4000          # of the integration of one impact: its error is below 3e-6 of mu v_n
UNITS = {"rebound_slip": "1", "rebound_spin": "1", "sliding_impulse": "1", "angular_momentum": "1"}


# ---- initial states -------------------------------------------------------------------------------------------------

def quasi_random(count, dimensions):
    """Evenly spread numbers in [0, 1): multiples of square roots of primes, modulo 1 (Weyl 1916)."""
    return np.outer(np.arange(1, count + 1), np.sqrt([2, 3, 5, 7, 11][:dimensions])) % 1.0


def incidences(count):
    """psi = slip/(mu normal speed) before the impact [count], from sticking to sliding, and azimuths of the slip."""
    u = quasi_random(count, 4)
    return 0.1 + 9.4 * u[:, 0], 2 * np.pi * u[:, 1]


def places(count):
    """Horizontal places [count, 2] on a square grid."""
    side = round(count**0.5)
    return CELL * (np.stack(np.unravel_index(np.arange(count), (side, side)), axis=1) + 0.5)


def wall_state():
    """x [n, 3], diameter [n], v [n, 3] of grains that fall on the plane z = 0."""
    u, (psi, azimuth) = quasi_random(ON_PLANE, 4), incidences(ON_PLANE)
    diameter = 1e-3 * (1 + 0.3 * u[:, 2])
    height = diameter / 2 + SPEED * (3e-6 + 5e-6 * u[:, 3])
    slip = psi * FRICTION * SPEED
    x = np.column_stack([places(ON_PLANE), height])
    return x, diameter, np.column_stack([slip * np.cos(azimuth), slip * np.sin(azimuth), np.full(ON_PLANE, -SPEED)])


def pair_state():
    """x [2 n, 3], diameter, v of pairs of unequal grains (2k and 2k + 1); the line of centres is inclined."""
    u, (psi, azimuth) = quasi_random(PAIRS, 4), incidences(PAIRS)
    diameter = np.stack([1e-3 * (1 + 0.3 * u[:, 2]), np.full(PAIRS, 1.5e-3)], axis=1)
    first = np.column_stack([places(PAIRS), np.full(PAIRS, 5e-3)])
    normal, along, _ = frame(azimuth)
    gap = SPEED * (3e-6 + 5e-6 * u[:, 3])
    second = first - (diameter.sum(axis=1) / 2 + gap)[:, None] * normal
    relative = -SPEED * normal + FRICTION * SPEED * psi[:, None] * along
    x = np.stack([first, second], axis=1).reshape(-1, 3)
    v = np.stack([0.6 * relative, -0.4 * relative], axis=1).reshape(-1, 3)
    return x, diameter.ravel(), v


def frame(azimuth):
    """Normals (from the second to the first grain), tangents along and across the slip [n, 3] of the pairs."""
    tilt = 0.3 * np.cos(azimuth)
    normal = np.column_stack([np.sin(tilt), np.zeros_like(tilt), np.cos(tilt)])
    first = np.column_stack([np.cos(tilt), np.zeros_like(tilt), -np.sin(tilt)])
    second = np.cross(normal, first)
    along = np.cos(azimuth)[:, None] * first + np.sin(azimuth)[:, None] * second
    return normal, along, np.cross(normal, along)


def written_state(name):
    """x, diameter, v as the solver reads them."""
    table = np.loadtxt(Path(__file__).parent / name, delimiter=",", skiprows=1)
    return table[:, :3], table[:, 3], table[:, 4:]


# ---- one impact -----------------------------------------------------------------------------------------------------

def damping_ratio(restitution):
    """beta of an oscillator whose speed falls to `restitution` in half a period."""
    log_e = np.log(restitution)
    return -log_e / np.sqrt(np.pi**2 + log_e**2)


def instants():
    """Ends and middles of the STEPS steps in [0, 1], dense at both ends where Hertz's forces go with roots of time."""
    ends = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, STEPS + 1))
    t = np.empty(2 * STEPS + 1)
    t[0::2], t[1::2] = ends, 0.5 * (ends[:-1] + ends[1:])
    return t


@cache
def normal_motion(law, restitution):
    """t, overlap, its rate, normal force and dashpot coefficient [2 STEPS + 1] in units of m*, v_n and w0 (or a)."""
    beta = damping_ratio(restitution)
    if law == "hertz_mindlin":
        alpha = np.sqrt(5) * beta

        def rates(_, y):
            o = max(y[0], 0.0)
            return [y[1], -o**1.5 - alpha * o**0.25 * y[1]]

        def parts(_, y):
            return y[0]
        parts.terminal, parts.direction = True, -1
        path = solve_ivp(rates, (0, 10), [0.0, 1.0], method="DOP853", events=parts, rtol=1e-11, atol=1e-14,
                         dense_output=True, first_step=1e-4)
        t = path.t_events[0][0] * instants()
        overlap, rate = path.sol(t)
        overlap = np.maximum(overlap, 0.0)
        dashpot = alpha * overlap**0.25
        return t, overlap, rate, overlap**1.5 + dashpot * rate, dashpot
    frequency = np.sqrt(1 - beta**2)
    t = np.pi / frequency * instants()
    decay = np.exp(-beta * t)
    overlap = decay * np.sin(frequency * t) / frequency
    rate = decay * (np.cos(frequency * t) - beta / frequency * np.sin(frequency * t))
    return t, overlap, rate, overlap + 2 * beta * rate, 2 * beta + 0 * t


def hertz_depth():
    """Unit of the overlap over R: (m v_n^2/k_h)^(2/5)/R with m = 4/3 pi rho R^3 and k_h = 4/3 E* R^(1/2)."""
    modulus = YOUNG / (2 * (1 - POISSON**2))  # two bodies of one material
    return (np.pi * DENSITY * SPEED**2 / modulus) ** 0.4


def rebound(law, ratio, restitution, psi):
    """Slip after the impact over mu v_n for slips psi [n] before it: the equations of the README, solved by the
    trapezoidal rule with the force returned to Coulomb's limit, STEPS steps (second order)."""
    if law == "linear_spring_coulomb":
        return np.maximum(psi - SURFACE * (1 + 1.0), 0.0)
    t, overlap, rate, normal, dashpot = normal_motion(law, restitution)
    hertz = law == "hertz_mindlin"
    arm = 1 - hertz_depth() * overlap if hertz else np.ones_like(t)  # of the contact point over R
    spring = ratio * np.sqrt(overlap) if hertz else np.full_like(t, ratio)
    loading = rate >= 0
    dashpot = dashpot * np.sqrt(ratio / 1.5) if hertz else np.zeros_like(t)  # c_t = c_n sqrt(k_t/k_n); none if linear
    slip, elastic = psi.copy(), np.zeros_like(psi)
    centre, spin = psi.copy(), np.zeros_like(psi)  # velocity of the centre, R omega; slip = centre + arm spin
    force = np.minimum(dashpot[0] * slip, max(normal[0], 0.0))
    for k in range(0, 2 * STEPS, 2):
        # Loading: the force grows by spring ds. Unloading: the force is spring times the stretch, so it shrinks with it.
        grows = loading[k + 1] or not hertz
        kept = 1.0 if grows else np.sqrt(overlap[k + 2] / overlap[k])
        # elastic' = kept elastic + h/2 spring (slip + slip'), slip' = slip - h/2 SURFACE (force + force'),
        # force' = elastic' + dashpot slip': linear, solved for slip'. SURFACE is 1 + 5/2 arm^2 in full.
        h = t[k + 2] - t[k]
        pull = 0.5 * h * spring[k + 1 if grows else k + 2]
        old, new = 0.5 * h * (1 + 2.5 * arm[k] * arm[k + 2]), 0.5 * h * (1 + 2.5 * arm[k + 2] ** 2)
        free = centre + arm[k + 2] * spin - old * force
        after = (free - new * (kept * elastic + pull * slip)) / (1 + new * (pull + dashpot[k + 2]))
        stretched = kept * elastic + pull * (slip + after)
        limit = max(normal[k + 2], 0.0)
        new_force = np.clip(stretched + dashpot[k + 2] * after, -limit, limit)
        after = free - new * new_force
        centre -= 0.5 * h * (force + new_force)
        spin -= 0.5 * h * 2.5 * (arm[k] * force + arm[k + 2] * new_force)
        slides = np.abs(stretched + dashpot[k + 2] * after) > limit
        elastic = np.where(slides, new_force - dashpot[k + 2] * after, stretched)
        slip, force = after, new_force
    return centre + spin


def case_of(scene):
    """(law, k_t/k in the law's own units, restitution) of the variant; the numbers are those of this file."""
    contact = scene["grains"]["contact"]
    law = contact["law"]
    e = 1.0 if contact["restitution"] == 1.0 else RESTITUTION
    if law == "hertz_mindlin":  # S_t/(k_h overlap^0.5) = 8 G*/(4/3 E*)
        return law, 3 * (1 - POISSON) / (2 - POISSON), e
    if law == "linear_spring_coulomb":
        return law, 0.0, e
    resonant = contact["tangential_stiffness"] < 0.5 * contact["stiffness"]
    return law, RESONANT_RATIO if resonant else RATIO, e


def on_plane(scene):
    """True for the variants in which every grain strikes the plane, False for the pairs."""
    return scene["grains"]["arrange"]["path"] == "wall.csv"


def arrangement(scene):
    """x, diameter, v and spin of all grains before the impact, and the normals of the n contacts."""
    x, diameter, v = written_state(scene["grains"]["arrange"]["path"])
    spin = SPIN if any(scene["grains"]["angular_velocity"]) else np.zeros(3)
    if on_plane(scene):
        normal = np.tile([0.0, 0.0, 1.0], (len(x), 1))
    else:
        gap = x[0::2] - x[1::2]
        normal = gap / np.linalg.norm(gap, axis=1)[:, None]
    return x, diameter, v, np.tile(spin, (len(x), 1)), normal


def slip_velocity(v, omega, diameter, normal):
    """Velocity of the surface at the contact [n, 3] against the plane or the other grain, tangential part."""
    if len(v) == len(normal):
        relative = v - diameter[:, None] / 2 * np.cross(omega, normal)
    else:
        surface = diameter[:, None] / 2 * omega
        relative = v[0::2] - v[1::2] - np.cross(surface[0::2] + surface[1::2], normal)
    return relative - np.sum(relative * normal, axis=1)[:, None] * normal


def before(scene):
    """psi [n], tangents along and across the slip before the impact, and R omega of the (first) grains, [n, 3]."""
    _, diameter, v, omega, normal = arrangement(scene)
    slip = slip_velocity(v, omega, diameter, normal)
    size = np.linalg.norm(slip, axis=1)
    along = slip / size[:, None]
    return size / (FRICTION * SPEED), along, np.cross(normal, along), firsts(scene, diameter[:, None] / 2 * omega)


def firsts(scene, values):
    """The rows of the grains whose spin is judged: all on the plane, the first of each pair."""
    return values if on_plane(scene) else values[0::2]


@cache
def rebound_of(law, ratio, restitution, psi):
    """As `rebound`, remembered: all steps of a sweep have the same answer."""
    return rebound(law, ratio, restitution, np.array(psi))


def slides_throughout(scene, psi):
    """True for the impacts that slide from the first to the last touch (undamped linear spring; README)."""
    ratio = case_of(scene)[1]
    return psi > 1.02 * max(1 / ratio, 2 * SURFACE - 1 / ratio)


def reference(quantity, scene, t):
    """Expected values in the order of `measure`."""
    if quantity == "angular_momentum":
        return 0.0
    psi, along, across, surface = before(scene)
    after = rebound_of(*case_of(scene), tuple(psi))
    if quantity == "rebound_slip":
        return np.concatenate([after, np.zeros_like(after)])
    impulse = (psi - after) / SURFACE  # over m* mu v_n, against the slip
    if quantity == "sliding_impulse":
        return np.full(int(np.sum(slides_throughout(scene, psi))), 2.0)
    if quantity == "rebound_spin":
        spin = surface / (FRICTION * SPEED) + share(scene)[:, None] * (2.5 * impulse)[:, None] * across
        return spin.ravel()
    raise KeyError(quantity)


# ---- measured -------------------------------------------------------------------------------------------------------

def share(scene):
    """m*/m of the (first) grain [n]: 1 against a plane."""
    _, diameter, _, _, _ = arrangement(scene)
    if on_plane(scene):
        return np.ones(len(diameter))
    mass = diameter**3
    return mass[1::2] / (mass[0::2] + mass[1::2])


def final_state(run):
    """x, v, omega in the order of creation."""
    grains = run.snapshot(-1)["grains"]
    order = np.argsort(grains["id"])
    return [grains[name][order] for name in ("x", "v", "omega")]


def measure(quantity, run):
    """(number, value) of all impacts; lengths of slip and spin are over mu v_n."""
    if quantity not in UNITS:
        return NotImplemented
    _, diameter, v0, _, normal = arrangement(run.scene)
    x, v, omega = final_state(run)
    unit = FRICTION * SPEED
    psi, along, across, _ = before(run.scene)
    if quantity == "angular_momentum":
        return float(np.max(angular_momentum_change(run.scene, x, v, omega)))
    if quantity == "rebound_slip":
        slip = slip_velocity(v, omega, diameter, normal) / unit
        values = np.concatenate([np.sum(slip * along, axis=1), np.sum(slip * across, axis=1)])
    elif quantity == "rebound_spin":
        values = firsts(run.scene, diameter[:, None] / 2 * omega / unit).ravel()
    else:
        change = np.sum(firsts(run.scene, v - v0) * along, axis=1) / unit
        values = -change[slides_throughout(run.scene, psi)]
    return np.arange(len(values)), values


def angular_momentum_change(scene, x, v, omega):
    """Change of the angular momentum of every pair about its centre of mass over the sum of its absolute parts."""
    x0, diameter, v0, omega0, _ = arrangement(scene)
    mass = (DENSITY * np.pi / 6 * diameter**3)[:, None]
    inertia = 0.1 * mass * diameter[:, None]**2

    def parts(x_, v_, omega_):
        centre = (mass[0::2] * x_[0::2] + mass[1::2] * x_[1::2]) / (mass[0::2] + mass[1::2])
        return mass * np.cross(x_ - np.repeat(centre, 2, axis=0), v_), inertia * omega_

    old, new = parts(x0, v0, omega0), parts(x, v, omega)
    total = [sum(p)[0::2] + sum(p)[1::2] for p in (old, new)]
    scale = sum(np.linalg.norm(p, axis=1).reshape(-1, 2).sum(axis=1) for p in new)
    return np.linalg.norm(total[1] - total[0], axis=1) / scale


def figures(runs):
    """Slip after against slip before the impact, with the reference."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.4, 4.8), layout="constrained")
    axes = figure.subplots()
    finest = {run.variant: run for run in runs if not run.failure}  # the last of every variant
    for number, (variant, run) in enumerate(finest.items()):
        psi = before(run.scene)[0]
        order = np.argsort(psi)
        colour = f"C{number}"
        axes.plot(psi[order], measure("rebound_slip", run)[1][:len(psi)][order], ".", ms=3, color=colour, label=variant)
        axes.plot(psi[order], rebound_of(*case_of(run.scene), tuple(psi))[order], "-", lw=0.8, color=colour)
    axes.set_xlabel("slip before the impact over mu v_n [-]")
    axes.set_ylabel("slip after the impact over mu v_n [-]")
    axes.legend(fontsize="x-small")
    return [("rebound", figure, "Points: the solver at its finest step. Lines: integration of one impact (README). From "
             "left to right: sticking, partly sliding, sliding throughout; the Coulomb law without a spring ends at zero "
             "slip (rolling) until it slides throughout.")]


def write_states():
    """Writes wall.csv and pairs.csv; 13 digits: 1e-14 m in a place, gaps are 3e-9 m and more."""
    for name, (x, diameter, v) in (("wall.csv", wall_state()), ("pairs.csv", pair_state())):
        with open(Path(__file__).parent / name, "w", encoding="utf-8") as file:
            file.write("x [m],y [m],z [m],diameter [m],vx [m/s],vy [m/s],vz [m/s]\n")
            for row in np.column_stack([x, diameter, v]):
                file.write(",".join(f"{value:.13g}" for value in row) + "\n")


if __name__ == "__main__":
    write_states()
