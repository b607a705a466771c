"""The fluid velocity that a two-way coupled grain gathers from its own reaction force, in linear theory.

A grain at X(t) pushes on the fluid with F(t), N, spread as s(x - X), and feels the mean of the fluid velocity weighted by
g(x - X). Linearised about fluid at rest, incompressible, each wave number keeps a fading sum of what it received:

    u_self(t) = (1/rho) (2 pi)^-3 Int s^(k) g^(k) S(k) (1 - c^2) Re a(k, t) d3k,
    da/dt = F - [lambda(k) + beta/rho + i k c dX/dt] a,      c = k.e/|k|, e the direction of F and of the motion,        (1)

so the past needs no store. lambda(k) is the symbol of the scheme's viscous operator (Morris: equation (2) of sph_operators;
the exact one: nu k^2), beta the drag of other grains per unit volume and velocity (Brinkman), S their structure factor: 1 for
a lone grain. With a pair force of the form sum (P/rho^2) grad W, pressure and divergence both have the direction of k in the
limit of many neighbours, so the projection 1 - c^2 is exact for particles as well.

In a periodic box the integral is a sum over its reciprocal vectors, 1/(box volume) for each. Without k = 0 the mean velocity
of the box is zero (the net force is balanced by a mean pressure gradient: zero net flux); with it the box accelerates.

Frames. Velocities are those of the laboratory, where the fluid is at rest far away (unbounded) or in the mean (box), downwards
positive. The grain moves at v, its slip is w = v - u_self. dX/dt in (1) is what carries the grain out of its own wake: v in
strict linear theory ("path"); the slip, if one holds that the fluid about the grain carries the wake along ("slip", Oseen's
equation in the frame of the nearby fluid); nothing in creeping flow ("still"). They differ at second order of the disturbance;
the full equations (`nonlinear_wake`, steady) are nearer to "slip", which is the one to compare with.

Left out: a floor or any wall (the images of a no-slip plane are not in (1)), the finite speed of sound, the self-advection
of the wake, the noise of disordered particles, and the three effects of the grain's own volume, see `own_volume_fraction`.

Theory: Stokes and Oseen flow past regularised forces; Horwitz & Mani (2016), J. Comput. Phys. 318, 85, and Balachandar, Liu &
Lakhote (2019), J. Comput. Phys. 376, 160, correct for it. All lengths in m; h is the smoothing length, not the support.
"""

import math
from typing import NamedTuple, Optional

import numpy as np
from scipy.special import spherical_jn

from theory import sph_operators


class Smoothing(NamedTuple):
    kernel: str  # a name of sph_operators.KERNELS
    h: float


class Scheme(NamedTuple):
    """How a force enters the fluid, spreads in it and is felt. viscosity: Morris' operator on that kernel; None: exact."""

    spread: Smoothing
    gather: Smoothing
    viscosity: Optional[Smoothing]


class Fluid(NamedTuple):
    """rho, kg/m3; mu, Pa s; brinkman = beta, drag of other grains per volume and velocity, kg/(m3 s); artificial: kinematic viscosity

    of an artificial viscosity in the scheme, m2/s (`sph_operators.central_shear_ratio`)."""

    rho: float
    mu: float
    brinkman: float = 0.0
    artificial: float = 0.0


def one_kernel(kernel, h, morris=True):
    """The same kernel and width for spreading, gathering and, if `morris`, viscosity."""
    smoothing = Smoothing(kernel, h)
    return Scheme(smoothing, smoothing, smoothing if morris else None)


# --- symbols ---


def filter_product(scheme, k):
    """s^(k) g^(k)."""
    return np.prod([sph_operators.transform(part.kernel, 3, k * part.h) for part in (scheme.spread, scheme.gather)], axis=0)


def viscosity_ratio(scheme, k):
    """lambda(k)/(nu k^2); 1 for the exact operator and for k = 0."""
    k = np.asarray(k, float)
    if scheme.viscosity is None:
        return np.ones_like(k)
    kh = np.maximum(k * scheme.viscosity.h, 1e-6)  # the ratio is 1 - O(kh^2)
    return sph_operators.viscosity_ratio(scheme.viscosity.kernel, 3, kh)


