"""The HTML pages: one per case and tier, and the overview. Self-contained: style and pictures are inside."""

import base64
import json
from pathlib import Path

import jinja2
from markupsafe import Markup

from . import verdicts
from .files import locked, replace_file
from .history import read_history
from .prose import html_of_markdown

TIERS = ("quick", "full", "campaign", "must_fail")
WORDS = {"pass": "pass", "fail": "fail", "not_met": "not met"}
KIND_TITLES = {
    "theory": ("Against theory", "Exact or manufactured solutions: the difference is an error of plumb."),
    "measured": ("Against measurements", "The difference is shown in per cent and in units of the measurement's "
                 "standard uncertainty."),
    "published": ("Against published simulations", "Results of other people's codes. Agreement is reproduction, not "
                  "truth.")}


def number(value):
    """A number for people: four significant digits, powers of ten spelled out, a dash for nothing."""
    if value is None:
        return "–"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(str(number(v)) for v in value) + "]"
    if isinstance(value, (bool, str)):
        return str(value)
    text = f"{value:.4g}"
    if "e" not in text:
        return text.replace("-", "−")
    mantissa, exponent = text.split("e")
    power = str(int(exponent)).replace("-", "−")
    factor = "" if mantissa == "1" else f"{mantissa.replace('-', '−')}&thinsp;×&thinsp;"
    return Markup(f"{factor}10<sup>{power}</sup>")


def per_cent(fraction):
    """A signed fraction in per cent."""
    return "–" if fraction is None else f"{100 * fraction:+.2f} %".replace("-", "−")


def seconds(value):
    """A time with sensible digits."""
    return "–" if value is None else f"{value:.2f} s" if value < 100 else f"{value:.0f} s"


def megabytes(value):
    """Bytes as MB."""
    return "–" if not value else f"{value / 1e6:.1f} MB"


def data_uri(png_bytes):
    """A PNG as a data URI."""
    return "data:image/png;base64," + base64.b64encode(png_bytes).decode("ascii")


def environment():
    """Templates with the filters above; everything from outside is escaped."""
    made = jinja2.Environment(loader=jinja2.FileSystemLoader(Path(__file__).parent / "templates"), autoescape=True,
                              undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    made.filters.update(number=number, per_cent=per_cent, seconds=seconds, megabytes=megabytes)
    made.globals.update(words=WORDS, kind_titles=KIND_TITLES)
    return made


def case_page(report, drift, pictures, table, readme):
    """HTML of one case and tier. `readme` is Markdown; `pictures` are Pictures, `table` as authors_table returns it."""
    groups = {}
    for check in report["checks"]:
        groups.setdefault(check["kind"], {}).setdefault(check["id"], []).append(check)
    figures = [{"uri": data_uri(p.png), "caption": p.caption, "name": p.name} for p in pictures]
    return environment().get_template("case.html").render(
        report=report, counts=report["counts"], groups=groups, drift=drift, figures=figures, table=table,
        readme=Markup(html_of_markdown(readme)))


def write_overview(build):
    """Rewrites <build>/reports/index.html from the reports on disk."""
    folder = Path(build) / "reports"
    with locked(folder):
        replace_file(folder / "index.html", overview_page(folder))


def overview_page(folder):
    """HTML of the overview of all reports under `folder`."""
    cases = overview_cases(folder)
    reports = [report for case in cases for report in case["tiers"].values()]
    words = [check["verdict"] for report in reports for check in report["checks"]]
    unmet = [(report, check) for report in reports for check in report["checks"] if check["verdict"] == "not_met"]
    failing = [(report, check) for report in reports for check in report["checks"] if check["verdict"] == "fail"]
    return environment().get_template("index.html").render(
        cases=cases, counts=verdicts.counts(words), unmet=unmet, failing=failing, benchmarks=benchmark_rows(folder),
        trend=trend(read_history(folder / "history.jsonl")),
        problems=[(report, problem) for report in reports for problem in report["problems"]])


def overview_cases(folder):
    """[{"name", "tiers": {tier: report}, "main": report, "checks": worst row per check, "thumbnail"}] by area, name."""
    cases = []
    for case in sorted(path for path in folder.iterdir() if path.is_dir()):
        tiers = {tier: json.loads((case / tier / "report.json").read_text(encoding="utf-8"))
                 for tier in TIERS if (case / tier / "report.json").is_file()}
        if not tiers:
            continue
        main = next(tiers[tier] for tier in ("campaign", "full", "quick", "must_fail") if tier in tiers)
        picture = folder / case.name / main["tier"] / "thumbnail.png"
        cases.append({"name": case.name, "tiers": tiers, "main": main, "checks": worst_rows(main),
                      "thumbnail": data_uri(picture.read_bytes()) if picture.is_file() else None})
    return sorted(cases, key=lambda c: (c["main"]["area"], c["name"]))


def worst_rows(report):
    """For every check of a report the variant that does worst, with the number of variants."""
    groups = {}
    for check in report["checks"]:
        groups.setdefault(check["id"], []).append(check)
    return [{**max(group, key=badness), "variants": len(group)} for group in groups.values()]


def badness(check):
    """Sorts checks by verdict, then by error."""
    return ("pass", "not_met", "fail").index(check["verdict"]), abs(check["value"] or 0.0)


def benchmark_rows(folder):
    """[{"name", "counters": {name: rate}}] of benchmarks.json (Google Benchmark); None when there is no file."""
    path = folder / "benchmarks.json"
    if not path.is_file():
        return None
    standard = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations",
                "real_time", "cpu_time"}
    rows = []
    for entry in json.loads(path.read_text(encoding="utf-8")).get("benchmarks", []):
        counters = {key: value for key, value in entry.items()
                    if key not in standard and isinstance(value, (int, float)) and not isinstance(value, bool)}
        rows.append({"name": entry["name"], "counters": counters, "error": entry.get("error_message")})
    return {"rows": rows, "counters": sorted({name for row in rows for name in row["counters"]})}


def trend(lines):
    """The last commits against all checks: {"commits", "rows"}; None when fewer than two states were judged."""
    states = list(dict.fromkeys((line["commit"], line["dirty"]) for line in lines))[-6:]
    if len(states) < 2:
        return None
    cells = {}
    for line in sorted(lines, key=badness):  # the worst variant of a check is written last and stays
        if line["tier"] != "must_fail":
            name = (line["case"], line["tier"], line["id"])
            cells.setdefault(name, {})[(line["commit"], line["dirty"])] = line
    commits = [f"{(commit or 'unknown')[:9]}{' (changed)' if dirty else ''}" for commit, dirty in states]
    rows = [{"name": name, "cells": [cells[name].get(state) for state in states]} for name in sorted(cells)]
    return {"commits": commits, "rows": rows}
