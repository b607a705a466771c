"""The figures of a case: curves against their reference, errors against the sweep and against the cost."""

from typing import NamedTuple

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from .figure_style import (BOUND_STYLE, COLOURS, MARKERS, REFERENCE_MARK, REFERENCE_STYLE, new_figure, parameter_label,
                           png, styled, with_units)
from .metrics import TIME_AXIS
from .verdicts import number

MOST_PANELS = 9
MOST_COMPONENTS = 4
REFERENCE_NAME = {"analytic": "exact", "manufactured": "manufactured", "measured": "measured",
                  "published": "published simulation"}


class Picture(NamedTuple):
    """A figure ready for the page."""
    name: str
    png: bytes
    caption: str


def check_pictures(judgements):
    """All figures that the checks bring about: curves first, then errors."""
    return styled(lambda: curve_pictures(judgements) + error_pictures(judgements) + deviation_pictures(judgements))


def curve_pictures(judgements):
    """One figure per quantity and kind of reference: a panel with residual for every variant's finest run."""
    pictures = []
    for (quantity, kind), group in grouped(curves(judgements), curve_key).items():
        group = first_by_variant(group)
        shown = group[:MOST_PANELS]
        against = f", {REFERENCE_NAME[kind]} reference and residual" if kind else ", for which a range is stated"
        abscissa = group[0].comparisons[-1].axis.split(" (")[0]
        caption = f"{quantity} against {abscissa}, finest run of each variant{against}."
        if len(shown) < len(group):
            caption += f" The first {len(shown)} of {len(group)} variants are shown."
        name = f"curve_{slug(quantity)}_{kind}" if kind else f"curve_{slug(quantity)}"
        pictures.append(Picture(name, png(curve_figure(shown)), caption))
    return pictures


def curves(judgements):
    """The judgements of series; those of a range only where no check compares the same quantity with a reference."""
    series = [j for j in judgements if j.comparisons and j.comparisons[-1].is_series]
    compared = {j.check.quantity for j in series if not j.check.range}
    return [j for j in series if not j.check.range or j.check.quantity not in compared]


def curve_key(judgement):
    """(quantity, kind of reference or None): what shares a figure. References of different kinds are kept apart."""
    return judgement.check.quantity, None if judgement.check.range else judgement.check.reference


