"""The porous channel of the mud-cake paper without grains: geometry of the cylinders, and the pressure drop layer by layer.

The side walls step in by 2 mm between y = 150 and 250 mm. Between them an equilateral staggered array of cylinders: pitch
s = width/N, rows s sqrt(3)/2 apart, their diameter that of the void fraction phi there,

    D = s sqrt(2 sqrt(3) (1 - phi)/pi),   phi = 0.4 for y <= 200 mm, then linearly to 0.7 at y = 250 mm                  (1)

The paper states phi, N and the outer measures; the array is an inference (mud_cake's README).
"""

import math
from typing import NamedTuple

import numpy as np
from scipy import stats
from scipy.integrate import trapezoid

from tables import table
from theory import cylinder_arrays

WHICH = "mudcake_ddpm_dem"
BOTTOM, TOP = 0.150, 0.250  # of the porous section, m
BENDS = (0.200, 0.250)  # where the void fraction begins and ends to rise, m
HEXAGONAL = 2.0 * math.sqrt(3.0) / math.pi  # (D/s)^2 = HEXAGONAL times the solid fraction
DENSEST = 1.0 / HEXAGONAL


def paper(name):
    """A table of the paper as {column: value} if it has one row, in SI units."""
    rows = table(f"{WHICH}/{name}.csv")
    return {key: column[0] if len(column) == 1 else column for key, column in rows.items()}


GEOMETRY, FLUID = paper("geometry"), paper("simulation")
CHANNEL, WIDTH, DEPTH = GEOMETRY["channel_length"], GEOMETRY["porous_width"], GEOMETRY["depth"]
MEAN = FLUID["inlet_mean_velocity"]  # m/s, over the whole channel
REFERENCE_PRESSURE = float(table(f"{WHICH}/text_values.csv")["reference_pressure"][3])  # Pa


def void_fraction(y):
    """phi of equation (1) at the heights y, m."""
    return np.interp(y, BENDS, (GEOMETRY["porosity_least"], GEOMETRY["porosity_greatest"]))


def height_of(phi):
    """The height, m, above which the void fraction exceeds phi (one between the least and the greatest)."""
    return float(np.interp(phi, (GEOMETRY["porosity_least"], GEOMETRY["porosity_greatest"]), BENDS))


class Array(NamedTuple):
    """The cylinders: how many a full row has, on which width, m, and how wide the channel is above and below them."""

    per_row: int
    width: float = WIDTH
    channel: float = CHANNEL

    @property
    def pitch(self):
        return self.width / self.per_row

    @property
    def row_distance(self):
        return 0.5 * math.sqrt(3.0) * self.pitch

    def rows(self):
        """Heights of the rows, m: as many as there is room for, in the middle of the section."""
        count = math.floor((TOP - BOTTOM) / self.row_distance * (1.0 + 1e-12))
        return 0.5 * (BOTTOM + TOP) + (np.arange(count) - 0.5 * (count - 1)) * self.row_distance

    def diameter(self, y):
        return self.pitch * np.sqrt(HEXAGONAL * (1.0 - void_fraction(y)))

    def throat(self, y):
        """The gap between neighbours, m; within a row and between rows it is the same but for the change of phi."""
        return self.pitch - self.diameter(y)

    def stops(self, d):
        """The height, m, below which a grain of diameter d passes no throat; None if it passes all."""
        if d <= self.throat(BENDS[0]):
            return None
        return height_of(1.0 - DENSEST * (1.0 - d / self.pitch) ** 2)

    def open_area(self, lower, upper, points=2001):
        """Area, m2, that the cylinders leave open between two heights of the channel, by the void fraction."""
        y = np.linspace(lower, upper, points)
        inside = (y >= BOTTOM) & (y <= TOP)
        return float(trapezoid(np.where(inside, void_fraction(y) * self.width, self.channel), y))


