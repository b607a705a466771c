"""Waves of compression in a uniform bed of free grains on a grid, step by step (README.md, equations 1 to 6)."""

import math

import numpy as np

SUPPORT = 3.5  # of the Gaussian, in widths
CELLS = 24     # of the sums, to each side
LEFT = {
    "exponential": lambda z: math.exp(-z),
    "implicit": lambda z: 1.0 / (1.0 + z + 0.5 * z * z),
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
        self.stress = float((weights(x, 0.0) * np.cos(k * x)).sum()) * math.cos(0.5 * k * h)
        e = 1e-4 * h
        slope = (weights(x, e) - weights(x, -e)) / (2.0 * e)
        self.displacement = float((slope * np.sin(k * x)).sum()) * h / (2.0 * math.sin(0.5 * k * h))


class LongWave:
    velocity = stress = displacement = 1.0


def step_matrix(exchange, z, phi, ratio, symbols, gradient):
    """What a step makes of (v, v before, u, dt times the stress on grains over rho_p, what is owed, the last way/dt)."""
    fraction = phi / (1.0 - phi)
    phi0 = LEFT[exchange](z)
    q = 1.0 - phi0
    phi1 = q / z
    phi2 = (1.0 - phi1) / z
    v, v_before, u, stress, owed, way = np.eye(6)
    new_u = -fraction * symbols.displacement * (way + 0.5 * (v - v_before))
    seen = symbols.velocity * new_u
    foreseen = q * (seen - v) - gradient * (1.0 - phi1) * stress
    on_fluid = q * new_u + symbols.velocity * (owed - q * v - gradient * (1.0 - phi1) * stress)
    new_stress = symbols.stress * ((new_u - u) / ratio + fraction * on_fluid)
    push = gradient * new_stress
    new_v = phi0 * v + q * seen + phi1 * push
    new_owed = new_v - v - push - foreseen
    return np.array([new_v, v, new_u, new_stress, new_owed, phi1 * v + (1.0 - phi1) * seen + phi2 * push])


def factor(exchange, z, phi, ratio, symbols, gradient):
    """The largest growth factor of a step."""
    return float(np.abs(np.linalg.eigvals(step_matrix(exchange, z, phi, ratio, symbols, gradient))).max())


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
