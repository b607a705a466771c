// The corrected operators in one pass over the neighbours, and in a second one for what is made of gradients.
#pragma once

#include "sph/fluid.hpp"

namespace plumb {

/// Accelerations and density rates of all particles with corrected gradients, for the state in the records:
///     B_a^-1 = sum V (x_b - x_a) (x) grad W,   grad v_a = sum V (v_b - v_a) (x) B_a grad W,   grad p_a, grad rho_a
///     likewise dv_a/dt = -grad p_a/rho_a + mu/rho_a sum V (grad v_b - grad v_a) . B_a grad W,   d rho_a/dt = -rho_a tr
///     grad v_a
/// Viscous terms that are sums over pairs and artificial viscosity stay as they are in pair_terms.hpp; density
/// diffusion takes the linear part out of its differences (Antuono et al. 2010, Comput. Phys. Commun. 181, 532), or it
/// would be an error of the first order in h.
void evaluate_corrected(SphFluid& fluid);

} // namespace plumb
