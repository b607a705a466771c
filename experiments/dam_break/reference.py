"""Collapse of a liquid column: measured front and height, and Ritter's shallow-water dam break as a bound (README.md)."""

import math
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

import tables  # noqa: E402

UNITS = {"front": "1", "height": "1", "front_speed": "1", "front_bound": "1", "arrival": "1"}
AXES = {"arrival": "row"}
COLUMNS = {1: "front_square.csv", 2: "front_tall.csv"}  # n^2 = height/width
TIME_ERROR, PLACE_ERROR = 0.05, 0.02  # standard, in T and Z: source.toml of the tables; the zero of time is not in it


class Column:
    """initial = {law = "dam_break", width = a, height = n^2 a}, gravity along the last axis that has one."""

    def __init__(self, scene):
        initial = scene["fluid"]["initial"]
        self.width, self.height = initial["width"], initial["height"]
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
    """dZ/dT by least squares between Z = least and most, and its standard error: free of the zero of time."""
    rows = tables.table(f"martin_moyce_1952/{COLUMNS[column.ratio]}")
    keep = (rows["Z"] >= least) & (rows["Z"] <= most)
    (slope, _), covariance = np.polyfit(rows["T"][keep], rows["Z"][keep], 1, cov=True)
    return {"value": float(slope), "uncertainty": float(math.sqrt(covariance[0, 0]))}


def ritter_front(column, t):
    """Z of Ritter's front, 1 + 2 t sqrt(g n^2 a)/a: no friction, no vertical acceleration, unlimited reservoir. A bound."""
    return 1.0 + 2.0 * column.front_time(t)


def ritter_depth(column, x, t):
    """Depth/(n^2 a) at x, m, past the dam's place at t > 0 s: (2 - x/(t c))^2/9 between -tc and 2tc, c = sqrt(g n^2 a)."""
    c = math.sqrt(column.g * column.height)
    return (2.0 - np.clip(np.asarray(x, float) / (t * c), -1.0, 2.0)) ** 2 / 9.0


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
    if quantity == "arrival":  # T at the rows' Z
        rows = tables.table(f"martin_moyce_1952/{COLUMNS[column.ratio]}")
        return {"value": rows["T"], "uncertainty": np.full(len(rows["T"]), TIME_ERROR)}
    raise KeyError(quantity)
