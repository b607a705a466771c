#include "core/walls.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {
namespace {

Table table_of(std::string_view text) { return Table(toml::parse(text), "wall", "scene.toml"); }

template <class Shape> Shape shape_of(std::string_view text) {
    Table table = table_of(text);
    Shape shape(table);
    table.finish();
    return shape;
}

template <class Shape> std::vector<WallPoint> touched(const Shape& shape, const Vec3& x, double reach) {
    std::vector<WallPoint> found;
    shape.touch(x, reach, [&](const WallPoint& p) { found.push_back(p); });
    return found;
}

Vec3 random_point(Random& random, double lower, double upper) {
    const double x = random.uniform(lower, upper), y = random.uniform(lower, upper);
    return {x, y, random.uniform(lower, upper)};
}

TEST(Plane, DistanceAndNormal) {
    const auto plane = shape_of<Plane>("point = [0, 0, 1]\nnormal = [0, 3, 4]");
    EXPECT_DOUBLE_EQ(plane.normal.norm(), 1.0);
    auto found = touched(plane, {7.0, 5.0, 1.0}, 3.1); // 5 * 3/5 = 3
    ASSERT_EQ(found.size(), 1U);
    EXPECT_DOUBLE_EQ(found[0].distance, 3.0);
    EXPECT_TRUE(found[0].normal.isApprox(Vec3(0.0, 0.6, 0.8)));
    EXPECT_TRUE(touched(plane, {7.0, 5.0, 1.0}, 2.9).empty());
    found = touched(plane, {0.0, -5.0, 1.0}, 1.0);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_DOUBLE_EQ(found[0].distance, -3.0); // behind
}

TEST(Plane, RefusesAZeroNormal) {
    EXPECT_THROW(shape_of<Plane>("point = [0, 0, 1]\nnormal = [0, 0, 0]"), InputError);
    EXPECT_NEAR(shape_of<Plane>("point = [0, 0, 0]\nnormal = [1e-300, 0, 1e-300]").normal.norm(), 1.0, 1e-15);
}

TEST(Box, TouchesUpToThreeFaces) {
    const auto box = shape_of<Box>("lower = [0, 0, 0]\nupper = [1, 2, 3]");
    EXPECT_TRUE(touched(box, {0.5, 1.0, 1.5}, 0.4).empty());
    const auto found = touched(box, {0.1, 1.8, 2.7}, 0.4);
    ASSERT_EQ(found.size(), 3U);
    const std::array<std::int32_t, 3> elements{0, 3, 5};
    const std::array<double, 3> distances{0.1, 0.2, 0.3};
    const std::array<Vec3, 3> normals{Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1)};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(found[k].element, elements[k]);
        EXPECT_NEAR(found[k].distance, distances[k], 1e-15);
        EXPECT_EQ(found[k].normal, normals[k]);
    }
    EXPECT_EQ(touched(box, {0.5, 1.0, 1.5}, 10.0).size(), 6U);
    EXPECT_THROW(shape_of<Box>("lower = [0, 0, 0]\nupper = [1, 0, 3]"), InputError);
}

TEST(SolidBox, NearestPointIsOnAFaceAnEdgeOrACorner) {
    const auto box = shape_of<SolidBox>("lower = [0, 0, 0]\nupper = [1, 2, 3]");
    auto found = touched(box, {0.5, 2.25, 1.0}, 0.3);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_DOUBLE_EQ(found[0].distance, 0.25);
    EXPECT_EQ(found[0].normal, Vec3::UnitY());
    found = touched(box, {1.3, 2.4, 1.0}, 1.0); // an edge, 0.3 and 0.4 away
    EXPECT_DOUBLE_EQ(found.at(0).distance, 0.5);
    EXPECT_TRUE(found[0].normal.isApprox(Vec3(0.6, 0.8, 0.0)));
    found = touched(box, {-2.0, -1.0, -2.0}, 4.0); // a corner
    EXPECT_DOUBLE_EQ(found.at(0).distance, 3.0);
    found = touched(box, {0.9, 1.0, 1.5}, 0.0); // inside: the nearest face
    EXPECT_NEAR(found.at(0).distance, -0.1, 1e-15);
    EXPECT_EQ(found[0].normal, Vec3::UnitX());
    EXPECT_TRUE(touched(box, {0.5, 2.25, 1.0}, 0.2).empty());
    const auto plane = shape_of<SolidBox>("lower = [0, 0]\nupper = [1, 2]"); // across the plane without end
    EXPECT_NEAR(touched(plane, {1.3, 2.4, 1e9}, 1.0).at(0).distance, 0.5, 1e-15);
    EXPECT_NEAR(touched(plane, {0.9, 1.0, -7.0}, 1.0).at(0).distance, -0.1, 1e-15);
}

