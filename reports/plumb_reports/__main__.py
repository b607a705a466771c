"""Command line of the judge. Exit codes: 0 all checks pass (or not_met within accepted), 1 one fails, 2 bad input."""

import argparse
import os
import sys
from pathlib import Path

from . import baseline, film, outcome, pages
from .case_file import TIERS
from .strict import CaseError


def main(arguments=None):
    """Runs one command; returns the exit code."""
    options = parser().parse_args(arguments)
    try:
        return options.run(options)
    except CaseError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


def parser():
    """The commands and their options."""
    made = argparse.ArgumentParser(prog="plumb_reports", description=__doc__)
    commands = made.add_subparsers(required=True)
    judge = commands.add_parser("judge", help="run a case and judge it")
    judge.add_argument("case", type=Path, help="case folder")
    judge.add_argument("--tier", required=True, choices=(*TIERS, "must_fail"))
    judge.add_argument("--plumb", required=True, type=Path, help="the solver")
    judge.add_argument("--planted", type=Path, help="the solver with planted faults, needed by must_fail twins only")
    judge.add_argument("--jobs", type=positive, default=1, help="runs at a time (default 1)")
    judge.set_defaults(run=judge_case)
    overview = commands.add_parser("overview", help="rewrite the overview page")
    overview.set_defaults(run=refresh_overview)
    accept = commands.add_parser("accept", help="make the current report of a case its baseline")
    accept.add_argument("case", help="name of the case")
    accept.add_argument("--tier", required=True, choices=TIERS)
    accept.add_argument("--reason", required=True, help="why the new numbers are right")
    accept.set_defaults(run=accept_baseline)
    shown = commands.add_parser("film", help="a result as a film")
    shown.add_argument("result", type=Path, help="folder of a run")
    shown.add_argument("-o", "--output", required=True, type=Path, help=".gif, .webp or .png")
    shown.add_argument("--along", choices=tuple(film.AXES), default="y", help="the axis that is looked along (default y)")
    shown.set_defaults(run=show_film)
    for command in (judge, overview, accept):
        command.add_argument("--build", required=True, type=Path, help="build folder; results go to <build>/reports")
    return made


def positive(text):
    """A whole number above zero."""
    value = int(text)
    if value < 1:
        raise ValueError
    return value


def judge_case(options):
    """judge: runs, judges, prints, writes."""
    for name in ("plumb", "planted"):
        binary = getattr(options, name)
        if binary is not None and not (binary.is_file() and os.access(binary, os.X_OK)):
            raise CaseError(f"--{name}: {binary} is not a program")
    binaries = [None if b is None else b.resolve() for b in (options.plumb, options.planted)]
    content = outcome.judged_case(options.case, options.tier, *binaries, options.build, options.jobs)
    print("\n".join(outcome.ctest_lines(content)))
    print(f"page: {(options.build / 'reports' / content['case'] / options.tier / 'report.html').resolve()}")
    return outcome.exit_code(content)


def refresh_overview(options):
    """overview: rewrites index.html."""
    pages.write_overview(options.build)
    print(f"page: {(options.build / 'reports' / 'index.html').resolve()}")
    return 0


def show_film(options):
    """film: all snapshots of a result as an animated picture."""
    film.write_film(options.result, options.output, options.along)
    print(options.output.resolve())
    return 0


def accept_baseline(options):
    """accept: copies the numbers of a report into reports/baseline."""
    target = baseline.accept(options.build, options.case, options.tier, options.reason)
    print(f"{target}\nCommit this file alone, with the reason as its message:\n"
          f"  git add reports/baseline/{target.name} && git commit")
    return 0


if __name__ == "__main__":
    sys.exit(main())
