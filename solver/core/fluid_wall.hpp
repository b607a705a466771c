// Walls as the fluid meets them.
#pragma once

#include "core/walls.hpp"

#include <limits>

namespace plumb {

/// A wall as the fluid meets it.
struct FluidWall {
    WallBody body;
    bool slips = false;                                            // free slip; otherwise the fluid sticks
    bool fluid_is_inside = false;                                  // of a closed mesh; other shapes know their side
    double cos_contact = std::numeric_limits<double>::quiet_NaN(); // of the angle at which a free surface meets it
};

} // namespace plumb
