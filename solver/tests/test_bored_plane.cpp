// A plane with a round bore as a wall.
#include "core/errors.hpp"
#include "core/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace plumb {
namespace {

const std::string text = "point = [1, 2, 3]\nnormal = [0, 0, 2]\nradius = 0.5\n";

BoredPlane shape_of(const std::string& toml) {
    Table table(toml::parse(toml), "wall", "scene.toml");
    BoredPlane shape(table);
    table.finish();
    return shape;
}

WallPoint nearest(const Vec3& from_point) {
    WallPoint found{};
    int met = 0;
    shape_of(text).touch(Vec3(1.0, 2.0, 3.0) + from_point, 10.0, [&](const WallPoint& p) {
        found = p;
        ++met;
    });
    EXPECT_EQ(met, 1);
    return found;
}

void expect_point(const Vec3& from_point, double distance, const Vec3& normal) {
    const WallPoint p = nearest(from_point);
    EXPECT_NEAR(p.distance, distance, 1e-15);
    EXPECT_NEAR((p.normal - normal).norm(), 0.0, 1e-15) << p.normal.transpose();
}

TEST(BoredPlane, PlaneRimAndBore) {
    expect_point({0.7, 0.0, 0.3}, 0.3, Vec3::UnitZ());                // above the plane
    expect_point({0.0, -0.2, 0.4}, 0.5, Vec3(0.0, 0.6, 0.8));         // above the mouth: 3, 4, 5 to the rim
    expect_point({-0.3, 0.0, -0.1}, 0.2, Vec3::UnitX());              // in the bore
    expect_point({0.0, 0.9, -0.1}, -0.1, Vec3::UnitZ());              // in the solid, nearer to the plane
    expect_point({0.0, 0.6, -3.0}, -0.1, -Vec3::UnitY());             // in the solid, nearer to the bore
    EXPECT_NEAR(nearest({0.0, 0.0, 0.0}).distance, 0.5, 1e-15);       // on the axis: to the rim
    EXPECT_NEAR(nearest({0.0, 0.0, -1.0}).normal.norm(), 1.0, 1e-15); // some direction across it
    EXPECT_NEAR(nearest({0.0, 0.0, -1.0}).normal.dot(Vec3::UnitZ()), 0.0, 1e-15);
}

TEST(BoredPlane, DistanceIsThatOfTheSolid) { // along any line it changes by no more than the way
    const BoredPlane shape = shape_of(text);
    const auto distance = [&](const Vec3& x) {
        double found = 1e9;
        shape.touch(x, 1e3, [&](const WallPoint& p) { found = p.distance; });
        return found;
    };
    for (int k = 0; k < 2000; ++k) {
        const Vec3 a(1.0 + std::sin(1.0 * k), 2.0 + std::sin(2.3 * k), 3.0 + std::sin(3.7 * k));
        const Vec3 b = a + 0.01 * Vec3(std::cos(5.1 * k), std::cos(0.7 * k), std::cos(1.9 * k));
        EXPECT_LE(std::abs(distance(a) - distance(b)), (a - b).norm() * (1.0 + 1e-9));
    }
}

TEST(BoredPlane, RefusesBadTables) {
    EXPECT_THROW(shape_of("point = [1, 2, 3]\nnormal = [0, 0, 0]\nradius = 0.5\n"), InputError);
    EXPECT_THROW(shape_of("point = [1, 2, 3]\nnormal = [0, 0, 1]\nradius = 0.0\n"), InputError);
    EXPECT_THROW(shape_of("point = [1, 2]\nnormal = [0, 1]\nradius = 0.5\n"), InputError);
}

} // namespace
} // namespace plumb
