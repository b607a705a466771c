"""Layers of grains, displaced in a wave and released in fluid at rest: linear theory of the coupled scheme, from the start on.

The limit of many fluid particles per kernel. Layers m at heights z_m carry 1/a^2 grains per area; everything varies as
cos k.x (vertical) or along its gradient, sin (horizontal), so a wave of two directions obeys the same equations with its |k|.

Base state. A grain sees <eps>, gathered by W(h) from the porosity spread by W(h_c), and falls through the fluid at w(<eps>), the
interstitial slip of a suspension of that porosity (its weight less buoyancy is borne to the part eps by drag, the rest by the
pressure gradient). No net flux: the fluid rises with u0 = sum_j V/a^2 w_j W(z - z_j), and layers fall at w_m - <u0>_m. They fall
at different speeds, so the edges blur as time goes on; `frozen` keeps the layers and the fluid where they are.

Waves. Grains are displaced by Z_m, X_m and have velocities v_m, fluid the solenoidal velocity (-Dc/k, c)(z), c in the splines of
layered_rayleigh_taylor. For every test function e(z), with S and G the spreading and the gathering kernel at wave number k,

    Int (1 - phi) rho [dc/dt e + D(dc/dt) De/k^2] + (viscous) = -1/a^2 sum_m { W_e [Z_m S(De) - k X_m Se] + m_p [dvz_m/dt Se - dvx_m/dt S(De)/k] }   (1)
    m_p dv_m/dt = (m_p/tau)(u_m - v_m) + rho V d(Gc)_m/dt,     dZ/dt = vz,  dX/dt = vx                                             (2)

(fluid pushed by the effective weight W_e = (rho_p - rho) V g at the displaced places, less what grains take to accelerate), and
u_m, the velocity at which the grain would move without inertia, is Gc and what settling adds:

    dw_m = w'(eps) d<eps>_m,   d<eps>_m = Z_m D<eps> - change of phi gathered,   change of phi = -V/a^2 sum_j (Z_j D + k X_j) W(z - z_j; k)
    u_m = Gc - dw_m z^ + Z_m D<u0> z^ - <(I - P) q>_m,                           q = z^ sum of the change of slip flux, -w phi               (3)

(I - P) is the projection on gradients: fluid makes room for the flux of grains by a potential flow; its solenoidal part is friction's
affair and in c. Base flow advects c. The viscous form is Morris' operator (layer_friction), or the exact one; with a suspension
viscosity mu varies with the layers' own porosity at the time (drag stays that of the pure fluid). Left out: the base's own start, second order in the waves, the change of S and G
while a layer falls but for its place, and the elasticity that particles on a lattice have under pressure (lattice_elasticity).
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import linalg
from scipy.interpolate import CubicSpline

from . import layer_friction
from . import layered_rayleigh_taylor as layered
from . import sedimentation_scene as scene
from .plane_kernel import KERNEL, plane_average, plane_share, wave_average
from .rayleigh_taylor import hindered_relaxation_time, settling_slip
from .settling import GRAIN, GRAVITY
from .sph_operators import transform

V = scene.GRAIN_VOLUME


class Setting(NamedTuple):
    """What the theory needs; `settles`: grains fall relative to the fluid; `frozen`: but the base does not move."""

    rho: float
    mu: float
    h: float  # m: of gathering
    h_c: float  # m: of spreading and of the porosity
    h_fluid: float  # m: of the fluid's own kernel
    height: float = scene.DEPTH
    settles: bool = True
    frozen: bool = False
    morris: bool = True
    kernel: str = KERNEL  # of the fluid; the coupling's is Wendland's C2
    block: tuple = scene.BLOCK
    floor: str = "no_slip"
    viscosity: str = "pure_fluid"  # of fluid among grains: layered.Closure

    @property
    def fluid(self):
        return {"rho": self.rho, "mu": self.mu}

    @property
    def lattice(self):
        return scene.lattice(0.8, self.block)

    @property
    def excess(self):
        """Weight less buoyancy of a grain, N."""
        return (GRAIN["rho_p"] - self.rho) * V * GRAVITY


# --- kernels along z ---


@lru_cache(maxsize=64)
def _wave_table(h, k):
    z = np.linspace(0.0, 2.0 * h, 241)
    return CubicSpline(z, wave_average(z, h, k))


def _wave(z, h, k):
    """wave_average from a table."""
    z = np.abs(z)
    return np.where(z < 2.0 * h, _wave_table(h, k)(np.minimum(z, 2.0 * h)), 0.0)


class Gathered(NamedTuple):
    """Sums over q for layers that are `gap` apart: spread, gathered (and projected on gradients) at wave number k."""

    plain: np.ndarray  # s^ g^
    slope: np.ndarray  # its D
    upright: np.ndarray  # (I - P)_zz s^ g^
    upright_slope: np.ndarray
    sideways: np.ndarray  # (I - P)_xz s^ g^, of the sine
    sideways_slope: np.ndarray


@lru_cache(maxsize=64)
def _wave_vectors(h, h_c, k, points=1500):
    q = (np.arange(points) + 0.5) * 40.0 / h / points
    square = q**2 + k**2
    both = transform(KERNEL, 3, np.sqrt(square) * h) * transform(KERNEL, 3, np.sqrt(square) * h_c) * (40.0 / h / points) / math.pi
    return q, square, both


def gathered(gap, h, h_c, k):
    q, square, both = _wave_vectors(h, h_c, k)
    cosine, sine = np.cos(np.multiply.outer(gap, q)), np.sin(np.multiply.outer(gap, q))
    return Gathered(cosine @ both, -sine @ (q * both), cosine @ (both * q**2 / square), -sine @ (both * q**3 / square),
                    sine @ (both * k * q / square), cosine @ (both * k * q**2 / square))


# --- base state ---


@lru_cache(maxsize=None)
def _slips(rho, mu):
    """Interstitial slip over eps as a spline, m/s."""
    eps = np.linspace(0.6, 1.0, 41)
    return CubicSpline(eps, [settling_slip({"rho": rho, "mu": mu}, e) / e for e in eps])


class Base(NamedTuple):
    """Of every layer: slip and its slope in eps, D<eps>, velocity upwards, D<u0>."""

    slip: np.ndarray
    slip_slope: np.ndarray
    eps_slope: np.ndarray
    velocity: np.ndarray
    flow_slope: np.ndarray


def base(s, z):
    """Of layers at heights z, m."""
    per_area = V / s.lattice.spacing**2
    if not s.settles:
        return Base(*(np.zeros_like(z) for _ in Base._fields))
    around = gathered(np.subtract.outer(z, z), s.h, s.h_c, 0.0)
    eps = 1.0 - per_area * around.plain.sum(axis=1)
    slip = _slips(s.rho, s.mu)
    w = slip(eps)
    return Base(w, slip(eps, 1), -per_area * around.slope.sum(axis=1), per_area * around.plain @ w - w, per_area * around.slope @ w)


# --- waves ---


def _space(s):
    block = s.lattice
    return layered._space(layered.Depth(s.height, s.floor, s.floor), (block.bottom, block.top), s.h_c)


def friction(s, k, z):
    """The viscous form of (1) with layers at heights z, whose porosity sets the viscosity."""
    x = _space(s)
    if s.viscosity == "pure_fluid":
        return _uniform_friction(s, k)
    excess = layered.Closure(s.viscosity).mu(s.fluid, spread_fraction(s, x, z)) / s.mu - 1.0
    if not s.morris:
        return layered.viscous_form(x, s.mu * (1.0 + excess), k)
    return _uniform_friction(s, k) + layer_friction.form(x, s.mu * excess, k, _operator(s))


@lru_cache(maxsize=32)
def _uniform_friction(s, k):
    x = _space(s)
    mu = np.full_like(x.z, s.mu)
    return layer_friction.form(x, mu, k, _operator(s)) if s.morris else layered.viscous_form(x, mu, k)


def _operator(s):
    return layer_friction.Operator(s.kernel, s.h_fluid, s.height, s.floor)


def spread_fraction(s, x, z):
    """phi at the points of x of layers at heights z, as the fluid's particles know it."""
    return V / s.lattice.spacing**2 * plane_average(x.z[:, None] - z, s.h_c).sum(axis=1)


