"""One sphere per cell of a simple cubic array in creeping flow, and what a smoothed force makes of it.

Hasimoto (1959), J. Fluid Mech. 5, 317: a force F on each sphere moves it relative to the mean velocity of the cell (spheres
included: zero net flux) at F/(3 pi mu d) K(phi), phi = pi d^3/(6 L^3),

    K = 1 - 1.7601 phi^(1/3) + phi - 1.5593 phi^2 + 3.9799 phi^(8/3) - 3.0734 phi^(10/3),

the last two terms of Sangani & Acrivos (1982), Int. J. Multiphase Flow 8, 343 (from memory; with them 1/K is the drag of Zick &
Homsy (1982), J. Fluid Mech. 115, 13, to its four digits up to phi = 0.064 and within 0.06 % at 0.125). F is the weight less
buoyancy of a settling grain.

1.7601 = 2.837297 (3/(4 pi))^(1/3), with the lattice constant of point forces in a uniform opposite force density: the periodic
velocity at a point force less its own unbounded one is -2.837297 F/(6 pi mu L). A smoothed force and a smoothed measurement of
second moments <r^2>_s, <r^2>_g add, since Stokes' flow past a force is biharmonic outside it,

    +(1/9) (<r^2>_s + <r^2>_g) F/(mu L^3)      exactly, once the supports of cells do not touch,                        (1)

because the uniform force density -F/L^3 gives the Laplacian of the velocity 2 F/(3 mu L^3). For the shell of a sphere, <r^2> =
d^2/4 twice, (1) is K's term +phi (Faxen). A kernel wider than the grain has a larger one, 3.2 (h/d)^2 phi for Wendland C2
with exact viscosity: a scheme corrected for its unbounded self-disturbance still differs from K by that.
"""

import math

from theory import self_disturbance, sph_operators

POINT_LATTICE = 2.8372974794806  # the simple cubic lattice of charges in a uniform background; from memory, the sums agree
TERMS = ((0.0, 1.0), (1 / 3, -1.7601), (1.0, 1.0), (2.0, -1.5593), (8 / 3, 3.9799), (10 / 3, -3.0734))  # power, coefficient


def volume_fraction(cell_over_d):
    """phi of one sphere in a cubic cell of side L, from L/d."""
    return math.pi / 6.0 / cell_over_d**3


def inverse_drag(fraction, terms=4):
    """K(phi): 4 terms Hasimoto's, 6 with Sangani & Acrivos', 2 the point force."""
    return sum(coefficient * fraction**power for power, coefficient in TERMS[:terms])


def settling_speed(force, mu, d, cell, terms=4):
    """m/s over the mean velocity of the cell, side `cell`; force = weight less buoyancy, N."""
    return force / (3.0 * math.pi * mu * d) * inverse_drag(volume_fraction(cell / d), terms)


def image_velocity(scheme, cell, reach=24.0):
    """mu/F times what the images (and the zero mean) add to the steady u_self of a lone grain in a cubic cell, 1/m."""
    fluid = self_disturbance.Fluid(1.0, 1.0)
    modes = self_disturbance.box_modes(scheme, (cell, cell, cell), reach=reach)
    periodic = self_disturbance.steady_velocity(modes, scheme, fluid, 1.0)
    return periodic - self_disturbance.steady_coefficient(scheme) / scheme.gather.h


def second_moment(scheme):
    """<r^2>_s + <r^2>_g less half the <r^2> of Morris' kernel, m2: s^ g^ nu k^2/lambda = 1 - k^2/6 times this."""
    moments = [sph_operators.moment(part.kernel, 3) * part.h**2 for part in (scheme.spread, scheme.gather)]
    viscous = scheme.viscosity and 0.5 * sph_operators.moment(scheme.viscosity.kernel, 3) * scheme.viscosity.h**2
    return sum(moments) - (viscous or 0.0)


def image_velocity_expanded(scheme, cell):
    """The same from the lattice constant and (1); exact for exact viscosity, else up to terms that fall exponentially."""
    return -POINT_LATTICE / (6.0 * math.pi * cell) + second_moment(scheme) / (9.0 * cell**3)


def corrected_speed(scheme, d, cell):
    """Speed over F/(3 pi mu d) of a two-way coupled Stokes grain in a cell, its unbounded self-disturbance subtracted."""
    return 1.0 + 3.0 * math.pi * d * image_velocity_expanded(scheme, cell)
