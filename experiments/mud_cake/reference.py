"""The mud-cake paper's Table 7 and claims, and the measures of a run (README.md). Published numbers are another group's simulation."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "reference_data")]

from bed_fields import draw_cylinders, fields_figure, studies_figure  # noqa: E402
from theory import clean_channel, mud_cake  # noqa: E402
from theory.bed_resistance import bed_drop  # noqa: E402
from theory.clean_channel import DEPTH, MEAN, Array  # noqa: E402

UNITS = {
    "pressure": "1", "rise": "1", "rise_over_published": "1", "bed_height": "m", "filled_height": "m", "bed_start": "m", "bed_porosity": "1", "resting_share": "1",
    "flow_change": "1", "volume_balance": "1", "trends_broken": "1", "series_trends_broken": "1", "pressure_change": "1", "height_change": "1",
    "clean_pressure": "Pa", "injected_share": "1", "pore_filling": "1", "rows_missed_pressure": "1", "rows_missed_rise": "1", "rows_missed_height": "1",
}
WITHIN = {"pressure": 0.1, "rise": 0.25, "height": 0.15}  # of Table 7, as the single rows are judged
TWELVE = "n12_d08_single"  # whose clean pressure is the reference pressure of all with the same cells
MEMBERS = ("", "member_2_", "member_3_", "member_4_")  # before the names of the studies on the strip
FINE, SHORT = "fine_", "short_"  # before the names of the rows with cells of half the width, steps of half the length
ROWS = {row.name: row for row in mud_cake.rows()}
INJECTED = 0.8  # s, of injection in Table 7


# --- what a scene says ---


def rows_wall(scene):
    return next(wall for wall in scene["wall"] if wall["shape"] == "cylinder_rows")


def array(scene):
    wall = rows_wall(scene)
    return Array(wall["per_row"], wall["upper"][0] - wall["lower"][0], scene["domain"]["size"][0])


def flow(scene):
    """m3/s, that the inlet is to bring."""
    profile_ = scene["inlet"][0]["profile"]
    return profile_["speed" if profile_["law"] == "uniform" else "mean_speed"] * scene["domain"]["size"][0] * DEPTH


def injectors(scene):
    found = scene["injector"]
    return found if isinstance(found, list) else [found]


def rate(scene):
    """Over the reference rate: one grain per point and 0.01 s."""
    return float(sum(clean_channel.paper("injection")["interval"] / one["interval"] for one in injectors(scene)))


def row(scene):
    """The row of Table 7 that a scene of the whole channel stands for, or None."""
    return mud_cake.row_of(round(rate(scene), 6), rows_wall(scene)["per_row"], injectors(scene)[0]["diameter"])


def start(scene):
    """When the first grain enters, s."""
    return min(one["start"] for one in injectors(scene))


def reference(quantity, scene, t):
    """Of Table 7. What is judged by a range has no reference."""
    if quantity == "trends_broken" or quantity == "series_trends_broken":
        return 0.0
    published = row(scene)
    if quantity == "pressure":
        return published.pressure
    if quantity == "rise":
        return published.pressure - published.clean
    if quantity in ("bed_height", "filled_height"):
        return published.bed_height
    if quantity == "bed_start":
        texts = clean_channel.table("mudcake_ddpm_dem/text_values.csv")
        return float(texts["deposition_start"][list(texts["obstacles"]).index(rows_wall(scene)["per_row"])])
    raise KeyError(quantity)


# --- what a run has ---


def series(run):
    """(t since the first grain, greatest pressure, Pa)."""
    t, p = run.series("greatest_pressure")
    return t - start(run.scene), np.ravel(p)


def clean_pressure(run):
    """Greatest pressure just before the first grain, Pa."""
    t, p = series(run)
    return float(np.interp(0.0, t, p))


def reference_pressure(run):
    """Of the clean channel with 12 cylinders a row and the same cells, Pa: the run's own unless it has 16."""
    return clean_pressure(run if rows_wall(run.scene)["per_row"] != 16 else run.other((FINE if run.variant.startswith(FINE) else "") + TWELVE))


