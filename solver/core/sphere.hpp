// Solid spheres.
#pragma once

#include <numbers>

namespace plumb {

/// pi d^3/6 [m3] of a sphere of diameter d [m].
inline double sphere_volume(double diameter) { return std::numbers::pi / 6.0 * diameter * diameter * diameter; }

/// 2/5 m R^2 = m d^2/10 [kg m2] about an axis through the centre.
inline double sphere_inertia(double mass, double diameter) { return 0.1 * mass * diameter * diameter; }

} // namespace plumb
