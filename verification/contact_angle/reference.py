"""A drop on a floor: the contact angle of the cap that it comes to rest as (README.md)."""

import math

import numpy as np
from scipy.optimize import brentq

UNITS = {"angle": "degrees", "wrong_way": "degrees"}


def middle_height(angle, area):
    """Height of the centre of mass of a cap of a disc, m (README, equation 2)."""
    radius = math.sqrt(area / (angle - math.sin(angle) * math.cos(angle)))
    return 2.0 * (radius * math.sin(angle)) ** 3 / (3.0 * area) - radius * math.cos(angle)


def angle_of(height, area):
    """Its contact angle, degrees."""
    return math.degrees(brentq(lambda angle: middle_height(angle, area) - height, 0.05, 3.1))


def asked_angle(scene):
    """The wall's contact angle, degrees."""
    return math.degrees(scene["wall"][0]["contact_angle"])


def reference(quantity, scene, t):
    if quantity == "angle":
        return asked_angle(scene)
    raise KeyError(quantity)


def found_angle(run):
    x = run.snapshot(len(run.snapshot_files()) - 1)["fluid"]["x"]
    return angle_of(x[:, 1].mean(), len(x) * run.scene["fluid"]["spacing"] ** 2)


def measure(quantity, run):
    if quantity == "angle":
        return found_angle(run)
    if quantity == "wrong_way":  # how far from a right angle, towards the one asked for
        return (found_angle(run) - 90.0) * math.copysign(1.0, asked_angle(run.scene) - 90.0)
    return NotImplemented


def table(runs):
    rows = [[f"{asked_angle(run.scene):.0f}", f"{1.0 / run.scene['fluid']['spacing']:.0f}", f"{found_angle(run):.1f}"]
            for run in runs if not run.failure]
    return {"columns": ["angle asked for", "spacings to the half disc's radius", "angle found"], "rows": rows,
            "caption": "Degrees, from the height of the centre of mass."}


def figures(runs):
    """The drops at the end, with the caps of the angles asked for."""
    from matplotlib.figure import Figure

    good = [run for run in runs if not run.failure]
    if not good:
        return []
    names = list(dict.fromkeys(run.variant for run in good))
    figure = Figure(figsize=(3.4 * len(names), 2.8), layout="constrained")
    for axes, name in zip(np.atleast_1d(figure.subplots(1, len(names))), names):
        run = min((r for r in good if r.variant == name), key=lambda r: r.scene["fluid"]["spacing"])
        x = run.snapshot(len(run.snapshot_files()) - 1)["fluid"]["x"]
        middle, area = x[:, 0].mean(), len(x) * run.scene["fluid"]["spacing"] ** 2
        angle = run.scene["wall"][0]["contact_angle"]
        radius = math.sqrt(area / (angle - math.sin(angle) * math.cos(angle)))
        arc = np.linspace(-angle, angle, 200)
        axes.plot(x[:, 0] - middle, x[:, 1], ".", ms=3)
        axes.plot(radius * np.sin(arc), radius * (np.cos(arc) - math.cos(angle)), lw=0.8)
        axes.set_aspect("equal")
        axes.set_title(f"{name}: {found_angle(run):.1f}", fontsize="small")
    return [("caps", figure, "Particles at the end, and the cap of the contact angle asked for. The numbers are the angles found, in degrees.")]