def pressures(run):
    """(t since the first grain, P)."""
    t, p = series(run)
    return t, p / reference_pressure(run)


def final_pressure(run):
    """P at the end: the mean over the last 0.04 s, two intervals of the lowest rate, since the fluid that entering grains displace comes in pulses."""
    t, p = pressures(run)
    return float(np.mean(p[t > t[-1] - 0.04 + 1e-9]))


class Bed:
    """The grains of a run at a snapshot, and the measures of those at rest."""

    def __init__(self, run, k=-1):
        grains = run.snapshot(k).get("grains", {"x": np.empty((0, 3)), "v": np.empty((0, 3)), "diameter": np.empty(0)})
        self.x, self.v, self.array = grains["x"], grains["v"], array(run.scene)
        self.d = float(injectors(run.scene)[0]["diameter"])
        self.resting = mud_cake.at_rest(self.v)
        self.y = self.x[self.resting, 1]

    @property
    def height(self):
        return mud_cake.bed_height(self.y, self.d)

    @property
    def filled_height(self):
        return mud_cake.filled_height(self.y, self.d, self.array)

    @property
    def porosity(self):
        return mud_cake.bed_porosity(self.y, self.d, self.array)

    @property
    def start(self):
        return mud_cake.bed_start(self.y, self.d)

    def expected_rise(self, law, flow):
        """Pa, of the grains at rest by a drag law, from their number and height."""
        return bed_drop(law, len(self.y), self.d, self.start, self.height, self.array, flow)


def profile(run, k, lower=0.27, upper=0.29, bins=50):
    """Mean of the velocity along y between two heights in `bins` across the channel, m/s: weighted by the open volume."""
    fluid = run.snapshot(k)["fluid"]
    inside = (fluid["x"][:, 1] > lower) & (fluid["x"][:, 1] < upper)
    edges = np.linspace(0.0, run.scene["domain"]["size"][0], bins + 1)
    x, v = fluid["x"][inside, 0], fluid["v"][inside, 1]
    return np.histogram(x, edges, weights=v)[0] / np.maximum(np.histogram(x, edges)[0], 1)


def snapshot_at(run, time):
    """Number of the snapshot next to a time since the first grain."""
    interval = run.scene["time"]["output_interval"]
    return min(round((start(run.scene) + time) / interval), len(run.snapshot_files()) - 1)


def flow_change(run):
    """Of the profile between injection and array 0.1 s after the first grain: root mean square over that of the clean one."""
    clean, now = profile(run, snapshot_at(run, 0.0)), profile(run, snapshot_at(run, 0.1))
    return float(np.linalg.norm(now - clean) / np.linalg.norm(clean))


def volume_balance(run):
    """Of what leaves: inflow and the grains' volume, whose room the fluid makes; mean over the last half of the injection, less 1."""
    scene = run.scene
    t, out = run.series("flow_out")
    inflow = np.ravel(run.series("flow_in")[1])
    late = t > start(scene) + 0.5 * (scene["time"]["end"] - start(scene))
    points = sum(one_points(one) / one["interval"] for one in injectors(scene))
    grains = points * math.pi * float(injectors(scene)[0]["diameter"]) ** 3 / 6.0
    return float(np.mean(np.ravel(out)[late]) / (np.mean(inflow[late]) - grains) - 1.0)


def one_points(injector):
    """How many points an injector has."""
    if "points" in injector:
        return len(injector["points"])
    return len((HERE / injector["path"]).read_text(encoding="utf-8").splitlines()) - 1


def injected_share(run):
    """Grains that have entered over those due."""
    scene, due = run.scene, 0
    for one in injectors(scene):
        last = min(one["end"] - 1e-9, scene["time"]["end"] - scene["time"]["step"])  # grains enter where a step begins
        due += one_points(one) * (math.floor((last - one["start"]) / one["interval"] + 1e-6) + 1)
    return len(Bed(run).x) / due


