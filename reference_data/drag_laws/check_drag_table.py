#!/usr/bin/env python3
"""Check a table of drag-law values against drag_table.csv.

    check_drag_table.py mine.csv [--tolerance 1e-9] [--law NAME]... [--all] [--rows N]

mine.csv has the columns of drag_table.csv: `law`, `eps [1]`, `re [1]`, `f [1]` (a bare name without the unit will do;
further columns are ignored). F = f_d / (3 pi mu d u_s) in the convention of README.md. Rows are matched by law, eps and
re, in any order. Without --law every law that occurs in mine.csv is judged, over all reference rows inside its range;
--all adds the rows outside. Prints one line per law and the first offending rows; the exit code is 0 when every row
agrees, 1 when one does not or is missing, 2 when a file cannot be used. Needs the Python standard library alone.
"""

import argparse
import csv
import math
import sys
from pathlib import Path

REFERENCE = Path(__file__).resolve().parent / "drag_table.csv"


class TableError(Exception):
    """A file that cannot be read as a drag table."""


def _rows(path):
    """{(law, eps, re): (f, in_range, line)} of one table."""
    try:
        with open(path, newline="", encoding="utf-8") as stream:
            lines = list(csv.reader(stream))
    except (OSError, UnicodeDecodeError) as error:
        raise TableError(f"{path}: {error}") from error
    if not lines:
        raise TableError(f"{path}: the file is empty")
    names = [field.split("[")[0].strip().lower() for field in lines[0]]
    missing = {"law", "eps", "re", "f"} - set(names)
    if missing:
        raise TableError(f"{path}: no column {', '.join(sorted(missing))} in the header {lines[0]}")
    column = {name: names.index(name) for name in names}
    rows = {}
    for number, line in enumerate(lines[1:], start=2):
        if not line:
            continue
        try:
            key = (line[column["law"]].strip(), *(_key(line[column[name]]) for name in ("eps", "re")))
            inside = line[column["in_range"]].strip() == "1" if "in_range" in column else True
            value = (float(line[column["f"]]), inside, number)
        except (IndexError, ValueError) as error:
            raise TableError(f"{path}, line {number}: {error}") from error
        if key in rows:
            raise TableError(f"{path}, line {number}: {key[0]} at eps {key[1]}, re {key[2]} occurs twice")
        rows[key] = value
    return rows


def _key(text):
    """eps and re are matched to ten digits, so that 0.4 and 4.0000000000000002e-01 are the same row."""
    return float(f"{float(text):.10g}")


def _offences(law, mine, reference, tolerance, everything):
    """[(message)] for one law, the number of rows judged and the largest relative deviation."""
    offences, judged, largest = [], 0, 0.0
    for (name, eps, re), (expected, inside, _) in reference.items():
        if name != law or not (inside or everything):
            continue
        judged += 1
        if (name, eps, re) not in mine:
            offences.append(f"  {law}: eps {eps:g}, re {re:g} is missing")
            continue
        value, _, line = mine[(name, eps, re)]
        deviation = abs(value - expected) / abs(expected) if expected != 0.0 else abs(value)
        if not math.isfinite(value):
            deviation = math.inf
        largest = max(largest, deviation)
        if not deviation <= tolerance:
            ratio = value / expected if expected != 0.0 else math.inf
            offences.append(
                f"  line {line}: {law} at eps {eps:g}, re {re:g}: F = {value:.12g}, expected {expected:.12g} (ratio {ratio:.6g})"
            )
    return offences, judged, largest


def _arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("table", help="CSV with columns law, eps, re, f")
    parser.add_argument("--tolerance", type=float, default=1e-9, help="largest relative deviation (default 1e-9)")
    parser.add_argument("--law", action="append", help="judge this law only (may repeat); it must be in the table")
    parser.add_argument("--all", action="store_true", help="judge the rows outside each law's range too")
    parser.add_argument("--rows", type=int, default=5, help="offending rows shown per law (default 5)")
    parser.add_argument("--reference", default=REFERENCE, help=argparse.SUPPRESS)
    return parser.parse_args()


def main():
    arguments = _arguments()
    try:
        reference, mine = _rows(arguments.reference), _rows(arguments.table)
    except TableError as error:
        print(error, file=sys.stderr)
        return 2
    known = list(dict.fromkeys(key[0] for key in reference))
    laws = arguments.law or [law for law in known if any(key[0] == law for key in mine)]
    unknown = [law for law in laws if law not in known] or [key[0] for key in mine if key[0] not in known]
    if unknown or not laws:
        print(f"{arguments.table}: unknown law {unknown[0]}" if unknown else f"{arguments.table}: no rows", file=sys.stderr)
        return 2
    failed = False
    for law in laws:
        offences, judged, largest = _offences(law, mine, reference, arguments.tolerance, arguments.all)
        failed = failed or bool(offences)
        verdict = f"{len(offences)} of {judged} rows FAIL" if offences else f"{judged} rows agree"
        print(f"{law}: {verdict}, largest deviation {largest:.3g} (tolerance {arguments.tolerance:g})")
        for message in offences[: arguments.rows]:
            print(message)
        if len(offences) > arguments.rows:
            print(f"  ... and {len(offences) - arguments.rows} more")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
