"""Turns a table of plumb_benchmark_state into a data file of LAMMPS or LIGGGHTS: lammps_data.py TABLE.csv BOX DATA."""
import csv
import sys


def write_data(table, box, path):
    with open(table) as source:
        rows = list(csv.reader(source, skipinitialspace=True))[1:]
    with open(path, "w") as out:
        out.write(f"one millimetre spheres\n\n{len(rows)} atoms\n1 atom types\n")
        for axis in "xyz":
            out.write(f"0.0 {box} {axis}lo {axis}hi\n")
        out.write("\nAtoms\n\n")
        for k, row in enumerate(rows, 1):
            out.write(f"{k} 1 1e-3 2500.0 {' '.join(row[0:3])}\n")
        out.write("\nVelocities\n\n")
        for k, row in enumerate(rows, 1):
            out.write(f"{k} {' '.join(row[3:9])}\n")


if __name__ == "__main__":
    write_data(sys.argv[1], sys.argv[2], sys.argv[3])
