"""Collapse of a liquid column: measured front and height, and Ritter's shallow-water dam break as a bound (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import tables  # noqa: E402

UNITS = {"front": "1", "height": "1", "front_speed": "1", "front_bound": "1", "arrival": "1", "front_shifted": "1",
         "time_offset": "1"}
AXES = {"arrival": "row"}
FIRST, LAST = 1.4, 4.0  # window of Z in which fronts are compared: the gate is gone, the table not at its end
ZERO_OF_TIME = 0.2  # standard uncertainty of the zero of T: source.toml of the tables
COLUMNS = {1: "front_square.csv", 2: "front_tall.csv"}  # n^2 = height/width
TIME_ERROR, PLACE_ERROR = 0.05, 0.02  # standard, in T and Z: source.toml of the tables; the zero of time is not in it


class Column:
    """fill = {law = "box", ...} with corners (0, 0) and (a, n^2 a): wall at x = 0, floor at y = 0."""

    def __init__(self, scene):
        fill = scene["fluid"]["fill"]
        self.width, self.height = fill["upper"][0] - fill["lower"][0], fill["upper"][1] - fill["lower"][1]
        self.g = max(abs(value) for value in scene["domain"]["gravity"])
        self.ratio = round(self.height / self.width)
        if self.ratio not in COLUMNS or not math.isclose(self.ratio * self.width, self.height, rel_tol=1e-6):
            raise ValueError("measured columns are as high as wide, or twice as high")

    def front_time(self, t):
        """T = n t sqrt(g/a) of a time, s."""
        return math.sqrt(self.ratio * self.g / self.width) * np.asarray(t, float)

    def height_time(self, t):
        """tau = t sqrt(g/a)."""
        return math.sqrt(self.g / self.width) * np.asarray(t, float)


def measured(x, y, at, x_error, y_error):
    """{"value", "uncertainty"} of the polyline through (x, y) at the places `at`; nan outside, so that a window has to be stated."""
    at = np.asarray(at, float)
    inside = (at >= x[0]) & (at <= x[-1])
    value = np.where(inside, np.interp(at, x, y), np.nan)
    slope = np.interp(at, x, np.gradient(y, x))
    return {"value": value, "uncertainty": np.where(inside, np.hypot(y_error, slope * x_error), np.nan)}


def front(column, t):
    """Z = front/a with its standard uncertainty at times t, s."""
    rows = tables.table(f"martin_moyce_1952/{COLUMNS[column.ratio]}")
    return measured(rows["T"], rows["Z"], column.front_time(t), TIME_ERROR, PLACE_ERROR)


def height(column, t):
    """H = height at the wall/(n^2 a) with its standard uncertainty at times t, s; the tall column only."""
    if column.ratio != 2:
        raise ValueError("heights are tabulated for the column n^2 = 2 only")
    rows = tables.table("martin_moyce_1952/height_tall.csv")
    return measured(rows["tau"], rows["H"], column.height_time(t), TIME_ERROR, PLACE_ERROR)


def speed_of_front(column, least=2.0, most=4.0):
    """dZ/dT by least squares between Z = least and most, free of the zero of time, and its standard uncertainty: that of the rows
    as the table states it, taken as independent. How well the rows fit a line says less: what they share does not scatter."""
    rows = tables.table(f"martin_moyce_1952/{COLUMNS[column.ratio]}")
    keep = (rows["Z"] >= least) & (rows["Z"] <= most)
    slope, _ = np.polyfit(rows["T"][keep], rows["Z"][keep], 1)
    spread = np.linalg.norm(rows["T"][keep] - rows["T"][keep].mean())
    return {"value": float(slope), "uncertainty": float(math.hypot(PLACE_ERROR, slope * TIME_ERROR) / spread)}


def ritter_front(column, t):
    """Z of Ritter's front, 1 + 2 t sqrt(g n^2 a)/a: no friction, no vertical acceleration, unlimited reservoir. A bound."""
    return 1.0 + 2.0 * column.front_time(t)


def ritter_depth(column, x, t):
    """Depth/(n^2 a) at x, m, past the dam's place at t > 0 s: (2 - x/(t c))^2/9 between -tc and 2tc, c = sqrt(g n^2 a)."""
    c = math.sqrt(column.g * column.height)
    return (2.0 - np.clip(np.asarray(x, float) / (t * c), -1.0, 2.0)) ** 2 / 9.0


def rows_in_window(column):
    """Rows (T, Z) of the front's table between Z = FIRST and LAST."""
    rows = tables.table(f"martin_moyce_1952/{COLUMNS[column.ratio]}")
    keep = (rows["Z"] >= FIRST) & (rows["Z"] <= LAST)
    return rows["T"][keep], rows["Z"][keep]


