"""Writes dense_<percent>_<seed>.csv: fluids of equal hard spheres in a periodic cube, which random addition does not make (fluid fraction
0.8: its long waves are a third too weak) or cannot reach (0.6, 0.5).

A stretched lattice of nearly evenly spread places melts in a Monte Carlo walk of hard spheres. (Places thrown at random and pushed
apart would keep the large-scale fluctuations of the throw, many times those of a fluid of hard spheres.) /usr/bin/python3 beds.py
"""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
LEAST = 1.0 + 1e-4  # distance in diameters
CELLS = {"body": ((0.0, 0.0, 0.0), (0.5, 0.5, 0.5)), "face": ((0.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.5, 0.0, 0.5), (0.0, 0.5, 0.5))}


class Bed(NamedTuple):
    kind: str  # of the lattice that melts
    cells: tuple  # along the axes
    sweeps: int  # of the walk: long enough for the box's longest wave, of rate D k^2/S(0)
    step: float  # its greatest step, diameters
    seeds: int  # numbered from 1


BEDS = {80: Bed("body", (7, 7, 7), 400, 0.5, 12), 60: Bed("face", (7, 7, 7), 200, 0.15, 6), 50: Bed("body", (9, 9, 10), 200, 0.15, 6)}  # by percent of fluid


def lattice(kind, cells, side):
    """Places [n, 3] in the cube."""
    corner = np.stack(np.meshgrid(*(np.arange(n) for n in cells), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    return side * ((corner + np.array(CELLS[kind])) / cells).reshape(-1, 3)


def side_of(percent):
    """Side of the cube in diameters that makes the fluid fraction exact."""
    bed = BEDS[percent]
    return (len(CELLS[bed.kind]) * math.prod(bed.cells) * math.pi / 6.0 / (1.0 - percent / 100.0)) ** (1.0 / 3.0)


def walk(x, side, sweeps, step, random):
    """Metropolis' walk of hard spheres: a move is allowed when it ends near nobody."""
    reach = 1.0 + 2.0 * step * math.sqrt(3.0) + 1e-3
    for _ in range(sweeps):
        neighbours = cKDTree(x, boxsize=side).query_ball_point(x, reach)
        for k in random.permutation(len(x)):
            place = x[k] + step * random.uniform(-1.0, 1.0, 3)
            away = x[[j for j in neighbours[k] if j != k]] - place
            away -= side * np.rint(away / side)
            if not len(away) or (away**2).sum(axis=1).min() > LEAST**2:
                x[k] = place
        x = np.mod(x, side)
        x[x >= side] = 0.0
    return x


def main():
    for percent, bed in BEDS.items():
        side = side_of(percent)
        for seed in range(1, bed.seeds + 1):
            path = HERE / f"dense_{percent}_{seed}.csv"
            if path.exists():
                continue
            x = walk(lattice(bed.kind, bed.cells, side), side, bed.sweeps, bed.step, np.random.default_rng(1000 * percent + seed))
            lines = ["x [m],y [m],z [m]"] + [",".join(f"{c:.5f}e-4" for c in place) for place in x]
            path.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
