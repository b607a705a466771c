// What a scene says of the fluid on a grid.
#pragma once

#include "core/fluid_wall.hpp"
#include "core/table.hpp"
#include "grid/grid_fluid.hpp"
#include "schemes/stable_step.hpp"

#include <vector>

namespace plumb {

/// The fluid of a [fluid] table with method = "grid". Planes of `walls` that lie on a side of the box, inlets and
/// outlets are its sides; other walls are immersed. InputError for whatever cannot be meant.
GridFluid read_grid_fluid(Table& table, const Domain& domain, const std::vector<FluidWall>& walls,
                          std::vector<Table>& inlets, std::vector<Table>& outlets);

/// At the start, of inlets and of walls [m/s].
double greatest_speed(const GridFluid& fluid);

/// The step is implicit: nothing limits it but accuracy, at one cell a step for the greatest speed known before the
/// run.
std::vector<StepLimit> grid_limits(const GridFluid& fluid);

} // namespace plumb
