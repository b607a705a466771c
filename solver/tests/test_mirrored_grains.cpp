// Grains mirrored in walls: an even bed has an even porosity up to the wall.
#include "coupling/mirrored_grains.hpp"

#include "core/scene.hpp"
#include "core/sphere.hpp"
#include "coupled_fixtures.hpp"
#include "sph/kernels.hpp"

#include <numbers>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double h = 0.085, reach_of_kernel = 2.0 * h; // a sixth of the cylinder's radius

std::vector<WallBody> walls(const std::string& text) {
    Scene scene = scene_from_text(text, "scene.toml", "/");
    std::vector<Table> tables = scene.root.tables("wall");
    return make_walls(tables);
}

/// phi at x of grains of volume V and their mirrors, under the Wendland C2 kernel.
double solid_fraction(const std::vector<Vec3>& grains, const std::vector<double>& volume,
                      const MirroredGrains& mirrored, const Vec3& x) {
    const auto part = [&](const Vec3& place, double v) {
        const double q = (place - x).norm() / h;
        return q < 2.0 ? v * WendlandC2::sigma(3) / (h * h * h) * WendlandC2::w(q) : 0.0;
    };
    double sum = 0.0;
    for (std::size_t j = 0; j < grains.size(); ++j) sum += part(grains[j], volume[j]);
    for (std::size_t q = 0; q < mirrored.size(); ++q) sum += part(mirrored.x[q], mirrored.volume[q]);
    return sum;
}

/// A cubic lattice of grains in [0, 1]^3, the first half a spacing from the sides.
std::vector<Vec3> lattice(int n) {
    std::vector<Vec3> x;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) x.push_back((Vec3(i, j, k) + Vec3::Constant(0.5)) / n);
    return x;
}

} // namespace

// A mirror that is missing in an edge or a corner, or counted twice there: the box of mirrors goes on as the lattice.
TEST(MirroredGrains, ContinueALatticeInEveryCorner) {
    const auto box = walls("[[wall]]\nname = \"box\"\nshape = \"box\"\nlower = [0, 0, 0]\nupper = [1, 1, 1]\n");
    const std::vector<Vec3> x = lattice(10);
    const std::vector<double> volume(x.size(), 5e-4);
    MirroredGrains mirrored;
    mirrored.wanted = true;
    prepare_mirrors(mirrored, box, {WendlandC2{}, h});
    choose_mirrors(mirrored, box, x, volume, reach_of_kernel);
    const double middle = solid_fraction(x, volume, mirrored, Vec3::Constant(0.55));
    for (const Vec3& place :
         {Vec3(0.05, 0.55, 0.55), Vec3(0.55, 0.95, 0.05), Vec3(0.05, 0.05, 0.95), Vec3(0.95, 0.95, 0.95)})
        EXPECT_NEAR(solid_fraction(x, volume, mirrored, place), middle, 1e-14) << place.transpose();
    MirroredGrains unwanted;
    choose_mirrors(unwanted, box, x, volume, reach_of_kernel);
    EXPECT_EQ(unwanted.size(), 0U);
}

// Shells behind a round wall are wider: without that weight the porosity at the wall is off by h/R.
TEST(MirroredGrains, AreEvenAtACylinder) {
    const auto cylinder = walls("[[wall]]\nname = \"c\"\nshape = \"cylinder\"\nside = \"inside\"\n"
                                "point = [0.5, 0.5, 0]\naxis = [0, 0, 1]\nradius = 0.5\n");
    std::vector<Vec3> x;
    for (const Vec3& one : lattice(80)) // fine: where the wall cuts the lattice is chance, 2 %
        if (std::hypot(one[0] - 0.5, one[1] - 0.5) < 0.5 && std::abs(one[2] - 0.5) < 1.1 * reach_of_kernel)
            x.push_back(one);
    const std::vector<double> volume(x.size(), 0.5 / 512000.0);
    MirroredGrains mirrored;
    mirrored.wanted = true;
    prepare_mirrors(mirrored, cylinder, {WendlandC2{}, h});
    choose_mirrors(mirrored, cylinder, x, volume, reach_of_kernel);
    for (const double r : {0.0, 0.2, 0.3, 0.4, 0.45, 0.5})
        for (const double angle : {0.1, 1.0, 2.2})
            EXPECT_NEAR(
                solid_fraction(x, volume, mirrored, Vec3(0.5 + r * std::cos(angle), 0.5 + r * std::sin(angle), 0.5)),
                0.5, 0.0125)
                << r;
}

