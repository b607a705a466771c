#include "core/cylinder_rows.hpp"

#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace plumb {
namespace {

CylinderRows rows_of(const std::string& text) {
    Table table(toml::parse(text), "wall", "scene.toml");
    CylinderRows rows(table);
    table.finish();
    return rows;
}

std::vector<WallPoint> touched(const CylinderRows& rows, const Vec3& x, double reach) {
    std::vector<WallPoint> found;
    rows.touch(x, reach, [&](const WallPoint& point) { found.push_back(point); });
    return found;
}

TEST(CylinderRows, StandWhereTheVoidFractionAndThePitchSay) {
    // pitch 1, rows sqrt(3)/2 apart: 5 of them in a height of 4.5, 4 and 3 cylinders in turn
    const auto rows = rows_of("lower = [1, 9.75]\nupper = [5, 14.25]\nper_row = 4\nbetween = 'one_fewer'\n"
                              "porosity_at = [11, 13]\nporosity = [0.4, 0.8]");
    ASSERT_EQ(rows.rows.size(), 5U);
    const double lowest = 12.0 - std::sqrt(3.0);
    EXPECT_NEAR(rows.rows[0].y, lowest, 1e-14);
    EXPECT_EQ(rows.rows[0].count, 4);
    EXPECT_EQ(rows.rows[1].count, 3);
    EXPECT_EQ(rows.rows[4].element, 14);
    EXPECT_DOUBLE_EQ(rows.rows[0].first, 1.5);
    EXPECT_DOUBLE_EQ(rows.rows[1].first, 2.0);
    // the share of a unit cell of one pitch by one distance that a cylinder leaves
    const auto void_fraction = [&](std::size_t k) {
        return 1.0 - std::numbers::pi * rows.rows[k].radius * rows.rows[k].radius / (0.5 * std::sqrt(3.0));
    };
    EXPECT_NEAR(void_fraction(0), 0.4, 1e-14); // below 11
    EXPECT_NEAR(void_fraction(2), 0.6, 1e-14); // at 12
    EXPECT_NEAR(void_fraction(4), 0.8, 1e-14); // above 13
    // every place sees what a search over all cylinders finds
    for (double x = 0.3; x < 6.0; x += 0.137)
        for (double y = 9.5; y < 14.5; y += 0.171) {
            for (const double reach : {0.05, 0.3, std::numeric_limits<double>::infinity()}) {
                std::vector<WallPoint> all;
                for (const auto& row : rows.rows)
                    for (int q = 0; q < row.count; ++q) {
                        const Vec3 away(x - row.first - q, y - row.y, 0.0);
                        if (away.norm() - row.radius < reach)
                            all.push_back({away.normalized(), away.norm() - row.radius, row.element + q});
                    }
                const auto found = touched(rows, {x, y, 3.0}, reach);
                ASSERT_EQ(found.size(), all.size()) << x << " " << y << " " << reach;
                for (std::size_t k = 0; k < all.size(); ++k) {
                    EXPECT_EQ(found[k].element, all[k].element);
                    EXPECT_NEAR(found[k].distance, all[k].distance, 1e-14);
                    EXPECT_TRUE(found[k].normal.isApprox(all[k].normal));
                }
            }
        }
}

TEST(CylinderRows, MayHaveOneMoreInTheSidesAndNeverOverlap) {
    const std::string common = "lower = [0, 0, 0]\nupper = [4, 1.8, 1]\nper_row = 4\nporosity_at = [0]\n";
    const CylinderRows more = rows_of(common + "between = 'one_more'\nporosity = [0.5]");
    ASSERT_EQ(more.rows.size(), 2U);
    EXPECT_EQ(more.rows[1].count, 5);
    EXPECT_DOUBLE_EQ(more.rows[1].first, 0.0);
    EXPECT_THROW(rows_of(common + "between = 'one_more'\nporosity = [0.05]"), InputError);
    EXPECT_THROW(rows_of(common + "between = 'one_more'\nporosity = [0.5, 0.6]"), InputError);
    EXPECT_THROW(rows_of("lower = [0, 0]\nupper = [4, 0.5]\nper_row = 4\nbetween = 'one_fewer'\n"
                         "porosity_at = [0]\nporosity = [0.5]"),
                 InputError);
}

} // namespace
} // namespace plumb