def decay_rate(scheme, fluid, k):
    """lambda(k) + beta/rho, 1/s."""
    rate = fluid.mu / fluid.rho * np.square(k) * viscosity_ratio(scheme, k) + fluid.brinkman / fluid.rho
    if fluid.artificial == 0.0:
        return rate
    kh = np.maximum(np.asarray(k, float) * scheme.viscosity.h, 1e-6)
    return rate + fluid.artificial * np.square(k) * sph_operators.central_shear_ratio(scheme.viscosity.kernel, kh)


def wave_numbers(scheme, distance=0.0, points=8):
    """Gauss nodes k [n], 1/m, and weights for Int dk from 0 to 48/H, H the wider of the filters.

    Panels halve towards k = 0 down to 2^-12/H: at large times and small Re_h the integrands change at small k. They are split
    where the phase over `distance` would turn too much within one.
    """
    edges = np.concatenate([[0.0], 2.0 ** np.arange(-12, 0), np.arange(1.0, 8.0), np.arange(8.0, 49.0, 4.0)])
    wider = max(scheme.spread.h, scheme.gather.h)
    pieces = 1 + np.floor(np.diff(edges) * distance / wider / 6.0).astype(int)
    parts = [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(edges[:-1], edges[1:], pieces)]
    edges = np.append(np.concatenate(parts), edges[-1]) / wider
    node, weight = np.polynomial.legendre.leggauss(points)
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    return (middle[:, None] + half[:, None] * node).ravel(), (half[:, None] * weight).ravel()


# --- structure factors: functions of k, 1/m ---


def lone(k):
    """S = 1: one grain, or grains placed independently of each other."""
    return np.ones_like(np.asarray(k, float))


def percus_yevick(fraction, d):
    """S(k) of hard spheres at volume fraction `fraction`; closed form of Wertheim (1963) and Thiele (1963).

    S = 1/(1 - n c^), c(r) = -[A + 6 phi B x + phi A x^3/2] for x = r/d < 1, A = (1+2 phi)^2/(1-phi)^4, B =
    -(1+phi/2)^2/(1-phi)^4. For k d < 1 by quadrature, where the closed form cancels. S(0) = (1-phi)^4/(1+2 phi)^2, the
    compressibility. Within the Percus-Yevick closure; good to a few per cent of S below phi = 0.45.
    """
    first = (1.0 + 2.0 * fraction) ** 2 / (1.0 - fraction) ** 4
    second = -6.0 * fraction * (1.0 + 0.5 * fraction) ** 2 / (1.0 - fraction) ** 4
    third = 0.5 * fraction * first
    node, weight = np.polynomial.legendre.leggauss(16)
    x, dx = 0.5 * (node + 1.0), 0.5 * weight

    def integral(q):
        """Int_0^1 (A + 6 phi B x + phi A x^3/2) x^2 sin(q x)/(q x) dx."""
        return np.sinc(np.multiply.outer(q, x) / math.pi) @ (dx * x**2 * (first + second * x + third * x**3))

    def closed(q):
        sin, cos = np.sin(q), np.cos(q)
        constant = first * (sin - q * cos)
        linear = second * (2.0 * q * sin + (2.0 - q**2) * cos - 2.0) / q
        cubic = third * (-(q**4) * cos + 4.0 * ((3.0 * q**2 - 6.0) * cos + (q**3 - 6.0 * q) * sin + 6.0)) / q**3
        return (constant + linear + cubic) / q**3

    def factor(k):
        q = np.asarray(k, float) * d
        whole = np.where(q < 1.0, integral(np.minimum(q, 1.0)), closed(np.maximum(q, 1.0)))
        return 1.0 / (1.0 + 24.0 * fraction * whole)

    return factor


def below_first_vector(spacing):
    """S of a cubic lattice as far as a continuous function can say it: 0 for k < 2 pi/spacing, 1 beyond (its mean over shells).

    Exact is the sum over the reciprocal vectors: `box_modes` with the cell as the box.
    """
    return lambda k: np.where(np.asarray(k, float) < 2.0 * math.pi / spacing, 0.0, 1.0)


