"""Looks shared by all figures: colour-blind safe, legible in print, light background whatever the page's theme."""

import io

import matplotlib
from PIL import Image

matplotlib.use("Agg")
from matplotlib.figure import Figure  # noqa: E402  (the backend has to be chosen first)

# Okabe & Ito 2008, Color Universal Design; its yellow and black replaced by darker hues that stand out on white.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A5C00", "#444444")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
REFERENCE_STYLE = {"color": "black", "linestyle": (0, (4, 2)), "linewidth": 1.2}
REFERENCE_MARK = {"color": "black", "linestyle": "none", "marker": "x", "markersize": 4, "markeredgewidth": 0.8}
BOUND_STYLE = {"color": "#B00020", "linestyle": ":", "linewidth": 1.2}
SETTINGS = {
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 9.5, "axes.titleweight": "bold",
    "axes.labelsize": 9, "legend.fontsize": 8, "legend.frameon": False, "xtick.labelsize": 8, "ytick.labelsize": 8,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#E3E6EA",
    "grid.linewidth": 0.7, "axes.axisbelow": True, "axes.edgecolor": "#5B6570", "lines.linewidth": 1.6,
    "lines.markersize": 5, "axes.formatter.limits": (-3, 4), "axes.formatter.use_mathtext": True}
DOTS_PER_INCH = 110

# Units of the scene keys that a sweep may vary (SI; the scene's own convention), by the last word of the key.
PARAMETER_UNITS = {
    "step": "s", "grain_step": "s", "end": "s", "output_interval": "s", "interval": "s", "window": "s", "spacing": "m",
    "diameter": "m", "kernel_width": "m", "radius": "m", "stiffness": "N/m", "tangential_stiffness": "N/m",
    "damping": "kg/s", "tangential_damping": "kg/s", "young": "Pa", "density": "kg/m³", "viscosity": "Pa s",
    "speed": "m/s", "velocity": "m/s", "peak": "m/s", "amplitude": "m/s", "rate": "1/s", "frequency": "Hz",
    "sound_speed": "m/s"}


def new_figure(width, height):
    """An empty Figure of width x height inches whose parts arrange themselves."""
    with matplotlib.rc_context(SETTINGS):
        return Figure(figsize=(width, height), layout="constrained")


def styled(draw, *arguments):
    """The result of draw(*arguments) with the common settings in force."""
    with matplotlib.rc_context(SETTINGS):
        return draw(*arguments)


def png(figure, dpi=DOTS_PER_INCH):
    """The figure as PNG bytes of 128 colours (a third of the size), without a date or version inside."""
    drawn, small = io.BytesIO(), io.BytesIO()
    with matplotlib.rc_context(SETTINGS):
        figure.savefig(drawn, format="png", dpi=dpi, facecolor="white")
    Image.open(drawn).convert("RGB").quantize(128, dither=Image.Dither.NONE).save(small, format="png", optimize=True)
    return small.getvalue()


def parameter_label(parameter):
    """Axis label of a sweep parameter, with units where its name tells them."""
    return with_units(parameter, PARAMETER_UNITS.get(parameter.split(".")[-1], ""))


def with_units(name, units):
    """"name (units)"; dimensionless quantities are marked (-), unknown units left out."""
    return f"{name} ({'-' if units == '1' else units})" if units else name