def through(s, x, z, width, k):
    """c and Dc of the splines x at heights z, seen through a kernel of that width: [layers, splines] each."""
    weights = _wave(z[:, None] - x.z, width, k) * x.weight
    inside = plane_share(s.height - z, width) - plane_share(-z, width)
    return (weights @ x.value) / inside[:, None], (weights @ x.first) / inside[:, None]


def matrices(s, k, z):
    """E, B of E dy/dt = B y for layers at heights z; y = [c, Z, X, vz, vx]."""
    x, n = _space(s), len(z)
    area = s.lattice.spacing**2

    (spread, spread_d), (gather, gather_d) = (through(s, x, z, width, k) for width in (s.h_c, s.h))
    now = base(s, z)
    heavy = (1.0 - spread_fraction(s, x, z)) * s.rho
    m_p, tau = GRAIN["rho_p"] * V, hindered_relaxation_time(s.fluid, 0.8, settling_slip(s.fluid, 0.8))
    size = x.value.shape[1]
    lengths = [size, n, n, n, n]
    ends = np.cumsum(lengths)
    c, disp_z, disp_x, vz, vx = (slice(end - length, end) for end, length in zip(ends, lengths))
    e, b = np.zeros((ends[-1],) * 2), np.zeros((ends[-1],) * 2)

    e[c, c] = layered.inertia_form(x, heavy, k)
    e[c, vz], e[c, vx] = m_p / area * spread.T, -m_p / area / k * spread_d.T
    b[c, c] = -friction(s, k, z) - _advection(s, x, heavy, now, z, k)
    b[c, disp_z], b[c, disp_x] = -s.excess / area * spread_d.T, s.excess * k / area * spread.T

    b[disp_z, vz] = b[disp_x, vx] = np.eye(n)
    e[disp_z, disp_z] = e[disp_x, disp_x] = np.eye(n)

    displaced = _velocity_by_settling(s, now, z, k)
    e[vz, vz] = e[vx, vx] = tau * np.eye(n)
    share = s.rho / GRAIN["rho_p"] * tau
    e[vz, c], e[vx, c] = -share * gather, share / k * gather_d
    b[vz, c], b[vx, c] = gather, -gather_d / k
    b[vz, vz] = b[vx, vx] = -np.eye(n)
    for row, parts in zip((vz, vx), displaced):
        b[row, disp_z], b[row, disp_x] = parts
    return e, b


