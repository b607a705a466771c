// The step of the smoothed particles.
#pragma once

#include "sph/fluid.hpp"

#include <cstdint>

namespace plumb {

/// One step of the midpoint rule with a single evaluation:
///     x* = x + dt/2 v      v* = v + dt/2 a_before      rho* = rho + dt/2 rho'_before
///     a, rho' = terms(x*, v*, rho*) + sources(x*, t + dt/2)
///     v <- v + dt a        rho <- rho + dt rho'        x <- x* + dt/2 v
/// With a memory b > 0 (integrator "damped_midpoint", b = 1/2) the rates of the predictor are (1 + b) a_before - b
/// times those of the step before. Second order: the predicted v* and rho* are off by O(dt^2). v and rho then follow
/// the Adams-Bashforth formulas (b = 0: the second order one, b = 5/6: the third): a decay rate s is stable for s dt <
/// 1/(1 + b), sound of frequency w grows by (1/4 - 3 b/4) w^4 dt^3 per second, so it is damped from b = 1/3 on. Walls
/// and open sides are particles whose state is made from the fluid's in every evaluation (sph/boundary.hpp). Throws
/// Diverged in the step in which a particle's speed or density stops being finite, its speed passes the speed of sound,
/// or its density changes by half.
void advance_fluid(SphFluid& fluid, double dt, std::int64_t step);

/// Its three parts, for schemes that do more in the middle. The first moves particles to the middle of the step and
/// returns true when the lists were renewed; the second evaluates the rates there; the third uses them.
bool go_to_middle(SphFluid& fluid, double dt, std::int64_t step);
void evaluate_middle(SphFluid& fluid, double dt, std::int64_t step);
void go_to_end(SphFluid& fluid, double dt, std::int64_t step);

/// Builds lists and evaluates the rates of the present state, once, before the first step.
void start(SphFluid& fluid);

} // namespace plumb
