"""Speed and pressure over the plane of a run, as in the paper's Figure 3."""

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