def tracked(run):
    """(t, front/a, height/(n^2 a)) of the snapshots: the farthest particle along the floor, the highest one within a tenth of
    the width from the wall, each with half a spacing for the rest of the particle."""
    column, half = Column(run.scene), 0.5 * run.scene["fluid"]["spacing"]
    states = [run.snapshot(k) for k in range(len(run.snapshot_files()))]
    far, high = [], []
    for state in states:
        x, y = state["fluid"]["x"][:, 0], state["fluid"]["x"][:, 1]
        low = y < 0.5 * column.width  # not what has left the body of the fluid
        far.append((x[low].max() + half) / column.width)
        high.append((y[x < 0.1 * column.width].max() + half) / column.height)
    return np.array([state["time"] for state in states]), np.array(far), np.array(high)


def arrivals(run):
    """T at which the front reaches the places of the table's rows in the window."""
    t, far, _ = tracked(run)
    column = Column(run.scene)
    return np.interp(rows_in_window(column)[1], np.maximum.accumulate(far), column.front_time(t))


def solved_speed(run, least=2.0, most=4.0):
    """dZ/dT by least squares between Z = least and most, as of the table."""
    t, far, _ = tracked(run)
    keep = (far >= least) & (far <= most)
    return float(np.polyfit(Column(run.scene).front_time(t)[keep], far[keep], 1)[0])


def measure(quantity, run):
    column = Column(run.scene)
    if quantity == "front":
        t, far, _ = tracked(run)
        return t, far
    if quantity == "height":
        t, _, high = tracked(run)
        return t, high
    if quantity == "front_speed":
        return solved_speed(run)
    if quantity == "time_offset":
        return float(np.mean(arrivals(run) - rows_in_window(column)[0]))
    if quantity == "front_shifted":  # scatter of the arrivals about their mean offset
        offset = arrivals(run) - rows_in_window(column)[0]
        return float(np.sqrt(np.mean((offset - offset.mean()) ** 2)))
    return NotImplemented


def figures(runs):
    """Front and height of every run on the measured points, and Ritter's bound."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.5, 4.0), layout="constrained")
    place, height_axes = figure.subplots(1, 2)
    good = [run for run in runs if not run.failure]
    for run in good:
        column = Column(run.scene)
        t, far, high = tracked(run)
        label = f"{run.variant}, a/spacing = {column.width / run.scene['fluid']['spacing']:.0f}"
        place.plot(column.front_time(t), far, lw=1.0, label=label)
        height_axes.plot(column.height_time(t), high, lw=1.0)
    for ratio in sorted({Column(run.scene).ratio for run in good}):
        rows = tables.table(f"martin_moyce_1952/{COLUMNS[ratio]}")
        place.errorbar(rows["T"], rows["Z"], PLACE_ERROR, TIME_ERROR, fmt="kx" if ratio == 2 else "k+", ms=4, lw=0.7, label=f"measured, n^2 = {ratio}")
    rows = tables.table("martin_moyce_1952/height_tall.csv")
    height_axes.errorbar(rows["tau"], rows["H"], PLACE_ERROR, TIME_ERROR, fmt="kx", ms=4, lw=0.7)
    time = np.linspace(0.0, 2.0, 2)
    place.plot(time, 1.0 + 2.0 * time, "k:", lw=0.8, label="Ritter (bound)")
    place.set_xlim(0.0, 3.6)
    place.set_ylim(1.0, 5.0)
    height_axes.set_xlim(0.0, 2.6)
    place.set_xlabel("T = n t sqrt(g/a)")
    place.set_ylabel("front Z = x/a")
    height_axes.set_xlabel("tau = t sqrt(g/a)")
    height_axes.set_ylabel("height at the wall/(n^2 a)")
    place.legend(fontsize="x-small")
    return [("front", figure, "Front (left) and height at the wall (right); the zero of the measured time is uncertain by 0.2 in T.")]


def reference(quantity, scene, t):
    column = Column(scene)
    if quantity == "front":
        return front(column, t)
    if quantity == "height":
        return height(column, t)
    if quantity == "front_speed":
        return speed_of_front(column)
    if quantity == "front_bound":
        return ritter_front(column, t)
    if quantity == "front_shifted":
        return 0.0
    if quantity == "time_offset":
        return {"value": 0.0, "uncertainty": ZERO_OF_TIME}
    if quantity == "arrival":  # T at the rows' Z
        rows = tables.table(f"martin_moyce_1952/{COLUMNS[column.ratio]}")
        return {"value": rows["T"], "uncertainty": np.full(len(rows["T"]), TIME_ERROR)}
    raise KeyError(quantity)
