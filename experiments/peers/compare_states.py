"""How far the grains of a peer are from plumb's after the same steps: compare_states.py TABLE.csv PEER_OUTPUT.

Velocities are taken relative to their mean, which the drift of the benchmark makes large and which no force changes."""
import csv
import math
import sys


def rows_of(path):
    """Rows of x y z vx vy vz wx wy wz: a table of plumb, a dump of LAMMPS or LIGGGHTS, or the rows of Yade."""
    with open(path) as source:
        text = source.read()
    if text.startswith("x [m]"):
        return [[float(q) for q in row] for row in list(csv.reader(text.splitlines(), skipinitialspace=True))[1:]]
    lines = text.splitlines()
    header = [k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS")]
    if header:  # the last state of a dump; its first column is the number of the grain
        return [[float(q) for q in line.split()[1:10]] for line in lines[header[-1] + 1:]]
    return [[float(q) for q in line.split()] for line in lines]


def about_mean(vectors):
    mean = [sum(v[c] for v in vectors) / len(vectors) for c in range(3)]
    return [[v[c] - mean[c] for c in range(3)] for v in vectors]


def squares(vectors):
    return sum(q * q for v in vectors for q in v)


def relative_difference(ours, theirs):
    difference = [[a - b for a, b in zip(u, v)] for u, v in zip(ours, theirs)]
    return math.sqrt(squares(difference) / squares(ours))


def comparison(table, output):
    """{"velocity", "spin": relative difference in the root mean square, "energy": of peculiar kinetic energy}"""
    ours, theirs = rows_of(table), rows_of(output)
    if len(ours) != len(theirs):
        raise SystemExit(f"{output}: {len(theirs)} grains, expected {len(ours)}")
    v, u = (about_mean([row[3:6] for row in rows]) for rows in (ours, theirs))
    w, q = ([row[6:9] for row in rows] for rows in (ours, theirs))
    return {"velocity": relative_difference(v, u), "spin": relative_difference(w, q),
            "energy": squares(u) / squares(v) - 1.0}


if __name__ == "__main__":
    print("velocity {velocity:.2e}  spin {spin:.2e}  energy {energy:+.2e}".format(**comparison(*sys.argv[1:3])))
