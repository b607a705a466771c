"""The whole judge with a fake solver, in folders with spaces."""

import json
import os
import shutil
import subprocess
import sys

import pytest
from conftest import HERE, SOLVER
from plumb_reports import baseline, outcome
from plumb_reports.__main__ import main


@pytest.fixture
def with_figures():
    """Asks for real figures."""


@pytest.fixture(autouse=True)
def few_figures(request, monkeypatch):
    """Leaves out the figures, which take most of the time, where a test does not look at them."""
    if "with_figures" not in request.fixturenames:
        monkeypatch.setattr(outcome, "check_pictures", lambda judgements: [])


OWN_FIGURE_AND_TABLE = """

def table(runs):
    return dict(columns=["a"], rows=[[1.5e-7]], caption="<own>")


def figures(runs):
    from matplotlib.figure import Figure
    figure = Figure()
    figure.subplots().plot([1, 2])
    return [("mine", figure, "My figure.")]
"""
STATED_FIGURES = """
[[figure]]
quantity = "v3"

[[figure]]
quantity = "terminal"
kind = "sweep"
x = "log"
"""


def judged(case, build, tier, *more):
    """(exit code, report.json) of one judgement."""
    code = main(["judge", str(case.folder), "--tier", tier, "--plumb", str(SOLVER), "--build", str(build), *more])
    path = build / "reports" / "relaxation" / tier / "report.json"
    return code, json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


def verdict_of(report, identity):
    return next(c for c in report["checks"] if c["id"] == identity)["verdict"]


def without_times(report):
    """A report without what may differ between identical runs."""
    del report["cost"], report["provenance"]["judged"]
    for run in report["runs"]:
        del run["wall_s"], run["cpu_s"], run["peak_bytes"]
    return report


def test_quick_passes(case, build, capsys, with_figures):
    code, report = judged(case, build, "quick")
    assert code == 0
    assert report["schema_version"] == 1 and report["case"] == "relaxation" and report["reference"] == "analytic"
    assert report["counts"] == {"pass": 3, "fail": 0, "not_met": 0}
    velocity = report["checks"][0]
    assert velocity["order"] == pytest.approx(2.0, abs=0.02)
    assert velocity["order_interval"][0] < velocity["order"] < velocity["order_interval"][1]
    assert report["checks"][1]["reference"] == "measured" and report["checks"][1]["sigma"] < 0
    assert len(report["runs"]) == 3 and report["runs"][0]["updates"] == 10
    assert '<CTestMeasurement type="numeric/double" name="velocity.value">' in capsys.readouterr().out


def test_full_uses_all_values_and_its_own_bound(case, build):
    code, report = judged(case, build, "full", "--jobs", "2")
    assert code == 0
    assert [run["value"] for run in report["runs"]] == [0.05, 0.025, 0.0125, 0.00625, 0.003125]
    assert report["checks"][0]["bound"] == 1e-4
    assert [c["id"] for c in report["checks"]] == ["velocity"]


def test_pages(case, build, with_figures):
    case.append("reference.py", OWN_FIGURE_AND_TABLE)
    case.append("case.toml", STATED_FIGURES)
    code, _ = judged(case, build, "quick")
    assert code == 0
    folder = build / "reports" / "relaxation" / "quick"
    page = (folder / "report.html").read_text(encoding="utf-8")
    names = {path.name for path in folder.glob("*.png")}
    assert names == {"curve_v_analytic.png", "error_velocity.png", "error_terminal.png", "figure_1_v3.png",
                     "figure_2_terminal.png", "own_mine.png", "thumbnail.png"}
    assert all(path.stat().st_size < 150_000 for path in folder.glob("*.png"))
    for text in ("My figure.", "&lt;own&gt;", "Against theory", "Against measurements", "3 pass", "0 not met", "<svg"):
        assert text in page
    assert 'src="http' not in page and 'href="http' not in page
    index = (build / "reports" / "index.html").read_text(encoding="utf-8")
    assert "relaxation/quick/report.html" in index and "data:image/png" in index


def test_report_is_reproducible(case, build, tmp_path):
    first = without_times(judged(case, build, "quick")[1])
    second = without_times(judged(case, tmp_path / "other", "quick", "--jobs", "3")[1])
    assert first == second


def test_must_fail(case, build):
    code, report = judged(case, build, "must_fail")
    assert code == 0
    assert [c["verdict"] for c in report["checks"]] == ["pass", "pass"]
    assert report["checks"][1]["control"]
    assert report["without_twin"] == ["terminal", "mean"]


