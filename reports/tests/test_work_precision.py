"""Work-precision: the front on made-up points, and the chart of a judged case."""

import json
from types import SimpleNamespace

import pytest
from conftest import SOLVER
from plumb_reports.__main__ import main
from plumb_reports.case_file import read_case
from plumb_reports.strict import CaseError
from plumb_reports.work_precision import failed_variants, on_front

STATED = """
[[variant]]
name = "trapezoid"

[[variant]]
name = "euler"
set = {"fake.rule" = "euler", "fake.cpu_s" = 0.25}

[work_precision]
check = "velocity"
"""


def test_the_front():
    points = [{"cpu_s": c, "error": e} for c, e in ((1.0, 1.0), (2.0, 0.5), (2.0, 0.6), (3.0, 0.5), (4.0, 0.1), (1.0, 1.0))]
    assert [on_front(point, points) for point in points] == [True, True, False, False, True, True]


def test_chart_and_report(case, build):
    case.append("case.toml", STATED)
    case.edit("case.toml", 'why = "The trap', 'variants = ["trapezoid"]\nwhy = "The trap')
    code = main(["judge", str(case.folder), "--tier", "quick", "--plumb", str(SOLVER), "--build", str(build)])
    folder = build / "reports" / "relaxation" / "quick"
    content = json.loads((folder / "report.json").read_text(encoding="utf-8"))["work_precision"]
    assert code == 0
    assert (content["check"], content["quantity"], content["metric"]) == ("velocity", "v", "relative_l2")
    assert [(p["variant"], p["value"]) for p in content["points"]] == [
        (name, value) for name in ("trapezoid", "euler") for value in (0.05, 0.025, 0.0125)]
    front = {(p["variant"], p["value"]) for p in content["points"] if p["front"]}
    assert front == {("trapezoid", 0.0125), ("euler", 0.0125)}  # more accurate; cheaper
    assert (folder / "work_precision_velocity.png").stat().st_size < 150_000
    assert "Work-precision" in (folder / "report.html").read_text(encoding="utf-8")


def test_failed_runs_are_left_out(case, build):
    case.append("case.toml", STATED)
    case.edit("scene.toml", "exit = 0\nexit_above = 0.0", "exit = 3\nexit_above = 0.03")
    main(["judge", str(case.folder), "--tier", "quick", "--plumb", str(SOLVER), "--build", str(build)])
    path = build / "reports" / "relaxation" / "quick" / "report.json"
    assert len(json.loads(path.read_text(encoding="utf-8"))["work_precision"]["points"]) == 4


@pytest.mark.parametrize("pattern, replacement, message", [
    ('check = "velocity"', 'check = "speed"', "'check' is 'speed'"),
    ('check = "velocity"', 'check = "mean"', "the chart needs an error"),
    ('check = "velocity"', "", "'check' is missing"),
    ('check = "velocity"', 'check = "velocity"\nvariants = ["other"]', "'variants' names 'other'"),
    ('check = "velocity"', 'check = "velocity"\nx = "wall_s"', "'x' is unknown")])
def test_mistakes(case, pattern, replacement, message):
    case.append("case.toml", STATED)
    case.edit("case.toml", pattern, replacement)
    with pytest.raises(CaseError) as caught:
        read_case(case.folder)
    assert message in str(caught.value)


def test_variants_whose_runs_all_failed_are_named():
    runs = [SimpleNamespace(variant=name) for name in ("good", "good", "lost")]
    assert failed_variants(["good", "lost", "of_another_tier"], runs, [{"variant": "good"}]) == ["lost"]