def all_rows(run, value):
    """{row: value} of the twelve runs of Table 7, of the kind (as published or hindered) of this run."""
    prefix = run.variant[:-len(row(run.scene).name)]
    return {one: value(run.other(prefix + name)) for name, one in ROWS.items()}


def missed(run, what):
    """How many of the twelve rows are not within what a single one is asked for."""
    quantity = {"height": "bed_height"}.get(what, what)
    errors = all_rows(run, lambda one: abs(measure(quantity, one) / reference(quantity, one.scene, None) - 1.0))
    return float(sum(error > WITHIN[what] for error in errors.values()))


def broken(claims):
    return float(sum(not holds for holds in claims.values()))


def measure(quantity, run):
    simple = {
        "pressure": final_pressure, "clean_pressure": clean_pressure, "flow_change": flow_change, "volume_balance": volume_balance,
        "rise": lambda r: final_pressure(r) - clean_pressure(r) / reference_pressure(r),
        "bed_height": lambda r: Bed(r).height, "filled_height": lambda r: Bed(r).filled_height, "bed_start": lambda r: Bed(r).start, "bed_porosity": lambda r: Bed(r).porosity,
        "resting_share": lambda r: mud_cake.resting_share(Bed(r).x[:, 1], Bed(r).v), "injected_share": injected_share, "pore_filling": lambda r: mud_cake.pore_filling(Bed(r).x[:, 1], row(r.scene)),
        "trends_broken": lambda r: broken(mud_cake.trends(all_rows(r, lambda one: (final_pressure(one), Bed(one).height)))),
        "series_trends_broken": lambda r: broken(mud_cake.series_trends(all_rows(r, pressures))),
        "pressure_change": lambda r: float(np.mean(changes(r, final_pressure))),
        "height_change": lambda r: float(np.mean(changes(r, lambda one: Bed(one).height))),
    }
    if quantity.startswith("rows_missed_"):
        return missed(run, quantity.removeprefix("rows_missed_"))
    if quantity == "rise_over_published":
        return measure("rise", run) / reference("rise", run.scene, None)
    return simple[quantity](run) if quantity in simple else NotImplemented


def unchanged(run):
    """The variant of the whole width that one differs from in one thing."""
    bare = run.variant.removeprefix(FINE).removeprefix(SHORT)
    return bare if bare != run.variant else "n16_d06_single"


def changes(run, value):
    """Of a value by what the variant changes, relative; by member where it has several."""
    if not run.variant.startswith("strip"):
        return [value(run) / value(run.other(unchanged(run))) - 1.0]
    return [value(run.other(one + run.variant)) / value(run.other(one + "strip")) - 1.0 for one in MEMBERS]


# --- tables and figures ---


def finished(runs):
    return [run for run in runs if run.failure is None]


def table(runs):
    """Every run beside Table 7, and what the drag law says of its bed."""
    lines = []
    for run in finished(runs):
        bed, published = Bed(run), row(run.scene)
        values = [f"{1e3 * bed.filled_height:.1f}"] + [f"{1e3 * mud_cake.bed_height(bed.y, bed.d, ends):.1f}" for ends in mud_cake.READINGS.values()]
        law = run.scene["coupling"]["drag"]
        clean, p = clean_pressure(run), series(run)[1][-1]
        try:
            scaled = f"{final_pressure(run):.3f}"
        except Exception:  # the run whose clean pressure is wanted failed
            scaled = ""
        lines.append([run.variant, scaled, f"{published.pressure:.2f}" if published else "", *values,
                      f"{1e3 * published.bed_height:.1f}" if published else "", filling(run), f"{1e3 * bed.start:.1f}", f"{bed.porosity:.3f}",
                      f"{len(bed.y)} of {mud_cake.arrived(bed.x[:, 1])} of {len(bed.x)}", f"{1e-3 * clean:.2f}", f"{1e-3 * (p - clean):.2f}",
                      f"{1e-3 * bed.expected_rise(law, flow(run.scene)):.2f}"])
    readings = [f"h_b, {name} (mm)" for name in ("filled", *mud_cake.READINGS)]
    columns = ["variant", "P", "Table 7", *readings, "Table 7 (mm)", "filling, needed", "start (mm)", "porosity", "at rest, arrived, injected", "clean (kPa)",
               "rise (kPa)", "rise by the law (kPa)"]
    return {"columns": columns, "rows": lines, "caption": CAPTION + fits(runs)}


