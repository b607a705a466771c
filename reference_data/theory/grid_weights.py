"""How a grain is spread over the nodes of an even, periodic grid: plain sums over all pairs.

    P_aj = w(|x_a - x_j|/width) / sum_b w(|x_b - x_j|/width),    w(q) = exp(-q^2/2) for q < 3.5                          (1)

with the nearest image in each direction: nodes a are the centres of cells (volume, pressure) or of the faces across one axis (that
component of the velocity). q P gathers a field at the grains; 1 - sum_j V_j P_aj/V_a is the fluid fraction of a cell. The columns
sum to one, so the volume of the grains is all in the cells and their forces all on the faces, wherever they are.

Over many places of a grain in its cell, the mean of P is the transform of w,

    P^(k) = exp(-k^2 width^2/2)    (cut off at 3.5: within 7e-3)                                                        (2)

and what depends on the place are its aliases, P^(k + 2 pi n/spacing): 2.7e-9 for widths of one cell, 2e-5 for 0.75, 7e-3 for a half.

Lengths in m. Theory: Apte, Mahesh & Lundgren (2008), Int. J. Multiphase Flow 34, 260, for the kernel.
"""

import numpy as np

REACH = 3.5  # deviations: where the Gaussian is cut off


def nodes(side, cells, across=None):
    """Centres of the cells [n, 3] of a cube, or with `across` of the lower faces across that axis; x changes fastest."""
    centre = (np.arange(cells) + 0.5) * side / cells
    axes = [centre - (0.5 * side / cells if axis == across else 0.0) for axis in range(3)]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)


def gaussian_weights(at, grains, width, side):
    """P [nodes, grains] of (1); `side` of the periodic cube must be at least twice the reach."""
    if side < 2.0 * REACH * width:
        return folded_weights(at, grains, width, side)
    away = np.zeros((len(at), len(grains)))
    for axis in range(3):
        apart = at[:, axis, None] - grains[None, :, axis]
        away += (apart - side * np.rint(apart / side)) ** 2
    q = np.sqrt(away) / width
    weight = np.where(q < REACH, np.exp(-0.5 * q**2), 0.0)
    return weight / weight.sum(axis=0)


def folded_weights(at, grains, width, side):
    """P when a grain meets its own images: every image within reach counts by itself."""
    turns = int(np.ceil(REACH * width / side + 0.5))
    weight = np.zeros((len(at), len(grains)))
    shifts = side * np.arange(-turns, turns + 1)
    apart = [at[:, axis, None] - grains[None, :, axis] for axis in range(3)]
    for x in shifts:
        for y in shifts:
            for z in shifts:
                q = np.sqrt((apart[0] + x) ** 2 + (apart[1] + y) ** 2 + (apart[2] + z) ** 2) / width
                weight += np.where(q < REACH, np.exp(-0.5 * q**2), 0.0)
    return weight / weight.sum(axis=0)


def cell_porosity(weights, volume, cell_volume):
    """Fluid fraction of the cells [n] for grains of one `volume`."""
    return 1.0 - weights.sum(axis=1) * volume / cell_volume


def transform(k, width):
    """P^(k) of (2), 1 at k = 0, of the Gaussian that is not cut off."""
    return np.exp(-0.5 * (np.asarray(k, float) * width) ** 2)
