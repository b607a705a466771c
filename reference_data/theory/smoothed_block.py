"""A rigid block of grains that falls through fluid, with the porosity and the exchange smoothed by kernels: the limit of a
coupled scheme with many fluid particles per kernel, along z alone.

The block fills x and y, so in the mean over planes everything depends on z. It falls steadily at V in a closed box. In its
own frame, z upwards, for an incompressible mixture of rigid grains (v = -V) and fluid:

1. Volume. With the porosity field eps(z), spread from the grains by the kernel of width h_c, and the fluid's velocity u,
   d eps/dt + d(eps u)/dz = 0 and a field that travels with the block, d/dt = V d/dz, give d[eps (u + V)]/dz = 0. Far away
   eps = 1 and, with no net flux through a plane, u = 0. Hence eps (u + V) = V at every z: the superficial slip is V.
2. Fluid momentum. -grad p + div tau = G acts on fluid and grains alike. A grain feels V_g G + f_d, the reaction goes back to
   the fluid spread by h_c over the area a^2 of one grain of a layer:

       G(z) = sum_j [f_j + V_g g_j] w(z - z_j; h_c)/a^2                                                             (1)

   (inertia rho eps (u + V) du/dz is odd about the middle of the block and drops out of the sum over grains; stresses are
   part of G and need no closure.)
3. Grains. The block is rigid: only the sum counts, sum_i [f_i + V_g g_i] = N (rho_p - rho) V_g g.                  (2)

What a grain sees is gathered by a kernel: eps_i = <eps>, (u + V)_i = <V/eps>, g_i = <G>. With exchange = "gathered", the
scheme as it is, the slip eps_i (u + V)_i is therefore V <eps><1/eps>, a little more than V, and (1) is a linear system for g_i.
With exchange = "local" the slip is V and -eps dp/dz = f_d per volume point by point, G = sum_j f_j w/(a^2 eps), then gathered.
Both return the hindered velocity of a uniform suspension, (4/3) Ar eps^(1 + chi) = C_D Re^2, in a thick block.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from drag_laws.drag_laws import di_felice

from . import sedimentation_scene as scene
from .plane_kernel import plane_average
from .settling import FLUIDS, GRAIN, GRAVITY, archimedes, hindered_re

SMOOTHING = (1.5, 2.0, 3.0, 4.0, 6.0)  # h/d of the slides
NOMINAL = (0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95)
STEP = 1.0 / 40.0  # of the narrowest kernel; the plane kernel is smooth, so the sum over z is good to 1e-8


class Coupling(NamedTuple):
    """Matrices between n layers and m places z: eps [m]; gather [n, m] with row sums 1; spread [m, n], 1/m."""

    eps: np.ndarray
    gather: np.ndarray
    spread: np.ndarray


def gather_width(kind, h, h_c, eps):
    """Width of the gathering kernel. "h": the fluid's h in the clear; "h_c": as the spreading; "particle": h eps^(-1/3) with
    the eps of each place, the h of a fluid particle whose mass per volume is eps rho."""
    widths = {"h": h, "h_c": h_c, "particle": h * eps ** (-1.0 / 3.0)}
    if kind not in widths:
        raise ValueError(f"gather = '{kind}': expected one of {', '.join(widths)}")
    return widths[kind]


def coupling(block, h, gather="h", own_widths=False):
    """Coupling of the layers of a `scene.Lattice` with unbounded fluid; h in m.

    The spreading kernel has the width h eps^(-1/3) of the nominal porosity, or with own_widths that of the porosity at each
    place, as in the public code: eps is then the fixed point of its own spreading, and a grain's force is spread over its sum
    of weights.
    """
    h_c = scene.coupling_width(h, block.nominal)
    reach = 2.0 * h_c + 2.0 * h * block.eps ** (-1.0 / 3.0) + 2.0 * h
    count = math.ceil((block.top - block.bottom + 2.0 * reach) / (STEP * h))
    z = np.linspace(block.bottom - reach, block.top + reach, count)
    spread = plane_average(z[:, None] - block.heights, h_c)
    eps = 1.0 - (1.0 - block.eps) * block.spacing * spread.sum(axis=1)
    if eps.min() <= 0.0:
        raise ValueError("the smoothed porosity vanishes: a layer is thinner than its kernel can resolve")
    if own_widths:
        eps, spread = own_width_spreading(block, h, z, eps)
    weight = plane_average(block.heights[:, None] - z, gather_width(gather, h, h_c, eps))
    return Coupling(eps, weight / weight.sum(axis=1, keepdims=True), spread)


def own_width_spreading(block, h, z, eps):
    """(eps [m], spread [m, n], 1/m) with the width h eps^(-1/3) of each place; `eps` [m] to begin with."""
    for _ in range(200):
        spread = plane_average(z[:, None] - block.heights, (h * eps ** (-1.0 / 3.0))[:, None])
        before, eps = eps, 1.0 - (1.0 - block.eps) * block.spacing * spread.sum(axis=1)
        if np.max(np.abs(eps - before)) < 1e-13:
            return eps, spread / (spread.sum(axis=0) * (z[1] - z[0]))
    raise ValueError("the porosity and its widths do not settle: the block is too dense for this kernel")


def porosities(block, h, gather="h"):
    """eps that the grains of each layer gather."""
    parts = coupling(block, h, gather)
    return parts.gather @ parts.eps


def mean_porosity(nominal, h, gather="h"):
    """Mean over the grains of the slides' block of the porosity they gather."""
    return float(porosities(scene.lattice(nominal), h, gather).mean())


