"""Lid-driven cavity by second-order finite differences and Newton's method: an independent look at published tables.

Stream function and vorticity on a uniform grid of n x n cells of the unit square, lid at y = 1 with u = 1:

    lap psi = -omega,   u = psi_y, v = -psi_x,   u omega_x + v omega_y = lap omega/Re,   psi = 0 on all walls,

wall vorticity -2 (psi_1 + h u_wall)/h^2 from the node beside the wall (Thom 1933), which is second order in the whole. Two grids
give profiles free of the h^2 error (Richardson). The corners' singularities are local: extremes agree with the spectral
solution of Botella & Peyret (1998) to what README.md of the case says.
"""

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import splu


class Grid:
    """Difference operators on the m x m inner nodes, m = n - 1, index x + m y; `lid` is Thom's contribution of the moving lid."""

    def __init__(self, n):
        m, h = n - 1, 1.0 / n
        one = sparse.identity(m, format="csr")
        second = sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(m, m)) / h**2
        first = sparse.diags([-0.5, 0.5], [-1, 1], shape=(m, m)) / h
        self.n, self.m, self.h = n, m, h
        self.laplacian = (sparse.kron(one, second) + sparse.kron(second, one)).tocsr()
        self.dx, self.dy = sparse.kron(one, first).tocsr(), sparse.kron(first, one).tocsr()
        low = sparse.csr_matrix(([1.0], ([0], [0])), shape=(m, m))
        high = sparse.csr_matrix(([1.0], ([m - 1], [m - 1])), shape=(m, m))
        wall = -2.0 / h**2  # omega_wall = wall psi_1 (and - 2/h on the lid)
        left, right = sparse.kron(one, low) * wall, sparse.kron(one, high) * wall
        below, above = sparse.kron(low, one) * wall, sparse.kron(high, one) * wall
        # what the walls' vorticity adds to lap omega, omega_x, omega_y at the nodes beside them, as operators on psi:
        self.wall_laplacian = ((left + right + below + above) / h**2).tocsr()
        self.wall_dx = ((right - left) / (2.0 * h)).tocsr()
        self.wall_dy = ((above - below) / (2.0 * h)).tocsr()
        top = np.zeros((m, m))
        top[-1] = 1.0
        self.top = top.ravel()
        self.lid = -2.0 / h  # vorticity of the lid from its own speed


def _residual(grid, psi, omega, re):
    u, v = grid.dy @ psi, -(grid.dx @ psi)
    omega_x = grid.dx @ omega + grid.wall_dx @ psi
    omega_y = grid.dy @ omega + grid.wall_dy @ psi + grid.top * grid.lid / (2.0 * grid.h)
    diffusion = grid.laplacian @ omega + grid.wall_laplacian @ psi + grid.top * grid.lid / grid.h**2
    return grid.laplacian @ psi + omega, u * omega_x + v * omega_y - diffusion / re, (u, v, omega_x, omega_y)


def solve(n, re, start=None, tolerance=1e-10):
    """(psi, omega) at the inner nodes [m*m] of an n x n grid; `start`: those of another Reynolds number."""
    grid = Grid(n)
    psi, omega = (np.zeros(grid.m**2), np.zeros(grid.m**2)) if start is None else start
    one = sparse.identity(grid.m**2, format="csr")
    for _ in range(20):
        first, second, (u, v, omega_x, omega_y) = _residual(grid, psi, omega, re)
        diagonal = lambda values: sparse.diags(values)  # noqa: E731
        by_psi = (diagonal(omega_x) @ grid.dy - diagonal(omega_y) @ grid.dx + diagonal(u) @ grid.wall_dx
                  + diagonal(v) @ grid.wall_dy - grid.wall_laplacian / re)
        by_omega = diagonal(u) @ grid.dx + diagonal(v) @ grid.dy - grid.laplacian / re
        # omega = -lap psi + correction is eliminated: one unknown per node
        matrix = (by_psi - by_omega @ grid.laplacian).tocsc()
        step = splu(matrix).solve(by_omega @ first - second)
        omega = omega - first - grid.laplacian @ step
        psi = psi + step
        if np.abs(step).max() < tolerance:
            return psi, omega
    raise ArithmeticError(f"no convergence at Re {re}")


def profiles(n, psi):
    """(s, u on x = 1/2, v on y = 1/2) at all nodes of the lines, walls included; n even."""
    grid = Grid(n)
    middle = grid.m // 2
    u = (grid.dy @ psi).reshape(grid.m, grid.m)[:, middle]
    v = -(grid.dx @ psi).reshape(grid.m, grid.m)[middle]
    s = np.linspace(0.0, 1.0, n + 1)
    return s, np.concatenate([[0.0], u, [1.0]]), np.concatenate([[0.0], v, [0.0]])
