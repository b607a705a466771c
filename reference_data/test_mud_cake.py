"""Tests of the porous channel's geometry and estimates, and of the measures of a bed, on made-up data."""

import math
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent
sys.path.insert(0, str(ROOT))

from drag_laws.drag_laws import LAWS  # noqa: E402
from tables import table  # noqa: E402
from theory import clean_channel, cylinder_arrays, mud_cake, packed_beds  # noqa: E402
from theory.bed_resistance import bed_drop  # noqa: E402
from theory.clean_channel import Array  # noqa: E402

D = 8e-4


# --- the channel ---


def test_the_cylinders_leave_the_stated_void_fraction():
    for per_row in (12, 16):
        array = Array(per_row)
        for y in (0.15, 0.2, 0.23, 0.25):
            solid = math.pi * array.diameter(y) ** 2 / 4.0 / (array.pitch * array.row_distance)
            assert 1.0 - solid == pytest.approx(clean_channel.void_fraction(y), rel=1e-12)


def test_throats_stop_what_the_paper_says_they_stop():
    assert Array(12).stops(6e-4) is None and Array(12).stops(7e-4) is None
    assert 0.2 < Array(12).stops(8e-4) < 0.25
    heights = [Array(16).stops(d) for d in (6e-4, 7e-4, 8e-4)]
    assert heights == sorted(heights) and 0.2 < heights[0] and heights[-1] < 0.25
    for d, y in zip((6e-4, 7e-4, 8e-4), heights):
        assert Array(16).throat(y) == pytest.approx(d, rel=1e-9)


def test_rows_lie_in_the_middle_of_the_section():
    y = Array(12).rows()
    assert len(y) == 30 and y[0] - clean_channel.BOTTOM == pytest.approx(clean_channel.TOP - y[-1])
    assert len(Array(16).rows()) == 40
    assert np.diff(y) == pytest.approx(Array(12).row_distance)


def test_open_area_by_hand():
    assert Array(12).open_area(0.15, 0.2) == pytest.approx(0.4 * 0.046 * 0.05)
    assert Array(12).open_area(0.2, 0.25) == pytest.approx(0.55 * 0.046 * 0.05, rel=1e-6)
    assert Array(12).open_area(0.26, 0.27) == pytest.approx(0.05 * 0.01)


def test_creeping_drop_of_a_uniform_array_is_darcys(monkeypatch):
    """With one void fraction: mu U/K over the rows' heights; twice as many a row, four times the drop."""
    monkeypatch.setattr(clean_channel, "void_fraction", lambda y: np.full_like(np.asarray(y, float), 0.5))
    array = Array(12)
    radius = 0.5 * float(array.diameter(0.2))
    k = cylinder_arrays.permeability_from_force(cylinder_arrays.force(0.5, "hexagonal"), 0.5, radius)
    expected = 2.797e-2 * 0.118 * 0.05 / 0.046 / k * len(array.rows()) * array.row_distance
    assert clean_channel.creeping_drop(array) == pytest.approx(expected, rel=1e-6)
    assert clean_channel.creeping_drop(Array(24)) / clean_channel.creeping_drop(array) == pytest.approx(
        4.0 * len(Array(24).rows()) * 0.5 / len(array.rows()), rel=1e-6)


def test_gebart_stays_within_its_range_of_the_unit_cell():
    for per_row in (12, 16):
        exact, gebart = (clean_channel.creeping_drop(Array(per_row), law) for law in ("exact", "gebart"))
        assert gebart == pytest.approx(exact, rel=0.03)


def test_darcy_returns_the_permeability():
    assert clean_channel.darcy(2.797e-2 * 0.118 * 0.1 / 3e-8) == pytest.approx(3e-8)


def test_clean_ratio_is_the_common_intercept():
    found = clean_channel.clean_pressure_ratio()
    t = table("mudcake_ddpm_dem/bed_and_pressure.csv", si=False)
    intercepts = [np.polyfit(t["rate"][k], t["pressure"][k], 1)[1]
                  for k in ((t["obstacles"] == 16) & (t["d"] == d) for d in (0.6, 0.7, 0.8))]
    assert found.value == pytest.approx(np.mean(intercepts))  # same rates for each diameter: the mean of the three
    assert 0.0 < found.half < 0.2


def test_richardson_finds_the_limit_of_a_power():
    h = np.array([4.0, 2.0, 1.0])
    found = clean_channel.richardson(h, 7.0 + 0.3 * h**1.7)
    assert found.value == pytest.approx(7.0) and found.order == pytest.approx(1.7)
    assert abs(found.value - 7.0) < found.half
    scattered = clean_channel.richardson(h, [7.1, 7.0, 7.2])
    assert math.isnan(scattered.order) and scattered.half > 0.0
    with pytest.raises(ValueError):
        clean_channel.richardson([4.0, 2.0, 1.5], [1.0, 2.0, 3.0])


# --- the bed ---


def column(low, high, count):
    """Heights of grains spread evenly."""
    return np.linspace(low, high, count)


