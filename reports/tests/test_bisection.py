"""Bisection of a stability boundary: how case.toml states it, the search, and the report."""

import json

import pytest
from conftest import SOLVER
from plumb_reports.__main__ import main
from plumb_reports.case_file import read_case
from plumb_reports.strict import CaseError

# Euler's rule on v' = (u - v)/tau, tau = 0.1: |1 - step/tau| passes 1, and v its double terminal value, at step = 0.2.
CASE = """
[[variant]]
name = "euler"
set = {"fake.rule" = "euler", "time.end" = 60.0}

[[variant]]
name = "slow"
set = {"fake.rule" = "euler", "time.end" = 60.0, "fake.tau" = 0.2}

[[bisection]]
id = "step"
parameter = "time.step"
low = 0.01
default = 0.1
high = 1.0
resolution = 0.02
quick_resolution = 0.2
unstable = {quantity = "v", above = 4.5}

[[check]]
id = "boundary"
quantity = "step.boundary"
metric = "final_relative"
finest_quick = 0.12
finest_full = 0.02
why = "Half the resolution, and what the growth to a tenth above the double takes."

[[check]]
id = "default"
quantity = "step.stable"
metric = "value"
range = [0.1, 1.0]
why = "The default lies inside."

[[must_fail]]
set = {"fake.tau" = 0.04}
breaks = "default"
"""
REFERENCE = """

def reference(quantity, scene, t):
    return 2.0 * scene["fake"]["tau"]


def measure(quantity, run):
    return NotImplemented
"""


@pytest.fixture
def bisected(case):
    """The fake case with a bisection in place of its sweep and checks."""
    case.edit("case.toml", r"\[sweep\].*", CASE)
    case.append("reference.py", REFERENCE)
    return case


def judged(case, build, tier="quick", *more):
    """(exit code, report.json) of one judgement."""
    code = main(["judge", str(case.folder), "--tier", tier, "--plumb", str(SOLVER), "--build", str(build), *more])
    path = build / "reports" / "relaxation" / tier / "report.json"
    return code, json.loads(path.read_text(encoding="utf-8"))


def check_of(report, identity, variant="euler"):
    return next(c for c in report["checks"] if (c["id"], c["variant"]) == (identity, variant))


def test_the_boundary_is_found(bisected, build):
    code, report = judged(bisected, build, "full", "--jobs", "2")
    assert code == 0 and report["counts"] == {"pass": 4, "fail": 0, "not_met": 0}
    assert check_of(report, "boundary")["deviation"] == pytest.approx(0.0, abs=0.02)
    assert check_of(report, "default")["value"] == pytest.approx(0.2, rel=0.03)
    assert check_of(report, "default", "slow")["value"] == pytest.approx(0.4, rel=0.03)
    runs = [run for run in report["runs"] if run["variant"] == "euler"]
    assert [run["value"] for run in runs[:2]] == [0.1, 1.0]  # the default first, then the end of the bracket
    assert {run["parameter"] for run in runs} == {"time.step"}
    assert all((run["outcome"] == "stable") == (run["value"] < 0.2) for run in runs)
    folder = build / "reports" / "relaxation" / "full"
    assert (folder / "bisection_step.png").is_file()
    assert "v reached" in (folder / "report.html").read_text(encoding="utf-8")


def test_the_quick_tier_may_be_coarser(bisected, build):
    _, quick = judged(bisected, build)
    _, full = judged(bisected, build, "full")
    assert len(quick["runs"]) < len(full["runs"])


def test_divergence_is_unstable_and_any_other_failure_an_error(bisected, build):
    bisected.edit("scene.toml", "exit = 0\nexit_above = 0.0", "exit = 3\nexit_above = 0.15")
    code, report = judged(bisected, build)
    assert code == 1 and check_of(report, "default")["verdict"] == "pass"
    assert check_of(report, "default")["value"] == pytest.approx(0.15, rel=0.2)
    assert any("diverged" in run["outcome"] for run in report["runs"])
    bisected.edit("scene.toml", "exit = 3", "exit = 4")
    code, report = judged(bisected, build)
    assert code == 1 and "time.step = 1: the run ended with exit 4" in check_of(report, "default")["reason"]


def test_a_boundary_beyond_the_bracket_is_open(bisected, build):
    bisected.edit("case.toml", "high = 1.0", "high = 0.15")
    code, report = judged(bisected, build)
    assert code == 1 and check_of(report, "default")["verdict"] == "pass"
    assert check_of(report, "default")["value"] == 0.15
    assert "no unstable time.step was found from 0.1 to 0.15" in check_of(report, "boundary")["reason"]


