"""Measures of a bed of grains in the porous channel, the paper's table and claims, and its correlation.

At rest is a grain slower than a twentieth of the channel's mean velocity. Bed height: the paper does not say how it was
measured; here the distance between the 2nd and the 98th percentile of the heights of grains at rest, plus one diameter.
Grains that are caught in corners far above the bed count in that; the height over which the pores are filled knows
nothing of them.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import trapezoid

from tables import table
from theory import clean_channel
from theory.clean_channel import DEPTH, MEAN, WHICH, Array
from theory.settling import stokes_velocity

REST = 0.05  # of the mean velocity
PERCENTILES = (2.0, 98.0)
READINGS = {"2 to 98 %": (2.0, 98.0), "5 to 95 %": (5.0, 95.0), "10 to 90 %": (10.0, 90.0), "lowest to highest": (0.0, 100.0)}


def at_rest(v, mean=MEAN):
    """Which of the velocities [n, 3], m/s, are those of grains at rest."""
    return np.linalg.norm(np.asarray(v, float).reshape(-1, 3), axis=1) < REST * mean


def bed_height(y, d, percentiles=PERCENTILES):
    """h_b, m, of grains of diameter d at the heights y [n] of their centres; 0 without a grain."""
    if len(y) == 0:
        return 0.0
    low, high = np.percentile(y, percentiles)
    return float(high - low + d)


def filled_height(y, d, array, step=2.5e-4):
    """Height, m, over which grains of diameter d at rest at the heights y [n] fill at least half as much of the room between
    the cylinders as where they fill most of it; both of running means over two rows. From the lowest such place up to the
    first two rows without one; 0 without a grain."""
    if len(y) == 0:
        return 0.0
    edges = np.arange(clean_channel.BOTTOM, clean_channel.TOP + 0.1, step)
    window = np.ones(max(1, round(2.0 * array.row_distance / step)))
    room = np.array([array.open_area(low, high, 3) for low, high in zip(edges, edges[1:])]) * DEPTH
    solid = np.histogram(y, edges)[0] * math.pi * d**3 / 6.0
    filling = np.convolve(solid, window, "same") / np.convolve(room, window, "same")
    filled = np.flatnonzero(filling >= 0.5 * filling.max())
    gaps = np.flatnonzero(np.diff(filled) > len(window))
    last = filled[gaps[0]] if len(gaps) else filled[-1]
    return float((last + 1 - filled[0]) * step)


def bed_start(y, d):
    """Height, m, of the bed's lower end: the 2nd percentile less a radius; NaN without a grain."""
    return float(np.percentile(y, PERCENTILES[0]) - 0.5 * d) if len(y) else math.nan


def bed_porosity(y, d, array):
    """Void fraction of the bed: of the room that the cylinders leave between the ends of the bed, the share without grains.

    Grains whose centres lie between the percentiles count whole; NaN without a grain.
    """
    if len(y) == 0:
        return math.nan
    low, high = np.percentile(y, PERCENTILES)
    if high <= low:
        return math.nan
    inside = np.count_nonzero((y >= low) & (y <= high))
    return 1.0 - inside * math.pi * d**3 / 6.0 / (array.open_area(low, high) * DEPTH)


def resting_share(y, v):
    """Share at rest of the grains that have come below the top of the porous section; NaN if none has."""
    below = np.asarray(y) < clean_channel.TOP
    return float(np.mean(at_rest(v)[below])) if below.any() else math.nan


def arrived(y):
    """How many grains are below the top of the porous section."""
    return int(np.count_nonzero(np.asarray(y) < clean_channel.TOP))


RAISED = 4.1e-4  # m: the second set of points over the first, for grains up to 0.8 mm at 1.38/2 mm across


def injection_points(diameter_clearance=1e-4, complement=False):
    """Places [59, 3], m: lines of 30 and 29 at two depths, staggered, over 40 mm of the channel's middle at y = 300 mm.

    The depths keep a radius and a clearance of the greatest grain from the symmetry planes. The complement, for a doubled rate, has
    the lines of 30 and 29 exchanged, so its points lie half way between those of the other, and is raised: grains of both sets then
    enter at once without touching, and those of the raised set have passed the others' points after 0.01 s.
    """
    injection, greatest = clean_channel.paper("injection"), clean_channel.FLUID["d_greatest"]
    depth = 0.5 * greatest + diameter_clearance
    left, length = 0.5 * (clean_channel.CHANNEL - injection["line_length"]), injection["line_length"]
    long_line = left + length * np.arange(30) / 29.0
    short_line = 0.5 * (long_line[1:] + long_line[:-1])
    near, far = (short_line, long_line) if complement else (long_line, short_line)
    height = injection["height"] + (RAISED if complement else 0.0)
    return np.array([[x, height, z] for line, z in ((near, depth), (far, DEPTH - depth)) for x in line])


