"""Reader of the tables in this folder: numbers by column, units from the header. Needs NumPy and the standard library.

A header field is `name [unit]`; a field without brackets names a text column. Dimensionless columns have the unit `1`.
"""

import csv
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent

# Factor from each unit that occurs in a header to SI. New units are added here or `column` refuses them.
SI_FACTOR = {
    "1": 1.0,
    "%": 1e-2,
    "m": 1.0,
    "mm": 1e-3,
    "um": 1e-6,
    "m/s": 1.0,
    "s": 1.0,
    "1/s": 1.0,
    "1/m": 1.0,
    "kg/m3": 1.0,
    "g": 1e-3,
    "Pa s": 1.0,
    "Pa": 1.0,
    "kPa": 1e3,
    "N/m": 1.0,
    "kg/s": 1.0,
    "m2/s": 1.0,
    "ml/min": 1e-6 / 60.0,
}


class TableError(Exception):
    """A table that is not in the form this folder promises."""


def _split(field):
    """("u_t", "m/s") of "u_t [m/s]", ("name", None) of "name"."""
    name, bracket, rest = field.strip().partition(" [")
    if not bracket:
        return name, None
    if not rest.endswith("]"):
        raise TableError(f"header field '{field}': expected 'name [unit]'")
    return name, rest[:-1]


def header(path):
    """[(name, unit or None)] of the table at `path` (relative to reference_data/)."""
    with open(ROOT / path, newline="", encoding="utf-8") as stream:
        return [_split(field) for field in next(csv.reader(stream))]


def table(path, si=True):
    """{name: array} of the table at `path`; text columns are lists. Numbers in SI units, or as printed with si=False.

    An empty numeric field is nan (not stated by the source).
    """
    columns = header(path)
    with open(ROOT / path, newline="", encoding="utf-8") as stream:
        lines = [line for line in csv.reader(stream)][1:]
    for number, line in enumerate(lines, start=2):
        if len(line) != len(columns):
            raise TableError(f"{path}, line {number}: {len(line)} fields, the header has {len(columns)}")
    result = {}
    for index, (name, unit) in enumerate(columns):
        texts = [line[index].strip() for line in lines]
        if unit is None:
            result[name] = texts
            continue
        if unit not in SI_FACTOR:
            raise TableError(f"{path}: unit [{unit}] of column '{name}' is not in SI_FACTOR")
        factor = SI_FACTOR[unit] if si else 1.0
        result[name] = factor * np.array([float(text) if text else np.nan for text in texts])
    return result
