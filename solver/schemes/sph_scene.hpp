// The fluid of scenes with fluid.method = "sph": what its table says, and how long its step may be.
#pragma once

#include "core/table.hpp"
#include "schemes/stable_step.hpp"
#include "sph/fluid.hpp"
#include "sph/wall_particles.hpp"

#include <vector>

namespace plumb {

/// The walls of the fluid: shapes, velocities and `slip`; for a mesh also `fluid_side`.
std::vector<FluidWall> read_fluid_walls(std::vector<Table>& tables, const Domain& domain);

/// The planes of the [[inlet]] and [[outlet]] tables.
std::vector<OpenSide> read_open_sides(std::vector<Table>& inlets, std::vector<Table>& outlets, const Domain& domain);

/// Reads the [fluid] table and puts the particles in place, those of the walls as well. InputError for whatever cannot
/// be meant.
SphFluid read_sph_fluid(Table& table, const Domain& domain, const std::vector<FluidWall>& walls,
                        const std::vector<OpenSide>& open_sides);

/// Bounds of the step: a sound wave and the body force may each move by a share of h, diffusion of momentum and
/// shifting undo a share of what they find.
std::vector<StepLimit> fluid_limits(const SphFluid& fluid);

} // namespace plumb