def _advection(s, x, heavy, now, z, k):
    """Int rho (1 - phi)[(u0 Dc + c Du0) e + u0 D2c De/k^2]."""
    if not s.settles:
        return 0.0
    apart = x.z[:, None] - z
    flow = V / s.lattice.spacing**2 * plane_average(apart, s.h_c) @ now.slip
    tiny = 1e-3 * s.h_c
    slope = V / s.lattice.spacing**2 * (plane_average(apart + tiny, s.h_c) - plane_average(apart - tiny, s.h_c)) @ now.slip / (2 * tiny)
    return (x.gram(heavy * flow, x.value, x.first) + x.gram(heavy * slope, x.value, x.value)
            + x.gram(heavy * flow, x.first, x.second) / k**2).toarray()


def _velocity_by_settling(s, now, z, k):
    """((of Z, of X) for the vertical velocity, the same for the horizontal one): the parts of (3) that are not Gc."""
    per_area = V / s.lattice.spacing**2
    g = gathered(np.subtract.outer(z, z), s.h, s.h_c, k)
    # change of phi gathered at the layers, by Z and by X
    phi_z, phi_x = -per_area * g.slope, -per_area * k * g.plain
    slip_z = now.slip_slope[:, None] * (np.diag(now.eps_slope) - phi_z)
    slip_x = now.slip_slope[:, None] * -phi_x
    # q = sum_j V/a^2 [w_j (Z_j D + k X_j) - dw_j] W
    up = per_area * (g.upright_slope * now.slip - g.upright @ slip_z), per_area * (k * g.upright * now.slip - g.upright @ slip_x)
    side = per_area * (g.sideways_slope * now.slip - g.sideways @ slip_z), per_area * (k * g.sideways * now.slip - g.sideways @ slip_x)
    vertical = np.diag(now.flow_slope) - slip_z - up[0], -slip_x - up[1]
    return vertical, side


def growth_rate(s, k):
    """Largest growth rate of the frozen base, 1/s."""
    e, b = matrices(s, k, s.lattice.heights)
    return float(linalg.eigvals(np.linalg.solve(e, b)).real.max())


class History(NamedTuple):
    """Over t: heights of the layers [nt, n], and their vertical displacement [nt, n] for a unit displacement at the start."""

    t: np.ndarray
    z: np.ndarray
    rise: np.ndarray


@lru_cache(maxsize=64)
def history(s, k, times, most=1.0e-3):
    """From rest, all layers displaced by 1 upwards. The base moves on by `most` s at a time (midpoint rule)."""
    z, n = s.lattice.heights, s.lattice.layers
    e, b = matrices(s, k, z)
    size = _space(s).value.shape[1]
    y = np.zeros(len(e))
    y[size : size + n] = 1.0
    heights, rises, t, still = [z], [np.ones(n)], 0.0, {}
    for end in times[1:]:
        parts = math.ceil((end - t) / most - 1e-9)
        dt = (end - t) / parts
        for _ in range(parts):
            if s.frozen or not s.settles:
                if dt not in still:
                    still[dt] = linalg.expm(dt * np.linalg.solve(e, b))
                y = still[dt] @ y
                continue
            middle = z + 0.5 * dt * base(s, z).velocity
            e, b = matrices(s, k, middle)
            y = linalg.expm(dt * np.linalg.solve(e, b)) @ y
            z = z + dt * base(s, middle).velocity
        t = end
        heights.append(z)
        rises.append(y[size : size + n])
    return History(np.array(times), np.array(heights), np.array(rises))