class Row(NamedTuple):
    """One of Table 7: rate over the reference's, cylinders a row, diameter and bed height [m], P."""

    rate: float
    per_row: int
    d: float
    bed_height: float
    pressure: float

    @property
    def name(self):
        rate = {0.5: "half", 1.0: "single", 2.0: "double"}[self.rate]
        return f"n{self.per_row}_d{round(1e4 * self.d):02d}_{rate}"

    @property
    def clean(self):
        """P before the first grain arrives: 1 by definition for 12 cylinders, for 16 what the table implies."""
        return 1.0 if self.per_row == 12 else clean_channel.clean_pressure_ratio().value


def rows():
    """The twelve of Table 7."""
    t = table(f"{WHICH}/bed_and_pressure.csv")
    return [Row(float(r), int(n), float(d), float(h), float(p))
            for r, n, d, h, p in zip(t["rate"], t["obstacles"], t["d"], t["bed_height"], t["pressure"])]


def row_of(rate, per_row, d):
    """The row of Table 7 of these parameters, or None."""
    return next((row for row in rows() if row.rate == rate and row.per_row == per_row and math.isclose(row.d, d, rel_tol=1e-6)), None)


class Fit(NamedTuple):
    """P = constant + per_obstacle N + per_rate rate + per_diameter d (d in mm), R^2 and residuals P - fit."""

    coefficients: np.ndarray
    r_squared: float
    residuals: np.ndarray


def _columns(chosen):
    return np.column_stack([np.ones(len(chosen)), [row.per_row for row in chosen], [row.rate for row in chosen], [1e3 * row.d for row in chosen]])


def judged_fit(coefficients, chosen, pressures):
    """R^2 and residuals of given coefficients."""
    residuals = np.asarray(pressures, float) - _columns(chosen) @ coefficients
    spread = np.sum((pressures - np.mean(pressures)) ** 2)
    return Fit(np.asarray(coefficients, float), 1.0 - float(np.sum(residuals**2) / spread), residuals)


def correlation(chosen, pressures):
    """Least squares of the form of equation (6) to the pressures of rows."""
    pressures = np.asarray(pressures, float)
    solution, *_ = np.linalg.lstsq(_columns(chosen), pressures, rcond=None)
    return judged_fit(solution, chosen, pressures)


def published_correlation():
    """Equation (6) as printed, judged on Table 7 itself."""
    printed = table(f"{WHICH}/correlation.csv", si=False)
    coefficients = [float(printed[name][0]) for name in ("constant", "per_obstacle", "per_rate", "per_diameter")]
    return judged_fit(coefficients, rows(), [row.pressure for row in rows()])


def travel_time(x, settling, lower):
    """s, from the injection to the height `lower` [m] of a grain that the clean flow carries at x [m] across the channel.

    Down the free channel with the parabola at x and its settling velocity; in the porous section with the mean flow of its void
    fraction. What grains do to the flow and to each other is left out.
    """
    injection = clean_channel.paper("injection")
    parabola = 1.5 * MEAN * (1.0 - (2.0 * x / clean_channel.CHANNEL - 1.0) ** 2)
    free = (injection["height"] - max(lower, clean_channel.TOP)) / (parabola + settling)
    y = np.linspace(min(lower, clean_channel.TOP), clean_channel.TOP, 501)
    inside = MEAN * clean_channel.CHANNEL / (clean_channel.WIDTH * clean_channel.void_fraction(y)) + settling
    return float(free + trapezoid(1.0 / inside, y))


def carried(row, lower, settling, duration=0.8):
    """How many grains of a row of Table 7 the clean flow carries to the height `lower` [m] in `duration` [s]."""
    injection = clean_channel.paper("injection")
    interval = injection["interval"] / row.rate
    times = np.array([travel_time(x, settling, lower) for x in injection_points()[:, 0]])
    return int(np.sum(np.maximum(np.ceil((duration - times) / interval), 0.0)))


