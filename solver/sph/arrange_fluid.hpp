// Where the fluid's particles are at the start.
#pragma once

#include "sph/fluid.hpp"

namespace plumb {

/// Fills the box with a square (cubic) lattice of the fluid's spacing, particles in the middle of their cells, each
/// moved by up to `jitter` spacings along every axis. At rest, at rho_0; ids run along x fastest. Sides are whole
/// numbers of spacings.
void fill_box(SphFluid& fluid, double jitter, std::uint64_t seed);

} // namespace plumb
