"""Work-precision: what accuracy costs. The error of one check against CPU time for every variant and resolution."""

import numpy as np

from .figure_style import COLOURS, MARKERS, new_figure, parameter_label, png, styled, with_units
from .figures import Picture, make_logarithmic, slug
from .judge import measured
from .metrics import NotComparable
from .verdicts import number

SMALLEST, LARGEST = 4.5, 10.0  # marks, from the coarsest to the finest resolution


def work_precision(case, runs, reference):
    """{check, quantity, metric, units, points: [{variant, parameter, value, cpu_s, wall_s, error, error_bar, front}],
    without_points: [variant]}, or None without [work_precision].

    A run that failed or took no measurable time is left out: the table of runs tells why. A variant all of whose runs failed
    is named without points.
    """
    stated = case.work_precision
    if stated is None:
        return None
    check, points, units = case.check(stated.check), [], "1"
    for run in runs:
        if run.variant not in stated.variants or run.failure or not run.cost()["cpu_s"]:
            continue
        try:
            data = reference.comparison(check, run)
            error = measured(check, data)
        except NotComparable:
            continue
        units = data.units if check.metric in ("absolute_linf", "final_absolute") else "1"
        points.append({"variant": run.variant, "parameter": run.parameter, "value": run.value,
                       "cpu_s": run.cost()["cpu_s"], "wall_s": run.cost()["wall_s"], "error": error.value,
                       "error_bar": error.error_bar})
    return {"check": check.id, "quantity": check.quantity, "metric": check.metric, "units": units,
            "points": [{**point, "front": on_front(point, points)} for point in points],
            "without_points": failed_variants(stated.variants, runs, points)}


def failed_variants(names, runs, points):
    """Variants that ran, but have no point on the chart."""
    ran, shown = {run.variant for run in runs}, {point["variant"] for point in points}
    return [name for name in names if name in ran - shown]


def on_front(point, points):
    """Whether no other point is as accurate and as cheap, and better in one of the two."""
    return not any(other["cpu_s"] <= point["cpu_s"] and other["error"] <= point["error"]
                   and (other["cpu_s"] < point["cpu_s"] or other["error"] < point["error"]) for other in points)


def work_precision_pictures(case, content):
    """The chart of what work_precision() returned, when there is anything to draw."""
    drawn = [point for point in content["points"] if point["error"] > 0] if content else []
    if not drawn:
        return []
    check = case.check(case.work_precision.check)
    over = f" Larger marks: finer {case.sweep.parameter}." if case.sweep else ""
    caption = (f"Work-precision: {check.metric} of {check.quantity} (check {check.id}) against the CPU time of the run, one mark "
               f"for every run. The grey line joins the front: no other run is as accurate and as cheap. Points on it are "
               f"labelled.{over}")
    return [Picture(f"work_precision_{slug(check.id)}", png(styled(chart, case, content, drawn)), caption)]


def chart(case, content, points):
    """Error against CPU seconds, both logarithmic."""
    figure = new_figure(9.0, 5.4)
    axes = figure.subplots()
    for k, variant in enumerate(dict.fromkeys(point["variant"] for point in points)):
        own = [point for point in points if point["variant"] == variant]
        draw_variant(axes, case, own, COLOURS[k % len(COLOURS)], MARKERS[(k + k // len(COLOURS)) % len(MARKERS)])
    for name in content["without_points"]:
        axes.plot([], [], "x", color="#3A424A", label=f"{name}: every run failed")
    draw_front(axes, sorted((point for point in points if point["front"]), key=lambda point: point["cpu_s"]))
    axes.margins(x=0.16, y=0.1)
    make_logarithmic(axes)
    axes.set_xlabel("CPU time of the run (s)")
    axes.set_ylabel(with_units(f"{content['metric']} of {content['quantity']}", content["units"]))
    title = f"resolution by size of the mark: {parameter_label(case.sweep.parameter)}" if case.sweep else None
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), title=title and title.replace(": ", ":\n"), title_fontsize=8)
    return figure


def draw_variant(axes, case, points, colour, marker):
    """The runs of one variant, joined from coarse to fine."""
    cost, error = ([point[key] for point in points] for key in ("cpu_s", "error"))
    axes.plot(cost, error, color=colour, linewidth=0.9, alpha=0.6)
    axes.plot([], [], color=colour, marker=marker, markersize=6, linewidth=0.9, label=points[0]["variant"])
    for point in points:
        axes.plot(point["cpu_s"], point["error"], marker=marker, markersize=mark_size(case, point["value"]), color=colour,
                  linestyle="none", markeredgecolor="white", markeredgewidth=0.5)


def draw_front(axes, front):
    """The front as a broad line behind the marks, each of its points with its name."""
    axes.plot([p["cpu_s"] for p in front], [p["error"] for p in front], color="#A8B0B8", linewidth=5, alpha=0.5, zorder=0,
              label="front")
    for k, point in enumerate(front):
        side = {"xytext": (7, 5), "ha": "left"} if k % 2 else {"xytext": (-5, -12), "ha": "right"}  # neighbours kept apart
        text = point["variant"] if point["value"] is None else f"{point['variant']}; {number(point['value'])}"
        axes.annotate(text, (point["cpu_s"], point["error"]), textcoords="offset points", fontsize=7, color="#3A424A",
                      **side)


def mark_size(case, value):
    """Size of a mark: the finer, the larger; runs without a sweep have the middle one."""
    if value is None:
        return 0.5 * (SMALLEST + LARGEST)
    values = case.sweep.values + case.sweep.campaign
    return float(np.interp(values.index(value), [0, max(len(values) - 1, 1)], [SMALLEST, LARGEST]))
