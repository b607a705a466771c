#include "core/cylinder_rows.hpp"

#include <fmt/format.h>

#include <numbers>

namespace plumb {

namespace {

/// Linear between the places `at`, constant beyond.
double interpolated(const std::vector<double>& at, const std::vector<double>& value, double y) {
    const auto above = std::upper_bound(at.begin(), at.end(), y);
    if (above == at.begin()) return value.front();
    if (above == at.end()) return value.back();
    const auto k = static_cast<std::size_t>(above - at.begin());
    return value[k - 1] + (value[k] - value[k - 1]) * (y - at[k - 1]) / (at[k] - at[k - 1]);
}

double component(Table& table, std::string_view key, Eigen::Index c) {
    return table.length(key) == 2 ? table.components(key, 2)[c] : table.vector(key)[c];
}

} // namespace

CylinderRows::CylinderRows(Table& table) : largest_radius(0.0) {
    const double left = component(table, "lower", 0), bottom = component(table, "lower", 1);
    const double width = component(table, "upper", 0) - left, height = component(table, "upper", 1) - bottom;
    if (!(width > 0.0) || !(height > 0.0)) table.fail("upper", "is not above lower in x and y");
    const auto per_row = static_cast<int>(table.integer("per_row", 1, 100'000));
    const bool fewer = table.choice("between", {"one_fewer", "one_more"}) == "one_fewer";
    const std::vector<double> at = table.numbers("porosity_at");
    const std::vector<double> porosity = table.numbers("porosity", {0.0, 1.0, true, true});
    if (at.empty() || at.size() != porosity.size() || !std::is_sorted(at.begin(), at.end(), std::less_equal<>()))
        table.fail("porosity_at", "expected ascending heights, as many as `porosity` has numbers");
    pitch = width / per_row;
    row_distance = 0.5 * std::sqrt(3.0) * pitch;
    const double count = std::floor(height / row_distance * (1.0 + 1e-12));
    if (count < 1.0 || count > 1e6)
        table.fail("upper", fmt::format("there is height for {} rows, {:.6g} m apart", count, row_distance));
    std::int32_t element = 0;
    for (int k = 0; k < static_cast<int>(count); ++k) {
        const double y = bottom + 0.5 * (height - (count - 1.0) * row_distance) + k * row_distance;
        const double solid = 1.0 - interpolated(at, porosity, y);
        const double radius = 0.5 * pitch * std::sqrt(2.0 * std::numbers::sqrt3 * solid / std::numbers::pi);
        const bool full = k % 2 == 0;
        const int here = full ? per_row : (fewer ? per_row - 1 : per_row + 1);
        const double first = left + (full ? 0.5 * pitch : (fewer ? pitch : 0.0));
        rows.push_back({y, first, radius, here, element});
        element += here;
        largest_radius = std::max(largest_radius, radius);
    }
    if (2.0 * largest_radius >= pitch)
        table.fail("porosity",
                   fmt::format("cylinders of {:.6g} m overlap at a pitch of {:.6g} m", 2.0 * largest_radius, pitch));
}

} // namespace plumb