// Room that a round wall takes or makes: what a kernel leaves behind the wall is what its mirror brings back.
TEST(MirroredGrains, LoseNoRoomAtRoundWalls) {
    for (const char* shape : {"shape = \"cylinder\"\npoint = [0.5, 0.5, 0]\naxis = [0, 0, 1]\n",
                              "shape = \"sphere\"\ncentre = [0.5, 0.5, 0.5]\n"})
        for (const char* side : {"inside", "outside"}) {
            const auto round =
                walls(std::string("[[wall]]\nname = \"w\"\nside = \"") + side + "\"\nradius = 0.3\n" + shape);
            MirroredGrains mirrored;
            mirrored.wanted = true;
            prepare_mirrors(mirrored, round, {WendlandC2{}, h});
            const double out = side[0] == 'i' ? -1.0 : 1.0;
            for (const double distance : {0.01, 0.06, 0.13}) {
                const std::vector<Vec3> x{Vec3(0.5 + 0.3 + out * distance, 0.5, 0.5)};
                choose_mirrors(mirrored, round, x, {1.0}, reach_of_kernel);
                double room = 0.0;
                constexpr int n = 150;
                for (int k = 0; k < n * n * n; ++k) { // a cube around the grain
                    const Vec3 cell(k % n, k / n % n, k / (n * n));
                    const Vec3 at = x[0] + (cell + Vec3::Constant(0.5 - 0.5 * n)) * (3.0 * reach_of_kernel / n);
                    bool open = false;
                    round[0].touch(at, 1e9, 0.0, [&](const WallPoint& p) { open = p.distance > 0.0; });
                    if (open) room += solid_fraction(x, {1.0}, mirrored, at) * std::pow(3.0 * reach_of_kernel / n, 3);
                }
                EXPECT_NEAR(room, 1.0, 0.01) << shape << side << ' ' << distance;
            }
        }
}

// In a scene: every particle of the fluid sees the porosity of the bed, in corners too, and only if that is wanted.
TEST(MirroredGrains, ABedFillsItsBoxEvenly) {
    const Keys common{{"coupling.mean_pressure_gradient", ""},
                      {"grains.arrange", "{law = \"lattice\", kind = \"cubic\", lower = [1e-4, 1e-4, 1e-4], "
                                         "upper = [1.6e-3, 1.6e-3, 1.6e-3], spacing = 2e-4}"}};
    const auto bench = [&](const std::string& at_walls) {
        Keys keys = common;
        keys["domain.periodic"] = "[false, false, false]";
        keys["coupling.at_walls"] = at_walls;
        return coupled_scene_text(keys) +
               "[[wall]]\nname = \"box\"\nshape = \"box\"\nlower = [0, 0, 0]\nupper = [1.6e-3, 1.6e-3, 1.6e-3]\n"
               "slip = \"no_slip\"\ncontact = \"none\"\n";
    };
    CoupledBench endless(common), even(bench("\"mirrored\"")), cut(bench("\"cut\""));
    const std::vector<std::int32_t> in_endless = ordered_slots(endless.fluid()), in_even = ordered_slots(even.fluid()),
                                    in_cut = ordered_slots(cut.fluid());
    ASSERT_EQ(in_endless.size(), in_even.size());
    double least = 1.0;
    for (std::size_t id = 0; id < in_even.size(); ++id) {
        const double eps = endless.fluid().eps[static_cast<std::size_t>(in_endless[id])];
        EXPECT_NEAR(even.fluid().eps[static_cast<std::size_t>(in_even[id])], eps, 1e-13);
        least = std::min(least, (1.0 - cut.fluid().eps[static_cast<std::size_t>(in_cut[id])]) / (1.0 - eps));
    }
    EXPECT_LT(least, 0.5); // in the corners
    expect_error(
        [&] {
            CoupledBench bad(bench("\"mirrored\"") +
                             "[[wall]]\nname = \"s\"\nshape = \"solid_box\"\n"
                             "lower = [0.1, 0.1, 0.1]\nupper = [0.2, 0.2, 0.2]\nslip = \"no_slip\"\n"
                             "contact = \"none\"\n");
        },
        {"coupling.at_walls", "planes, boxes, cylinders and spheres"});
}
