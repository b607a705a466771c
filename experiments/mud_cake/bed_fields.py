"""What is drawn of the mud cake: cylinders, speed and pressure over the plane of a run as in the paper's Figure 3, the studies."""

import math

import numpy as np


def plane(run, lower, upper):
    """(x nodes, y nodes, speed, pressure) of the cells between two heights: mm, m/s, kPa; NaN in the cylinders."""
    shot = run.snapshot(-1)
    x, y, fluid = shot["grid"]["nodes_x"], shot["grid"]["nodes_y"], shot["fluid"]
    speed, p = np.full((2, len(y) - 1, len(x) - 1), np.nan)
    open_ = fluid["open"] > 0.5
    i, j = np.searchsorted(x, fluid["x"][open_, 0]) - 1, np.searchsorted(y, fluid["x"][open_, 1]) - 1
    speed[j, i], p[j, i] = np.linalg.norm(fluid["v"][open_], axis=1), 1e-3 * fluid["p"][open_]
    rows = np.flatnonzero((y[:-1] >= lower) & (y[1:] <= upper))
    return 1e3 * x, 1e3 * y[rows[0]:rows[-1] + 2], speed[rows], p[rows]


def draw_cylinders(axes, wall, cylinders):
    """Of a scene's wall and its Array, as circles, mm."""
    from matplotlib.patches import Circle

    for number, y in enumerate(cylinders.rows()):
        fewer = -1 if wall["between"] == "one_fewer" else 1
        count = cylinders.per_row + (0 if number % 2 == 0 else fewer)
        first = 0.5 * (cylinders.width - (count - 1) * cylinders.pitch)
        for q in range(count):
            x = wall["lower"][0] + first + q * cylinders.pitch
            axes.add_patch(Circle((1e3 * x, 1e3 * y), 5e2 * float(cylinders.diameter(y)), color="0.75", lw=0))


def fields_figure(run, lower=0.145, upper=0.3):
    """Speed and pressure over the plane, cylinders left white."""
    from matplotlib.figure import Figure

    x, y, speed, p = plane(run, lower, upper)
    figure = Figure(figsize=(6.5, 7.0), layout="constrained")
    for axes, (value, label) in zip(figure.subplots(1, 2, sharey=True), ((speed, "speed (m/s)"), (p, "pressure (kPa)"))):
        drawn = axes.pcolormesh(x, y, value, cmap="viridis", rasterized=True)
        axes.set(aspect="equal", xlabel="x (mm)")
        figure.colorbar(drawn, ax=axes, shrink=0.6, location="bottom", label=label)
    figure.axes[0].set_ylabel("y (mm)")
    return figure


def studies_figure(found):
    """{study: (relative changes of P by member, of h_b)}."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 0.32 * len(found) + 1.0), layout="constrained")
    places = np.arange(len(found))[::-1]
    for number, (axes, what) in enumerate(zip(figure.subplots(1, 2, sharey=True), ("P", "h_b"))):
        for place, changes in zip(places, found.values()):
            one = 100.0 * np.array(changes[number])
            axes.plot(one, np.full(len(one), place), "o", color="0.7", ms=3)
            axes.errorbar(one.mean(), place, xerr=one.std(ddof=1) / math.sqrt(len(one)), fmt="D", color="C0", ms=4, capsize=2)
        axes.axvline(0.0, color="k", lw=0.6)
        axes.set(xlabel=f"change of {what} (%)")
    figure.axes[0].set_yticks(places, list(found))
    return figure