TEST(Cylinder, InsideAndOutside) {
    // Axis along (0, 1, 1)/sqrt 2 through (1, 0, 0); (1, 1, -1) t is across it at distance sqrt 2 t.
    const std::string_view common = "point = [1, 0, 0]\naxis = [0, 2, 2]\nradius = 2.0\n";
    const auto inside = shape_of<Cylinder>(std::string(common) + "side = 'inside'");
    const auto outside = shape_of<Cylinder>(std::string(common) + "side = 'outside'");
    const double h = std::numbers::sqrt2 / 2.0;
    const Vec3 outward(0.0, h, -h), along(0.0, 5.0, 5.0);
    auto found = touched(inside, Vec3(1, 0, 0) + along + 1.5 * outward, 0.6);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].distance, 0.5, 1e-14);
    EXPECT_TRUE(found[0].normal.isApprox(-outward, 1e-14));
    EXPECT_TRUE(touched(inside, Vec3(1, 0, 0) + along + 1.3 * outward, 0.6).empty());
    found = touched(outside, Vec3(1, 0, 0) - along + 2.5 * outward, 0.6);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].distance, 0.5, 1e-14);
    EXPECT_TRUE(found[0].normal.isApprox(outward, 1e-14));
    found = touched(inside, Vec3(1, 0, 0), 3.0); // on the axis
    ASSERT_EQ(found.size(), 1U);
    EXPECT_DOUBLE_EQ(found[0].distance, 2.0);
    EXPECT_NEAR(found[0].normal.norm(), 1.0, 1e-15);
    EXPECT_THROW(shape_of<Cylinder>("point = [1, 0, 0]\naxis = [0, 0, 0]\nradius = 2.0\nside = 'inside'"), InputError);
    EXPECT_THROW(shape_of<Cylinder>("point = [1, 0, 0]\naxis = [0, 0, 1]\nradius = 0.0\nside = 'inside'"), InputError);
    EXPECT_THROW(shape_of<Cylinder>(std::string(common) + "side = 'left'"), InputError);
}

TEST(Walls, AreReadFromTheirTables) {
    const auto toml = toml::parse(R"(
        [[wall]]
        name = "floor"
        shape = "plane"
        point = [0, 0, 0]
        normal = [0, 0, 1]
        velocity = [0, 0, 2]
        [[wall]]
        name = "tube"
        shape = "cylinder"
        point = [0, 0, 0]
        axis = [0, 0, 1]
        radius = 1.0
        side = "inside")");
    Table scene(toml, "", "scene.toml");
    auto tables = scene.tables("wall");
    const std::vector<WallBody> walls = make_walls(tables);
    scene.finish();
    ASSERT_EQ(walls.size(), 2U);
    EXPECT_EQ(walls[1].name, "tube");
    EXPECT_EQ(walls[1].velocity, Vec3::Zero());
    // The floor has risen to z = 1 at t = 0.5.
    std::vector<WallPoint> found;
    walls[0].touch({0.0, 0.0, 1.25}, 0.5, 0.5, [&](const WallPoint& p) { found.push_back(p); });
    ASSERT_EQ(found.size(), 1U);
    EXPECT_DOUBLE_EQ(found[0].distance, 0.25);

    const auto fails = [](std::string_view text) {
        const auto parsed = toml::parse(text);
        Table bad(parsed, "", "scene.toml");
        auto entries = bad.tables("wall");
        EXPECT_THROW(make_walls(entries), InputError) << text;
    };
    fails("[[wall]]\nname = 'a'\nshape = 'sphere'");
    fails("[[wall]]\nname = 'a'\nshape = 'stl'\npath = 'nowhere.stl'");
    fails("[[wall]]\nshape = 'plane'\npoint = [0,0,0]\nnormal = [0,0,1]");
    fails("[[wall]]\nname = 'a'\nshape = 'plane'\npoint = [0,0,0]\nnormal = [0,0,1]\n"
          "[[wall]]\nname = 'a'\nshape = 'plane'\npoint = [0,0,0]\nnormal = [0,0,1]");
}

