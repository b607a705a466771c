// The step of the smoothed particles.
#pragma once

#include "sph/fluid.hpp"

#include <cstdint>

namespace plumb {

/// One step of the midpoint rule with a single evaluation:
///     x* = x + dt/2 v      v* = v + dt/2 a_before      rho* = rho + dt/2 rho'_before
///     a, rho' = terms(x*, v*, rho*) + sources(x*, t + dt/2)
///     v <- v + dt a        rho <- rho + dt rho'        x <- x* + dt/2 v
/// Second order: the predicted v* and rho* are off by O(dt^2). Throws Diverged in the step in which a particle's speed
/// or density stops being finite, its speed passes the speed of sound, or its density changes by half.
void advance_fluid(SphFluid& fluid, double dt, std::int64_t step);

/// Builds lists and evaluates the rates of the present state, once, before the first step.
void start(SphFluid& fluid);

} // namespace plumb
