"""States of the box of smoothed particles, for LIGGGHTS and for comparison with it; needs numpy and h5py.

    sph_states.py start PARTICLES_TO_A_SIDE DATA     the benchmark's box: lattice, jitter 0.1 dx, a vortex
    sph_states.py data SNAPSHOT DATA                 a snapshot of plumb
    sph_states.py compare FIRST LAST DUMP            prints {"velocity", "energy"}: relative differences as JSON
"""
import json
import sys

import h5py
import numpy as np


def write_data(path, x, v, rho):
    """Two columns of an atom's line are dead in LIGGGHTS' reader: the fourth, and the last two, which it takes for images."""
    with open(path, "w") as out:
        out.write(f"smoothed particles\n\n{len(x)} atoms\n1 atom types\n")
        out.writelines(f"0.0 1.0 {axis}lo {axis}hi\n" for axis in "xyz")
        out.write("\nAtoms\n\n")
        np.savetxt(out, np.column_stack([np.arange(1, len(x) + 1), rho, np.mod(x, 1.0)]), "%d 1 %.17g 0 %.17g %.17g %.17g 0 0")
        out.write("\nVelocities\n\n")
        np.savetxt(out, np.column_stack([np.arange(1, len(x) + 1), v]), "%d %.17g %.17g %.17g 0 0 0")


def benchmark_box(side):
    """(x, v, rho) as in solver/benchmarks/sph_benchmarks.cpp, other random numbers."""
    site = (np.arange(side) + 0.5) / side
    x = np.stack(np.meshgrid(site, site, site, indexing="ij"), axis=-1).reshape(-1, 3)
    x += np.random.default_rng(1).uniform(-0.1, 0.1, x.shape) / side
    a, b = 2.0 * np.pi * x[:, 0], 2.0 * np.pi * x[:, 1]
    return x, np.stack([np.sin(a) * np.cos(b), -np.cos(a) * np.sin(b), 0.0 * a], axis=1), np.ones(len(x))


def snapshot(path):
    with h5py.File(path) as file:
        return file["fluid/x"][:], file["fluid/v"][:], file["fluid/rho"][:]


def comparison(first, last, dump):
    """Of velocities, over the change that plumb made; of kinetic energy, over what plumb has lost."""
    begin, ours = snapshot(first)[1], snapshot(last)[1]
    with open(dump) as source:
        lines = source.read().split("ITEM: ATOMS")[-1].splitlines()[1:]
    theirs = np.array([line.split() for line in lines], float)[:, 4:7]
    energies = [(v**2).sum() for v in (begin, ours, theirs)]
    return {"velocity": float(np.linalg.norm(theirs - ours) / np.linalg.norm(ours - begin)),
            "energy": float((energies[1] - energies[2]) / (energies[0] - energies[1]))}


if __name__ == "__main__":
    what, *rest = sys.argv[1:]
    if what == "start":
        write_data(rest[1], *benchmark_box(int(rest[0])))
    elif what == "data":
        write_data(rest[1], *snapshot(rest[0]))
    else:
        print(json.dumps(comparison(*rest)))