// --- triangle meshes ---

using Soup = std::vector<Vec3>;

void add(Soup& soup, const Vec3& a, const Vec3& b, const Vec3& c) { soup.insert(soup.end(), {a, b, c}); }

/// A parallelogram of n x n cells, each cut along a random diagonal.
void add_sheet(Soup& soup, const Vec3& corner, const Vec3& u, const Vec3& w, int n, Random& random) {
    // Each point once: with contracted multiply-adds the same expression in two places may differ in its last bit.
    std::vector<Vec3> points;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) points.push_back(corner + u * (double(i) / n) + w * (double(j) / n));
    const auto at = [&](int i, int j) { return points[static_cast<std::size_t>(i * (n + 1) + j)]; };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if (random.uniform() < 0.5)
                add(soup, a, b, c), add(soup, a, c, d);
            else
                add(soup, a, b, d), add(soup, d, b, c); // and the other orientation of the loop does not matter
        }
}

/// Coordinates as a binary file would hold them.
Soup in_single_precision(Soup soup) {
    for (Vec3& p : soup)
        for (double& x : p) {
            volatile float rounded =
                static_cast<float>(x); // g++ 12 -O3 drops the rounding of cast<float>().cast<double>()
            x = static_cast<double>(rounded);
        }
    return soup;
}

Soup cube(int n, Random& random) {
    Soup soup;
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), o(0, 0, 0);
    add_sheet(soup, o, x, y, n, random), add_sheet(soup, z, x, y, n, random);
    add_sheet(soup, o, y, z, n, random), add_sheet(soup, x, y, z, n, random);
    add_sheet(soup, o, z, x, n, random), add_sheet(soup, y, z, x, n, random);
    return soup;
}

