// The step of the fluid on a grid.
#pragma once

#include "grid/grid_fluid.hpp"

#include <cstdint>

namespace plumb {

/// Whether the next step is of second order in time: the fluid is to be so, and two of its steps are known.
bool two_steps_known(const GridFluid& fluid);

/// One step, implicit in everything but the velocity that carries momentum, which is continued from the last steps:
///     M (3 u^n+1 - 4 u^n + u^n-1)/(2 dt) + C(2 u^n - u^n-1) u^n+1 + K u^n+1 - D^T p = f,    D u^n+1 = -V d(eps)/dt
/// second order in dt, or with `second_order` false
///     M (u^n+1 - u^n)/dt + C(u^n) u^n+1 + K u^n+1 - D^T p = f,
/// as in the first step of either. With grains foreseen D u^n+1 has what they carry beside the fluid, and D^T p what
/// they hand on (ForeseenGrains). No step is too long. Throws Diverged when the equations cannot be solved to the
/// fluid's residual or a velocity stops being finite.
void advance_grid(GridFluid& fluid, double dt, std::int64_t step);

} // namespace plumb
