// Closed meshes as walls of the smoothed particles.
#include "sph/wall_particles.hpp"

#include <gtest/gtest.h>

using namespace plumb;

namespace {

/// The cube [0.3, 0.7]^3, corners in any order of turning.
TriangleMesh cube() {
    std::vector<Vec3> soup;
    for (int axis = 0; axis < 3; ++axis)
        for (const double at : {0.3, 0.7}) {
            const auto corner = [&](double a, double b) {
                Vec3 x;
                x[axis] = at, x[(axis + 1) % 3] = a, x[(axis + 2) % 3] = b;
                return x;
            };
            const std::array<Vec3, 4> face{corner(0.3, 0.3), corner(0.7, 0.3), corner(0.7, 0.7), corner(0.3, 0.7)};
            const bool outward = at > 0.5;
            for (const auto& t : {std::array{0, 1, 2}, std::array{0, 2, 3}})
                for (int k = 0; k < 3; ++k)
                    soup.push_back(face[static_cast<std::size_t>(t[static_cast<std::size_t>(outward ? k : 2 - k)])]);
        }
    return TriangleMesh(joined_triangles(soup));
}

} // namespace

// A mesh that is solid on the wrong side, or a depth measured from the wrong face.
TEST(SphWalls, ClosedMeshesKnowTheirSide) {
    std::vector<FluidWall> block{{WallBody{"block", cube()}, false, false}}, vessel = block;
    vessel[0].fluid_is_inside = true;
    const Vec3 inside(0.5, 0.45, 0.36), outside(0.2, 0.5, 0.5);
    EXPECT_TRUE(is_solid(block, inside));
    EXPECT_FALSE(is_solid(block, outside));
    EXPECT_FALSE(is_solid(vessel, inside));
    EXPECT_TRUE(is_solid(vessel, outside));
    const Penetration deep = penetration(block, inside, 0.0, 1.0);
    EXPECT_NEAR(deep.depth, 0.06, 1e-12);
    EXPECT_LT((deep.normal - Vec3(0.0, 0.0, -1.0)).norm(), 1e-9); // out of the block, into the fluid
    const Penetration out = penetration(vessel, outside, 0.0, 1.0);
    EXPECT_NEAR(out.depth, 0.1, 1e-12);
    EXPECT_LT((out.normal - Vec3(1.0, 0.0, 0.0)).norm(), 1e-9);
    EXPECT_EQ(penetration(block, inside, 0.0, 0.01).depth, 0.0); // farther from the surface than is asked for
}