/// Slow twin of the distance to a triangle, by another route: the plane if the foot is inside, else the three segments.
double plain_distance(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    Eigen::Matrix<double, 3, 2> sides;
    sides << b - a, c - a;
    const Eigen::Vector2d uw = (sides.transpose() * sides).inverse() * (sides.transpose() * (x - a));
    if (uw[0] >= 0.0 && uw[1] >= 0.0 && uw.sum() <= 1.0) return (x - a - sides * uw).norm();
    const auto to_segment = [&](const Vec3& p, const Vec3& q) {
        const double s = std::clamp((x - p).dot(q - p) / (q - p).squaredNorm(), 0.0, 1.0);
        return (x - p - s * (q - p)).norm();
    };
    return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

TEST(TriangleMesh, NearestPointAgreesWithAllTriangles) {
    Random random(1);
    Soup soup;
    for (int t = 0; t < 300; ++t) {
        const Vec3 a = random_point(random, 0.0, 1.0);
        add(soup, a, a + random_point(random, -0.3, 0.3), a + random_point(random, -0.3, 0.3));
    }
    const TriangleMesh mesh(joined_triangles(soup));
    for (int trial = 0; trial < 3000; ++trial) {
        const Vec3 x = random_point(random, -0.2, 1.2);
        const double reach = random.uniform(0.0, 0.3);
        double nearest = std::numeric_limits<double>::max();
        for (std::size_t t = 0; t < soup.size(); t += 3)
            nearest = std::min(nearest, plain_distance(x, soup[t], soup[t + 1], soup[t + 2]));
        const auto found = touched(mesh, x, reach);
        ASSERT_EQ(found.empty(), nearest >= reach);
        if (found.empty()) continue;
        EXPECT_NEAR(found[0].distance, nearest, 1e-12);
        EXPECT_NEAR(found[0].normal.norm(), 1.0, 1e-12);
        for (const WallPoint& p : found) EXPECT_LT(p.distance, reach);
    }
}

TEST(TriangleMesh, ASmoothFloorIsOneContactOfOneElement) {
    Random random(2);
    const Vec3 u = Vec3(3.0, 0.4, 0.2), w = Vec3(-0.5, 2.0, 0.7); // no axis of the grid lies in the plane
    const Vec3 normal = u.cross(w).normalized(), corner(10.1, -3.3, 5.7);
    Soup soup;
    add_sheet(soup, corner, u, w, 17, random);
    for (const bool single : {false, true}) {
        const TriangleMesh mesh(joined_triangles(single ? in_single_precision(soup) : soup));
        EXPECT_EQ(mesh.face_count(), 1) << (single ? "single precision" : "double precision");
        const double accuracy = single ? 2e-6 : 1e-12; // single precision: 1e-6 at a coordinate of 10
        for (int trial = 0; trial < 20000; ++trial) {
            // Every third above a grid line, every ninth above a grid point.
            double i = random.uniform(0.6, 16.4), j = random.uniform(0.6, 16.4);
            if (trial % 3 == 0) i = std::round(i);
            if (trial % 9 == 0) j = std::round(j);
            const double height = random.uniform(0.01, 0.05) * (trial % 2 == 0 ? 1.0 : -1.0);
            const auto found = touched(mesh, corner + u * (i / 17.0) + w * (j / 17.0) + normal * height, 0.05);
            ASSERT_EQ(found.size(), 1U);
            EXPECT_NEAR(found[0].distance, std::abs(height), accuracy);
            EXPECT_NEAR(found[0].normal.dot(normal) * (height > 0.0 ? 1.0 : -1.0), 1.0, accuracy);
            EXPECT_EQ(found[0].element, 0);
        }
    }
}

TEST(TriangleMesh, AFloorWhoseTrianglesDoNotShareCornersIsOneContact) {
    Soup soup; // a big triangle beside three small ones: corners of these lie on its side (T-junctions)
    add(soup, {0, 0, 0}, {3, 0, 0}, {1.5, -3, 0});
    for (int i = 0; i < 3; ++i) add(soup, {double(i), 0, 0}, {i + 1.0, 0, 0}, {1.5, 3, 0});
    const TriangleMesh mesh(joined_triangles(soup));
    Random random(3);
    for (int trial = 0; trial < 2000; ++trial) {
        const Vec3 x(random.uniform(0.9, 2.1), random.uniform(-0.5, 0.5), 0.4);
        const auto found = touched(mesh, x, 0.6);
        ASSERT_EQ(found.size(), 1U) << x.transpose();
        EXPECT_NEAR(found[0].distance, 0.4, 1e-12);
    }
}

TEST(TriangleMesh, AConvexBodyIsTouchedOnce) {
    Random random(4);
    const TriangleMesh mesh(joined_triangles(cube(5, random)));
    EXPECT_EQ(mesh.face_count(), 6);
    std::set<std::int32_t> elements;
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec3 x = random_point(random, -0.4, 1.4);
        const Vec3 foot = x.cwiseMax(0.0).cwiseMin(1.0); // nearest point of the cube
        const double distance = (x - foot).norm();
        if (distance == 0.0) continue; // inside
        const auto found = touched(mesh, x, 0.5);
        ASSERT_EQ(found.size(), distance < 0.5 ? 1U : 0U) << x.transpose();
        if (found.empty()) continue;
        EXPECT_NEAR(found[0].distance, distance, 1e-12);
        EXPECT_LT((found[0].normal - (x - foot) / distance).norm(), 1e-9);
        elements.insert(found[0].element);
    }
    EXPECT_EQ(elements.size(), 26U); // 6 faces, 12 edges, 8 corners, however many triangles
}

TEST(TriangleMesh, FromInsideACubeIsABox) {
    Random random(5);
    const TriangleMesh mesh(joined_triangles(cube(4, random)));
    const auto box = shape_of<Box>("lower = [0, 0, 0]\nupper = [1, 1, 1]");
    for (int trial = 0; trial < 20000; ++trial) {
        const Vec3 x = random_point(random, 0.02, 0.98);
        auto found = touched(mesh, x, 0.3), expected = touched(box, x, 0.3);
        ASSERT_EQ(found.size(), expected.size()) << x.transpose();
        const auto nearer = [](const WallPoint& a, const WallPoint& b) { return a.distance < b.distance; };
        std::sort(found.begin(), found.end(), nearer);
        std::sort(expected.begin(), expected.end(), nearer);
        for (std::size_t k = 0; k < found.size(); ++k) {
            EXPECT_NEAR(found[k].distance, expected[k].distance, 1e-12);
            EXPECT_LT((found[k].normal - expected[k].normal).norm(), 1e-12);
        }
    }
}

