"""Writes grains.csv: the lattice of reference_data/theory/sedimentation_scene.py, displaced in two waves. Committed files are
tested against it (reference_data/test_rayleigh_taylor.py).

    python3 displaced_lattice.py            # writes them again
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "reference_data"))

from theory import sedimentation_scene as scene  # noqa: E402

FILES = {"grains.csv": 1.0, "grains_tenth.csv": 0.1}  # of the published displacement


def places(amplitude):
    """[grains, 3] in m: layers from the lowest up, in each y runs slowest."""
    block = scene.lattice(0.8)
    across = (np.arange(block.columns) + 0.5) * block.spacing
    z, y, x = (axis.ravel() for axis in np.meshgrid(block.heights, across, across, indexing="ij"))
    return np.column_stack([x, y, z + amplitude * scene.displacement(x, y)])


def text(amplitude):
    """The file: 1e-12 m of rounding, 1e-7 of the displacement."""
    return "x [m],y [m],z [m]\n" + "".join(",".join(f"{c:.9e}" for c in row) + "\n" for row in places(amplitude))


if __name__ == "__main__":
    for name, amplitude in FILES.items():
        (HERE / name).write_text(text(amplitude), encoding="utf-8")