@pytest.mark.parametrize("broken", ['"fake.exit" = 3', '"fake.exit" = 2', '"fake.exit" = 4', '"fake.nan" = true',
                                    '"fake.unknown" = 1', '"fake.tau" = 0.1'])
def test_twins_that_do_not_count(case, build, broken):
    case.edit("case.toml", '"fake.gain" = 1.1', broken)
    code, report = judged(case, build, "must_fail")
    assert code == 1
    assert [c["verdict"] for c in report["checks"]] == ["fail", "pass"]


def test_a_twin_whose_unbroken_run_fails_shows_nothing(case, build):
    case.edit("case.toml", "value = 0.0125", "value = 0.1")
    code, report = judged(case, build, "must_fail")
    assert code == 1
    assert "unbroken run fails already" in report["checks"][1]["reason"]


def test_a_twin_that_breaks_only_the_order(case, build):
    case.edit("case.toml", '"fake.gain" = 1.1', '"fake.rule" = "euler"')
    case.edit("case.toml", "finest_quick = 2e-3", "finest_quick = 1.0")
    case.edit("case.toml", "value = 0.0125", "")
    code, report = judged(case, build, "must_fail")
    assert code == 0 and report["checks"][0]["order"] == pytest.approx(1.0, abs=0.2)


def test_planted_faults(case, build, capsys):
    case.edit("case.toml", '"fake.gain" = 1.1}', '"fake.gain" = 1.1}\nplanted = "long_tau"')
    assert judged(case, build, "must_fail")[0] == 2
    assert "key 'planted'" in capsys.readouterr().err
    code, report = judged(case, build, "must_fail", "--planted", str(SOLVER))
    assert code == 0 and report["checks"][0]["planted"] == "long_tau"


@pytest.mark.parametrize("pattern, replacement, reason", [
    ("nan = false", "nan = true", "not finite"),
    ("exit = 0", "exit = 3", "exit 3 (diverged): error: it was asked for"),
    ("gain = 1.0", "gain = 1.2", "> 0.002"),
    ('rule = "trapezoid"', 'rule = "euler"', "order")])
def test_failures(case, build, pattern, replacement, reason):
    case.edit("scene.toml", pattern, replacement)
    code, report = judged(case, build, "quick")
    assert code == 1
    assert verdict_of(report, "velocity") == "fail"
    assert reason in report["checks"][0]["reason"]
    assert (build / "reports" / "relaxation" / "quick" / "report.html").is_file()


def test_an_unknown_probe_fails(case, build):
    case.edit("case.toml", 'quantity = "v"', 'quantity = "speed"')
    code, report = judged(case, build, "quick")
    assert code == 1 and "no probe 'speed'" in report["checks"][0]["reason"]


def test_an_exception_in_the_reference_fails_the_check(case, build):
    case.edit("reference.py", "    fake = scene", "    fake = {}[quantity]  # scene")
    code, report = judged(case, build, "quick")
    assert code == 1 and "raised KeyError" in report["checks"][0]["reason"]
    assert verdict_of(report, "terminal") == "pass"


def test_a_broken_figure_is_bad_input(case, build):
    case.append("reference.py", "\n\ndef figures(runs):\n    return 1 / 0\n")
    code, report = judged(case, build, "quick")
    assert code == 2 and "ZeroDivisionError" in report["problems"][0] and report["verdict"] == "fail"


def test_vector_probes_and_snapshots(case, build):
    case.edit("case.toml", 'quantity = "v"', 'quantity = "v3"')
    case.append("reference.py", "\n\nplain = measure\n\n\ndef measure(quantity, run):\n"
                "    assert run.snapshot(-1)['grains']['x'].shape == (2, 3) and run.snapshot(0)['time'] == 0.5\n"
                "    return plain(quantity, run)\n")
    code, report = judged(case, build, "quick")
    assert code == 0 and report["checks"][0]["points"] == 3 * 41


def test_a_set_of_impacts_is_no_time_series(case, build, with_figures):
    """measure() may number things instead of timing them; whole numbers tell."""
    case.append("reference.py", "\n\ndef measure(quantity, run):\n    return np.arange(4), np.full(4, 2.01)\n"
                "\n\ndef reference(quantity, scene, t):\n    return np.full(len(t), 2.0)\n")
    case.edit("case.toml", "order = .1.8, 2.2.", "")
    code, report = judged(case, build, "quick")
    page = (build / "reports" / "relaxation" / "quick" / "report.html").read_text(encoding="utf-8")
    assert code == 1 and report["checks"][0]["value"] == pytest.approx(0.005)
    assert "v against number" in page


