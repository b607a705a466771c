// One entry of a field of vectors.
#pragma once

#include "core/vec.hpp"
#include "sph/clusters.hpp"

namespace plumb {

/// The vector in slot k; z is 0 in the plane.
inline Vec3 vector_at(const VectorField& field, std::size_t k, int dimensions) {
    Vec3 value = Vec3::Zero();
    for (int c = 0; c < dimensions; ++c) value[c] = field[static_cast<std::size_t>(c)][k];
    return value;
}

} // namespace plumb