def filling(run):
    """Of the pores where the published bed would be, and what that bed needs."""
    one = row(run.scene)
    return f"{mud_cake.pore_filling(Bed(run).x[:, 1], one):.2f}, {mud_cake.needed_filling(one):.2f}" if one else ""


CAPTION = ("Every run at its end. P: greatest pressure over that of the clean channel with 12 cylinders a row and the same cells; h_b: where the pores are filled, and four readings of the heights of "
           "the grains at rest, each plus one diameter, the first of those is judged; filling: share of the room between the cylinders that grains fill where the published bed would be, and what that bed would need; start: the 2nd percentile less a radius; porosity: of the room between the cylinders. Rise by the law: the "
           "drag law's pressure gradient for as many grains over that height. ")


def fits(runs):
    """The correlation in the form of equation (6), fitted to what was computed, beside the published one."""
    published = mud_cake.published_correlation()
    refit = mud_cake.correlation(list(ROWS.values()), [one.pressure for one in ROWS.values()])
    texts = [said("Equation (6) as printed, on Table 7", published), said("refitted to Table 7", refit)]
    computed = of_table(finished(runs))
    if len(computed) == len(ROWS):
        own = mud_cake.correlation(list(ROWS.values()), [final_pressure(computed[name]) for name in ROWS])
        texts.append(said("fitted to the runs", own))
    return "; ".join(texts) + "."


def said(what, fit):
    c = fit.coefficients
    return (f"{what}: P = {c[0]:.4g} + {c[1]:.4g} N + {c[2]:.4g} rate + {c[3]:.4g} d/mm, R2 = {fit.r_squared:.3f}, "
            f"residuals {np.min(fit.residuals):.2f} to {np.max(fit.residuals):.2f}")


def figures(runs):
    """Beds by speed (Figures 5 and 7), P over time (Figure 6), P against the rate (Figure 8), and velocity and pressure."""
    runs = finished(runs)
    drawn = [("beds", beds_figure(runs), "Grains at the end by their speed over the mean velocity, as in Figures 5 and 7; circles are the cylinders, lines the ends of the published bed."),
             ("pressure", series_figure(runs), "P over the time since the first grain, as in Figure 6; crosses are Table 7.")]
    rows = of_table(runs)
    if len(rows) > 1:
        drawn.append(("rates", rates_figure(rows), "P against the rate, as in Figure 8: lines are Table 7, points the runs, dashed the correlation refitted to Table 7."))
    if runs:
        one = rows.get(TWELVE, runs[0])
        drawn += studies(runs)
        drawn.append(("fields", fields_figure(one), f"Speed and pressure of the fluid at the end of {one.variant}, as in Figure 3."))
    return drawn


def studies(runs):
    """What each study on the strip changes: [(name, figure, caption)], nothing where no study is."""
    names = {run.variant for run in runs}
    done = [run for run in runs if run.variant.startswith("strip_") and MEMBERS[-1] + run.variant in names]
    found = {run.variant.removeprefix("strip_").replace("_", " "): (changes(run, final_pressure), changes(run, lambda one: Bed(one).height)) for run in done}
    return [("studies", studies_figure(found), "What each study on the strip changes: four members (grey), mean and standard error.")] if found else []