def test_bed_height_is_that_of_the_percentiles_and_a_grain():
    y = column(0.200, 0.220, 1001)
    assert mud_cake.bed_height(y, D) == pytest.approx(0.96 * 0.020 + D)
    assert mud_cake.bed_height(y, D, (0.0, 100.0)) == pytest.approx(0.020 + D)
    assert mud_cake.bed_height(np.array([0.2]), D) == pytest.approx(D)
    assert mud_cake.bed_height(np.array([]), D) == 0.0
    assert mud_cake.bed_start(y, D) == pytest.approx(0.2004 - 0.5 * D)


def test_a_few_stray_grains_do_not_change_the_bed():
    y = np.concatenate([column(0.200, 0.220, 1000), [0.17] * 9, [0.26] * 9])
    assert mud_cake.bed_height(y, D) == pytest.approx(mud_cake.bed_height(column(0.200, 0.220, 1000), D), rel=0.03)


def test_rest_is_a_twentieth_of_the_mean_velocity():
    limit = 0.05 * 0.118
    v = [[0.0, -0.99 * limit, 0.0], [0.0, -1.01 * limit, 0.0], [0.8 * limit, 0.0, 0.8 * limit]]
    assert mud_cake.at_rest(v).tolist() == [True, False, False]


def test_resting_share_counts_only_those_that_arrived():
    y, v = np.array([0.3, 0.24, 0.24, 0.22]), np.zeros((4, 3))
    v[1] = 0.1
    assert mud_cake.resting_share(y, v) == pytest.approx(2.0 / 3.0) and mud_cake.arrived(y) == 3
    assert math.isnan(mud_cake.resting_share(np.array([0.3]), v[:1]))


def test_bed_porosity_by_hand():
    """Grains of a known number in 20 mm of the array where phi = 0.4."""
    count = 1000
    y = column(0.160, 0.180, count)
    low, high = np.percentile(y, (2, 98))
    inside = np.count_nonzero((y >= low) & (y <= high))
    expected = 1.0 - inside * math.pi * D**3 / 6.0 / (0.4 * 0.046 * (high - low) * 0.002)
    assert mud_cake.bed_porosity(y, D, Array(12)) == pytest.approx(expected)
    assert math.isnan(mud_cake.bed_porosity(np.array([]), D, Array(12)))


def test_injection_points_are_fifty_nine_apart_from_walls_and_each_other():
    points, other = mud_cake.injection_points(), mud_cake.injection_points(complement=True)
    assert len(points) == len(other) == 59
    for one in (points, other):
        assert one[:, 0].min() == pytest.approx(0.005) and one[:, 0].max() == pytest.approx(0.045)
        assert (one[:, 2] - D / 2 > 0.0).all() and (one[:, 2] + D / 2 < 0.002).all()
        apart = np.linalg.norm(one[:, None] - one[None], axis=2) + np.eye(59)
        assert apart.min() > D
    # Both sets of a doubled rate enter at once; those of the raised set have passed the others' points at the next event.
    assert np.linalg.norm(points[:, None] - other[None], axis=2).min() > D
    for fall in (0.9e-3, 0.118 * 0.01, 1.9e-3):  # slowest beside the walls to fastest in the middle
        assert np.linalg.norm(points[:, None] - (other - [0.0, fall, 0.0])[None], axis=2).min() > D


# --- the table, the correlation, the claims ---


def test_rows_and_their_names():
    rows = mud_cake.rows()
    assert len(rows) == 12 and len({row.name for row in rows}) == 12
    row = mud_cake.row_of(2.0, 12, 8e-4)
    assert row.name == "n12_d08_double" and row.pressure == 3.70 and row.bed_height == pytest.approx(0.046) and row.clean == 1.0
    assert mud_cake.row_of(2.0, 12, 6e-4) is None


def test_correlation_returns_what_was_put_in():
    rows = mud_cake.rows()
    exact = [0.1 + 0.02 * row.per_row + 0.9 * row.rate + 1.5e3 * row.d for row in rows]
    fit = mud_cake.correlation(rows, exact)
    assert fit.coefficients == pytest.approx([0.1, 0.02, 0.9, 1.5]) and fit.r_squared == pytest.approx(1.0)
    assert np.abs(fit.residuals).max() < 1e-9


def test_the_printed_correlation_does_not_fit_its_table():
    printed = mud_cake.published_correlation()
    refit = mud_cake.correlation(mud_cake.rows(), [row.pressure for row in mud_cake.rows()])
    assert printed.r_squared == pytest.approx(0.907, abs=5e-4)
    assert refit.r_squared == pytest.approx(0.968, abs=5e-4)
    assert refit.coefficients == pytest.approx([-0.0575, 0.0350, 0.929, 1.600], rel=1e-2)


def published():
    return {row: (row.pressure, row.bed_height) for row in mud_cake.rows()}


def test_the_table_obeys_its_own_claims():
    assert all(mud_cake.trends(published()).values())


