"""The figure of a bisection: measured boundary, default and theory for every variant."""

from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from .figure_style import COLOURS, new_figure, parameter_label, png, styled
from .figures import Picture, slug
from .verdicts import number


def bisection_pictures(case, runs, judgements):
    """One figure for every bisection of which at least one variant was run."""
    pictures = []
    for bisection in case.bisections:
        own = [run for run in runs if run.variant in bisection.variants and not run.failure]
        if own:
            caption = (f"Bisection {bisection.id}: highest stable and lowest unstable {bisection.parameter} (bar and its "
                       f"two ends) by variant, with the default {number(bisection.default)} (dashed). Crosses: theory, where "
                       "a check compares with it. An arrow: no boundary was found up to there.")
            predicted = predictions(bisection, judgements)
            figure = styled(boundary_figure, bisection, own, predicted)
            pictures.append(Picture(f"bisection_{slug(bisection.id)}", png(figure), caption))
    return pictures


def predictions(bisection, judgements):
    """{variant: expected boundary} of the checks that compare the boundary with a reference."""
    return {j.variant: float(j.comparisons[-1].expected.ravel()[-1]) for j in judgements
            if j.check.quantity == f"{bisection.id}.boundary" and j.comparisons and j.comparisons[-1].expected is not None}


def boundary_figure(bisection, runs, predicted):
    """One row per variant on a logarithmic axis; stable up to the bar."""
    figure = new_figure(7.6, 1.3 + 0.3 * len(runs))
    axes = figure.subplots()
    rows = range(len(runs))[::-1]
    for row, run in zip(rows, runs):
        draw_bracket(axes, row, run, bisection)
        if run.variant in predicted:
            axes.plot(predicted[run.variant], row, "x", color="black", markersize=7, markeredgewidth=1.4, zorder=3)
    axes.axvline(bisection.default, color="black", linestyle=(0, (4, 2)), linewidth=1.1, label="default")
    axes.plot([], [], color="#9CCBB9", linewidth=6, label="stable")
    axes.plot([], [], color=COLOURS[1], marker="|", markersize=9, linewidth=3, label="measured boundary")
    if predicted:
        axes.plot([], [], "x", color="black", linestyle="none", label="theory")
    axes.set_yticks(list(rows), [run.variant for run in runs])
    axes.grid(axis="y", visible=False)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 3.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: number(value)))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_xlim(min(0.8 * bisection.low, 0.8 * bisection.default), 1.1 * bisection.high)
    axes.set_ylim(-0.6, len(runs) - 0.4)
    axes.set_xlabel(parameter_label(bisection.parameter))
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)
    return figure


def draw_bracket(axes, row, run, bisection):
    """The stable side as a pale bar, the bracket of the boundary as a dark one, an arrow where there is no boundary."""
    left, colour = 0.5 * min(bisection.low, bisection.default), COLOURS[1]
    if run.stable is not None:
        axes.plot([left, run.stable], [row, row], color="#9CCBB9", linewidth=6, solid_capstyle="butt", zorder=1)
    if run.stable is not None and run.unstable is not None:
        axes.plot([run.stable, run.unstable], [row, row], color=colour, marker="|", markersize=9, linewidth=3, zorder=2)
    elif run.unstable is None:
        axes.plot(run.stable, row, ">", color="#2F8F6F", markersize=8, zorder=2)
    else:
        axes.plot(run.unstable, row, "<", color=colour, markersize=8, zorder=2)
