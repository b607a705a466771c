"""Judges a whole case in one tier and writes everything a reader will want to see."""

import json
from pathlib import Path

from . import baseline, history, pages, report, verdicts
from .bisection import bisected_variants
from .bisection_figure import bisection_pictures
from .case_file import read_case
from .extra_figures import authors_pictures, authors_table, stated_pictures, thumbnail
from .figures import check_pictures
from .files import locked, replace_file, replace_json
from .judge import judgements
from .metrics import NotComparable
from .plan import tier_plans
from .reference_file import Reference
from .runner import executed
from .twins import judged_twins
from .work_precision import work_precision, work_precision_pictures


def judged_case(case_folder, tier, plumb, planted, build, jobs):
    """Runs and judges a case, writes its report and refreshes the overview; returns the report.

    Raises CaseError for a case that cannot be read; everything that happens later is in the report.
    """
    case = read_case(case_folder)
    reference = Reference(case.folder)
    folder = Path(build).resolve() / "reports" / case.name / tier
    if tier == "must_fail":
        content = twins_report(case, plumb, planted, jobs, folder, reference)
    else:
        content = tier_report(case, tier, plumb, jobs, folder, reference)
    history.extend_history(folder.parents[1], content)
    pages.write_overview(build)
    return content


def tier_report(case, tier, plumb, jobs, folder, reference):
    """Report, figures and page of the tiers quick, full and campaign."""
    runs = executed(case, tier_plans(case, tier, folder / "runs"), plumb, jobs)
    for run in runs:
        run.judged_with = runs
    runs += bisected_variants(case, tier, folder / "runs", plumb, jobs, reference)
    judged = judgements(case, tier, runs, reference)
    precision = work_precision(case, runs, reference)
    problems = []
    pictures = work_precision_pictures(case, precision) + bisection_pictures(case, runs, judged) + check_pictures(judged)
    for extend in (lambda: stated_pictures(case, runs, reference), lambda: authors_pictures(runs, reference)):
        try:
            pictures += extend()
        except NotComparable as error:
            problems.append(str(error))
    table = None
    try:
        table = authors_table(runs, reference)
    except NotComparable as error:
        problems.append(str(error))
    content = report.report(case, tier, single_runs(runs), [report.check_entry(j) for j in judged], problems)
    content["work_precision"] = precision
    write_report(case, folder, content, pictures, table, thumbnail(judged))
    return content


def single_runs(runs):
    """`runs` with every bisected variant replaced by the runs of its bisection."""
    return [trial for run in runs for trial in run.trials]


def twins_report(case, plumb, planted, jobs, folder, reference):
    """Report and page of the tier must_fail."""
    twins = judged_twins(case, plumb, planted, jobs, folder / "runs", reference)
    runs = single_runs(run for twin in twins for part in (twin.broken, twin.control) if part for run in part.runs)
    content = report.report(case, "must_fail", runs, [report.twin_entry(twin) for twin in twins], [])
    content["without_twin"] = [c.id for c in case.checks if c.id not in {twin.breaks for twin in case.must_fail}]
    write_report(case, folder, content, [], None, None)
    return content


def write_report(case, folder, content, pictures, table, small):
    """Writes report.json, the figures and report.html; figures of an earlier judgement are removed."""
    readme = (case.folder / "README.md").read_text(encoding="utf-8")
    page = pages.case_page(content, baseline.drift(content), pictures, table, readme)
    with locked(folder.parents[1]):  # another judge may be reading the figures for the overview
        for old in folder.glob("*.png"):
            old.unlink()
        for picture in pictures:
            replace_file(folder / f"{picture.name}.png", picture.png)
        if small:
            replace_file(folder / "thumbnail.png", small)
        replace_file(folder / "report.html", page)
        replace_json(folder / "report.json", content)


def exit_code(content):
    """0 when everything passes or is not_met within accepted, 1 when a check fails, 2 when reference.py is at fault."""
    if content["counts"][verdicts.FAIL]:
        return 1
    return 2 if content["problems"] else 0


def ctest_lines(content):
    """What the judge prints: one line per check for people, one per number for CTest's result files."""
    lines = []
    for check in content["checks"]:
        name = check["id"] if check["variant"] == "default" else f"{check['id']}/{check['variant']}"
        lines.append(f"{check['verdict']:8}{name}: {check['reason']}")
        lines += measurement_lines(name, {"value": check["value"], "order": check["order"]})
    lines += [f"problem {problem}" for problem in content["problems"]]
    lines += measurement_lines("cost", {"cpu_s": content["cost"]["cpu_s"]})
    if content["cost"]["over_budget"]:
        lines.append(f"over the budget of {content['cost']['cpu_limit_s']:g} CPU seconds")
    return lines


def measurement_lines(name, numbers):
    """CTest measurements (CMake 3.21 and later, see ctest_test, "Additional Measurements")."""
    return [f'<CTestMeasurement type="numeric/double" name="{name}.{key}">{json.dumps(value)}</CTestMeasurement>'
            for key, value in numbers.items() if value is not None]
