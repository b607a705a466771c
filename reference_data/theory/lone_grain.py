"""A lone grain in smoothed particles: Di Felice's law without neighbours, and what the grain's own volume does to it.

Derived in verification/single_grain. `s` is anything with rho, mu, rho_p, d, kernel, h (the fluid's), c (speed of sound), end (of the run) and
volume, all SI; speeds are downwards.
"""

import numpy as np

from drag_laws.drag_laws import di_felice
from theory import self_disturbance, sph_operators
from theory.released_sphere import Sphere, speed_without_history


def law_of(eps):
    """Di Felice's factor on the interstitial slip at porosity eps, as a function of the interstitial Re."""
    return lambda re: eps * di_felice(eps, np.maximum(eps * np.asarray(re, float), 1e-12))


def sphere(s):
    """The grain at porosity 1."""
    return Sphere(law_of(1.0), s.rho_p, s.d, s.rho, s.mu)


def terminal_speed(s):
    """u_t of Di Felice's law for a lone grain, porosity 1, m/s."""
    return sphere(s).terminal_speed()


def by_law(s, t):
    """v [nt], m/s, at increasing times t that may begin with 0, of a lone grain under the drag law, from rest."""
    t = np.asarray(t, float)
    first = 0 if t[0] > 0.0 else 1
    return np.concatenate([np.zeros(first), speed_without_history(sphere(s), t[first:], False)])


def fall(run):
    """(t, v), s and m/s, v downwards, of the probe `v` of a run."""
    t, v = run.series("v")
    return t, -np.ravel(v)


def from_rest(settled, s, t):
    """(v, u_self) of settled(s, times), which wants times > 0, at times t that may begin with 0."""
    t = np.asarray(t, float)
    later = t > 0.0
    v, u = np.zeros_like(t), np.zeros_like(t)
    v[later], u[later] = settled(s, tuple(t[later]))
    return v, u


class OwnVolume(Sphere):
    """A grain that meets the backflow of its own moving porosity: in v' = (1 + b) v, drag = drag(v' - u_self) and m/(1 + b) dv'/dt is its
    inertia. Where a mean gradient balances the weight of a box, the grain's is less by its share of the box."""

    b, share_of_box = 0.0, 0.0

    def inertia(self, added_mass):
        return super().inertia(added_mass) / (1.0 + self.b)

    def weight(self):
        return super().weight() * (1.0 - self.share_of_box)


def backflow(scheme, modes, s):
    """Share b of the grain's speed with which the fluid about it flows the other way (verification/single_grain, equation 3). Waves that the
    fluid's own kernel does not see have no pressure."""
    smoothed = sph_operators.transform(s.kernel, 3, modes.k * s.h)
    rate = s.c**2 * (modes.k * smoothed) ** 2 / self_disturbance.decay_rate(scheme, self_disturbance.Fluid(s.rho, s.mu), modes.k)
    settled = np.where(np.abs(smoothed) > 1e-6, -np.expm1(-rate * s.end) / smoothed, 0.0)
    return s.volume * float((modes.share * modes.cosine**2) @ settled)
