// Rows of parallel cylinders: an array across a flow.
#pragma once

#include "core/laws.hpp"
#include "core/vec.hpp"
#include "core/wall_point.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

namespace plumb {

/// An equilateral staggered array of cylinders along z in the rectangle from `lower` to `upper`. A full row has
/// `per_row` of them, a pitch s = width/per_row apart, the first half a pitch from the side; the rows between are
/// shifted by s/2 and have one fewer, or one more of which two stand half in the sides. Rows are s sqrt(3)/2 apart, as
/// many as there is height for, in the middle of it; the lowest is full. The diameter follows from the void fraction at
/// the row, linear between the heights `porosity_at` and constant beyond: s sqrt(2 sqrt(3) (1 - phi)/pi). Element:
/// number of the cylinder, from the lowest row on.
struct CylinderRows {
    static constexpr std::string_view name = "cylinder_rows";
    static constexpr LawInfo info{"staggered cylinders of diameter s sqrt(2 sqrt(3) (1 - phi)/pi), s = width/per_row",
                                  "outside of the cylinders", "geometry of the hexagonal array"};
    explicit CylinderRows(Table& table);

    struct Row {
        double y, first, radius; // height, x of the first cylinder [m]
        int count;
        std::int32_t element; // of the first cylinder
    };
    double pitch;          // [m]
    double row_distance;   // [m]
    double largest_radius; // [m]
    std::vector<Row> rows;

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        const double far = reach + largest_radius;
        const auto [first_row, last_row] =
            range(x[1], far, rows.front().y, row_distance, static_cast<int>(rows.size()));
        for (int k = first_row; k < last_row; ++k) {
            const Row& row = rows[static_cast<std::size_t>(k)];
            const auto [begin, end] = range(x[0], far, row.first, pitch, row.count);
            for (int q = begin; q < end; ++q) {
                const double dx = x[0] - (row.first + pitch * q), dy = x[1] - row.y, near = reach + row.radius;
                if (dx * dx + dy * dy > near * near * (1.0 + 1e-12)) continue; // cheap; what is left is told exactly
                const double r = std::hypot(dx, dy);
                if (!(r - row.radius < reach)) continue;
                const Vec3 outward = r > 0.0 ? Vec3(dx / r, dy / r, 0.0) : Vec3(Vec3::UnitX());
                visit(WallPoint{outward, r - row.radius, row.element + q});
            }
        }
    }

private:
    /// The numbers q in [0, count) for which first + q step may be within `far` of x.
    static std::pair<int, int> range(double x, double far, double first, double step, int count) {
        const double low = (x - far - first) / step, high = (x + far - first) / step;
        return {low > 0.0 ? static_cast<int>(std::min<double>(std::ceil(low - 1e-9), count)) : 0,
                high < count ? static_cast<int>(std::max(std::floor(high + 1e-9) + 1.0, 0.0)) : count};
    }
};

} // namespace plumb
