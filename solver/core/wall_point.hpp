// Where a sphere touches a wall.
#pragma once

#include "core/vec.hpp"

#include <cstdint>

namespace plumb {

struct WallPoint {
    Vec3 normal;          // unit vector from the wall to the grain's centre
    double distance;      // from the centre to the wall [m]; negative behind a plane
    std::int32_t element; // part of the wall (face, triangle): a tangential spring belongs to (grain, wall, element)
};

} // namespace plumb