TEST(TriangleMesh, AValleyIsTouchedOnBothSides) {
    Soup soup; // two sheets rising at 30 degrees from the y axis
    Random random(6);
    const double c = std::numbers::sqrt3 / 2.0, s = 0.5;
    add_sheet(soup, {0, -1, 0}, {c, 0, s}, {0, 2, 0}, 3, random);
    add_sheet(soup, {0, -1, 0}, {-c, 0, s}, {0, 2, 0}, 3, random);
    const TriangleMesh mesh(joined_triangles(soup));
    const auto found = touched(mesh, {0.0, 0.1, 0.2}, 0.2);
    ASSERT_EQ(found.size(), 2U);
    for (const WallPoint& p : found) {
        EXPECT_NEAR(p.distance, 0.2 * c, 1e-15);
        EXPECT_NEAR(p.normal.z(), c, 1e-15);
    }
    EXPECT_NEAR(found[0].normal.x() + found[1].normal.x(), 0.0, 1e-15);
    EXPECT_NE(found[0].element, found[1].element);
    // Near one side only: the foot on the other lies beyond the valley, where the first is nearer.
    EXPECT_EQ(touched(mesh, {0.4, 0.1, 0.4}, 0.2).size(), 1U);
    // From below it is a convex ridge: its edge, one element along its whole length.
    std::set<std::int32_t> elements;
    for (double y = -0.95; y < 0.95; y += 0.01) {
        const auto ridge = touched(mesh, {0.01, y, -0.1}, 0.15);
        ASSERT_EQ(ridge.size(), 1U);
        EXPECT_NEAR(ridge[0].distance, std::hypot(0.01, 0.1), 1e-15);
        elements.insert(ridge[0].element);
    }
    EXPECT_EQ(elements.size(), 1U);
}

TEST(TriangleMesh, AThinPlateIsTouchedOnItsNearSideOnly) {
    Soup soup;
    Random random(7);
    add_sheet(soup, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, random);
    add_sheet(soup, {0, 0, -0.01}, {1, 0, 0}, {0, 1, 0}, 3, random);
    const TriangleMesh mesh(joined_triangles(soup));
    const auto above = touched(mesh, {0.4, 0.6, 0.2}, 0.25), below = touched(mesh, {0.4, 0.6, -0.21}, 0.25);
    ASSERT_EQ(above.size(), 1U);
    ASSERT_EQ(below.size(), 1U);
    EXPECT_NEAR(above[0].distance, 0.2, 1e-15);
    EXPECT_NEAR(below[0].distance, 0.2, 1e-15);
    EXPECT_EQ(above[0].normal, Vec3(0, 0, 1));
    EXPECT_EQ(below[0].normal, Vec3(0, 0, -1));
}

TEST(TriangleMesh, SeparatePartsAreTouchedSeparately) {
    Soup soup; // two posts of a gate, and the sphere between their edges
    add(soup, {-0.5, 0, -1}, {-0.5, 0, 1}, {-2, 0, 0});
    add(soup, {0.5, 0, -1}, {0.5, 0, 1}, {2, 0, 0});
    const TriangleMesh mesh(joined_triangles(soup));
    const auto found = touched(mesh, {0.1, 0.0, 0.0}, 0.7);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_NEAR(found[0].distance, 0.4, 1e-15);
    EXPECT_EQ(found[0].normal, Vec3(-1, 0, 0));
    EXPECT_NEAR(found[1].distance, 0.6, 1e-15);
    EXPECT_EQ(found[1].normal, Vec3(1, 0, 0));
}

TEST(TriangleMesh, ACentreOnTheMeshHasANormal) {
    Soup soup;
    add(soup, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const TriangleMesh mesh(joined_triangles(soup));
    for (const Vec3& x : {Vec3(0.2, 0.2, 0.0), Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)}) {
        const auto found = touched(mesh, x, 0.1);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_EQ(found[0].distance, 0.0);
        EXPECT_EQ(found[0].normal, Vec3(0, 0, 1));
    }
    EXPECT_TRUE(touched(mesh, {0.2, 0.2, 0.1}, 0.0).empty());
}

} // namespace
} // namespace plumb
