// Walls as the fluid meets them.
#pragma once

#include "core/walls.hpp"

namespace plumb {

/// A wall as the fluid meets it.
struct FluidWall {
    WallBody body;
    bool slips = false;           // free slip; otherwise the fluid sticks
    bool fluid_is_inside = false; // of a closed mesh; other shapes know their side
};

} // namespace plumb
