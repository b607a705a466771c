"""A drop at rest: Laplace's pressure, and what moves although nothing should (README.md)."""

import math

import numpy as np

UNITS = {"excess_pressure": "Pa", "capillary_number": "1", "out_of_round": "1", "drift": "1"}
SHARE = 5.0 / 6.0  # of the run after which averages are taken


def centre_of(scene):
    return np.array(scene["fluid"]["fill"]["centre"], float)


def radius(scene):
    """Of the disc or ball that holds as much fluid as the particles that fill_box puts into the ellipsoid, m."""
    fluid, centre = scene["fluid"], centre_of(scene)
    semi_axes = np.array(fluid["fill"]["semi_axes"], float)
    middles = [(np.arange(round(size / fluid["spacing"])) + 0.5) * fluid["spacing"] for size in scene["domain"]["size"]]
    away = np.meshgrid(*[(m - c) / s for m, c, s in zip(middles, centre, semi_axes)], indexing="ij")
    volume = np.count_nonzero(sum(a**2 for a in away) <= 1.0) * fluid["spacing"] ** len(centre)
    return math.sqrt(volume / math.pi) if len(centre) == 2 else (0.75 * volume / math.pi) ** (1.0 / 3.0)


def laplace(tension, radius, dimensions):
    """Pressure over that outside, Pa: tension times the sum of the principal curvatures."""
    return (dimensions - 1) * tension / radius


def reference(quantity, scene, t):
    if quantity != "excess_pressure":
        raise KeyError(quantity)
    # a scene told to do without tension (must_fail) is held against that of the case
    tension = scene["fluid"]["surface"]["tension"] if isinstance(scene["fluid"]["surface"], dict) else 1.0
    return laplace(tension, radius(scene), len(scene["domain"]["size"]))


def late_mean(run, name):
    t, v = run.series(name)
    return float(np.mean(v[t >= SHARE * t[-1] - 1e-9]))


def places(run, k=-1):
    files = len(run.snapshot_files())
    dimensions = len(run.scene["domain"]["size"])
    fluid = run.snapshot(k % files)["fluid"]
    return fluid["x"][:, :dimensions], fluid["p"]


def core_pressure(run):
    """Mean over the particles within 0.6 R of the middle, at the end (the probe's box is one of the plane), Pa."""
    x, p = places(run)
    return float(p[np.linalg.norm(x - x.mean(axis=0), axis=1) < 0.6 * radius(run.scene)].mean())


def out_of_round(run):
    """Of the outermost particle in each of some sectors of three spacings."""
    x, _ = places(run)
    x = x - x.mean(axis=0)
    sectors = max(8, int(2.0 * math.pi * radius(run.scene) / (3.0 * run.scene["fluid"]["spacing"])))
    sector = ((np.arctan2(x[:, 1], x[:, 0]) / (2.0 * math.pi) + 0.5) * sectors).astype(int) % sectors
    r = np.linalg.norm(x, axis=1)
    return float(np.std([r[sector == k].max() for k in range(sectors)]) / radius(run.scene))


def measure(quantity, run):
    if quantity == "excess_pressure":
        return late_mean(run, "pressure") if len(centre_of(run.scene)) == 2 else core_pressure(run)
    if quantity == "capillary_number":
        tension = run.scene["fluid"]["surface"]["tension"]
        return late_mean(run, "greatest_speed") * run.scene["fluid"]["viscosity"] / tension
    if quantity == "out_of_round":
        return out_of_round(run)
    if quantity == "drift":
        return float(np.linalg.norm(places(run)[0].mean(axis=0) - places(run, 0)[0].mean(axis=0)) / radius(run.scene))
    return NotImplemented


def table(runs):
    rows = []
    for run in runs:
        if run.failure:
            continue
        dimensions = len(run.scene["domain"]["size"])
        expected = laplace(run.scene["fluid"]["surface"]["tension"], radius(run.scene), dimensions)
        rows.append([run.variant, f"{radius(run.scene) / run.scene['fluid']['spacing']:.2f}",
                     f"{100.0 * (measure('excess_pressure', run) / expected - 1.0):+.2f}",
                     f"{measure('capillary_number', run):.1e}", f"{measure('drift', run):.1e}"])
    return {"columns": ["variant", "R over spacing", "pressure, error [%]", "capillary number of what moves", "drift/R"], "rows": rows,
            "caption": "Error of the excess pressure, and speeds and ways that should be zero."}


def figures(runs):
    """Pressure over time and where the particles are at the end."""
    from matplotlib.figure import Figure

    good = [run for run in runs if not run.failure and len(run.scene["domain"]["size"]) == 2]
    if not good:
        return []
    figure = Figure(figsize=(10.5, 4.2), layout="constrained")
    over_time, where = figure.subplots(1, 2)
    for run in good:
        t, v = run.series("pressure")
        over_time.plot(t, v / laplace(run.scene["fluid"]["surface"]["tension"], radius(run.scene), 2), lw=1.0,
                       label=f"{run.variant}, spacing {run.scene['fluid']['spacing']:.3g}")
    over_time.axhspan(0.98, 1.02, color="0.9")
    over_time.set_ylim(0.85, 1.15)
    over_time.set_xlabel("time [s]")
    over_time.set_ylabel("pressure inside over Laplace's")
    over_time.legend(fontsize="x-small")
    last = next((run for run in good if run.variant == "from_ellipse"), good[-1])
    x, p = places(last)
    dots = where.scatter(x[:, 0], x[:, 1], c=p, s=8, cmap="viridis")
    figure.colorbar(dots, ax=where, label="pressure [Pa]")
    where.set_aspect("equal")
    where.set_title(f"{last.variant}, end", fontsize="small")
    return [("drop", figure, "Left: the mean pressure inside, over Laplace's (grey: 2 %). Right: particles at the end.")]