# --- steady state, unbounded ---


def oseen_angle(a):
    """Int_-1^1 (1 - c^2)/(1 + a^2 c^2) dc = 2 [(1 + 1/a^2) arctan(a)/a - 1/a^2]; 4/3 for a = 0."""
    a = np.asarray(a, float)
    series = sum(4.0 * (-1.0) ** n / ((2 * n + 1) * (2 * n + 3)) * a ** (2 * n) for n in range(6))
    large = np.maximum(a, 0.1)
    closed = 2.0 * ((1.0 + large**-2) * np.arctan(large) / large - large**-2)
    return np.where(a < 0.1, series, closed)


def steady_coefficient(scheme, re_h=0.0, screening=0.0, structure=lone):
    """C of u_self = C F/(mu h), h the gathering width. re_h = U h/nu (Oseen), screening = h sqrt(beta/mu) (Brinkman)."""
    h = scheme.gather.h
    k, weight = wave_numbers(scheme)
    kh = k * h
    resistance = kh**2 * viscosity_ratio(scheme, k) + screening**2
    share = weight * h * filter_product(scheme, k) * structure(k) * kh**2
    return float(share @ (oseen_angle(re_h * kh / resistance) / resistance)) / (4.0 * math.pi**2)


def steady_excess(scheme, d, re_h=0.0, screening=0.0, structure=lone):
    """u_self over the velocity F/(3 pi mu d) that Stokes' drag law gives the force."""
    return 3.0 * math.pi * d / scheme.gather.h * steady_coefficient(scheme, re_h, screening, structure)


def steady_settling(sphere, scheme, moves="slip"):
    """(slip, u_self), m/s, of a lone grain at its final speed: drag(slip) = weight, u_self with dX/dt as `moves` says."""
    slip, h = sphere.terminal_speed(), scheme.gather.h
    u = 0.0
    for _ in range(100):
        speed = {"still": 0.0, "slip": slip, "path": slip + u}[moves]
        before, u = u, steady_coefficient(scheme, sphere.rho * speed * h / sphere.mu) * sphere.weight() / (sphere.mu * h)
        if abs(u - before) <= 1e-14 * slip:
            break
    return slip, u


def steady_field(scheme, distance):
    """mu u/F, 1/m, at `distance` from the grain, (on the line of the force, across it): Oseen's tensor of the smoothed force.

    Creeping flow; the velocity is the gathered one. Tends to 1/(4 pi r), 1/(8 pi r) far away.
    """
    k, weight = wave_numbers(scheme, distance)
    z = k * distance
    share = weight * filter_product(scheme, k) / viscosity_ratio(scheme, k) / (2.0 * math.pi**2)
    ratio = spherical_jn(1, z) / z
    return float(share @ (2.0 * ratio)), float(share @ (spherical_jn(0, z) - ratio))


def overlap(scheme):
    """(s o g)(0) = Int s g dV, 1/m3: the mean of the spread force density where it is gathered."""
    k, weight = wave_numbers(scheme)
    return float(weight @ (k**2 * filter_product(scheme, k))) / (2.0 * math.pi**2)


def own_volume_fraction(scheme, d):
    """f = V (s o g)(0), the share of its own volume that a grain sees; of order (d/h)^3 and not part of u_self. From it follow

    its own porosity 1 - f; with the forces V (-grad p + div tau) on, a whole force of drag/(1 - f) once steady; and a backflow
    of -(f/3) v that the moving porosity drives (div(eps u) = -d eps/dt, spherical kernels) if the divergence is exact; smoothed
    particles answer with V W(0)/3 instead (verification/single_grain, equation 3).
    """
    return math.pi / 6.0 * d**3 * overlap(scheme)


# --- wave vectors: unbounded space and periodic boxes ---


class Modes(NamedTuple):
    """Wave vectors [n]: modulus k, cosine c to the motion, share = s^ g^ S times the measure (2 pi)^-3 d3k or 1/volume."""

    k: np.ndarray
    cosine: np.ndarray
    share: np.ndarray


