// Vectors of space. Fixed-size Eigen vectors are evaluated in a fixed order, so results do not depend on the machine.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <string_view>

namespace plumb {

using Vec3 = Eigen::Vector3d; // [m], [m/s], ... components x, y, z

inline constexpr std::string_view axis_names = "xyz";

} // namespace plumb
