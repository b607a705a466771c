"""Layers of grains, displaced in a wave, that fall through a gas: the two-fluid equations of the coupled scheme about a falling base.

As released_layers, for grains that do not follow the fluid. There is neither a state of rest nor a terminal one, so the base is
integrated first, and the waves are linearised about it as it is at each time. Notation and what is left out as there, and the share
rho V du/dt of the pressure gradient in a grain's acceleration (rho/rho_p of its inertia) besides.

Base. V_m upwards, w_m = <u0>_m - V_m the slip, u0 = sum_j V/a^2 w_j W(z - z_j) from zero net flux, so (1 - P) w = -V with P_mj =
V/a^2 of the kernels spread and gathered over z_m - z_j;

    m_p dV_m/dt = -W_e + R(w_m, <eps>_m),      R = 3 pi mu d w F(eps, rho d eps w/mu)                                     (1)

(drag f_d to the part eps, the rest from the pressure gradient, which all grains together raise: f_d/eps in all).

Waves. The slip of grain m changes by s_m = U_m - v_m, the fluid's velocity where the grain is less the grain's, and with it the drag:

    m_p dvz/dt = R_w sz + R_eps d<eps>,        m_p dvx/dt = (R/w) sx                                                      (2)
    U_m = Gc + Z_m D<u0> z^ - <(I - P) q>_m,   q = sum_j V/a^2 {z^ [w_j (Z_j D + k X_j) - sz_j] - x^ sx_j} W               (3)

linear in s on both sides. Fluid is pushed by the drag of the moment: in released_layers' (1) R_m(t) stands for W_e.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import linalg
from scipy.integrate import solve_ivp

from drag_laws.drag_laws import di_felice

from . import layered_rayleigh_taylor as layered
from . import released_layers as released
from .settling import GRAIN

V, D = released.V, GRAIN["d"]
MASS = GRAIN["rho_p"] * V


class Base(NamedTuple):
    """Of every layer: height, velocity upwards, slip, <eps>, drag and its derivatives in w and eps, R/w, D<eps>, D<u0>."""

    z: np.ndarray
    velocity: np.ndarray
    slip: np.ndarray
    eps: np.ndarray
    drag: np.ndarray
    drag_by_slip: np.ndarray
    drag_by_eps: np.ndarray
    drag_across: np.ndarray
    eps_slope: np.ndarray
    flow_slope: np.ndarray


def drag(s, w, eps):
    """R of (1), N; odd in w."""
    speed = np.maximum(np.abs(w), 1e-9)
    return 3.0 * math.pi * s.mu * D * w * di_felice(eps, s.rho * D * eps * speed / s.mu)


def base(s, z, velocity):
    per_area = V / s.lattice.spacing**2
    around = released.gathered(np.subtract.outer(z, z), s.h, s.h_c, 0.0)
    eps = 1.0 - per_area * around.plain.sum(axis=1)
    w = np.linalg.solve(np.eye(len(z)) - per_area * around.plain, -velocity)
    tiny = 1e-4
    step = tiny * np.maximum(np.abs(w), 1e-6)
    return Base(z, velocity, w, eps, drag(s, w, eps), (drag(s, w + step, eps) - drag(s, w - step, eps)) / (2.0 * step),
                (drag(s, w, eps + tiny) - drag(s, w, eps - tiny)) / (2.0 * tiny), drag(s, w + 1e-9, eps) / (w + 1e-9),
                -per_area * around.slope.sum(axis=1), per_area * around.slope @ w)


@lru_cache(maxsize=16)
def fall(s, end):
    """The base from rest to `end` s: a function of t that gives (z, V)."""
    start = s.lattice.heights
    n = len(start)

    def rate(_, y):
        now = base(s, y[:n], y[n:])
        return np.concatenate([y[n:], (now.drag - s.excess) / MASS])

    found = solve_ivp(rate, (0.0, end), np.concatenate([start, np.zeros(n)]), rtol=1e-8, atol=1e-10, dense_output=True)
    return lambda t: np.split(found.sol(t), 2)


def slip_change(s, now, k, gather, gather_d):
    """Matrices with s = (sz, sx) = sum of them times c, Z, X, vz, vx: equation (3) solved for s."""
    per_area, n = V / s.lattice.spacing**2, len(now.z)
    g = released.gathered(np.subtract.outer(now.z, now.z), s.h, s.h_c, k)
    own = np.eye(2 * n) - per_area * np.block([[g.upright, g.sideways], [-g.sideways, g.plain - g.upright]])
    zero = np.zeros((n, n))
    by_z = np.vstack([np.diag(now.flow_slope) - per_area * g.upright_slope * now.slip, per_area * g.sideways_slope * now.slip])
    by_x = np.vstack([-per_area * k * g.upright * now.slip, per_area * k * g.sideways * now.slip])
    flow = np.vstack([gather, -gather_d / k])
    right = [flow, by_z, by_x, np.vstack([-np.eye(n), zero]), np.vstack([zero, -np.eye(n)])]
    return [np.linalg.solve(own, one) for one in right]


def matrices(s, k, now):
    """E, B of E dy/dt = B y; y = [c, Z, X, vz, vx]."""
    x, z, n = released._space(s), now.z, len(now.z)
    area = s.lattice.spacing**2
    (spread, spread_d), (gather, gather_d) = (released.through(s, x, z, width, k) for width in (s.h_c, s.h))
    heavy = (1.0 - released.spread_fraction(s, x, z)) * s.rho
    size = x.value.shape[1]
    ends = np.cumsum([size, n, n, n, n])
    parts = [slice(end - length, end) for end, length in zip(ends, [size, n, n, n, n])]
    c, disp_z, disp_x, vz, vx = parts
    e, b = np.eye(ends[-1]), np.zeros((ends[-1],) * 2)

    e[c, c] = layered.inertia_form(x, heavy, k)
    e[c, vz], e[c, vx] = MASS / area * spread.T, -MASS / area / k * spread_d.T
    b[c, c] = -released.friction(s, k, z) - released._advection(s, x, heavy, now, z, k)
    b[c, disp_z], b[c, disp_x] = -spread_d.T * now.drag / area, k * spread.T * now.drag / area
    b[disp_z, vz] = b[disp_x, vx] = np.eye(n)

    phi = -V / area * released.gathered(np.subtract.outer(z, z), s.h, s.h_c, k).slope, \
        -V / area * k * released.gathered(np.subtract.outer(z, z), s.h, s.h_c, k).plain
    for part, change in zip(parts, slip_change(s, now, k, gather, gather_d)):
        b[vz, part] = now.drag_by_slip[:, None] / MASS * change[:n]
        b[vx, part] = now.drag_across[:, None] / MASS * change[n:]
    b[vz, disp_z] += now.drag_by_eps[:, None] / MASS * (np.diag(now.eps_slope) - phi[0])
    b[vz, disp_x] -= now.drag_by_eps[:, None] / MASS * phi[1]
    return e, b


@lru_cache(maxsize=32)
def history(s, k, times, most=5e-4):
    """released_layers.History from rest, all layers displaced by 1 upwards; the base of the middle of every step."""
    path, n = fall(s, times[-1]), s.lattice.layers
    size = released._space(s).value.shape[1]
    y = np.zeros(size + 4 * n)
    y[size : size + n] = 1.0
    heights, rises, t = [s.lattice.heights], [np.ones(n)], 0.0
    for end in times[1:]:
        parts = math.ceil((end - t) / most - 1e-9)
        dt = (end - t) / parts
        for part in range(parts):
            e, b = matrices(s, k, base(s, *path(t + (part + 0.5) * dt)))
            y = linalg.expm(dt * np.linalg.solve(e, b)) @ y
        t = end
        heights.append(path(t)[0])
        rises.append(y[size : size + n])
    return released.History(np.array(times), np.array(heights), np.array(rises))
