// Reader of triangle meshes in the STL format (3D Systems, 1989), binary and ASCII.
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

/// Triangles with shared corners. The normals in the file are ignored: they follow from the corners.
struct Triangles {
    std::vector<Vec3> points;                         // distinct corners [m]
    std::vector<std::array<std::int32_t, 3>> corners; // three indices into points per triangle
};

/// Joins corners with exactly equal coordinates. `soup` has three points per triangle.
Triangles joined_triangles(const std::vector<Vec3>& soup);

/// True if the triangle is so thin that its plane means nothing: its height is below 1e-6 of its longest side, which
/// is the resolution of the single-precision numbers in a binary file.
bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c);

/// The mesh in the file `path`, times `scale` (file units to metres). InputError naming the file if it is missing, a
/// directory, empty, truncated, neither kind of STL, or has a non-finite coordinate or a degenerate triangle.
Triangles read_stl(const std::string& path, double scale);

} // namespace plumb