def test_not_met(case, build):
    mark = 'finest_quick = 0.1\nnot_met = {evidence = "known bias", accepted = 0.7}'
    case.edit("case.toml", "finest_quick = 2.0", mark)
    code, report = judged(case, build, "quick")
    assert code == 0
    assert report["counts"] == {"pass": 2, "fail": 0, "not_met": 1} and report["verdict"] == "not_met"
    for page in ("relaxation/quick/report.html", "index.html"):
        text = (build / "reports" / page).read_text(encoding="utf-8")
        assert "1 not met" in text and "known bias" in text
    case.edit("case.toml", "accepted = 0.7", "accepted = 0.5")
    assert judged(case, build, "quick")[0] == 1


def test_an_ensemble_is_judged_once(case, build):
    plain = '[[variant]]\nname = "plain"\n\n'
    members = "".join(f'[[variant]]\nname = "{n}"\nsweep = false\nset = {{"fake.terminal" = {v}}}\n\n' for n, v in (("low", 1.98), ("high", 2.04)))
    case.edit("case.toml", r"\[sweep\]", plain + members + "[sweep]")
    for identity in ("velocity", "terminal", "mean"):
        case.edit("case.toml", f'id = "{identity}"', f'id = "{identity}"\nvariants = ["plain"]')
    case.append("case.toml", '[[check]]\nid = "both"\nquantity = "terminal"\nmetric = "ensemble_relative"\nvariants = ["low", "high"]\n'
                'tiers = ["quick"]\nfinest_quick = 0.3\nwhy = "Their mean is 2.01."\n')
    _, report = judged(case, build, "quick")
    (both,) = [c for c in report["checks"] if c["id"] == "both"]
    assert both["variant"] == "low to high" and both["verdict"] == "pass" and both["points"] == 2
    assert both["deviation"] == pytest.approx((2.01 * (1.0 - 2.718281828**-5) - 2.0) / 2.0, abs=1e-3)
    assert both["error_bar"] == pytest.approx(12.706 * 0.03 / 2.0, rel=0.02)  # Student's t of one degree of freedom


def test_over_budget_is_said(case, build, capsys):
    case.edit("scene.toml", "cpu_s = 0.5", "cpu_s = 8.0")
    code, report = judged(case, build, "quick")
    assert code == 0 and report["cost"]["over_budget"]
    assert "over the budget of 20 CPU seconds" in capsys.readouterr().out


def test_history_and_trend(case, build, monkeypatch):
    path = build / "reports" / "history.jsonl"
    judged(case, build, "quick")
    once = path.read_text(encoding="utf-8").splitlines()
    judged(case, build, "quick")
    assert len(path.read_text(encoding="utf-8").splitlines()) == len(once) == 3
    monkeypatch.setenv("FAKE_COMMIT", "def456")
    judged(case, build, "quick")
    lines = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    assert len(lines) == 6 and {line["commit"] for line in lines} == {"abc123", "def456"}
    assert "Trend" in (build / "reports" / "index.html").read_text(encoding="utf-8")


def test_baseline_and_drift(case, build, capsys):
    accept = ["accept", "relaxation", "--tier", "quick", "--build", str(build), "--reason"]
    assert main([*accept, "first"]) == 2
    judged(case, build, "quick")
    assert main([*accept, " "]) == 2
    assert main([*accept, "First results."]) == 0
    assert "git" in capsys.readouterr().out
    stored = json.loads(baseline.baseline_file("relaxation", "quick").read_text(encoding="utf-8"))
    assert stored["reason"] == "First results." and len(stored["checks"]) == 3
    case.edit("scene.toml", "gain = 1.0", "gain = 1.0001")
    judged(case, build, "quick")
    page = (build / "reports" / "relaxation" / "quick" / "report.html").read_text(encoding="utf-8")
    assert "First results." in page
    case.edit("scene.toml", "gain = 1.0001", "gain = 1.3")
    judged(case, build, "quick")
    assert main([*accept, "Hide a failure."]) == 2


