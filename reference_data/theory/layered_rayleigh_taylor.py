"""Growth of a wave on a layer of grains in fluid of finite depth, with the layer's edges smoothed by the coupling kernel.

Waves w(z) exp(i k x + n t) on a fluid at rest with rho(z), mu(z) (Chandrasekhar 1961, sections 91 to 93, no surface tension,
no Boussinesq approximation): u = i Dw/k from continuity, n drho = -w Drho, and momentum times the conjugate velocity,
integrated over the depth, is for every test function v(z)

    n^2 Int rho (w v + Dw Dv/k^2) + n Int mu [4 Dw Dv + (D2w + k^2 w)(D2v + k^2 v)/k^2] - g Int Drho w v = 0            (1)

Floor or lid: "no_slip" w = Dw = 0; "free_slip" w = 0, and the form then makes the stress vanish; "free_surface": nothing is
imposed, and the surface is a jump of -rho in (1). Galerkin's method with quintic splines turns (1) into symmetric matrices
F(n) x = 0, and F(n) is positive definite exactly where n exceeds the largest growth rate: there is then no x with x.F(n)x = 0,
and n is bracketed by whether Cholesky's factorisation exists. This cannot miss the largest root.

Grains at volume fraction phi(z): rho = (1 - phi) rho_f + phi rho_p f and Drho -> f (rho_p - rho_f) Dphi with f(n) of
rayleigh_taylor.following (f = 1 for grains that follow the fluid). phi(z) is the layer smoothed by the plane kernel of width
h_c. Two forms:

once       phi smoothed once, and its grains move with the fluid at their place: (1) as it stands.
gathered   what a coupled scheme does in the limit of many particles: grains stay a sharp layer and move with the velocity
           gathered by W(h), forces return by W(h_c). With G and S the kernels at wave number k (plane_kernel.wave_average),
           the grains' terms of (1) are phi rho_p f Int_layer [Sv Gw + S(Dv) G(Dw)/k^2] and -g f (rho_p - rho_f) phi [Sv Gw] at
           the bottom less that at the top; the fluid keeps (1 - phi) rho_f. Taken symmetric in G and S (their widths differ by
           eps^(-1/3), 8 % at 0.8). The viscous term is the fluid's own in both.

"once" lets the smoothed layer be carried by the fluid point by point; it leaves out that grains are spread and gathered along
x as well. One edge between deep fluids of equal viscosity and (Boussinesq) density shows the whole effect: the edge's force
g phi (rho_p - rho_f) xi delta(z) is spread, answered by every wave vector (k, q) of the fluid and gathered,

    n = g phi (rho_p - rho_f) Int dq/(2 pi) s^(K) g^(K) k^2/K^2 / (rho n + mu K^2 lambda(K)),    K^2 = k^2 + q^2          (2)

with s^, g^ the kernels' transforms and lambda = 1, or the symbol of Morris' operator over nu K^2 (sph_operators). With point
kernels and rho = 0 it is Chandrasekhar's g phi (rho_p - rho_f)/(4 k mu).
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy import linalg, sparse
from scipy.interpolate import BSpline
from scipy.optimize import brentq

from . import sedimentation_scene as scene
from .plane_kernel import KERNEL, plane_average, plane_share, wave_average
from .rayleigh_taylor import EPS, following, hindered_relaxation_time, settling_slip, suspension_viscosity
from .rayleigh_taylor import growth_rate as sharp_growth_rate
from .settling import FLUIDS, GRAIN, GRAVITY
from .sph_operators import transform, viscosity_ratio

DEGREE = 5
DROPPED = {"no_slip": 2, "free_slip": 1, "free_surface": 0}  # splines that a condition removes at its end
SHARP = 1.0e-5  # m: a layer smoothed by a tenth of a grain, for rates at a sharp edge
ACROSS = (10, 12, 15, 20, 30, 40)  # fluid particles in 4 mm: h/d = 6, 5, 4, 3, 2, 1.5


class Layer(NamedTuple):
    """Grains of volume fraction phi between two heights, m."""

    bottom: float
    top: float
    phi: float

    def fraction(self, z, width):
        return self.phi * (plane_share(z - self.bottom, width) - plane_share(z - self.top, width))

    def slope(self, z, width):
        return self.phi * (plane_average(z - self.bottom, width) - plane_average(z - self.top, width))


class Closure(NamedTuple):
    """Which viscosity the suspension has ("pure_fluid" or "krieger_dougherty") and how grains follow (tau in s, rho/rho_p)."""

    viscosity: str = "pure_fluid"
    tau: float = 0.0
    density_ratio: float = 0.0

    def mu(self, fluid, phi):
        if self.viscosity not in ("pure_fluid", "krieger_dougherty"):
            raise ValueError(f"viscosity = '{self.viscosity}': expected pure_fluid or krieger_dougherty")
        return suspension_viscosity(fluid["mu"], 1.0 - phi) if self.viscosity == "krieger_dougherty" else fluid["mu"] + 0.0 * phi


class Depth(NamedTuple):
    """Fluid from 0 to height, m, and the conditions at its ends."""

    height: float = scene.DEPTH
    floor: str = "no_slip"
    lid: str = "free_surface"


class Space(NamedTuple):
    """Quadrature points, weights and the splines' values there: sparse [points, splines]; `surface`, values at the top."""

    z: np.ndarray
    weight: np.ndarray
    value: sparse.csr_matrix
    first: sparse.csr_matrix
    second: sparse.csr_matrix
    surface: np.ndarray

    def gram(self, density, left, right):
        return left.T @ sparse.diags(self.weight * density) @ right


