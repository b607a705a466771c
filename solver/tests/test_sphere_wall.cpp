// A sphere as a wall.
#include "core/errors.hpp"
#include "core/walls.hpp"

#include <gtest/gtest.h>

#include <string>

namespace plumb {
namespace {

template <class Shape> Shape shape_of(const std::string& text) {
    Table table(toml::parse(text), "wall", "scene.toml");
    Shape shape(table);
    table.finish();
    return shape;
}

TEST(SphereWall, InsideAndOutside) {
    const std::string common = "centre = [1, 2, 3]\nradius = 2.0\n";
    const auto inside = shape_of<SphereWall>(common + "side = 'inside'");
    const auto outside = shape_of<SphereWall>(common + "side = 'outside'");
    int met = 0;
    inside.touch(Vec3(1.0, 2.0, 4.5), 1.0, [&](const WallPoint& p) {
        EXPECT_DOUBLE_EQ(p.distance, 0.5);
        EXPECT_EQ(p.normal, Vec3(0.0, 0.0, -1.0));
        ++met;
    });
    outside.touch(Vec3(1.0, 4.5, 3.0), 1.0, [&](const WallPoint& p) {
        EXPECT_DOUBLE_EQ(p.distance, 0.5);
        EXPECT_EQ(p.normal, Vec3(0.0, 1.0, 0.0));
        ++met;
    });
    outside.touch(Vec3(1.0, 2.0, 3.0), 1.0, [&](const WallPoint& p) { // the centre: deepest, with some direction
        EXPECT_DOUBLE_EQ(p.distance, -2.0);
        EXPECT_DOUBLE_EQ(p.normal.norm(), 1.0);
        ++met;
    });
    outside.touch(Vec3(1.0, 6.0, 3.0), 1.0, [&](const WallPoint&) { ADD_FAILURE(); });
    EXPECT_EQ(met, 3);
    EXPECT_THROW(shape_of<SphereWall>("centre = [1, 2, 3]\nradius = 0.0\nside = 'inside'"), InputError);
    EXPECT_THROW(shape_of<SphereWall>(common + "side = 'left'"), InputError);
}

} // namespace
} // namespace plumb
