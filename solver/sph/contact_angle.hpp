// Where a wall is wet, for the surface tension of the fluid in front of it.
#pragma once

#include "sph/fluid.hpp"

namespace plumb {

/// Colours of the walls' particles: 1 where the fluid, mirrored, would be, 0 where not. The surface then meets the wall
/// at a right angle.
void mirror_colour(SphFluid& fluid);

/// The same with the surface continued straight into the wall at its contact angle, from the layer's points near the
/// mirror point: n = -cos(angle) N + sin(angle) t, with N the wall's normal and t the direction along the wall into the
/// wet. A surface that meets the wall at another angle then has a kink there, whose curvature moves it.
void continue_colour(SphFluid& fluid);

} // namespace plumb
