"""What grains at given places in a periodic cube do to the fluid of a grid: linear theory, wave by wave of the discrete Fourier series.

`grid_weights` spreads and gathers each grain where it is, so nothing is averaged over its place in a cell. On an even grid of spacing a

    second differences, friction:   K^2 = sum K_i^2,  K_i = (2/a) sin(k_i a/2)          (nu k^2 of `sph_operators`: Morris' symbol)
    gradient to faces, divergence:  i K_i e^(+-i k_i a/2), so that pressure takes K K/K^2 of a push                              (1)
    mean of eps on two faces, then its difference over a cell:  i sin(k_i a)/a, for what the mean flow carries

A grain hands its drag on and takes from the fluid, with the weights of the cells, the stress on its own volume; both together are the
weight W less buoyancy, and leave eps + phi w^2 of friction in the fluid (w the transform of the kernel, twice: spread and gathered):

    R u_across = -W n (1 - e^(-R t/inertia)),   R = mu (eps + phi w^2) K^2 + (phi/V) b phi_1(b dt/m) (1 - w^2)                   (2)

n the transform of the grains spread over the faces, inertia = eps rho + phi w^2 rho_p. The last term of R is the solver's own: in a step of
dt every face pays the drag, linear in the new velocity with the coefficient b phi_1 of the exponential exchange, b = f_d/slip, for the
velocity that it has itself. What the grain's gathered velocity makes different is paid back spread as ever, so a grain's momentum is
exact, but a wave is held by b phi_1 to its own mean over the kernel, whatever the step: to m/dt in long steps, to b in short ones. Grains that move at v through fluid of mean u0, each at the slip of the eps around
it, and at the velocity that it gathers, drive a flow along k:

    (eps + phi w^2) i K.u_along = -i [u0 sin(k_z a)/a - v k_z - phi w^2 (d slip/d eps) k_z] eps',   eps' = -V n_cells/a^3       (3)

The change of slip with eps that grains see lies along z and is continued by the pressure like everything along k. Left out: squares of the
fluctuations, inertia of the disturbance at Re > 0, and that waves have not moved along with the grains since the start.
"""

from typing import NamedTuple

import numpy as np

from theory import grid_weights


class Bed(NamedTuple):
    """Grid and suspension; lengths in m, `weight` of a grain less buoyancy in N, slip interstitial, d slip/d eps in m/s."""

    side: float
    cells: int
    width: float
    volume: float
    weight: float
    rho: float
    rho_p: float
    mu: float
    slip: float
    slope: float
    held: float  # b phi_1, N s/m


class Symbols(NamedTuple):
    """Of the waves of the grid, [z, y, x]: the wave's own k_z, K_z, K^2 (1 for the mean), sin(k_z a)/a and w."""

    along: np.ndarray
    difference: np.ndarray
    square: np.ndarray
    carried: np.ndarray
    kernel: np.ndarray


def symbols(side, cells, width):
    """The symbols of (1). Waves of half the grid's own number turn neither way: k_z of theirs is set to zero."""
    a = side / cells
    k = 2.0 * np.pi * np.fft.fftfreq(cells, a)
    kz, ky, kx = np.meshgrid(k, k, k, indexing="ij")
    difference = [2.0 / a * np.sin(0.5 * part * a) for part in (kx, ky, kz)]
    square = sum(part**2 for part in difference)
    square[0, 0, 0] = 1.0
    turns = np.where(np.abs(np.abs(kz) * a - np.pi) < 1e-9, 0.0, kz)
    kernel = grid_weights.transform(np.sqrt(kx**2 + ky**2 + kz**2), width)
    return Symbols(turns, difference[2], square, np.sin(kz * a) / a, kernel)


def spread(weights, cells):
    """Transform of the grains' weights summed on the nodes, [z, y, x]."""
    return np.fft.fftn(weights.sum(axis=1).reshape(cells, cells, cells))


def wakes(bed, s, faces, phi, t):
    """Vertical velocity, m/s, on the faces across z, of (2)."""
    left = 1.0 - phi + phi * s.kernel**2
    resistance = bed.mu * s.square * left + phi / bed.volume * bed.held * (1.0 - s.kernel**2)
    rate = resistance / ((1.0 - phi) * bed.rho + phi * s.kernel**2 * bed.rho_p)
    across = 1.0 - s.difference**2 / s.square
    push = -bed.weight * (bed.cells / bed.side) ** 3 * faces
    resistance[0, 0, 0] = 1.0  # the mean does not count
    u = push * across / resistance * -np.expm1(-rate * t)
    u[0, 0, 0] = 0.0
    return np.fft.ifftn(u).real


def backflow(bed, s, cells, phi):
    """Vertical velocity, m/s, on the faces across z, of (3): the gradient of a potential of the cells."""
    eps = -bed.volume * (bed.cells / bed.side) ** 3 * cells
    share = phi * bed.rho_p / ((1.0 - phi) * bed.rho + phi * bed.rho_p)  # of the slip is the fluid's, momentum being zero
    driven = share * bed.slip * s.carried + ((1.0 - share) * bed.slip - phi * s.kernel**2 * bed.slope) * s.along
    divergence = -1j * driven * eps / (1.0 - phi + phi * s.kernel**2)
    potential = -divergence / s.square
    potential[0, 0, 0] = 0.0
    values = np.fft.ifftn(potential).real
    return (values - np.roll(values, 1, axis=0)) * bed.cells / bed.side


def carried(bed, places, t):
    """(wakes, backflow): mean vertical velocity, m/s, that the grains at `places` [n, 3] gather beyond that of the box, at time t."""
    phi = len(places) * bed.volume / bed.side**3
    s = symbols(bed.side, bed.cells, bed.width)
    of_faces = grid_weights.gaussian_weights(grid_weights.nodes(bed.side, bed.cells, 2), places, bed.width, bed.side)
    of_cells = grid_weights.gaussian_weights(grid_weights.nodes(bed.side, bed.cells), places, bed.width, bed.side)
    gather = of_faces.mean(axis=1)
    return (float(gather @ wakes(bed, s, spread(of_faces, bed.cells), phi, t).ravel()),
            float(gather @ backflow(bed, s, spread(of_cells, bed.cells), phi).ravel()))
