"""The rigid block of smoothed_block.py in a periodic box of smoothed particles: with the scheme's own divergence, widths and box.

smoothed_block.py gives the fluid's velocity by volume, eps (u + V) = V. Smoothed particles keep eps over their own density
constant, rho(t)/eps(t) along their path, and change their density by a divergence that is smoothed by the fluid's kernel. With
w = (u + V)/V in the block's frame and * the convolution with the kernel over planes (width h, transform W^),

    (w * W)' = -w (ln eps)'        in place of        w' = -w (ln eps)'  <=>  w = 1/eps                                    (1)

so u is that of an exact divergence with W^ divided out: sharper than eps. Waves so short that W^ is nearly zero are not answered
within a run: the pressure drives a plane wave of u towards (1) at the rate c^2 W^ k^2/(nu k^2), c the speed of sound and nu the
viscosity of that wave (artificial included),

    du^/dt = (c^2/nu) W^ {q^ - W^ u^},      q' = -w (ln eps)',                                                              (2)

linear in w and solved by a matrix exponential. Only waves with W^ << 1 are slow, on which the gathering kernel has little weight:
c^2 t/nu enters the block's velocity in the fourth digit. Waves of two spacings have no divergence on the fluid's lattice, and shorter ones it
does not hold: nothing answers them. (1) holds while the lattice of the fluid is not yet drawn apart.

Widths of spreading, gathering and porosity are independent, and eps has a filter of its own, POROSITY: the kernel (W^), its mean over a
grain's sphere (times 3 (sin x - x cos x)/x^3, x = k d/2), or 2 W - W*W (W^ (2 - W^)). A layer is a plane, so its mean over planes has the
filter's transform in space. As in smoothed_block.py a grain's slip is <eps> V <w>, and the force of all grains, spread and gathered again,
is the gradient that each feels. Of the eps it gathers a grain may leave out what it has put there, V (2 pi)^-3 Int p^ g^ d3k (`own_volume`).

Box. With no net momentum (the mean gradient balances the weight) the clear fluid moves with q,
    V_box = V - q = V (1 - Phi + M)/(1 - Phi + Phi rho_p/rho),   Phi = mean of 1 - eps,   M = mean of eps (w - 1),          (3)
and M = Phi for w = 1/eps: no net flux.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.linalg import expm
from scipy.optimize import brentq

from drag_laws.drag_laws import di_felice

from . import sedimentation_scene as scene
from . import sph_operators
from .plane_kernel import KERNEL, plane_average
from .settling import GRAIN, GRAVITY

PER_WIDTH = 10  # points of z per h, and per narrower kernel


def sphere_transform(x):
    """Of a ball of radius R and integral one, x = k R > 0; below 0.01 its series, good to 1e-10."""
    x = np.asarray(x, float)
    far = np.maximum(x, 0.01)
    return np.where(x < 0.01, 1.0 - 0.1 * x**2, 3.0 * (np.sin(far) - far * np.cos(far)) / far**3)


# Filters of the porosity: transform from that of the kernel and the wave number, 1/m.
POROSITY = {
    "kernel": lambda kernel, k: kernel,
    "overlap": lambda kernel, k: kernel * sphere_transform(0.5 * GRAIN["d"] * k),
    "deconvolved": lambda kernel, k: kernel * (2.0 - kernel),
}


class Widths(NamedTuple):
    """Smoothing lengths, m: of the fluid, of spreading, gathering and porosity; which filter of POROSITY, own volume included or not."""

    fluid: float
    spread: float
    gather: float
    porosity: float
    law: str = "kernel"
    own_volume: bool = True


def porosity_transform(widths, k):
    """p^(k) of the filter of eps, k an array, 1/m."""
    return POROSITY[widths.law](sph_operators.transform(KERNEL, 3, k * widths.porosity), k)


def own_volume(widths):
    """Share of eps that a grain gathers of its own volume, V (2 pi)^-3 Int p^ g^ d3k."""
    k = np.linspace(0.0, 40.0 / min(widths.porosity, widths.gather), 4001)  # p^ g^ falls as k^-10: the rest is below 1e-8
    both = porosity_transform(widths, k) * sph_operators.transform(KERNEL, 3, k * widths.gather)
    return scene.GRAIN_VOLUME / (2.0 * math.pi**2) * float(np.sum(k**2 * both) * k[1])


class Field(NamedTuple):
    """Heights [m], porosity and w there, in the periodic box."""

    z: np.ndarray
    eps: np.ndarray
    w: np.ndarray
    box: float


def heights_apart(z, block, box):
    """z_a - z_j [m, n] to the nearest image, m."""
    apart = z[:, None] - block.heights
    return apart - box * np.round(apart / box)


def _by_waves(factor, count):
    """The matrix [count, count] that multiplies the waves of a periodic field with `factor`."""
    return np.fft.irfft(factor[:, None] * np.fft.rfft(np.eye(count), axis=0), count, axis=0)


class Answer(NamedTuple):
    """What the fluid makes of a porosity that moves: c^2 t/nu, and the spacing of its particles, m."""

    reached: float
    spacing: float


def response(eps, box, h, answered):
    """w of equation (2) for the porosities [n] of a box and an Answer. The first point lies in the clear."""
    count = len(eps)
    k = 2.0 * math.pi * np.fft.rfftfreq(count, box / count)
    smoothed = sph_operators.transform(KERNEL, 3, k * h)
    slope, primitive = 1j * k, np.zeros(len(k), complex)
    slope[-1] = 0.0
    primitive[1:-1] = 1.0 / slope[1:-1]
    steepness = np.fft.irfft(slope * np.fft.rfft(np.log(eps)), count)
    integral = _by_waves(primitive, count)
    integral = (integral - integral[0]) * steepness  # q = -integral w, zero in the clear
    drive = _by_waves(np.where(k < (1.0 - 1e-9) * math.pi / answered.spacing, answered.reached * smoothed, 0.0), count)
    rates = np.zeros((count + 1, count + 1))
    rates[:count, :count] = -drive @ (_by_waves(smoothed, count) + integral)
    rates[:count, count] = -drive @ integral.sum(axis=1)
    return 1.0 + expm(rates)[:count, count]


def field(block, box, widths, answered=None):
    """Porosity and w around the block in a box of height `box`, m; answered = None: equation (1) with an exact divergence."""
    narrowest = min(widths[:4])
    count = 2 * math.ceil(0.5 * PER_WIDTH * box / narrowest)
    z = 0.5 * (block.bottom + block.top) + box * (np.arange(count) / count - 0.5)
    k = 2.0 * math.pi * np.fft.rfftfreq(count, box / count)
    waves = np.exp(-1j * np.outer(k, block.heights - z[0])).sum(axis=1) * porosity_transform(widths, k)
    eps = 1.0 - (1.0 - block.eps) * block.spacing * np.fft.irfft(waves, count) * count / box
    return Field(z, eps, 1.0 / eps if answered is None else response(eps, box, widths.fluid, answered), box)


def velocity(fluid, block, widths, at, law=di_felice):
    """Fall of the block through clear fluid at rest, m/s, in the Field `at`."""
    rho, mu, d = fluid["rho"], fluid["mu"], GRAIN["d"]
    apart = heights_apart(at.z, block, at.box)
    gather = plane_average(apart, widths.gather).T
    gather = gather / gather.sum(axis=1, keepdims=True)
    eps, w = gather @ at.eps, gather @ at.w
    eps = np.minimum(eps if widths.own_volume else eps + own_volume(widths), 1.0)  # a drag law knows nothing above 1
    own = scene.GRAIN_VOLUME * gather @ plane_average(apart, widths.spread) / block.spacing**2
    weight = (GRAIN["rho_p"] - rho) * scene.GRAIN_VOLUME * GRAVITY

    def excess(logarithm):
        slip = math.exp(logarithm) * eps * w
        drag = 3.0 * math.pi * mu * d * slip * law(eps, rho * d * slip / mu)
        return np.linalg.solve(np.eye(block.layers) - own, drag).mean() / weight - 1.0

    return math.exp(brentq(excess, math.log(1e-9), math.log(1e2), xtol=1e-13, rtol=1e-14))


def share_in_box(at, density_ratio):
    """V_box/V of equation (3); density_ratio = rho_p/rho."""
    taken, moved = float((1.0 - at.eps).mean()), float((at.eps * (at.w - 1.0)).mean())
    return (1.0 - taken + moved) / (1.0 - taken + taken * density_ratio)
