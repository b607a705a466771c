// The box in which everything happens.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cmath>

namespace plumb {

/// Axis-aligned box [0, size]; sides are periodic or open (a wall is a separate thing).
struct Domain {
    Vec3 size = Vec3::Zero(); // [m]
    std::array<bool, 3> periodic{};
    Vec3 gravity = Vec3::Zero(); // [m/s2]
    int dimensions = 3;          // 2: size, gravity and positions have no z

    /// Shortest vector equivalent to the difference dx of two positions.
    Vec3 minimum_image(Vec3 dx) const {
        for (Eigen::Index c = 0; c < 3; ++c)
            if (periodic[static_cast<std::size_t>(c)]) dx[c] -= size[c] * std::nearbyint(dx[c] / size[c]);
        return dx;
    }
    /// The equivalent of x inside the box along periodic axes; others are left alone.
    Vec3 wrapped(Vec3 x) const {
        for (Eigen::Index c = 0; c < 3; ++c)
            if (periodic[static_cast<std::size_t>(c)]) {
                x[c] -= size[c] * std::floor(x[c] / size[c]);
                // The product is rounded, so the difference may end up just outside: the far side is the near one.
                if (x[c] < 0.0 || x[c] >= size[c]) x[c] = 0.0;
            }
        return x;
    }
};

} // namespace plumb