@pytest.mark.parametrize("rate, per_row, d, changed, claim", [
    (1.0, 16, 6e-4, (2.0, 7.5e-3), "P rises with the rate"),
    (2.0, 16, 7e-4, (3.4, 5e-3), "h_b rises with the rate"),
    (1.0, 16, 7e-4, (2.8, 14e-3), "P rises with the diameter"),
    (1.0, 16, 7e-4, (2.59, 30e-3), "h_b rises with the diameter"),
    (0.5, 12, 8e-4, (2.3, 10e-3), "12 a row below 16 at half the rate"),
    (2.0, 12, 8e-4, (3.3, 46e-3), "12 and 16 a row alike at twice the rate"),
])
def test_a_broken_claim_is_noticed(rate, per_row, d, changed, claim):
    results = published()
    results[mud_cake.row_of(rate, per_row, d)] = changed
    assert not mud_cake.trends(results)[claim]


def made_up_series(row):
    """Rises as the table's end values do, from 0.4 s on."""
    t = np.linspace(0.0, 0.8, 41)
    return t, row.clean + (row.pressure - row.clean) * np.clip((t - 0.4) / 0.4, 0.0, 1.0)


def test_claims_of_the_series():
    series = {row: made_up_series(row) for row in mud_cake.rows()}
    assert all(mud_cake.series_trends(series).values())
    slow, fast = mud_cake.row_of(0.5, 16, 6e-4), mud_cake.row_of(1.0, 16, 6e-4)
    series[slow], series[fast] = series[fast], series[slow]
    assert not any(mud_cake.series_trends(series).values())


def test_time_to_reach():
    t = np.array([0.0, 0.1, 0.2])
    assert mud_cake.time_to_reach(t, [1.0, 2.0, 3.0], 1.5) == pytest.approx(0.1)
    assert mud_cake.time_to_reach(t, [1.0, 2.0, 3.0], 3.5) == math.inf


# --- what a drag law says of a bed ---


def test_a_bed_of_grains_resists_by_its_law():
    """In the open channel: the gradient of a uniform bed times its height; single spheres far less than Di Felice."""
    lower, height, count, flow = 0.26, 0.01, 2000, 0.118 * 0.05 * 0.002
    eps = 1.0 - count * math.pi * D**3 / 6.0 / (0.05 * 0.002 * height)
    expected = packed_beds.pressure_gradient(LAWS["di_felice"], eps, 0.118, D, 1188.0, 2.797e-2) * height
    found = bed_drop("di_felice", count, D, lower, height, Array(12), flow)
    assert found == pytest.approx(expected)
    assert 3.0 < found / bed_drop("morsi_alexander", count, D, lower, height, Array(12), flow) < 17.0
    assert bed_drop("di_felice", 0, D, lower, 0.0, Array(12), flow) == 0.0
    assert math.isnan(bed_drop("di_felice", 10000, D, lower, height, Array(12), flow))


# --- what the published heights need ---


def test_travel_time_by_hand():
    """On the axis the parabola has 1.5 times the mean; in the porous section the mean over the void fraction of the narrower width."""
    free = mud_cake.travel_time(0.025, 0.01, clean_channel.TOP)
    assert free == pytest.approx(0.05 / (1.5 * clean_channel.MEAN + 0.01))
    slow = mud_cake.travel_time(0.025, 0.0, 0.2) - 0.05 / (1.5 * clean_channel.MEAN)
    assert slow == pytest.approx(0.55 * 0.05 * 0.046 / (0.05 * clean_channel.MEAN), rel=1e-6)


def test_published_heights_are_those_of_pores_half_filled():
    """All twelve, whatever rate, diameter and array: between 0.43 and 0.57."""
    for row in mud_cake.rows():
        assert 0.43 < mud_cake.needed_filling(row) < 0.57


def test_pore_filling_counts_the_centres_between_the_ends():
    row = mud_cake.row_of(1.0, 16, 8e-4)
    y = mud_cake.lowest(row) + np.array([-1e-6, 1e-6, 0.01, row.bed_height - 1e-6, row.bed_height + 1e-6])
    assert mud_cake.pore_filling(y, row) == pytest.approx(mud_cake.filling(3, row))


def test_filled_height_is_that_of_the_bed_alone():
    """Twenty millimetres of grains at one filling, and stray ones up to the plug's edge."""
    array = clean_channel.Array(16, 0.046, 0.05)
    d, rng = 8e-4, np.random.default_rng(3)
    open_area = np.array([array.open_area(y, y + 1e-4, 3) for y in np.arange(0.21, 0.23, 1e-4)])
    count = np.round(0.3 * open_area * clean_channel.DEPTH / (math.pi * d**3 / 6.0) * 50.0).astype(int)
    bed = np.concatenate([y + 1e-4 * rng.random(n) for y, n in zip(np.arange(0.21, 0.23, 1e-4), count)])
    stray = 0.235 + 0.015 * rng.random(len(bed) // 20)
    assert mud_cake.filled_height(np.concatenate([bed, stray]), d, array) == pytest.approx(0.02, abs=1e-3)
    assert mud_cake.bed_height(np.concatenate([bed, stray]), d) > 0.03
    assert mud_cake.filled_height(np.empty(0), d, array) == 0.0
