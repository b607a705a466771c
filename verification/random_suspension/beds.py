"""Writes dense_<percent>_<seed>.csv: random packings of equal hard spheres in a periodic cube, denser than random addition can make.

A stretched lattice of nearly evenly spread places melts in a Monte Carlo walk of hard spheres. (Places thrown at random and pushed
apart would keep the large-scale fluctuations of the throw, many times those of a fluid of hard spheres.) /usr/bin/python3 beds.py
"""

import math
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

HERE = Path(__file__).resolve().parent
SWEEPS, STEP, LEAST = 200, 0.15, 1.0 + 1e-4  # of the walk; its greatest step and the least distance, in diameters
CELLS = {"body": ((0.0, 0.0, 0.0), (0.5, 0.5, 0.5)), "face": ((0.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.5, 0.0, 0.5), (0.0, 0.5, 0.5))}
BEDS = {60: ("face", (7, 7, 7)), 50: ("body", (9, 9, 10))}  # fluid fraction in per cent: lattice, cells along the axes
SEEDS = (1, 2, 3)


def lattice(kind, cells, side):
    """Places [n, 3] in the cube."""
    corner = np.stack(np.meshgrid(*(np.arange(n) for n in cells), indexing="ij"), axis=-1).reshape(-1, 1, 3)
    return side * ((corner + np.array(CELLS[kind])) / cells).reshape(-1, 3)


def side_of(percent):
    """Side of the cube in diameters that makes the fluid fraction exact."""
    kind, cells = BEDS[percent]
    return (len(CELLS[kind]) * math.prod(cells) * math.pi / 6.0 / (1.0 - percent / 100.0)) ** (1.0 / 3.0)


def walk(x, side, random):
    """Metropolis' walk of hard spheres: a move is allowed when it ends near nobody."""
    reach = 1.0 + 2.0 * STEP * math.sqrt(3.0) + 1e-3
    for _ in range(SWEEPS):
        neighbours = cKDTree(x, boxsize=side).query_ball_point(x, reach)
        for k in random.permutation(len(x)):
            place = x[k] + STEP * random.uniform(-1.0, 1.0, 3)
            away = x[[j for j in neighbours[k] if j != k]] - place
            away -= side * np.rint(away / side)
            if not len(away) or (away**2).sum(axis=1).min() > LEAST**2:
                x[k] = place
        x = np.mod(x, side)
        x[x >= side] = 0.0
    return x


def main():
    for percent, (kind, cells) in BEDS.items():
        side = side_of(percent)
        for seed in SEEDS:
            x = walk(lattice(kind, cells, side), side, np.random.default_rng(1000 * percent + seed))
            lines = ["x [m],y [m],z [m]"] + [",".join(f"{c:.5f}e-4" for c in place) for place in x]
            (HERE / f"dense_{percent}_{seed}.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
