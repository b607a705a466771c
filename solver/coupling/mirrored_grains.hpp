// Grains mirrored in the walls that hold them. What a kernel would put behind a wall comes back from the mirrored
// grain, so that an even bed is even up to the wall: exactly at planes and in corners of planes. At round walls a
// mirrored grain counts for exactly what its kernel leaves behind the wall, so no room is lost; even beds are then even
// within half a per cent for kernels of a sixth of the wall's radius.
#pragma once

#include "core/vec.hpp"
#include "core/walls.hpp"
#include "coupling/porosity_laws.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

/// Which grain, and in which walls: one, or in corners up to three, one after the other.
struct Mirror {
    std::int32_t grain; // by id
    std::array<std::int32_t, 3> wall{-1, -1, -1}, element{-1, -1, -1};
};

/// What a mirrored grain counts for over the grain itself, by the grain's distance from a round wall: of the kernel,
/// the share of the grain behind the wall over the share of the mirrored one before it. Linear between entries.
struct MirrorShare {
    double step = 0.0;         // of the distance [m]; 0 at a plane, where it is 1
    std::vector<double> share; // [-]
    double operator()(double distance) const;
    double slope(double distance) const; // [1/m]
};

struct MirroredGrains {
    bool wanted = false;
    std::vector<MirrorShare> share_of_wall;
    std::vector<Mirror> of;     // by mirror
    std::vector<Vec3> x;        // [m]
    std::vector<double> volume; // with which they count [m3]
    std::size_t size() const { return of.size(); }
};

/// Where a mirror is, what it counts for, and how both change with the place of the grain.
struct Reflection {
    Vec3 x;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity(); // d x/d x_grain
    double share = 1.0;
    Vec3 share_gradient = Vec3::Zero(); // [1/m]
};

/// Whether grains can be mirrored in a wall of this shape.
bool has_mirror(const Wall& wall);

/// Gets ready for the kernel with which grains count in the porosity.
void prepare_mirrors(MirroredGrains& mirrored, const std::vector<WallBody>& walls, const SpaceKernel& kernel);

/// Chooses the mirrors of grains at x nearer than `reach` [m] to walls at rest, and places them.
void choose_mirrors(MirroredGrains& mirrored, const std::vector<WallBody>& walls, const std::vector<Vec3>& x,
                    const std::vector<double>& volume, double reach);

/// Places the mirrors of grains that are at x now.
void place_mirrors(MirroredGrains& mirrored, const std::vector<WallBody>& walls, const std::vector<Vec3>& x,
                   const std::vector<double>& volume);

/// Of a grain at x.
Reflection reflection(const MirroredGrains& mirrored, const Mirror& mirror, const std::vector<WallBody>& walls,
                      const Vec3& x);

} // namespace plumb
