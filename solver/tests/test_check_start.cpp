#include "tests/made_grains.hpp"

#include <gtest/gtest.h>

#include <string>

namespace plumb {
namespace {

TEST(CheckStart, GrainsAreInsideTheDomain) {
    const auto at = [](const std::string& position) {
        return "[grains]\ndensity = 1.0\ndiameter = 0.1\narrange = {law = 'single', position = " + position + "}";
    };
    const Domain open = box({1.0, 2.0, 3.0}, false), periodic = box({1.0, 2.0, 3.0}, true);
    EXPECT_EQ(made(at("[1.0, 2.0, 0.0]"), open).grains.size(), 1U); // on the side
    expect_fault(at("[0.5, 2.1, 0.5]"), open,
                 "grain 0 of group \"grains\" (id 0) at (0.5, 2.1, 0.5) m is outside the domain: y is not in [0, 2] m");
    EXPECT_NEAR(made(at("[0.5, 2.1, 0.5]"), periodic).grains.x[0].y(), 0.1, 1e-15);
    expect_fault("[grains]\ndensity = 1.0\ndiameter = 1.1\narrange = {law = 'single', position = [0, 0, 0]}", periodic,
                 "larger than the periodic box along x");
}

TEST(CheckStart, GrainsAreInFrontOfWalls) {
    const Domain domain = box({1.0, 1.0, 1.0}, false);
    const auto at = [](double z, const std::string& more) {
        return "[[wall]]\nname = 'floor'\nshape = 'plane'\npoint = [0, 0, 0.2]\nnormal = [0, 0, 1]\n[grains]\ndensity "
               "= 1.0\n"
               "diameter = 0.1\n" +
               more + "arrange = {law = 'single', position = [0.5, 0.5, " + std::to_string(z) + "]}";
    };
    EXPECT_EQ(made(at(0.248, ""), domain).grains.size(), 1U); // overlap 0.04 R
    expect_fault(at(0.247, ""), domain, "overlaps the wall \"floor\" by 0.06 of its radius");
    expect_fault(at(0.1, ""), domain, "overlaps the wall");
    EXPECT_EQ(made(at(0.1, "overlap = 'allow'\n"), domain).grains.size(), 1U);
    EXPECT_EQ(made(at(0.1, "motion = 'fixed'\n"), domain).grains.size(), 1U);
}

TEST(CheckStart, OverlapOfTwoGrains) {
    const Domain domain = box({1.0, 1.0, 1.0}, true);
    const auto two = [](double x, const std::string& of_a, const std::string& of_b) {
        const std::string common = "density = 1.0\narrange = {law = 'single', position = [";
        return "[[grains]]\nname = 'a'\ndiameter = 0.1\n" + of_a + common +
               "0.0, 0.5, 0.5]}\n[[grains]]\nname = 'b'\ndiameter = 0.2\n" + of_b + common + std::to_string(x) +
               ", 0.5, 0.5]}";
    };
    // Radii 0.05 and 0.1, across the periodic side: allowed down to a distance of 0.15 - 0.0025.
    EXPECT_EQ(made(two(0.852, "", ""), domain).grains.size(), 2U);
    expect_fault(two(0.853, "", ""), domain,
                 "grain 0 of group \"b\" (id 1) at (0.853, 0.5, 0.5) m overlaps grain 0 of group \"a\" (id 0)");
    EXPECT_EQ(made(two(0.99, "overlap = 'allow'\n", ""), domain).grains.size(), 2U);
    EXPECT_EQ(made(two(0.99, "motion = 'fixed'\n", "motion = 'fixed'\n"), domain).grains.size(), 2U);
    expect_fault(two(0.99, "motion = 'fixed'\n", ""), domain, "overlaps");
    expect_fault(two(0.99, "motion = 'block'\n", "motion = 'block'\n"), domain, "overlaps"); // two different blocks
    EXPECT_EQ(made(two(0.99, "", ""), domain, [](std::int32_t, std::int32_t) { return false; }).grains.size(), 2U);
}

} // namespace
} // namespace plumb