def lowest(row):
    """Where the grains of a row stop, m: none passes a throat narrower than itself."""
    return Array(row.per_row).stops(row.d)


def filling(count, row):
    """Share of the room between the cylinders that `count` grains of a row fill over the height of its published bed."""
    return count * math.pi * row.d**3 / 6.0 / (Array(row.per_row).open_area(lowest(row), lowest(row) + row.bed_height) * DEPTH)


def needed_filling(row):
    """The filling if all grains that the clean flow carries to the middle of the published bed are in it."""
    rho = clean_channel.FLUID["rho"]  # grains are twice as dense
    settling = stokes_velocity(2.0 * rho, rho, row.d, clean_channel.FLUID["mu"])
    return filling(carried(row, lowest(row) + 0.5 * row.bed_height, settling), row)


def pore_filling(y, row):
    """The filling by grains at the heights y [n], m."""
    y = np.asarray(y)
    return filling(int(np.count_nonzero((y >= lowest(row)) & (y < lowest(row) + row.bed_height))), row)


ALIKE = 0.05  # of P: the paper calls 3.62 and 3.70 "similar", 2.2 % apart, and 2.59 and 2.74 different, 5.6 %


def rising(t, lower, higher, from_time):
    """Whether `higher` exceeds `lower` at all times after `from_time`."""
    after = np.asarray(t) > from_time
    return bool(np.all(np.asarray(higher)[after] > np.asarray(lower)[after]))


def time_to_reach(t, p, level):
    """The first time at which p, series over t, has reached the level; infinite if never."""
    reached = np.asarray(p) >= level
    return float(np.asarray(t)[np.argmax(reached)]) if reached.any() else math.inf


def trends(results):
    """{claim: holds} of what the paper's text and Figure 6 say, for results {Row: (P, h_b)} of all twelve.

    "In time": `series_trends`.
    """
    found = {(row.rate, row.per_row, round(1e3 * row.d, 1)): value for row, value in results.items()}
    sizes, rates = (0.6, 0.7, 0.8), (0.5, 1.0, 2.0)
    steps = [(a, b, n, d) for a, b in zip(rates, rates[1:]) for n, d in [(16, d) for d in sizes] + [(12, 0.8)]]
    bigger = [(rate, a, b) for rate in rates for a, b in zip(sizes, sizes[1:])]
    return {
        "P rises with the rate": all(found[b, n, d][0] > found[a, n, d][0] for a, b, n, d in steps),
        "h_b rises with the rate": all(found[b, n, d][1] > found[a, n, d][1] for a, b, n, d in steps),
        "P rises with the diameter": all(found[rate, 16, b][0] > found[rate, 16, a][0] for rate, a, b in bigger),
        "h_b rises with the diameter": all(found[rate, 16, b][1] > found[rate, 16, a][1] for rate, a, b in bigger),
        "12 a row below 16 at half the rate": found[0.5, 12, 0.8][0] < found[0.5, 16, 0.8][0],
        "12 and 16 a row alike at twice the rate": abs(found[2.0, 12, 0.8][0] / found[2.0, 16, 0.8][0] - 1.0) < ALIKE,
    }


def series_trends(series):
    """{claim: holds} of Figure 6, for series {Row: (t, P)} of all twelve, t from the start of the injection.

    "During the whole time": from when the first grains can have arrived; the slower of both rates still has a clean channel then.
    """
    found = {(row.rate, row.per_row, round(1e3 * row.d, 1)): value for row, value in series.items()}
    arrival = (clean_channel.paper("injection")["height"] - clean_channel.TOP) / (1.5 * MEAN)
    kinds = [(16, 0.6), (16, 0.7), (16, 0.8), (12, 0.8)]
    pairs = [(found[a, *kind], found[b, *kind]) for kind in kinds for a, b in ((0.5, 1.0), (1.0, 2.0))]
    late = arrival + 0.5 * (0.8 - arrival)
    levels = [(slow, fast, slow[1][-1]) for slow, fast in pairs]
    return {
        "P higher for the higher rate, the whole second half": all(rising(slow[0], slow[1], fast[1], late) for slow, fast in pairs),
        "the same P sooner at the higher rate": all(
            time_to_reach(*fast, level) < time_to_reach(*slow, level) for slow, fast, level in levels),
    }
