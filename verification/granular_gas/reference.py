"""Homogeneous cooling of a granular gas: Haff's law with the constant of kinetic theory.

The numbers are stated here and not read from the scene, so that a scene which says something else fails; only which of
the two restitutions is meant follows from the scene.
"""

import numpy as np

GRAINS = 2500
DIAMETER = 1e-3             # sigma, m
BOX = 0.0296                # m
RESTITUTIONS = (0.8, 0.9)
UNITS = {"slowing": "1", "cooling_rate": "1"}


def restitution(scene):
    """Restitution of the variant."""
    stated = scene["grains"]["contact"]["restitution"]
    return min(RESTITUTIONS, key=lambda e: abs(e - stated))


def collision_frequency(temperature):
    """Enskog's collision frequency of a grain [1/s] at the temperature <v^2>/3 [m2/s2]."""
    density = GRAINS / BOX**3
    fraction = np.pi / 6 * density * DIAMETER**3
    contact_value = (1 - fraction / 2) / (1 - fraction)**3  # Carnahan & Starling 1969
    return 4 * density * contact_value * DIAMETER**2 * np.sqrt(np.pi * temperature)


def second_coefficient(e):
    """a_2 of the Sonine expansion in three dimensions (van Noije & Ernst 1998)."""
    return 16 * (1 - e) * (1 - 2 * e**2) / (81 - 17 * e + 30 * e**2 * (1 - e))


def cooling_rate(e):
    """1/tau over the initial collision frequency: equation (4) of the README."""
    return (1 - e**2) / 6 * (1 + 3 / 16 * second_coefficient(e))


def reference(quantity, scene, t):
    """sqrt(T(0)/T) at the scaled times t, and its slope."""
    rate = cooling_rate(restitution(scene))
    return 1 + rate * np.asarray(t) if quantity == "slowing" else rate


def measure(quantity, run):
    """(scaled time, sqrt(T(0)/T)) or the slope of its straight line through (0, 1).

    Time is scaled by the collision frequency at the measured T(0), so that the random start does not count as an error.
    """
    if quantity not in UNITS:
        return NotImplemented
    t, temperature = run.series("temperature")
    scaled = t * collision_frequency(temperature[0])
    slowing = np.sqrt(temperature[0] / temperature)
    if quantity == "slowing":
        return scaled, slowing
    return float(np.sum(scaled * (slowing - 1)) / np.sum(scaled**2))


def figures(runs):
    """sqrt(T(0)/T) against the scaled time."""
    from matplotlib.figure import Figure
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    finest = {run.variant: run for run in runs if not run.failure}
    for number, (variant, run) in enumerate(finest.items()):
        scaled, slowing = measure("slowing", run)
        axes.plot(scaled, slowing, "o", ms=3, color=f"C{number}", label=variant)
        axes.plot(scaled, reference("slowing", run.scene, scaled), "-", lw=1, color=f"C{number}")
    axes.set_xlabel("time times initial collision frequency [-]")
    axes.set_ylabel("sqrt(T(0)/T) [-]")
    axes.legend()
    return [("cooling", figure, "Symbols: the solver. Lines: Haff's law with the constant of kinetic theory, no fit.")]