def forces(speed, block, parts, fluid, exchange, law=di_felice):
    """Whole force of the fluid on one grain of each layer, N, upwards, for a block that falls at `speed`."""
    rho, mu, d = fluid["rho"], fluid["mu"], GRAIN["d"]
    eps = parts.gather @ parts.eps
    slip = speed * np.ones(block.layers) if exchange == "local" else speed * eps * (parts.gather @ (1.0 / parts.eps))
    drag = 3.0 * math.pi * mu * d * slip * law(eps, rho * d * slip / mu)
    spread = parts.spread / block.spacing**2
    if exchange == "local":
        return drag + scene.GRAIN_VOLUME * parts.gather @ (spread @ drag / parts.eps)
    if exchange != "gathered":
        raise ValueError(f"exchange = '{exchange}': expected gathered or local")
    own = scene.GRAIN_VOLUME * parts.gather @ spread
    return np.linalg.solve(np.eye(block.layers) - own, drag)  # f + V g with g = K (f + V g), own = V K


def velocity(fluid, block, h, gather="h", exchange="gathered", law=di_felice, own_widths=False):
    """Steady velocity of the rigid block, m/s, from equation (2)."""
    parts = coupling(block, h, gather, own_widths)
    weight = (GRAIN["rho_p"] - fluid["rho"]) * scene.GRAIN_VOLUME * GRAVITY

    def excess(logarithm):
        return forces(math.exp(logarithm), block, parts, fluid, exchange, law).mean() / weight - 1.0

    return math.exp(brentq(excess, math.log(1e-9), math.log(1e2), xtol=1e-13, rtol=1e-14))


def uniform_velocity(fluid, eps):
    """Settling speed of a uniform suspension, m/s: (4/3) Ar eps^(1 + chi) = C_D Re^2."""
    rho, mu, d = fluid["rho"], fluid["mu"], GRAIN["d"]
    return hindered_re(archimedes(GRAIN["rho_p"], rho, d, mu), eps, 1) * mu / (rho * d)


def porosity_rows():
    """(nominal, h/d, columns, layers, spacing, lattice's eps, mean gathered eps with h, h_c and the particles' own h)."""
    rows = []
    for nominal in NOMINAL:
        block = scene.lattice(nominal)
        for ratio in SMOOTHING:
            gathered = [mean_porosity(nominal, ratio * GRAIN["d"], kind) for kind in ("h", "h_c", "particle")]
            rows.append((nominal, ratio, block.columns, block.layers, block.spacing, block.eps, *gathered))
    return rows


def velocity_rows():
    """(fluid, nominal, h/d, v of the scheme with gathering by h and by the particles' own h, v of the local balance, v at the
    nominal and at the lattice's porosity)."""
    rows = []
    for name, fluid in FLUIDS.items():
        for nominal in NOMINAL:
            block = scene.lattice(nominal)
            plain = uniform_velocity(fluid, nominal), uniform_velocity(fluid, block.eps)
            for ratio in SMOOTHING:
                kinds = (("h", "gathered"), ("particle", "gathered"), ("h", "local"))
                smoothed = [velocity(fluid, block, ratio * GRAIN["d"], *kind) for kind in kinds]
                rows.append((name, nominal, ratio, *smoothed, *plain))
    return rows
