"""Steady flow with inertia across a square or hexagonal array of cylinders, driven by a uniform force.

    rho u.grad u = -grad p + mu lap u + g,   div u = 0,   u = 0 on the cylinder, u and p periodic

in one Wigner-Seitz cell, by spectral elements of degree N for the velocity and N - 2, discontinuous, for the pressure (Maday &
Patera 1989, in: State-of-the-art surveys on computational mechanics, ASME, 71) on the exact geometry, with Newton's method.
Convergence is exponential in N, so that two degrees say how exact a number is. The lattice constant is 1.
"""

import math
from functools import lru_cache

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

SIDES = {"square": 4, "hexagonal": 6}


def lobatto(n):
    """The n + 1 points of Gauss, Legendre and Lobatto on [-1, 1]."""
    inner = np.polynomial.legendre.Legendre.basis(n).deriv().roots()
    return np.r_[-1.0, np.sort(inner.real), 1.0]


def lagrange(nodes, x):
    """(values, slopes) [len(x), len(nodes)] at x of the polynomials that are 1 at one node and 0 at the others."""
    n = len(nodes)
    vandermonde = np.polynomial.legendre.legvander(nodes, n - 1)
    slopes = np.stack([np.polynomial.legendre.legval(x, np.polynomial.legendre.legder(row)) for row in np.eye(n)], axis=1)
    inverse = np.linalg.inv(vandermonde)
    return np.polynomial.legendre.legvander(x, n - 1) @ inverse, slopes @ inverse


