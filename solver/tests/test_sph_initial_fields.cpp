// Initial fields that need more than a formula's repetition; the others are in test_sph_scene.cpp.
#include "core/initial_fields.hpp"

#include "fluid_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

// A wrong sign, centre or series: the middle of a square under lap p = 2 has -0.1473 (Timoshenko & Goodier, torsion),
// p falls to zero at the sides, and the pressure's Laplacian is uniform.
TEST(SphInitialFields, RotatingSquareHasThePressureOfTorsion) {
    const FluidNumbers numbers{Vec3(4.0, 4.0, 0.0), 1000.0, 20.0, 0.0, Vec3::Zero(), Tait{}};
    const toml::table text = toml::parse("rate = 3.0\nside = 2.0\ncentre = [2.0, 1.5]");
    Table table(text, "fluid.initial", "scene.toml");
    const RotatingSquareField field(table);
    const auto p = [&](double x, double y) { return field(Vec3(x, y, 0.0), numbers).p / (1000.0 * 9.0 * 4.0); };
    EXPECT_NEAR(p(2.0, 1.5), -0.1473, 5e-5);
    EXPECT_NEAR(p(2.3, 2.0), p(2.5, 1.8), 1e-6); // the two axes are alike
    EXPECT_NEAR(p(2.3, 0.5002), 0.0, 1e-4);      // towards a side
    EXPECT_EQ(p(3.1, 1.5), 0.0);
    const double e = 0.02, x = 2.2, y = 1.1;
    const double laplacian = (p(x + e, y) + p(x - e, y) + p(x, y + e) + p(x, y - e) - 4.0 * p(x, y)) / (e * e);
    EXPECT_NEAR(4.0 * laplacian, 2.0, 1e-3);
    const Vec3 u = field(Vec3(2.5, 1.4, 0.0), numbers).u;
    EXPECT_NEAR(u[0], 0.3, 1e-13);
    EXPECT_NEAR(u[1], 1.5, 1e-13);
}
