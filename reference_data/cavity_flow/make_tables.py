#!/usr/bin/env python3
"""Writes the two tables of this folder: Richardson extrapolation of theory/cavity.py from 256 and 384 cells (1.5 minutes)."""

import csv
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from theory import cavity  # noqa: E402

REYNOLDS = (100, 400, 1000)
GRIDS = (256, 384)
PLACES = np.arange(129) / 128  # Ghia's grid, so that no interpolation is needed there


def extrapolated(grids=GRIDS, reynolds=REYNOLDS, places=PLACES):
    """{Re: (u on x = 1/2, v on y = 1/2)} at `places`, free of the error of order h^2."""
    result = {}
    flows = {n: None for n in grids}
    for re in reynolds:
        lines = []
        for n in grids:
            flows[n] = cavity.solve(n, re, flows[n])
            s, u, v = cavity.profiles(n, flows[n][0])
            lines.append((CubicSpline(s, u)(places), CubicSpline(s, v)(places)))
        r = (grids[1] / grids[0]) ** 2
        result[re] = [(r * fine - coarse) / (r - 1.0) for coarse, fine in zip(*lines)]
    return result


def main():
    found = extrapolated()
    for file, place, component, index in (("u_on_vertical_line", "y", "u", 0), ("v_on_horizontal_line", "x", "v", 1)):
        with open(HERE / f"{file}.csv", "w", newline="", encoding="utf-8") as stream:
            writer = csv.writer(stream, lineterminator="\n")
            writer.writerow([f"{place} [1]"] + [f"{component}_re_{re} [1]" for re in REYNOLDS])
            for number, s in enumerate(PLACES):
                values = [found[re][index][number] for re in REYNOLDS]
                writer.writerow([f"{s:.7f}"] + [f"{0.0 if abs(value) < 5e-7 else value:.6f}" for value in values])


if __name__ == "__main__":
    main()