def _cosine_counts(scheme, fluid, k, path, speed):
    """Gauss nodes over 0 < c < 1 that resolve the phase k c dX over what a wave number remembers, to 1e-6 of the whole."""
    folds = np.maximum(14.0 + np.log(np.abs(filter_product(scheme, k)) + 1e-300), 1.0)  # weak waves may be forgotten sooner
    phase = k * np.minimum(path, folds * speed / np.maximum(decay_rate(scheme, fluid, k), 1e-300))
    return np.where(phase < 1e-12, 2, 8 * np.ceil(0.5 + 0.6 * phase / 8.0)).astype(int)


def unbounded_modes(scheme, fluid, structure=lone, path=0.0, speed=0.0, points=6):
    """Gauss nodes for the integral (1). `path` and `speed`: the greatest displacement and dX/dt to come; 0 for "still"."""
    k, weight = wave_numbers(scheme, 0.0, points)
    radial = 2.0 / (2.0 * math.pi) ** 2 * weight * k**2 * filter_product(scheme, k) * structure(k)
    counts = _cosine_counts(scheme, fluid, k, path, speed)
    parts = []
    for count in np.unique(counts):
        node, gauss = np.polynomial.legendre.leggauss(count)
        here = counts == count
        shape = (int(here.sum()), count)
        parts.append([np.broadcast_to(k[here][:, None], shape).ravel(), np.broadcast_to(0.5 * (node + 1.0), shape).ravel(),
                      np.outer(radial[here], 0.5 * gauss).ravel()])
    return Modes(*(np.concatenate(part) for part in zip(*parts)))


CENTRING = {  # reciprocal vectors present, grains per cell
    "primitive": (lambda n: np.full(n.shape[:-1], True), 1),
    "body": (lambda n: n.sum(axis=-1) % 2 == 0, 2),
    "face": (lambda n: np.all(n % 2 == n[..., :1] % 2, axis=-1), 4),
}


def box_modes(scheme, size, axis=2, keep_mean=False, centring="primitive", reach=24.0):
    """Modes of a periodic box (size [3], m) around one grain that moves along `axis`; |k| up to reach/H, H the wider filter.

    With `centring` the box is the cubic cell of a lattice of equal grains that all move and push alike, u_self then being the
    velocity at each of them over the mean of the box. Waves of one modulus and cosine are one mode.
    """
    size = np.asarray(size, float)
    present, grains = CENTRING[centring]
    unit = 2.0 * math.pi / size
    top = reach / max(scheme.spread.h, scheme.gather.h)
    counts = np.floor(top / unit).astype(int)
    n = np.stack(np.meshgrid(*[np.arange(count + 1) for count in counts], indexing="ij"), axis=-1).reshape(-1, 3)
    square = (n * unit) ** 2
    n = n[present(n) & (square.sum(axis=1) <= top**2) & (keep_mean | (n.sum(axis=1) > 0))]
    square = (n * unit) ** 2
    copies = 2.0 ** (n > 0).sum(axis=1)
    along = n[:, axis]
    across = np.rint((square.sum(axis=1) - square[:, axis]) / unit.min() ** 2 * 1e8)  # equal to 1e-8 of the least
    _, first, where = np.unique(across * (counts[axis] + 1.0) + along, return_index=True, return_inverse=True)
    k = np.sqrt(square[first].sum(axis=1))
    cosine = along[first] * unit[axis] / np.maximum(k, 1e-300)
    share = np.bincount(where.ravel(), copies) * grains / size.prod() * filter_product(scheme, k)
    return Modes(k, cosine, share)


def steady_velocity(modes, scheme, fluid, force, speed=0.0):
    """u_self, m/s, under a constant force at constant dX/dt = speed. Without k = 0."""
    rate = decay_rate(scheme, fluid, modes.k)
    turn = modes.k * modes.cosine * speed
    return float((modes.share * (1.0 - modes.cosine**2)) @ (rate / (rate**2 + turn**2))) * force / fluid.rho