def knots(height, edges, width, coarse=1.0 / 48.0, fine=1.0 / 4.0):
    """Break points from 0 to height: height/48 apart, width/4 within 2 widths of an edge, doubling outwards from there."""
    places, z = [0.0], 0.0
    while z < height * (1.0 - 1e-12):
        gap = min(max(abs(z - edge) - 2.0 * width, 0.0) for edge in edges)
        z = min(z + min(coarse * height, fine * width + 0.25 * gap), height)
        places.append(z)
    return np.array(sorted(set(places) | {edge for edge in edges if 0.0 < edge < height}))


def space(breaks, floor, lid):
    """Quintic splines over the break points with the conditions at both ends; Gauss' rule with 6 points between breaks."""
    t = np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])
    count = len(t) - DEGREE - 1
    node, weight = np.polynomial.legendre.leggauss(6)
    half = 0.5 * np.diff(breaks)
    z = (0.5 * (breaks[1:] + breaks[:-1])[:, None] + half[:, None] * node).ravel()
    keep = slice(DROPPED[floor], count - DROPPED[lid])
    spline = BSpline(t, np.eye(count), DEGREE)
    values = [sparse.csr_matrix(spline(z, m)[:, keep]) for m in (0, 1, 2)]
    surface = np.eye(count)[-1][keep]  # the last spline is 1 at the top, all others 0
    return Space(z, np.outer(half, weight).ravel(), *values, surface)


@lru_cache(maxsize=64)
def _space(depth, edges, width):
    return space(knots(depth.height, edges, width), depth.floor, depth.lid)


class Form(NamedTuple):
    """Matrices of (1): n^2 (fluid + f grains) + n viscous - g f pull + g surface, dense and symmetric."""

    fluid: np.ndarray
    grains: np.ndarray
    viscous: np.ndarray
    pull: np.ndarray
    surface: np.ndarray

    def at(self, n, f, g):
        return n**2 * (self.fluid + f * self.grains) + n * self.viscous - g * f * self.pull + g * self.surface


def inertia_form(s, density, k):
    return (s.gram(density, s.value, s.value) + s.gram(density, s.first, s.first) / k**2).toarray()


def viscous_form(s, mu, k):
    shear = s.second + k**2 * s.value
    return (4.0 * s.gram(mu, s.first, s.first) + s.gram(mu, shear, shear) / k**2).toarray()


def gathered_terms(s, layer, k, h, h_c, points=32):
    """(inertia, pull) of a sharp layer of unit density and unit density difference, seen through the kernels G and S."""
    node, weight = np.polynomial.legendre.leggauss(points)
    half = 0.5 * (layer.top - layer.bottom)
    places = layer.bottom + half * (node + 1.0)

    def through(z, width, field):
        return (wave_average(np.asarray(z)[:, None] - s.z, width, k) * s.weight) @ field

    inertia = sum(scale * through(places, h_c, field).T @ ((layer.phi * half * weight)[:, None] * through(places, h, field))
                  for field, scale in ((s.value, 1.0), (s.first, 1.0 / k**2)))
    ends = np.array([layer.bottom, layer.top])
    pull = through(ends, h_c, s.value).T @ (layer.phi * np.array([[1.0], [-1.0]]) * through(ends, h, s.value))
    return 0.5 * (inertia + inertia.T), 0.5 * (pull + pull.T)


@lru_cache(maxsize=32)
def _gathered(depth, layer, k, h, h_c):
    return gathered_terms(_space(depth, (layer.bottom, layer.top), h_c), layer, k, h, h_c)


def form(k, fluid, layer, h_c, closure, depth, h=None):
    """Matrices for a layer smoothed by h_c; with h, the form "gathered", without it "once"."""
    s = _space(depth, (layer.bottom, layer.top), h_c)
    phi, rho = layer.fraction(s.z, h_c), fluid["rho"]
    if h is None:
        grains, pull = inertia_form(s, phi, k), s.gram(layer.slope(s.z, h_c), s.value, s.value).toarray()
        pull -= layer.fraction(depth.height, h_c) * np.outer(s.surface, s.surface)  # grains that end at a free surface
    else:
        grains, pull = _gathered(depth, layer, k, h, h_c)
    return Form(
        inertia_form(s, (1.0 - phi) * rho, k),
        GRAIN["rho_p"] * grains,
        viscous_form(s, closure.mu(fluid, phi), k),
        (GRAIN["rho_p"] - rho) * pull,
        rho * np.outer(s.surface, s.surface),
    )


