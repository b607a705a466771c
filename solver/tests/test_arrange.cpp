#include "dem/arrange.hpp"

#include "tests/made_grains.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace plumb {
namespace {

std::string written(const std::string& text) {
    const std::string name =
        std::string("plumb_arrange_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
    std::ofstream(::testing::TempDir() + name, std::ios::binary) << text;
    return name;
}

/// Distance to the nearest others of the first grain, and how many there are at that distance.
std::pair<double, int> nearest(const Grains& grains, const Domain& domain, std::size_t i) {
    double least = std::numeric_limits<double>::max();
    for (int pass = 0, number = 0;; ++pass) {
        for (std::size_t j = 0; j < grains.size(); ++j) {
            const double d = domain.minimum_image(grains.x[i] - grains.x[j]).norm();
            if (j == i) continue;
            if (pass == 0)
                least = std::min(least, d);
            else if (d < least * (1.0 + 1e-9))
                ++number;
        }
        if (pass == 1) return {least, number};
    }
}

const std::string sphere = "[[grains]]\nname = 'a'\ndensity = 2500.0\ndiameter = 1e-3\n";

TEST(Lattice, HasTheNeighboursOfItsCrystal) {
    struct Crystal {
        std::string kind;
        Vec3 cell; // in units of spacing
        int per_cell;
        double distance; // in units of spacing
        int neighbours;
    };
    const double r2 = std::numbers::sqrt2, r3 = std::numbers::sqrt3;
    const std::vector<Crystal> crystals{{"cubic", {1, 1, 1}, 1, 1.0, 6},
                                        {"bcc", {1, 1, 1}, 2, r3 / 2.0, 8},
                                        {"fcc", {1, 1, 1}, 4, 1.0 / r2, 12},
                                        {"hcp", {1, r3, 2.0 * r2 / r3}, 4, 1.0, 12}};
    for (const Crystal& c : crystals) {
        const double spacing = 2e-3;
        const Vec3 n(5, 4, 4);
        const Domain domain = box(spacing * n.cwiseProduct(c.cell), true);
        toml::table arrange{{"law", "lattice"},
                            {"kind", c.kind},
                            {"spacing", spacing},
                            {"lower", toml::array{0.0, 0.0, 0.0}},
                            {"upper", toml::array{domain.size.x(), domain.size.y(), domain.size.z()}}};
        Table table(arrange, "arrange", "scene.toml");
        const auto lattice = std::get<Lattice>(make_family<Arrangement>(table));
        const Grains none;
        const auto x = lattice({domain, none, {}}, {});
        ASSERT_EQ(x.size(), static_cast<std::size_t>(c.per_cell * 80));
        EXPECT_EQ(lattice.count(domain), x.size());
        Grains grains;
        std::vector<GrainGroup> groups{{"a", 1.0, true, Motion::free}};
        for (const Vec3& p : x) add_grain(grains, groups, 0, 1e-4, p, Vec3::Zero(), Vec3::Zero());
        for (std::size_t i = 0; i < grains.size(); i += 7) {
            const auto [distance, number] = nearest(grains, domain, i);
            EXPECT_NEAR(distance, c.distance * spacing, 1e-12) << c.kind;
            EXPECT_EQ(number, c.neighbours) << c.kind;
        }
    }
}

TEST(Lattice, RegionIsHalfOpen) {
    const Domain domain = box({1.0, 1.0, 1.0}, false);
    const std::string lattice =
        sphere + "arrange = {law = 'lattice', kind = 'cubic', spacing = 0.1, lower = [0.2, 0.2, 0.2], ";
    // 0.3 / 0.1 is 2.9999999999999996 in binary: three grains all the same, and none at the upper side.
    EXPECT_EQ(made(lattice + "upper = [0.5, 0.6, 0.3]}", domain).grains.size(), 3U * 4U * 1U);
    EXPECT_EQ(made(lattice + "upper = [0.51, 0.59, 0.21]}", domain).grains.size(), 4U * 4U * 1U);
    const Grains grains = made(lattice + "upper = [0.5, 0.5, 0.5]}", domain).grains;
    EXPECT_EQ(grains.x[0], Vec3(0.2, 0.2, 0.2));
    EXPECT_NEAR(grains.x.back().x(), 0.4, 1e-15);
}

TEST(Lattice, ClosesAcrossPeriodicSidesOrSaysWhyNot) {
    const Domain domain = box({1.0, 1.0, 1.0}, true);
    const auto lattice = [](const std::string& spacing) {
        return sphere + "arrange = {law = 'lattice', kind = 'fcc', spacing = " + spacing +
               ", lower = [0, 0, 0], upper = [1, 1, 1]}";
    };
    EXPECT_EQ(made(lattice("0.1"), domain).grains.size(), 4000U);
    EXPECT_EQ(made(lattice("0.33333333333"), domain).grains.size(), 108U);
    expect_fault(lattice("0.3"), domain, "expected a whole number");
    expect_fault(lattice("0.333333"), domain, "expected a whole number");
    EXPECT_EQ(made(lattice("0.3"), box({1.0, 1.0, 1.0}, false)).grains.size(), 4U * 4U * 4U + 3U * (3U * 3U * 4U));
}

TEST(Lattice, UnderCompressionIsAllowed) {
    // The benchmark crystal: 17 cells, centre distance 0.995 d.
    const double edge = 0.995e-3 * std::numbers::sqrt2, side = 17.0 * edge;
    const auto text = [&](double diameter) {
        return fmt::format(
            "[grains]\ndensity = 2500.0\ndiameter = {}\narrange = {{law = 'lattice', kind = 'fcc', spacing = {}, "
            "lower = [0, 0, 0], upper = [{}, {}, {}]}}",
            diameter, edge, side, side, side);
    };
    const Domain domain = box(Vec3::Constant(side), true);
    EXPECT_EQ(made(text(1e-3), domain).grains.size(), 19652U);
    expect_fault(text(1.1e-3), domain, "overlaps grain");
}

TEST(Lattice, RefusesNonsense) {
    const Domain domain = box({1.0, 1.0, 1.0}, false);
    const std::string begin = sphere + "arrange = {law = 'lattice', kind = 'cubic', lower = [0, 0, 0], ";
    expect_fault(begin + "upper = [1, 1, 1], spacing = 1e-7}", domain, "grains");
    expect_fault(begin + "upper = [1, 1, 1], spacing = 1e-300}", domain, "grains");
    expect_fault(begin + "upper = [1, 0, 1], spacing = 0.1}", domain, "not above lower");
    expect_fault(begin + "upper = [1, 1, 1], spacing = 0.0}", domain, "allowed range");
    expect_fault(sphere +
                     "arrange = {law = 'lattice', kind = 'diamond', spacing = 1.0, lower = [0,0,0], upper = [1,1,1]}",
                 domain, "diamond");
}

TEST(RandomPlaces, KeepTheirDistance) {
    const std::string text = R"(
        [[grains]]
        name = "big"
        density = 1.0
        diameter = 0.4
        arrange = {law = "single", position = [0.5, 0.5, 0.5]}
        motion = "fixed"
        [[grains]]
        name = "small"
        density = 1.0
        diameter = {law = "uniform", minimum = 0.04, maximum = 0.12, seed = 3}
        arrange = {law = "random", count = 500, lower = [0, 0, 0], upper = [1, 1, 1], seed = 3}
        [[wall]]
        name = "floor"
        shape = "plane"
        point = [0, 0, 0.1]
        normal = [0, 0, 1])";
    for (const bool periodic : {true, false}) {
        const Domain domain = box({1.0, 1.0, 1.0}, periodic);
        const Grains grains = made(text, domain).grains;
        ASSERT_EQ(grains.size(), 501U);
        for (std::size_t i = 0; i < grains.size(); ++i) {
            EXPECT_GE(grains.x[i].z() - grains.radius[i], 0.1);
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_GE(domain.minimum_image(grains.x[i] - grains.x[j]).norm(), grains.radius[i] + grains.radius[j]);
        }
        const Grains again = made(text, domain).grains;
        for (std::size_t i = 0; i < grains.size(); ++i) EXPECT_EQ(grains.x[i], again.x[i]);
    }
}

TEST(RandomPlaces, SayWhenTheRegionIsFull) {
    const Domain domain = box({1.0, 1.0, 1.0}, true);
    const auto text = [](int count) {
        return "[grains]\ndensity = 1.0\ndiameter = 0.2\narrange = {law = 'random', count = " + std::to_string(count) +
               ", lower = [0, 0, 0], upper = [1, 1, 1], seed = 1}";
    };
    EXPECT_EQ(made(text(70), domain).grains.size(), 70U); // a solid fraction of 0.29
    expect_fault(text(150), domain, "cannot exceed about 0.38");
    expect_fault(text(150), domain, "solid fraction of 0.3");
    expect_fault(
        "[grains]\ndensity = 1.0\ndiameter = 0.2\narrange = {law = 'random', count = 1, lower = [0, 0, 0], upper = "
        "[1, 1, 2], seed = 1}",
        domain, "leaves the domain");
}

TEST(RandomPlaces, AreUniform) {
    const Grains grains =
        made("[grains]\ndensity = 1.0\ndiameter = 1e-4\narrange = {law = 'random', count = 40000, lower = "
             "[0, 0.25, 0], upper = [1, 0.75, 1], seed = 7}",
             box({1.0, 1.0, 1.0}, true))
            .grains;
    Vec3 mean = Vec3::Zero(), square = Vec3::Zero();
    for (const Vec3& x : grains.x) mean += x / 40000.0, square += x.cwiseProduct(x) / 40000.0;
    const double four_sigma = 4.0 / std::sqrt(12.0 * 40000.0);
    for (Eigen::Index c = 0; c < 3; ++c) {
        const double width = c == 1 ? 0.5 : 1.0;
        EXPECT_NEAR(mean[c], 0.5, four_sigma * width);
        EXPECT_NEAR(square[c] - mean[c] * mean[c], width * width / 12.0, 0.02 * width * width / 12.0);
    }
}

TEST(FilePlaces, ReadPositionsSizesAndVelocities) {
    const Domain domain = box({1.0, 1.0, 1.0}, true);
    const std::string name = written("x [m],y [m],z [m],diameter [m],vx [m/s],vy [m/s],vz [m/s]\n"
                                     "0.1,0.2,0.3,1e-3,1,2,3\n"
                                     "1.25,-0.25,0.5,2e-3,4,5,6\n");
    const std::string arrange = "[grains]\ndensity = 1.0\narrange = {law = 'file', path = '" + name + "'}\n";
    const Grains grains = made(arrange + "diameter = 'file'\nvelocity = {law = 'file'}", domain).grains;
    ASSERT_EQ(grains.size(), 2U);
    EXPECT_EQ(grains.x[0], Vec3(0.1, 0.2, 0.3));
    EXPECT_EQ(grains.x[1], Vec3(0.25, 0.75, 0.5)); // wrapped
    EXPECT_EQ(grains.radius[1], 1e-3);
    EXPECT_EQ(grains.v[1], Vec3(4, 5, 6));
    expect_fault(arrange + "diameter = 1e-3\nvelocity = {law = 'file'}", domain,
                 "column \"diameter\" is unknown, or not used");
    expect_fault(arrange + "diameter = 'file'", domain, "column \"vx\" is unknown, or not used");
    written("x [m],y [m],z [m]\n0,0,0\n");
    expect_fault(arrange + "diameter = 'file'", domain, "has no column \"diameter [m]\"");
    written("x [m],y [m],z [m],diameter [m]\n0,0,0,1e-3\n0,0,0,0\n");
    expect_fault(arrange + "diameter = 'file'", domain, "line 3: the diameter 0 is not positive");
    written("x [m],y [m],z [m]\n0,0,0\n0,0\n");
    expect_fault(arrange + "diameter = 1e-3", domain, "line 3: has 2 fields");
    expect_fault("[grains]\ndensity = 1.0\ndiameter = 1.0\narrange = {law = 'file', path = 'nowhere.csv'}", domain,
                 "nowhere.csv: there is no such file");
}

TEST(GrainTables, AreStrict) {
    const Domain domain = box({1.0, 1.0, 1.0}, false);
    const std::string place = "arrange = {law = 'single', position = [0.5, 0.5, 0.5]}\n";
    const std::string rest = "density = 1.0\ndiameter = 1e-3\n" + place;
    const Made one = made("[grains]\n" + rest + "motion = 'block'\nrotation = false\nvelocity = [1, 0, 0]", domain);
    EXPECT_EQ(one.groups[0].motion, Motion::block);
    EXPECT_FALSE(one.groups[0].rotation);
    EXPECT_EQ(one.groups[0].name, "grains");
    const Made plain = made("[grains]\n" + rest, domain);
    EXPECT_EQ(plain.groups[0].motion, Motion::free);
    EXPECT_TRUE(plain.groups[0].rotation);
    EXPECT_EQ(plain.grains.v[0], Vec3::Zero());
    const Made empty = made("[grains]\ndensity = 1.0\narrange = 'none'", domain);
    EXPECT_EQ(empty.grains.size(), 0U);
    EXPECT_EQ(empty.groups.size(), 1U);
    expect_fault("[grains]\ndensity = 1.0\ndiameter = 1.0\narrange = 'none'", domain, "unknown key");
    expect_fault("[[grains]]\n" + rest + "[[grains]]\n" + rest, domain, "grains[0].name: missing");
    expect_fault(sphere + place + sphere + place, domain, "used by two groups");
    expect_fault("[grains]\n" + rest + "colour = 'red'", domain, "grains.colour: unknown key");
    expect_fault("[grains]\ndiameter = 1e-3\n" + place, domain, "grains.density: missing");
    expect_fault("[grains]\ndensity = -1.0\ndiameter = 1e-3\n" + place, domain, "grains.density: -1 is outside");
    expect_fault("[grains]\n" + rest + "motion = 'block'\nvelocity = {law = 'maxwell', speed = 1.0, seed = 1}", domain,
                 "one velocity");
    expect_fault("[grains]\n" + rest + "overlap = 'maybe'", domain, "not one of");
}

// Grains that overlap, touch a wall or are not the lowest, and a place that is the lattice's all the same.
TEST(JitteredPlaces, AreApartAndClearOfWalls) {
    const auto text = [](const std::string& keys) {
        return "[grains]\ndensity = 1.0\ndiameter = 0.1\narrange = {law = 'jittered', " + keys +
               ", lower = [0, 0, 0], upper = [1, 1, 1], seed = 3}\n"
               "[[wall]]\nname = 'c'\nshape = 'cylinder'\nside = 'inside'\npoint = [0.5, 0.5, 0]\naxis = [0, 0, 1]\n"
               "radius = 0.5\n[[wall]]\nname = 'f'\nshape = 'plane'\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n";
    };
    const Domain domain = box(Vec3::Constant(1.0), false);
    const Grains few = made(text("count = 200, spacing = 0.12, jitter = 0.0099"), domain).grains,
                 many = made(text("count = 400, spacing = 0.12, jitter = 0.0099"), domain).grains;
    double lowest_added = 1.0, highest = 0.0;
    for (std::size_t i = 0; i < many.size(); ++i) {
        EXPECT_GE(many.x[i][2], 0.05);
        EXPECT_LE(std::hypot(many.x[i][0] - 0.5, many.x[i][1] - 0.5), 0.45);
        for (std::size_t j = 0; j < i; ++j) EXPECT_GE((many.x[i] - many.x[j]).norm(), 0.1);
        if (i < few.size()) {
            EXPECT_EQ(few.x[i], many.x[i]);
            highest = std::max(highest, few.x[i][2]);
        } else {
            lowest_added = std::min(lowest_added, many.x[i][2]);
        }
    }
    EXPECT_GT(lowest_added, highest - 0.12 * std::numbers::sqrt2); // a cell of the lattice
    expect_fault(text("count = 200, spacing = 0.12, jitter = 0.02"), domain, "jitter");
    expect_fault(text("count = 2000, spacing = 0.12, jitter = 0.0099"), domain, "places that no wall touches");
}

} // namespace
} // namespace plumb
