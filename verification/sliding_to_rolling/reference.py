"""A sliding sphere starts to roll; with rolling resistance it comes to rest.

The numbers are stated here and not read from the scene, so that a scene which says something else fails. Only the law of
rolling decides which solution applies.
"""

import numpy as np

RADIUS = 5e-3            # R, m
GRAVITY = 9.81           # m/s2
FRICTION = 0.3           # mu
ROLLING_FRICTION = 0.2   # mu_r, of the variants with rolling resistance
SPEED = 0.5              # v0, m/s
START = 0.01             # x at t = 0, m
UNITS = {"rolling_time": "s", "travel": "m"}


def rolling_friction(scene):
    """mu_r of the variant: 0 without a law of rolling."""
    law = scene["grains"]["contact"].get("rolling", "none")
    name = law if isinstance(law, str) else law["law"]
    return 0.0 if name == "none" else ROLLING_FRICTION


def history(rolling, t):
    """x - x(0), v and R omega at the times t: sliding, rolling, at rest (README, equations 1 to 5)."""
    t_roll = 2 * SPEED / (GRAVITY * (7 * FRICTION - 5 * rolling))
    v_roll = SPEED - FRICTION * GRAVITY * t_roll
    x_roll = SPEED * t_roll - FRICTION * GRAVITY * t_roll**2 / 2
    slowing = 5 / 7 * rolling * GRAVITY
    t_stop = t_roll + v_roll / slowing if slowing > 0 else np.inf
    sliding = t < t_roll
    rolled = np.minimum(t, t_stop) - t_roll
    x = np.where(sliding, SPEED * t - FRICTION * GRAVITY * t**2 / 2, x_roll + v_roll * rolled - slowing * rolled**2 / 2)
    v = np.where(sliding, SPEED - FRICTION * GRAVITY * t, v_roll - slowing * rolled)
    surface = np.where(sliding, 2.5 * (FRICTION - rolling) * GRAVITY * t, v)
    return x, v, surface


def reference(quantity, scene, t):
    """Velocity [m/s], spin [rad/s] and place [m] at the times t; time until rolling [s]; travel to rest [m]."""
    x, v, surface = history(rolling_friction(scene), np.asarray(t))
    if quantity == "velocity":
        return v
    if quantity == "spin":
        return surface / RADIUS
    if quantity == "path":
        return START + x
    if quantity == "rolling_time":
        return 2 * SPEED / (7 * FRICTION * GRAVITY)
    if quantity == "travel":
        return history(rolling_friction(scene), np.array([1e9]))[0][0]
    raise KeyError(quantity)


def measure(quantity, run):
    """The time until rolling from the place at the end, x_end = (5/7) v0 t_end + v0 t_r/7; the whole travel."""
    if quantity not in UNITS:
        return NotImplemented
    t, x = run.series("path")
    if quantity == "travel":
        return float(x[-1] - START)
    return float(7 * (x[-1] - START - 5 / 7 * SPEED * t[-1]) / SPEED)


def figures(runs):
    """Velocity and surface speed of every variant at its finest value."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.8, 4.4), layout="constrained")
    axes = figure.subplots()
    finest = {run.variant: run for run in runs if not run.failure}
    for number, (variant, run) in enumerate(finest.items()):
        t, v = run.series("velocity")
        _, omega = run.series("spin")
        axes.plot(t, v, color=f"C{number}", lw=1, label=variant)
        axes.plot(t, RADIUS * omega, color=f"C{number}", lw=1, ls="--")
    for rolling in (0.0, ROLLING_FRICTION):
        t = np.linspace(0, 0.1 if rolling == 0 else 0.3, 61)
        axes.plot(t, history(rolling, t)[1], "k.", ms=3, label=f"exact, mu_r = {rolling}")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("velocity (solid), surface speed R omega (dashed) [m/s]")
    axes.legend(fontsize="x-small")
    return [("velocity", figure, "The sphere slides until its surface speed equals its velocity, then rolls.")]