def curve_figure(group):
    """Panels of curve and residual."""
    columns = min(3, len(group))
    rows = -(-len(group) // columns)
    figure = new_figure(6.4 if columns == 1 else 3.3 * columns, (4.0 if columns == 1 else 3.0) * rows)
    panels = figure.subfigures(rows, columns, squeeze=False).ravel()
    for panel, judgement in zip(panels, group):
        axes = curve_panel(panel, judgement)
        if len(group) > 1 or judgement.variant != "default":
            axes.set_title(judgement.variant)
        if panel is panels[0]:  # all panels share it
            axes.legend(loc="best")
    return figure


def curve_panel(panel, judgement):
    """Draws the curve above, the residual below; returns the upper axes."""
    data, check = judgement.comparisons[-1], judgement.check
    label = with_units(check.quantity, data.units)
    if data.expected is None:
        upper = panel.subplots()
        lower = upper
    else:
        upper, lower = panel.subplots(2, 1, sharex=True, gridspec_kw={"height_ratios": [3, 1]})
        for k, component in enumerate(shown_components(data)):
            residual = data.measured[:, component] - data.expected[:, component]
            lower.plot(data.t, residual, color=COLOURS[k], **joined(data, 1.1))
        lower.axhline(0.0, color="#5B6570", linewidth=0.8)
        lower.set_ylabel("residual")
    draw_curve(upper, data, check)
    upper.set_ylabel(label)
    lower.set_xlabel(data.axis)
    return upper


def draw_curve(axes, data, check):
    """Measured components in colour, the reference dashed black with its uncertainty, a range as a band."""
    components = shown_components(data)
    for k, component in enumerate(components):
        name = "plumb" if data.measured.shape[1] == 1 else f"component {component}"
        axes.plot(data.t, data.measured[:, component], color=COLOURS[k], label=name, **joined(data, 1.6))
        if data.expected is not None:
            style = REFERENCE_STYLE if data.axis == TIME_AXIS else REFERENCE_MARK
            axes.plot(data.t, data.expected[:, component], label=REFERENCE_NAME[check.reference] if k == 0 else None,
                      **style)
        if data.uncertainty is not None:
            low, high = (data.expected + sign * data.uncertainty for sign in (-1, 1))
            axes.fill_between(data.t, low[:, component], high[:, component], color="black", alpha=0.12, linewidth=0,
                              label="± 1 standard uncertainty" if k == 0 else None)
    if check.range:
        axes.axhspan(*check.range, color="#009E73", alpha=0.13, linewidth=0, label="allowed range")
    if check.window:
        axes.axvspan(*check.window, color="#5B6570", alpha=0.08, linewidth=0, label="window")


def joined(data, width):
    """How points are drawn: a line over time, marks for the members of a set, both for a few points of time."""
    if data.axis != TIME_AXIS:
        return {"linestyle": "none", "marker": "o", "markersize": 3}
    return {"linewidth": width} if len(data.t) > 40 else {"linewidth": width, "marker": "o", "markersize": 3.5}


def shown_components(data):
    """Indices of the components drawn: all, or a few spread evenly over many."""
    n = data.measured.shape[1]
    return range(n) if n <= MOST_COMPONENTS else np.linspace(0, n - 1, MOST_COMPONENTS).astype(int)


def error_pictures(judgements):
    """One figure per check that is swept: error against the parameter and against wall time."""
    pictures = []
    for identity, group in grouped(judgements, lambda j: j.check.id).items():
        group = [j for j in group if len(j.measurements) > 1 and j.check.metric != "value"]
        if any(m.value > 0.0 for j in group for m in j.measurements):  # errors of exactly zero have no place on a logarithmic axis
            caption = (f"Check {identity}: error against {group[0].runs[-1].parameter} (left) and wall time of the run "
                       "(right). Lines are fits with their 95 % interval, open marks lie on a plateau and "
                       "are not fitted, grey lines are guide slopes, the dotted line is the bound of the finest run.")
            pictures.append(Picture(f"error_{slug(identity)}", png(error_figure(group)), caption))
    return pictures


def error_figure(group):
    """Two panels: convergence and work-precision."""
    figure = new_figure(9.0, 3.9)
    left, right = figure.subplots(1, 2, sharey=True)
    for k, judgement in enumerate(group):
        draw_errors(left, right, judgement, COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)])
    draw_guides(left, group[0])
    check, bound = group[0].check, group[0].bound
    for axes in (left, right):
        make_logarithmic(axes)
        if bound:
            axes.axhline(bound, **BOUND_STYLE, label=f"bound {number(bound)}")
    units = group[0].comparisons[-1].units if check.metric.startswith(("absolute", "final_absolute")) else "1"
    left.set_ylabel(with_units(f"{check.metric} of {check.quantity}", units))
    left.set_xlabel(parameter_label(group[0].runs[-1].parameter))
    right.set_xlabel("wall time of the run (s)")
    left.legend(loc="best")
    return figure


