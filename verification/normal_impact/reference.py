"""Head-on impact of two spheres: restitution and duration of the contact for the linear and the Hertzian spring-dashpot.

The numbers of the materials are stated here and not read from the scene, so that a scene which says something else fails.
`python3 reference.py` writes pairs.csv, the initial state.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.special import gamma, zeta

PAIRS = 256
DENSITY = 2500.0       # kg/m3
STIFFNESS = 1000.0     # k, N/m
RESTITUTION = 0.7      # of the damped variants
DAMPING = 5.5e-3       # c, kg/s, of the variant that states a coefficient
YOUNG = 3.0e7          # E, Pa
POISSON = 0.3
SPEED = 0.1            # approach, m/s
END = 4e-4             # s
CELL = 5e-3            # room of a pair, m
UNITS = {"restitution": "1", "contact_time": "s", "error_size": "1"}


def quasi_random(count, dimensions):
    """Evenly spread numbers in [0, 1): multiples of square roots of primes, modulo 1 (Weyl 1916)."""
    return np.outer(np.arange(1, count + 1), np.sqrt([2, 3, 5, 7, 11][:dimensions])) % 1.0


def initial_state():
    """Centres [2, n, 3] in m, diameters [2, n] in m and velocities [2, n, 3] in m/s of the n pairs."""
    u = quasi_random(PAIRS, 5)
    diameter = np.array([1e-3 * (1 + 0.3 * u[:, 0]), 1.5e-3 * (1 + 0.3 * u[:, 1])])
    gap = SPEED * (3e-5 + 5e-5 * u[:, 2])
    height, azimuth = 2 * u[:, 3] - 1, 2 * np.pi * u[:, 4]
    ring = np.sqrt(1 - height**2)
    axis = np.stack([ring * np.cos(azimuth), ring * np.sin(azimuth), height], axis=1)  # from the first to the second
    place = np.stack(np.unravel_index(np.arange(PAIRS), (8, 8, 4)), axis=1)
    middle = CELL * (place + 0.5)
    apart = (gap + diameter.sum(axis=0) / 2)[:, None] * axis
    mass = DENSITY * np.pi / 6 * diameter**3
    share = (mass / mass.sum(axis=0))[:, :, None]  # the pair's centre of mass stays where it is
    x = np.stack([middle - share[1] * apart, middle + share[0] * apart])
    v = np.stack([share[1] * SPEED * axis, -share[0] * SPEED * axis])
    return x, diameter, v


def pairs():
    """The state that the solver reads from pairs.csv: x, diameter, v as above."""
    table = np.loadtxt(Path(__file__).parent / "pairs.csv", delimiter=",", skiprows=1)
    table = table.reshape(PAIRS, 2, 7).transpose(1, 0, 2)
    return table[..., :3], table[..., 3], table[..., 4:]


def effective():
    """m* [n] in kg and R* [n] in m of the pairs."""
    diameter = pairs()[1]
    mass = DENSITY * np.pi / 6 * diameter**3
    return mass[0] * mass[1] / mass.sum(axis=0), 0.5 * diameter[0] * diameter[1] / diameter.sum(axis=0)


def damping_ratio(restitution):
    """beta of an oscillator whose speed falls to `restitution` in half a period."""
    log_e = np.log(restitution)
    return -log_e / np.sqrt(np.pi**2 + log_e**2)


def ratio_of_pairs(contact):
    """beta [n] of the variant that the contact table belongs to (its numbers are not used)."""
    if "damping" in contact:
        return DAMPING / (2 * np.sqrt(STIFFNESS * effective()[0]))
    return np.full(PAIRS, damping_ratio(1.0 if contact["restitution"] == 1.0 else RESTITUTION))


def hertz_rate():
    """a = k_h/m* [n] in 1/(s2 m^0.5), with f = k_h overlap^1.5 and k_h = 4/3 E* sqrt(R*)."""
    mass, radius = effective()
    return 4 / 3 * YOUNG / (2 * (1 - POISSON**2)) * np.sqrt(radius) / mass


def hertz_duration(beta):
    """Duration of the contact [n] in s for the damping ratio beta: equation (7) of the README."""
    slope = beta / np.sqrt(1 - beta**2)

    def smooth(theta):  # exp(slope theta/5) sin(theta)^-1/5 without its end singularities theta^-1/5 (pi - theta)^-1/5
        if theta < np.pi / 2:
            bulge = np.sinc(theta / np.pi) / (np.pi - theta)
        else:
            bulge = np.sinc(1 - theta / np.pi) / theta
        return np.exp(slope * theta / 5) * bulge**-0.2

    integral = quad(smooth, 0, np.pi, weight="alg", wvar=(-0.2, -0.2), epsabs=1e-13, epsrel=1e-12)[0]
    frequency = np.sqrt(1.25 * hertz_rate() * (1 - beta**2))
    return integral / frequency * (1.25 * SPEED / frequency)**-0.2


def reference(quantity, scene, t):
    """Restitution or contact time [n] of every pair."""
    contact = scene["grains"]["contact"]
    beta = ratio_of_pairs(contact)
    if quantity == "restitution":
        return np.exp(-np.pi * beta / np.sqrt(1 - beta**2))
    if quantity == "contact_time":
        if contact["law"] == "hertz_mindlin":
            return hertz_duration(beta[0])
        return np.pi / np.sqrt(STIFFNESS / effective()[0] * (1 - beta**2))
    raise KeyError(quantity)


def final_state(run):
    """Centres [2, n, 3] and velocities [2, n, 3] at the end."""
    grains = run.snapshot(-1)["grains"]
    order = np.argsort(grains["id"])
    return [grains[name][order].reshape(PAIRS, 2, 3).transpose(1, 0, 2) for name in ("x", "v")]


def measure(quantity, run):
    """(number of the pair, its restitution or contact time), or the error over the predicted one.

    The contact time follows from the straight paths before and after: the pair touches at gap/speed and, traced back from
    its final gap at its final speed, has parted at the end less final gap/final speed.
    """
    if quantity not in UNITS:
        return NotImplemented
    if quantity == "error_size":
        return restitution_error(run) / predicted_error(run.scene, run.scene["time"]["step"])
    start, diameter, _ = pairs()
    x, v = final_state(run)
    before, after = start[1] - start[0], x[1] - x[0]
    distance = np.linalg.norm(after, axis=1)
    leaving = np.sum((v[1] - v[0]) * after, axis=1) / distance
    if quantity == "restitution":
        return np.arange(PAIRS), leaving / SPEED
    touch = diameter.sum(axis=0) / 2
    return np.arange(PAIRS), END - (np.linalg.norm(before, axis=1) - touch) / SPEED - (distance - touch) / leaving


def restitution_error(run):
    """Root mean square over the pairs of the error of the restitution, relative to its root mean square."""
    measured, expected = measure("restitution", run)[1], reference("restitution", run.scene, None)
    return float(np.linalg.norm(measured - expected) / np.linalg.norm(expected))


def predicted_error(scene, dt):
    """Root mean square of the relative error of the restitution, equation (11) of the README."""
    contact = scene["grains"]["contact"]
    beta, hertz = ratio_of_pairs(contact), contact["law"] == "hertz_mindlin"
    e = np.exp(-np.pi * beta / np.sqrt(1 - beta**2))
    a, frequency = hertz_rate(), np.sqrt(STIFFNESS / effective()[0])
    damped = bool(np.any(beta > 0))
    power = {(False, True): 0.0, (False, False): 1.0, (True, True): 0.25, (True, False): 1.5}[hertz, damped]
    size = {0.0: 2 * beta * frequency, 1.0: frequency**2, 0.25: 2 * beta * np.sqrt(1.25 * a) * SPEED**0.25,
            1.5: a * np.sqrt(SPEED)}[power]
    spread = 2 * gamma(1 + power)**2 * zeta(2 + 2 * power) / (2 * np.pi)**(2 + 2 * power)
    return float(np.sqrt(np.mean((size * dt**(1 + power))**2 * (1 + e**(2 * power)) * spread)))


def figures(runs):
    """Error of the restitution against the step, with the predicted size."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    for variant in sorted({run.variant for run in runs}):
        chosen = [run for run in runs if run.variant == variant and run.value is not None and not run.failure]
        if not chosen:
            continue
        dt = np.array([run.value for run in chosen])
        line, = axes.loglog(dt, [restitution_error(run) for run in chosen], "o", label=variant)
        axes.loglog(dt, [predicted_error(chosen[0].scene, h) for h in dt], "-", color=line.get_color(), lw=1)
    axes.set_xlabel("step [s]")
    axes.set_ylabel("relative error of the restitution (rms over pairs) [-]")
    axes.legend(fontsize="small")
    return [("restitution_error", figure, "Symbols: measured. Lines: predicted from the power with which the force sets "
             "in at the first and last touch (README, equation 11); nothing is fitted.")]


def write_pairs():
    """Writes pairs.csv; the numbers keep every bit."""
    x, diameter, v = initial_state()
    with open(Path(__file__).parent / "pairs.csv", "w", encoding="utf-8") as file:
        file.write("x [m],y [m],z [m],diameter [m],vx [m/s],vy [m/s],vz [m/s]\n")
        for pair in range(PAIRS):
            for side in range(2):
                row = [*x[side, pair], diameter[side, pair], *v[side, pair]]
                file.write(",".join(repr(float(value)) for value in row) + "\n")


if __name__ == "__main__":
    write_pairs()
