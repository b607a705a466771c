// What evens out smoothed particles that a run among grains has stirred up. The density of the fluid itself, share
// rho/eps, is not that of a particle, which takes more room where grains are: only the former may be evened out, and
// only the latter has to change when a particle is shifted.
#pragma once

#include "coupling/weights.hpp"

namespace plumb {

/// Diffusion and shifting among grains, after the rates of the present step are there.
///
/// Diffusion: D rho_f/Dt = 2 delta h c sum_b V_b [rho_f,b - rho_f,a - (g_a + g_b)/2 . (x_b - x_a)] (x_b - x_a) . grad
/// W/r^2, g the corrected gradient of rho_f: linear pressure is left alone, also beside walls and above a bed, through
/// which the plain term would carry delta h |grad p|/c of the mass (Antuono, Colagrossi, Marrone & Molteni 2010,
/// Comput. Phys. Commun. 181, 532, eq. 20). Particles of walls and of open sides take no part.
///
/// Shifting: what a particle of density rho_f eps/share changes by along its way s, s . (grad rho_f + rho_f grad
/// eps/eps) eps/share.
void even_out_own_density(SphFluid& fluid, const Weights& weights);

} // namespace plumb