def test_benchmarks_are_shown(case, build):
    folder = build / "reports"
    folder.mkdir(parents=True)
    (folder / "benchmarks.json").write_text(json.dumps({"benchmarks": [
        {"name": "dem_fcc/19652", "iterations": 3, "real_time": 1.0, "threads": 1, "grain_steps/s": 2.2e7}]}))
    judged(case, build, "quick")
    index = (folder / "index.html").read_text(encoding="utf-8")
    assert "dem_fcc/19652" in index and "grain_steps/s" in index and "real_time" not in index


def test_overview_of_nothing(build):
    assert main(["overview", "--build", str(build)]) == 0
    assert "No case has been judged yet" in (build / "reports" / "index.html").read_text(encoding="utf-8")


def test_two_judges_at_once(case, build):
    """Two processes share the overview and the history; neither loses a line of the other."""
    environment = {**os.environ, "PYTHONPATH": str(HERE.parent)}
    processes = [subprocess.Popen([sys.executable, "-m", "plumb_reports", "judge", str(case.folder), "--tier", tier,
                                   "--plumb", str(SOLVER), "--build", str(build)], env=environment,
                                  stdout=subprocess.DEVNULL) for tier in ("quick", "must_fail")]
    assert [process.wait() for process in processes] == [0, 0]
    lines = (build / "reports" / "history.jsonl").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 5
    index = (build / "reports" / "index.html").read_text(encoding="utf-8")
    assert "must_fail/report.html" in index and "quick/report.html" in index


@pytest.mark.skipif(shutil.which("cmake") is None, reason="needs cmake")
def test_cases_cmake(case, tmp_path):
    """The CTest glue: names, labels, what runs by default; in a path with spaces."""
    project = tmp_path / "a project"
    shutil.copytree(case.folder, project / "verification" / "relaxation")
    case.edit("case.toml", "quick = 3", "quick = 3\ncampaign = [0.001]")
    shutil.copytree(case.folder, project / "experiments" / "long_one")
    (project / "reports").symlink_to(HERE.parent)
    (project / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.25)\nproject(fake LANGUAGES NONE)\nenable_testing()\n"
        "foreach(name plumb plumb_planted)\nadd_executable(${name} IMPORTED)\n"
        f'set_property(TARGET ${{name}} PROPERTY IMPORTED_LOCATION "{SOLVER}")\nendforeach()\n'
        f'set(PLUMB_PYTHON "{sys.executable}")\ninclude(reports/cases.cmake)\nplumb_add_cases()\n', encoding="utf-8")
    subprocess.run(["cmake", "-S", project, "-B", project / "build"], check=True, stdout=subprocess.DEVNULL)

    def listed(*options):
        done = subprocess.run(["ctest", "--test-dir", project / "build", "-N", *options], check=True,
                              capture_output=True, text=True)
        return {line.split(": ")[1] for line in done.stdout.splitlines() if "Test " in line and "#" in line}

    quick = {f"{name}.{tier}" for name in ("relaxation", "long_one") for tier in ("quick", "must_fail")}
    full = {"relaxation.full", "long_one.full"}
    assert listed("-L", "quick") == quick
    assert listed("-L", "full") == full
    assert listed() == quick | full
    assert listed("-L", "fake") == quick | full
    assert listed("-C", "campaign", "-L", "campaign") == {"long_one.campaign"}
    done = subprocess.run(["ctest", "--test-dir", project / "build", "-R", "relaxation.quick"], check=False,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


VARIANTS = '''
[[variant]]
name = "fine"

[[variant]]
name = "strong"
set = {"fake.terminal" = 2.2}

[[check]]
id = "growth"
quantity = "growth"
metric = "value"
variants = ["strong"]
range = [1.05, 1.15]
tiers = ["quick"]
why = "A tenth more."
'''


@pytest.mark.parametrize("other, verdict, reason", [("fine", "pass", ""), ("none", "fail", "no run of 'none'")])
def test_a_run_is_measured_against_another_variant(case, build, other, verdict, reason):
    """At the same sweep value; one that is not there fails the check."""
    case.append("case.toml", VARIANTS)
    case.append("reference.py", f"\n\nalone = measure\n\n\ndef measure(quantity, run):\n    if quantity != 'growth':\n"
                f"        return alone(quantity, run)\n    other = run.other('{other}')\n    assert other.value == run.value\n"
                "    return run.series('v')[1][-1] / other.series('v')[1][-1]\n")
    report = judged(case, build, "quick")[1]
    found = next(c for c in report["checks"] if c["id"] == "growth")
    assert found["verdict"] == verdict and reason in found["reason"]