def draw_errors(left, right, judgement, colour, marker):
    """One variant: its errors, their bars, and the fitted line."""
    x = np.array([run.value for run in judgement.runs], dtype=float)
    wall = np.array([run.cost()["wall_s"] or np.nan for run in judgement.runs])
    errors = np.array([m.value for m in judgement.measurements])
    bars = np.array([m.error_bar or 0.0 for m in judgement.measurements])
    fit, shown = judgement.fit, errors > 0
    used = np.arange(len(errors)) < (fit.used if fit else len(errors))
    label = judgement.variant if judgement.variant != "default" else "plumb"
    if fit:
        label += f": order {fit.order:.2f} [{fit.lower:.2f}, {fit.upper:.2f}]"
        line_x = x[:fit.used][[0, -1]]
        left.plot(line_x, np.exp(fit.intercept) * line_x**fit.order, color=colour, linewidth=1.1)
    for axes, abscissa in ((left, x), (right, wall)):
        for part, face in ((shown & used, colour), (shown & ~used, "white")):
            axes.errorbar(abscissa[part], errors[part], yerr=bars[part] if bars.any() else None, fmt=marker, capsize=2,
                          color=colour, markerfacecolor=face, label=label if face == colour else None)
    right.plot(wall[shown], errors[shown], color=colour, linewidth=0.9)


def draw_guides(axes, judgement):
    """Grey guide slopes through the coarsest point: the whole orders around the band, or 1 and 2."""
    check = judgement.check
    slopes = {1, 2} if not check.order else {round(sum(check.order) / 2) + k for k in (-1, 0, 1)} - {0}
    x = np.array([run.value for run in judgement.runs], dtype=float)
    start = judgement.measurements[0].value
    if start <= 0 or x.min() <= 0:
        return
    for slope in sorted(slopes):
        y = 0.6 * start * (x / x[0])**slope  # a little below the data, so that neither hides the other
        axes.plot(x, y, color="#A8B0B8", linewidth=0.8, zorder=0)
        axes.annotate(f"{slope}", (x[-1], y[-1]), color="#7A838C", fontsize=7.5, ha="center", va="top")


def make_logarithmic(axes):
    """Logarithmic axes with plain labels, also when less than a decade is shown."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        if high / low < 50:
            axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
        axis.set_minor_formatter(NullFormatter())


def deviation_pictures(judgements):
    """One figure per check over several variants: deviation from the reference in per cent with its uncertainty."""
    pictures = []
    for identity, group in grouped(judgements, lambda j: j.check.id).items():
        group = [j for j in group if j.finest.deviation is not None]
        if len(group) > 1:
            kind = REFERENCE_NAME[group[0].check.reference]
            caption = (f"Check {identity}: deviation of the finest run from the {kind} value, by variant; grey bars "
                       "are the reference's expanded uncertainty (two standard uncertainties) where it is known.")
            pictures.append(Picture(f"deviation_{slug(identity)}", png(deviation_figure(group)), caption))
    return pictures


def deviation_figure(group):
    """Dots of the deviation, one row per variant."""
    figure = new_figure(7.2, 1.2 + 0.24 * len(group))
    axes = figure.subplots()
    rows = np.arange(len(group))[::-1]
    deviations = np.array([100 * j.finest.deviation for j in group])
    # deviation / sigma = uncertainty / reference
    widths = [abs(200 * j.finest.deviation / j.finest.sigma) if j.finest.sigma else 0.0 for j in group]
    axes.barh(rows, 2 * np.array(widths), left=-np.array(widths), height=0.6, color="#D5DADF", linewidth=0)
    axes.plot(deviations, rows, "o", color=COLOURS[0])
    axes.axvline(0.0, color="#5B6570", linewidth=0.9)
    axes.set_yticks(rows, [j.variant for j in group])
    axes.grid(axis="y", visible=False)
    axes.set_xlabel(f"deviation of {group[0].check.quantity} (%)")
    return figure


def grouped(judgements, key):
    """{key: judgements that have data} in the order of first appearance."""
    groups = {}
    for judgement in judgements:
        if judgement.measurements:
            groups.setdefault(key(judgement), []).append(judgement)
    return groups


def first_by_variant(group):
    """The first judgement of each variant: several checks of a quantity show the same curve."""
    first = {}
    for judgement in group:
        first.setdefault(judgement.variant, judgement)
    return list(first.values())


def slug(name):
    """`name` as part of a file name."""
    return "".join(c if c.isalnum() or c in "_-" else "_" for c in name)
