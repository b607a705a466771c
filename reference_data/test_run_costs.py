"""The costs of runs made of nothing."""

from types import SimpleNamespace

from run_costs import cheaper, cost, repeated


def run(variant, seconds):
    return SimpleNamespace(variant=variant, info={"cpu_s": seconds})


def test_repetitions_are_one_and_the_median_counts():
    found = repeated([run("water_080_plumb", 3.0), run("water_080_as_code", 20.0), run("water_080_plumb_2", 1.0), run("water_080_plumb_3", 2.0)])
    assert list(found) == ["water_080_plumb", "water_080_as_code"]
    assert cost(found["water_080_plumb"]) == 2.0
    assert cheaper(found["water_080_as_code"], found["water_080_plumb"]) == "10.0"
    assert cheaper(None, found["water_080_plumb"]) == ""