def of_table(runs):
    """{row of Table 7: the run with the finest cells of those that are there}."""
    found = {run.variant: run for run in runs}
    return {name: found.get(FINE + name, found.get(name)) for name in ROWS if FINE + name in found or name in found}


def shown(runs, most=12):
    """Those that Table 7 has, or the first ones."""
    return (list(of_table(runs).values()) or runs)[:most]


def beds_figure(runs, lower=0.18, upper=0.27):
    from matplotlib.collections import EllipseCollection
    from matplotlib.figure import Figure

    chosen = shown(runs)
    columns = min(4, max(len(chosen), 1))
    figure = Figure(figsize=(2.6 * columns, 4.2 * math.ceil(max(len(chosen), 1) / columns)), layout="constrained")
    for axes, run in zip(np.ravel(figure.subplots(math.ceil(max(len(chosen), 1) / columns), columns, squeeze=False)), chosen):
        bed = Bed(run)
        axes.set(title=run.variant, xlim=(0.0, 1e3 * run.scene["domain"]["size"][0]), ylim=(1e3 * lower, 1e3 * upper), aspect="equal")
        axes.title.set_fontsize(8)
        draw_cylinders(axes, rows_wall(run.scene), bed.array)
        size = np.full(len(bed.x), 1e3 * bed.d)
        dots = EllipseCollection(size, size, np.zeros(len(size)), units="x", offsets=1e3 * bed.x[:, :2], transOffset=axes.transData, cmap="viridis")
        dots.set_array(np.linalg.norm(bed.v, axis=1) / MEAN)
        dots.set_clim(0.0, 1.5)
        axes.add_collection(dots)
        published = row(run.scene)
        if published and not math.isnan(bed.start):
            for y in (bed.start, bed.start + published.bed_height):
                axes.axhline(1e3 * y, color="#B00020", lw=0.8, ls=":")
    if chosen:
        figure.colorbar(dots, ax=figure.axes, shrink=0.5, label="speed over mean velocity")
    return figure


def series_figure(runs):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    sides = figure.subplots(1, 2, sharey=True)
    for run in shown(runs):
        try:
            t, p = pressures(run)
        except Exception:  # without the run whose clean pressure is the unit
            continue
        twelve, published = rows_wall(run.scene)["per_row"] != 16, row(run.scene)
        line, = sides[1 if twelve else 0].plot(t, p, lw=1.0, label=run.variant)
        if published:
            sides[1 if twelve else 0].plot(INJECTED, published.pressure, "x", color=line.get_color())
    for axes, title in zip(sides, ("16 cylinders a row", "12 cylinders a row")):
        axes.set(title=title, xlabel="time since the first grain (s)", ylabel="P (-)")
        if axes.lines:
            axes.legend(fontsize=6)
    return figure


def rates_figure(rows):
    from matplotlib.figure import Figure

    figure = Figure(figsize=(5.5, 4.0), layout="constrained")
    axes = figure.subplots()
    refit = mud_cake.correlation(list(ROWS.values()), [one.pressure for one in ROWS.values()]).coefficients
    for color, (per_row, d) in zip(("C0", "C1", "C2", "C3"), ((16, 6e-4), (16, 7e-4), (16, 8e-4), (12, 8e-4))):
        known = [mud_cake.row_of(one, per_row, d) for one in (0.5, 1.0, 2.0)]
        axes.plot([one.rate for one in known], [one.pressure for one in known], color=color, label=f"N = {per_row}, {1e3 * d:g} mm")
        axes.plot([0.5, 2.0], [refit @ [1.0, per_row, one, 1e3 * d] for one in (0.5, 2.0)], color=color, ls="--", lw=0.7)
        found = [(ROWS[name].rate, final_pressure(run)) for name, run in rows.items() if ROWS[name] in known]
        if found:
            axes.plot(*zip(*found), "o", color=color)
    axes.set(xlabel="rate over the reference rate (-)", ylabel="P (-)")
    axes.legend(fontsize=7)
    return figure
