"""Values of a field at given places from scattered particles: a weighted least-squares polynomial about each place."""

import numpy as np
from scipy.spatial import cKDTree


def monomials(offsets, degree):
    """[n, terms] of 1, x, y, x^2, xy, y^2, ... up to `degree` at offsets [n, 2]."""
    powers = [(i, total - i) for total in range(degree + 1) for i in range(total, -1, -1)]
    return np.stack([offsets[:, 0] ** i * offsets[:, 1] ** j for i, j in powers], axis=1)


def fitted(x, values, places, radius, degree=2):
    """Values [m, ...] at places [m, 2] of a field known as values [n, ...] at scattered x [n, 2].

    The polynomial is fitted to the particles within `radius`, weights (1 - q)^2, q the distance over it: exact for a field
    of that degree wherever the particles are, an error of order radius^(degree + 1) else. Near a wall the neighbours lie on one
    side. Raises ValueError where they are too few to fix it.
    """
    x, values = np.asarray(x, float)[:, :2], np.asarray(values, float)
    found = []
    for place, near in zip(places, cKDTree(x).query_ball_point(places, radius)):
        offsets = (x[near] - place) / radius
        weight = 1.0 - np.linalg.norm(offsets, axis=1)
        terms = monomials(offsets, degree)
        coefficients, _, rank, _ = np.linalg.lstsq(terms * weight[:, None], values[near] * _spread(weight, values), rcond=1e-9)
        if rank < terms.shape[1]:
            raise ValueError(f"{len(near)} particles near {place} do not fix a polynomial of degree {degree}")
        found.append(coefficients[0])
    return np.array(found)


def _spread(weight, values):
    """weight [n] with as many axes as values [n, ...]."""
    return weight.reshape((-1,) + (1,) * (values.ndim - 1))