class Cell:
    """The cell around one cylinder: a sector for each side, cut into layers from the cylinder (0) to the side (1)."""

    def __init__(self, array, solid_fraction, degree=9, layers=(0.0, 0.12, 0.4, 1.0), pieces=2):
        self.n, self.degree = SIDES[array], degree
        self.apothem = 0.5
        self.area = self.n * self.apothem**2 * math.tan(math.pi / self.n)
        self.radius = math.sqrt(solid_fraction * self.area / math.pi)
        cuts = np.linspace(-1.0, 1.0, pieces + 1)
        self.elements = [(k, cuts[a : a + 2], layers[b : b + 2])
                         for k in range(self.n) for a in range(pieces) for b in range(len(layers) - 1)]
        nodes, (points, weights) = lobatto(degree), np.polynomial.legendre.leggauss(degree + 3)
        values, slopes = lagrange(nodes, points)
        self.value = np.kron(values, values)
        self.reference_slopes = np.kron(slopes, values), np.kron(values, slopes)
        self.test = np.kron(*2 * (np.polynomial.legendre.legvander(points, degree - 2),))
        self.weight = np.kron(weights, weights)
        self.points = np.repeat(points, len(points)), np.tile(points, len(points))
        local = np.repeat(nodes, len(nodes)), np.tile(nodes, len(nodes))
        self._number([self.place(e, *local)[0] for e in self.elements])
        self._slopes()

    def place(self, element, a, b):
        """Places [n, 2] of local a (around) and b (outwards), and their derivatives by a and by b."""
        k, around, outwards = element
        eta = around[0] + 0.5 * (a + 1.0) * (around[1] - around[0])
        s = (outwards[0] + 0.5 * (b + 1.0) * (outwards[1] - outwards[0]))[:, None]
        half, angle = math.pi / self.n, 2.0 * math.pi * k / self.n
        inner = self.radius * np.stack([np.cos(angle + half * eta), np.sin(angle + half * eta)], axis=1)
        inner_eta = half * np.stack([-inner[:, 1], inner[:, 0]], axis=1)
        normal, along = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        run = self.apothem * math.tan(half)
        outer = self.apothem * normal + run * eta[:, None] * along
        by_eta = ((1.0 - s) * inner_eta + s * run * along) * 0.5 * (around[1] - around[0])
        return (1.0 - s) * inner + s * outer, by_eta, (outer - inner) * 0.5 * (outwards[1] - outwards[0])

    def _number(self, places):
        """One number for places that coincide or lie a lattice vector apart; those on the cylinder are not solved for."""
        x = np.concatenate(places)
        tree, pairs = cKDTree(x), []
        angles = 2.0 * math.pi * np.arange(self.n) / self.n
        for shift in [np.zeros(2), *(np.stack([np.cos(angles), np.sin(angles)], axis=1))]:
            for i, found in enumerate(tree.query_ball_point(x + shift, 1e-8)):
                pairs += [(i, j) for j in found]
        i, j = np.array(pairs).T
        graph = coo_matrix((np.ones(len(i)), (i, j)), shape=(len(x), len(x)))
        count, label = connected_components(graph, directed=False)
        fluid = np.ones(count, bool)
        fluid[label[np.hypot(*x.T) < self.radius + 1e-8]] = False
        number = np.where(fluid, np.cumsum(fluid) - 1, -1)[label]
        self.nodes, self.number = int(fluid.sum()), number.reshape(len(self.elements), -1)

    def _slopes(self):
        """For every element d/dx and d/dy of the node functions at the quadrature points, and weights times area."""
        self.slopes, self.weights = [], []
        for element in self.elements:
            _, by_a, by_b = self.place(element, *self.points)
            jacobian = by_a[:, 0] * by_b[:, 1] - by_a[:, 1] * by_b[:, 0]
            d_a, d_b = self.reference_slopes
            self.slopes.append(((by_b[:, 1:] * d_a - by_a[:, 1:] * d_b) / jacobian[:, None],
                                (by_a[:, :1] * d_b - by_b[:, :1] * d_a) / jacobian[:, None]))
            self.weights.append(self.weight * np.abs(jacobian))

    def solve(self, force, density=1.0, viscosity=1.0, start=None, tolerance=1e-11):
        """Velocities [2, nodes + 1] (the last one is 0, the cylinder's) under a force [2] per volume."""
        u = np.zeros((2, self.nodes + 1)) if start is None else start.copy()
        for _ in range(30):
            step = self._newton(u, np.asarray(force, float), density, viscosity)
            u[:, :-1] += step
            if np.abs(step).max() <= tolerance * np.abs(u).max():
                return u
        raise ArithmeticError("Newton's method does not converge; raise the force in smaller steps")

    def _newton(self, u, force, density, viscosity):
        modes = self.test.shape[1]
        rows, columns, entries = [], [], []
        size = 2 * self.nodes + modes * len(self.elements)
        right = np.zeros(size)
        shift = lambda c, number: np.where(number >= 0, number + c * self.nodes, -1)  # noqa: E731

        def add(row, column, block):
            r, c = np.meshgrid(row, column, indexing="ij")
            keep = (r >= 0) & (c >= 0)
            rows.append(r[keep]), columns.append(c[keep]), entries.append(block[keep])

        for e, number in enumerate(self.number):
            d, w, phi = self.slopes[e], self.weights[e][:, None], self.value
            local = u[:, number]  # -1 is the last: at rest
            at, slope = [phi @ local[c] for c in (0, 1)], [[d[j] @ local[c] for j in (0, 1)] for c in (0, 1)]
            carried = at[0][:, None] * d[0] + at[1][:, None] * d[1]
            same = viscosity * (d[0].T @ (w * d[0]) + d[1].T @ (w * d[1])) + density * phi.T @ (w * carried)
            pressures = 2 * self.nodes + modes * e + np.arange(modes)
            for c in (0, 1):
                row = shift(c, number)
                known = force[c] - density * (at[0] * slope[c][0] + at[1] * slope[c][1])
                load = phi.T @ (w[:, 0] * known) - viscosity * sum(d[j].T @ (w[:, 0] * slope[c][j]) for j in (0, 1))
                np.add.at(right, row[row >= 0], load[row >= 0])
                for j in (0, 1):
                    cross = density * phi.T @ (w * slope[c][j][:, None] * phi)
                    add(row, shift(j, number), same + cross if j == c else cross)
                gradient = -d[c].T @ (w * self.test)
                add(row, pressures, gradient)
                add(pressures, row, gradient.T)
            right[pressures] = self.test.T @ (w[:, 0] * (slope[0][0] + slope[1][1]))
        rows, columns, entries = (np.concatenate(part) for part in (rows, columns, entries))
        pinned = 2 * self.nodes  # the level of the pressure is arbitrary
        entries = np.where((rows == pinned) | (columns == pinned), 0.0, entries)
        matrix = coo_matrix((np.r_[entries, 1.0], (np.r_[rows, pinned], np.r_[columns, pinned])), shape=(size, size))
        right[pinned] = 0.0
        return splu(matrix.tocsc()).solve(right)[: 2 * self.nodes].reshape(2, -1)

    def superficial(self, u):
        """Mean velocity [2] over the cell, the cylinder counted as at rest."""
        total = sum(np.array([self.weights[e] @ (self.value @ u[c, number]) for c in (0, 1)]) for e, number in enumerate(self.number))
        return total / self.area


LONGEST = 4.0  # ratio of two forces that Newton's method bridges
FIRST = 500.0


@lru_cache(maxsize=None)
def permeability(array, solid_fraction, force, angle=0.0, degree=7):
    """mu U/g over the lattice constant squared, for the dimensionless force rho g L^3/mu^2 at an angle to a side's normal, where U
    is the superficial velocity along the force. The Reynolds number of L is permeability times force."""
    cell = Cell(array, solid_fraction, degree)
    direction = np.array([math.cos(angle), math.sin(angle)])
    u = cell.solve(direction, 0.0)  # in units of g L^2/mu, so that the force takes the place of the density
    if force > 0.0:
        steps = max(math.ceil(math.log(force / FIRST) / math.log(LONGEST)), 0)
        for k in range(steps, -1, -1):
            u = cell.solve(direction, force / LONGEST**k, start=u)
    return float(cell.superficial(u) @ direction)
