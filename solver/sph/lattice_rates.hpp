// How fast the sums over neighbours can change anything: the greatest rate of all waves on the lattice that particles
// start from. Short waves, whose crests meet the neighbours' troughs, feel more than the average over directions and
// phases: for the viscous forms along the line of centres up to 1.6 times as much.
#pragma once

#include "sph/fluid.hpp"

namespace plumb {

/// Greatest rate at which the viscous term and artificial viscosity damp a velocity [1/s]; 0 without either.
double greatest_viscous_rate(const SphFluid& fluid);

/// Greatest rate at which density diffusion evens out a density [1/s]; 0 without it.
double greatest_diffusion_rate(const SphFluid& fluid);

/// Greatest rate at which a shift down the gradient of the concentration undoes a displacement, for a diffusivity of
/// positions of 1 m2/s [1/m2].
double greatest_concentration_rate(const SphFluid& fluid);

} // namespace plumb
