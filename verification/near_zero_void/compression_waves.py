"""Waves of compression in a uniform bed of free grains on a grid, step by step (README.md, equations 1 to 6)."""

import math
from typing import NamedTuple

import numpy as np

SUPPORT = 3.5  # of the Gaussian, in widths
CELLS = 24     # of the sums, to each side
LEFT = {
    "exponential": lambda z: math.exp(-z),
    "implicit": lambda z: 1.0 / (1.0 + z + 0.5 * z * z),
    "explicit": lambda z: 1.0 - z + 0.5 * z * z,
}


class Symbols:
    """What the Gaussian's weights and the staggered differences leave of a wave k along a cubic lattice of cells of width h with a grain at each centre."""

    def __init__(self, width, h, k):
        x = np.arange(-CELLS, CELLS + 1) * h
        across = np.add.outer(x**2, x**2).ravel()

        def weights(places, move):
            """By place along x, summed across; the grain is `move` off the origin, nodes in reach are those of no move."""
            kept = places[:, None] ** 2 + across < (SUPPORT * width) ** 2
            w = (np.exp(-0.5 * ((places - move)[:, None] ** 2 + across) / width**2) * kept).sum(axis=1)
            return w / w.sum()

        faces = x[:-1] + 0.5 * h
        self.velocity = float((weights(faces, 0.0) * np.cos(k * faces)).sum())
        self.stress = float((weights(x, 0.0) * np.cos(k * x)).sum()) * math.cos(0.5 * k * h)  # cells, and a mean of two faces
        e = 1e-4 * h
        slope = (weights(x, e) - weights(x, -e)) / (2.0 * e)
        self.displacement = float((slope * np.sin(k * x)).sum()) * h / (2.0 * math.sin(0.5 * k * h))
        self.difference = 2.0 * math.sin(0.5 * k * h) / h  # 1/m


class LongWave:
    velocity = stress = displacement = 1.0
    difference = 0.0


class Bed(NamedTuple):
    """A uniform bed: exchange law, dt over the relaxation time, solid fraction, density of grains over fluid's, whether the stress acts on grains,
    dt times the viscosity over the grains' density, m2, and the virtual mass over that of the grains."""
    exchange: str
    z: float
    phi: float
    ratio: float
    gradient: bool = True
    viscous: float = 0.0
    virtual: float = 0.0


def step_matrix(bed, symbols):
    """What a step makes of (v, v before, u, what is owed, the last way/dt, the way that was foreseen beyond v before)."""
    q = 1.0 / (1.0 + bed.virtual)                       # a grain's mass over that which moves with it
    z, phi, eps = q * bed.z, bed.phi, 1.0 - bed.phi
    phi0 = LEFT[bed.exchange](z)
    phi1 = (1.0 - phi0) / z
    phi2 = (1.0 - phi1) / z
    v, v_before, u, owed, way, foreseen_before = np.eye(6)
    G, H, S = symbols.velocity, symbols.stress, symbols.displacement
    stressed = 1.0 if bed.gradient else 0.0
    foresees = bed.exchange != "explicit"
    if bed.virtual and not foresees:
        raise ValueError("explicit exchange with virtual mass is not in this theory")
    rate = q * phi1 * (bed.z + bed.virtual) if foresees else 0.0    # F = rate u' - known - hands_on a'
    known = q * phi1 * (bed.z * v + bed.virtual * (G * u)) if foresees else z * (v - G * u)
    relaxes = 1.0 - phi1 if foresees else 0.0
    follows = relaxes + phi2 * q * bed.virtual if foresees else 0.0
    hands_on, yields = stressed * (1.0 - q * phi1) * foresees, stressed * phi2 * q * foresees
    drift = relaxes * H * (G * u - v) - follows * u     # of the way that is foreseen, what is known
    friction = yields * bed.viscous * symbols.difference**2
    # momentum and volume for u' and s, dt times the stress on the fluid over rho_p; the pressure's part alone makes grains yield
    left = np.array([[eps / bed.ratio + phi * rate, -(eps + phi * hands_on)], [eps + phi * (follows + friction), phi * yields]])
    right = np.array([eps / bed.ratio * u + phi * G * (known - owed), -phi * (S * (way + v - v_before) - foreseen_before + drift)])
    new_u, stress = np.linalg.solve(left, right)
    foreseen = drift + (follows + friction) * new_u + yields * stress
    push = stressed * H * stress                        # a'
    seen = G * new_u
    given = (rate * seen - known if foresees else -known) - (1.0 - q * phi1) * foresees * push
    carried = q * (push + bed.virtual * (seen - G * u))
    new_v = phi0 * v + z * phi1 * seen + phi1 * carried
    return np.array([new_v, v, new_u, new_v - v - push - given, phi1 * v + z * phi2 * seen + phi2 * carried, foreseen])


def factor(bed, symbols):
    """The largest growth factor of a step."""
    return float(np.abs(np.linalg.eigvals(step_matrix(bed, symbols))).max())


def history(bed, symbols, steps):
    """The grains' velocity over its start after 0 to `steps` steps; everything else starts at rest."""
    matrix, state, found = step_matrix(bed, symbols), np.array([1.0, 0, 0, 0, 0, 0]), [1.0]
    for _ in range(steps):
        state = matrix @ state
        found.append(state[0])
    return np.array(found)


def least(excess, low, high, points=60):
    """The least argument from which on excess > 0, or None; searched on a logarithmic grid, then halved."""
    places = np.geomspace(low, high, points)
    first = next((n for n, a in enumerate(places) if excess(a) > 0.0), None)
    if first is None or first == 0:
        return None
    below, above = places[first - 1 : first + 1]
    for _ in range(40):
        middle = math.sqrt(below * above)
        below, above = (below, middle) if excess(middle) > 0.0 else (middle, above)
    return above
