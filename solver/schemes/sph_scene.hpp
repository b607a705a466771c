// The fluid of scenes with fluid.method = "sph": what its table says, and how long its step may be.
#pragma once

#include "core/table.hpp"
#include "schemes/stable_step.hpp"
#include "sph/fluid.hpp"

#include <vector>

namespace plumb {

/// Reads the [fluid] table and puts the particles in place. InputError for whatever cannot be meant.
SphFluid read_sph_fluid(Table& table, const Domain& domain);

/// Bounds of the step: a sound wave and the body force may each move by a share of h, diffusion of momentum and
/// shifting undo a share of what they find.
std::vector<StepLimit> fluid_limits(const SphFluid& fluid);

} // namespace plumb
