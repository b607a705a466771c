// What the [coupling] table says of a fluid on a grid and grains.
#pragma once

#include "core/table.hpp"
#include "schemes/advance_grid_coupled.hpp"

namespace plumb {

/// Kernel, width, bounds and the direction.
GridCoupling read_grid_coupling(Table& coupling, const GridFluid& fluid, const GrainSystem& grains);

/// The forces of the fluid on the grains. `full_pressure`: the fluid's pressure holds its weight.
FluidOnGrains fluid_on_grains(Table& coupling, const GridFluid& fluid, bool full_pressure);

/// A mean pressure gradient, if the scene names one.
void drive(Table& coupling, GridFluid& fluid, FluidOnGrains& on_grains, const GridCoupling& state,
           const GrainSystem& grains);

} // namespace plumb
