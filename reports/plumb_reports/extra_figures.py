"""Figures asked for by [[figure]] or made by reference.py, and the small picture of the overview."""

import numpy as np

from .figure_style import COLOURS, REFERENCE_MARK, REFERENCE_STYLE, new_figure, parameter_label, png, styled, with_units
from .figures import Picture, joined, shown_components, slug
from .metrics import TIME_AXIS, NotComparable


def stated_pictures(case, runs, reference):
    """The figures of the [[figure]] tables. Raises NotComparable when a quantity is not to be had."""
    draw = {"time": time_figure, "sweep": sweep_figure}
    pictures = []
    for i, figure in enumerate(case.figures):
        usable = [run for run in runs if not run.failure]
        if usable:
            drawn = styled(draw[figure.kind], figure, usable, reference)
            against = "time" if figure.kind == "time" else case.sweep.parameter
            pictures.append(Picture(f"figure_{i + 1}_{slug(figure.quantity)}", png(drawn),
                                    f"{figure.quantity} against {against}."))
    return pictures


def time_figure(stated, runs, reference):
    """A quantity (its first component) of the finest run of each variant against time."""
    figure = new_figure(6.4, 3.6)
    axes = figure.subplots()
    for k, run in enumerate({run.variant: run for run in runs}.values()):
        t, values, _ = reference.measured(stated.quantity, run)
        values = values.reshape(len(t), -1)
        axes.plot(t, values[:, 0], color=COLOURS[k % len(COLOURS)], label=run.variant)
        axes.set_ylabel(with_units(stated.quantity, reference.units(stated.quantity, run)))
        axes.set_xlabel(reference.axis(stated.quantity, t))
    axes.set_xscale(stated.x)
    axes.legend()
    return figure


def sweep_figure(stated, runs, reference):
    """The last value of a quantity against the sweep parameter, for each variant."""
    figure = new_figure(6.4, 3.6)
    axes = figure.subplots()
    swept = [run for run in runs if run.value is not None]
    for k, variant in enumerate(dict.fromkeys(run.variant for run in swept)):
        own = [run for run in swept if run.variant == variant]
        last = [np.ravel(reference.measured(stated.quantity, run)[1][-1])[0] for run in own]
        axes.plot([run.value for run in own], last, "o-", color=COLOURS[k % len(COLOURS)], label=variant)
    if swept:
        axes.set_xlabel(parameter_label(swept[0].parameter))
        axes.set_ylabel(with_units(stated.quantity, reference.units(stated.quantity, swept[0])))
        axes.legend()
    axes.set_xscale(stated.x)
    return figure


def authors_pictures(runs, reference):
    """The figures that figures(runs) of reference.py returns, as (name, Figure, caption)."""
    if not reference.function("figures"):
        return []
    usable = [run for run in runs if not run.failure]
    made = styled(reference.call, "figures", usable) if usable else []
    try:
        return [Picture(f"own_{slug(name)}", png(figure), caption) for name, figure, caption in made]
    except (TypeError, ValueError, AttributeError) as error:
        raise NotComparable(f"reference.py: figures() must return (name, Figure, caption) entries: {error}") from error


def authors_table(runs, reference):
    """The table that table(runs) of reference.py returns: {"columns", "rows", "caption"}, or None."""
    usable = [run for run in runs if not run.failure]
    if not reference.function("table") or not usable:
        return None
    table = reference.call("table", usable)
    if not isinstance(table, dict) or set(table) != {"columns", "rows", "caption"} or any(
            len(row) != len(table["columns"]) for row in table["rows"]):
        raise NotComparable("reference.py: table() must return columns, rows of that many cells, and caption")
    return table


def thumbnail(judgements):
    """A small PNG of the case's first curve against its reference, or of its first errors; None without data."""
    usable = [j for j in judgements if j.comparisons]
    curves = [j for j in usable if j.comparisons[-1].is_series and len(j.comparisons[-1].t) > 1]
    swept = [j for j in usable if len(j.measurements) > 1 and all(m.value > 0 for m in j.measurements)]
    if curves:
        return png(styled(curve_thumbnail, curves[0].comparisons[-1]), dpi=100)
    if swept:
        return png(styled(error_thumbnail, swept[0]), dpi=100)
    return png(styled(deviation_thumbnail, usable), dpi=100) if usable else None


def curve_thumbnail(data):
    """The curve and its reference without numbers."""
    figure, axes = bare_axes()
    for k, component in enumerate(shown_components(data)):
        axes.plot(data.t, data.measured[:, component], color=COLOURS[k], **joined(data, 1.6))
        if data.expected is not None:
            style = REFERENCE_STYLE if data.axis == TIME_AXIS else REFERENCE_MARK
            axes.plot(data.t, data.expected[:, component], **style)
    return figure


def error_thumbnail(judgement):
    """Errors against the sweep parameter, both logarithmic, without numbers."""
    figure, axes = bare_axes()
    axes.loglog([run.value for run in judgement.runs], [m.value for m in judgement.measurements], "o-",
                color=COLOURS[0])
    axes.tick_params(which="both", length=0, labelbottom=False, labelleft=False)
    return figure


def deviation_thumbnail(judgements):
    """Last values against their reference: points near the line agree."""
    figure, axes = bare_axes()
    pairs = [(j.comparisons[-1].expected, j.comparisons[-1].measured) for j in judgements]
    pairs = np.array([(expected[-1, 0], measured[-1, 0]) for expected, measured in pairs if expected is not None])
    if pairs.size:
        axes.plot([pairs.min(), pairs.max()], [pairs.min(), pairs.max()], **REFERENCE_STYLE)
        axes.plot(pairs[:, 0], pairs[:, 1], "o", color=COLOURS[0])
    return figure


def bare_axes():
    """A small figure and axes without ticks."""
    figure = new_figure(2.4, 1.5)
    axes = figure.subplots()
    axes.set_xticks([])
    axes.set_yticks([])
    axes.grid(visible=False)
    return figure, axes