def test_an_unstable_default_is_bracketed_from_below(bisected, build):
    bisected.edit("case.toml", r'"time.end" = 60.0\}', '"time.end" = 60.0, "fake.tau" = 0.02}')
    code, report = judged(bisected, build)
    assert code == 1 and check_of(report, "boundary")["verdict"] == "pass"
    assert check_of(report, "default")["verdict"] == "fail"
    assert check_of(report, "default")["value"] == pytest.approx(0.04, rel=0.2)


def test_not_finite_is_unstable(bisected, build):
    bisected.edit("scene.toml", "nan = false", "nan = true")
    _, report = judged(bisected, build)
    assert {run["outcome"] == "stable" for run in report["runs"]} == {False}
    assert "no stable time.step was found from 0.01 to 0.1" in check_of(report, "default")["reason"]


def test_the_stated_limit_has_to_rule(bisected, build):
    bisected.edit("case.toml", "high = 1.0", 'high = 1.0\nrules = "viscous"')
    code, report = judged(bisected, build)
    assert code == 1 and "ruled by 'drag', not by 'viscous'" in check_of(report, "default")["reason"]
    bisected.edit("case.toml", "viscous", "drag")
    _, report = judged(bisected, build)
    assert check_of(report, "default")["value"] == pytest.approx(0.16, rel=0.2)  # the step is 1/1.25 of the limit


def test_a_bisected_twin(bisected, build):
    code, report = judged(bisected, build, "must_fail")
    assert code == 0 and report["checks"][0]["verdict"] == "pass"
    assert report["checks"][0]["value"] == pytest.approx(0.08, rel=0.2)
    assert len(report["runs"]) > 5
    bisected.edit("case.toml", '"fake.tau" = 0.04}', '"fake.tau" = 0.05, "fake.exit" = 2}')
    assert judged(bisected, build, "must_fail")[0] == 1


MISTAKES = [
    ("low = 0.01", "", "'low' is missing"),
    ("low = 0.01", "low = -1.0", "'default' must lie between low and high"),
    ("low = 0.01", "low = 0.5", "'default' must lie between low and high"),
    ("^resolution = 0.02", "resolution = 0.0", "'resolution' must lie between"),
    ("quick_resolution = 0.2", "quick_resolution = 9.0", "'quick_resolution' must lie between"),
    ("unstable = {.*?}", "", "'unstable' is missing"),
    (", above = 4.5", "", "'times_start' or 'above' has to be given"),
    ("above = 4.5", "above = 4.5, times_start = 2.0", "'times_start' or 'above' has to be given"),
    ("above = 4.5", "times_start = 1.0", "'times_start' must be more than 1"),
    ("above = 4.5", "above = 4.5, below = 1.0", "'below' is unknown"),
    ("high = 1.0", 'high = 1.0\nvariants = ["other"]', "'variants' names 'other'"),
    ("high = 1.0", "high = 1.0\nmost = 2.0", "'most' is unknown"),
    ('parameter = "time.step"', 'parameter = "time.end"', "'parameter' is set by variant 'euler'"),
    (r"\[\[bisection\]\]", '[sweep]\nparameter = "fake.gain"\nvalues = [1.0]\n\n[[bisection]]', "which is swept"),
    (r"\[\[check\]\]", '[work_precision]\ncheck = "boundary"\nvariants = ["euler"]\n\n[[check]]', "'variants' names 'euler'"),
]


@pytest.mark.parametrize("pattern, replacement, message", MISTAKES)
def test_mistakes(bisected, pattern, replacement, message):
    bisected.edit("case.toml", pattern, replacement)
    with pytest.raises(CaseError) as caught:
        read_case(bisected.folder)
    assert message in str(caught.value) and "\n" not in str(caught.value)


def test_a_variant_belongs_to_one_bisection(bisected):
    text = CASE[CASE.index("[[bisection]]"):CASE.index("[[check]]")]
    bisected.append("case.toml", text)
    with pytest.raises(CaseError, match="'step' is used twice"):
        read_case(bisected.folder)
    bisected.edit("case.toml", r'default"\n\[\[bisection\]\]\nid = "step"', 'default"\n[[bisection]]\nid = "other"')
    with pytest.raises(CaseError, match="another bisection varies already"):
        read_case(bisected.folder)