def _positive_definite(matrix):
    try:
        linalg.cholesky(matrix, lower=True, check_finite=False)
    except linalg.LinAlgError:
        return False
    return True


def largest_rate(matrix, high, digits=1e-10):
    """The n at which matrix(n) ceases to be positive definite; it is so at `high` and above."""
    if not _positive_definite(matrix(high)):
        raise ValueError(f"a growth rate above {high}: the upper bound is too low")
    low = high
    while _positive_definite(matrix(low)):
        high, low = low, 0.7 * low
        if low < 1e-6 * high or low < 1e-12:
            raise ValueError("nothing grows")
    while high - low > digits * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _positive_definite(matrix(middle)) else (middle, high)
    return 0.5 * (low + high)


def growth_rate(k, fluid, layer, h_c, closure=Closure(), depth=Depth(), h=None, g=GRAVITY):
    """Largest growth rate, 1/s, of wave number k on `layer` smoothed by h_c; with h, grains gather by W(h)."""
    matrices = form(k, fluid, layer, h_c, closure, depth, h)
    # No rate exceeds sqrt(g max(Drho/rho)) nor, by continuity, that of an edge without viscosity or inertia of the grains.
    high = 1.05 * math.sqrt(g * k * layer.phi * (GRAIN["rho_p"] - fluid["rho"]) / fluid["rho"] / (1.0 - layer.phi))
    return largest_rate(lambda n: matrices.at(n, following(n, closure.tau, closure.density_ratio), g), high)


def edge_growth_rate(k, fluid, phi, h_c, h, viscous_symbol=False, g=GRAVITY):
    """Root n of (2), 1/s, with rho the mean of clear fluid and suspension; h_c, h widths of spreading and gathering."""
    node, weight = np.polynomial.legendre.leggauss(400)
    angle = 0.25 * math.pi * (node + 1.0)  # q = k tan(angle)
    q = k * np.tan(angle)
    total = np.hypot(k, q)
    # beyond K h = 45 the transforms are below 1e-5, their product below 1e-10
    inside = total * max(h_c, h) < 45.0
    q, total, weight = q[inside], total[inside], (0.25 * math.pi * weight * k / np.cos(angle) ** 2)[inside]
    kernels = transform(KERNEL, 3, total * h_c) * transform(KERNEL, 3, total * h)
    friction = fluid["mu"] * total**2 * (viscosity_ratio(KERNEL, 3, total * h) if viscous_symbol else 1.0)
    excess = phi * (GRAIN["rho_p"] - fluid["rho"])
    rho = fluid["rho"] + 0.5 * excess

    def residual(n):
        return n - g * excess / math.pi * float(weight @ (kernels * k**2 / total**2 / (rho * n + friction)))

    return brentq(residual, 0.0, 2.0 * math.sqrt(g * k * excess / rho), xtol=1e-12, rtol=1e-12)


def scene_layer(nominal=EPS, block=scene.BLOCK):
    """The slides' layer as the lattice fills it: its own porosity and thickness."""
    filled = scene.lattice(nominal, block)
    return Layer(filled.bottom, filled.top, 1.0 - filled.eps)


def rows():
    """(fluid, mu_2 closure, k, across, h; rates: sharp and deep, sharp layer, once, gathered, the last two without and with inertia)."""
    layer, result = scene_layer(), []
    for name, fluid in FLUIDS.items():
        tau = hindered_relaxation_time(fluid, EPS, settling_slip(fluid, EPS))
        for viscosity in ("krieger_dougherty", "pure_fluid"):
            following_all = Closure(viscosity)
            inertial = Closure(viscosity, tau, fluid["rho"] / GRAIN["rho_p"])
            rho_2 = (1.0 - layer.phi) * fluid["rho"] + layer.phi * GRAIN["rho_p"]
            mu_2 = float(following_all.mu(fluid, layer.phi))
            for k in scene.wave_numbers():
                deep = sharp_growth_rate(k, (fluid["rho"], fluid["mu"]), (rho_2, mu_2))
                thin = growth_rate(k, fluid, layer, SHARP, following_all)
                for across in ACROSS:
                    h = scene.smoothing_length(across)
                    h_c = scene.coupling_width(h, EPS)
                    rates = [growth_rate(k, fluid, layer, h_c, closure, h=gather)
                             for gather in (None, h) for closure in (following_all, inertial)]
                    result.append((name, viscosity, k, across, h, deep, thin, *rates))
    return result


def edge_rows():
    """(fluid, k, across, n of (2) with point kernels, with the scheme's kernels, with Morris' operator too); not for air, whose
    density is nowhere near that of the suspension."""
    layer, result = scene_layer(), []
    for name in ("water", "glycerol_water"):
        fluid = FLUIDS[name]
        for k in scene.wave_numbers():
            point = edge_growth_rate(k, fluid, layer.phi, SHARP, SHARP)
            for across in ACROSS:
                h = scene.smoothing_length(across)
                widths = scene.coupling_width(h, EPS), h
                rates = [edge_growth_rate(k, fluid, layer.phi, *widths, symbol) for symbol in (False, True)]
                result.append((name, k, across, point, *rates))
    return result
