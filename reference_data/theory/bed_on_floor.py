"""Flow through a bed of fixed grains that lies on a floor through which the fluid comes in, as the coupled scheme smooths it.

One dimension, z up from the floor at 0. Layers of grains (volume V, n per area and layer) at z_k, spread and gathered with one kernel whose plane average
is w(z) (plane_kernel.py); above H is clear fluid. The floor mirrors the grains' room, and cuts the kernel of P, whose columns then
are one again by division:

    1 - eps(z) = n V sum_k [w(z - z_k) + w(z + z_k)],    P_k(z) = w(z - z_k)/int_0^inf w(z - z_k) dz                     (1)

Superficial velocity u_s is the same everywhere. A grain gathers eps_k = int P_k eps and U_k = int P_k u_s/eps, feels f_k by its drag law and its share
of the fluid's pressure gradient G = -dp/dz, of which the hydrostatic part is taken out:

    F_k = V int P_k G + f_k,    f_k = 3 pi mu d eps_k U_k F(eps_k, rho d eps_k U_k/mu),    G(z) = n sum_k F_k P_k(z) + d(rho u_s^2/eps)/dz     (2)

linear in the F_k. Viscous stress of a flow along z that changes along z only is 2 mu d2u/dz2 at most, 1e-4 of the drag here, and left out. The pressure drop is the integral of G: what
the grains receive, less the momentum that the fluid loses where the grains leave it more room.
"""

import math

import numpy as np

from .plane_kernel import plane_average


def part_below(z, d, level):
    """Share of the volumes of spheres of diameter d (m) at the heights z (m) that is below a level (m)."""
    s = np.clip((level - z) / d + 0.5, 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


class LayeredBed:
    """Layers at `z` (m), of `per_area` grains per m2 each, of diameter d (m), kernel h (m); the floor is at 0."""

    def __init__(self, z, per_area, d, h, panels=4000):
        self.z, self.per_area, self.d = np.asarray(z, float), per_area, d
        self.volume = math.pi * d**3 / 6.0
        top = self.z[-1] + 2.0 * h
        self.dz = top / panels
        self.at = (np.arange(panels) + 0.5) * self.dz
        spread = plane_average(self.at[None, :] - self.z[:, None], h)
        mirrored = plane_average(self.at[None, :] + self.z[:, None], h)
        self.eps = 1.0 - per_area * self.volume * np.sum(spread + mirrored, axis=0)
        self.weights = spread / (np.sum(spread, axis=1, keepdims=True) * self.dz)  # P_k(z), 1/m

    def gathered(self, field):
        """int P_k field dz, by layer."""
        return self.weights @ field * self.dz

    def forces(self, law, u_s, rho, mu):
        """F_k of equation (2), N, by layer; law(eps, Re) is F of the drag laws."""
        eps, slip = self.gathered(self.eps), self.gathered(u_s / self.eps)
        superficial = eps * slip
        drag = 3.0 * math.pi * mu * self.d * superficial * law(eps, rho * self.d * superficial / mu)
        inertial = np.gradient(rho * u_s**2 / self.eps, self.dz)
        shared = self.volume * self.per_area * self.weights @ self.weights.T * self.dz
        return np.linalg.solve(np.eye(len(self.z)) - shared, drag + self.volume * self.gathered(inertial))

    def pressure_drop(self, law, u_s, rho, mu):
        """From the floor to above the bed, Pa."""
        momentum = rho * u_s**2 * (1.0 / self.eps[0] - 1.0)
        return self.per_area * float(np.sum(self.forces(law, u_s, rho, mu))) - momentum