def permeability(phi, pitch, law):
    """K, m2, of the hexagonal array of void fraction phi in creeping flow: `law` "exact" (unit cell) or "gebart"."""
    solid = 1.0 - phi
    radius = 0.5 * pitch * math.sqrt(HEXAGONAL * solid)
    if law == "gebart":
        return cylinder_arrays.gebart(solid, "hexagonal", radius)
    return cylinder_arrays.permeability_from_force(cylinder_arrays.force(round(solid, 6), "hexagonal"), solid, radius)


def creeping_drop(array, law="exact", mean=MEAN, mu=None):
    """Pressure drop over the porous section, Pa: mu U/K(phi) for each row over the distance of rows, U over the array's width.

    Inertia, the sides and the change from row to row are left out.
    """
    u = mean * array.channel / array.width
    mu = FLUID["mu"] if mu is None else mu
    return sum(mu * u / permeability(float(void_fraction(y)), array.pitch, law) * array.row_distance for y in array.rows())


def darcy(drop, u=MEAN, mu=None, length=TOP - BOTTOM):
    """K, m2, of the paper's equation (5), with the channel's mean velocity."""
    return (FLUID["mu"] if mu is None else mu) * u * length / drop


def duct_drop(lower, upper, width=CHANNEL, mean=MEAN, mu=None):
    """Of developed flow between the free side walls: 12 mu U/w^2 a length, Pa."""
    return 12.0 * (FLUID["mu"] if mu is None else mu) * mean / width**2 * (upper - lower)


class Interval(NamedTuple):
    """A value and the half width of its 95 % interval."""

    value: float
    half: float


def clean_pressure_ratio():
    """P of the clean channel with 16 cylinders a row that Table 7 implies: its rows at rate zero.

    For each diameter P = P_0 + b_d rate with one P_0: nothing has happened yet at rate zero, whatever the diameter. Least squares
    over nine rows, four numbers; Student's t for the interval.
    """
    rows = table(f"{WHICH}/bed_and_pressure.csv", si=False)
    chosen = rows["obstacles"] == 16
    d, rate, p = rows["d"][chosen], rows["rate"][chosen], rows["pressure"][chosen]
    columns = np.column_stack([np.ones_like(rate), *(np.where(d == one, rate, 0.0) for one in np.unique(d))])
    solution, *_ = np.linalg.lstsq(columns, p, rcond=None)
    free = len(p) - columns.shape[1]
    variance = float(np.sum((p - columns @ solution) ** 2)) / free
    deviation = math.sqrt(variance * np.linalg.inv(columns.T @ columns)[0, 0])
    return Interval(float(solution[0]), float(stats.t.ppf(0.975, free)) * deviation)


class Extrapolated(NamedTuple):
    """Richardson's limit of values at falling spacings, its order, and the half width of its interval."""

    value: float
    order: float
    half: float


def richardson(spacings, values):
    """From the three finest of values [n] at spacings [n] in a constant ratio: f = f_0 + C h^p.

    The interval is the greater of the finest value's distance from the limit times 0.25 (the safety of Roache's grid convergence
    index, 1.25, less the distance itself), and what the order of two instead of the found one changes.
    """
    h, f = np.asarray(spacings, float)[-3:], np.asarray(values, float)[-3:]
    ratio = h[1] / h[2]
    if not math.isclose(h[0] / h[1], ratio, rel_tol=1e-6):
        raise ValueError("Richardson's formula wants spacings in a constant ratio")
    change = (f[0] - f[1]) / (f[1] - f[2])
    order = math.log(change) / math.log(ratio) if change > 1.0 else math.nan
    second = f[2] + (f[2] - f[1]) / (ratio**2 - 1.0)
    if not math.isfinite(order):
        return Extrapolated(float(second), order, abs(float(second - f[2])))
    limit = f[2] + (f[2] - f[1]) / (ratio**order - 1.0)
    return Extrapolated(float(limit), order, max(0.25 * abs(limit - f[2]), abs(limit - second)))
