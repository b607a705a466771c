// Fluid fractions that are given, not computed from the grains: scenes with fluid.method = "prescribed".
//
// Each law maps a position [m] in the box to eps in (0, 1].
// To add a porosity: write the struct, name it in PrescribedPorosity at the end, add its test and its README row.
#pragma once

#include "core/domain.hpp"
#include "core/laws.hpp"
#include "coupling/prescribed_flows.hpp"

#include <algorithm>
#include <variant>

namespace plumb {

/// eps = value everywhere.
struct UniformPorosity {
    static constexpr std::string_view name = "uniform";
    static constexpr LawInfo info{"eps = value", "0 < value <= 1", "definition"};
    double value = 1.0;

    UniformPorosity() = default;
    explicit UniformPorosity(double eps) : value(eps) {}
    explicit UniformPorosity(Table& table) : value(table.number("value", positive_fraction)) {}
    double operator()(const Vec3& /*x*/, const Domain& /*domain*/) const { return value; }
};

/// eps from `lower` at the side x_axis = 0 of the box to `upper` at the opposite side; constant beyond.
struct LinearPorosity {
    static constexpr std::string_view name = "linear";
    static constexpr LawInfo info{"eps = lower + (upper - lower) s/size, s along axis", "0 < lower, upper <= 1",
                                  "definition"};
    Eigen::Index axis;
    double lower, upper;

    LinearPorosity(Eigen::Index along, double low, double high) : axis(along), lower(low), upper(high) {}
    explicit LinearPorosity(Table& table)
        : axis(detail::axis(table, "axis")), lower(table.number("lower", positive_fraction)),
          upper(table.number("upper", positive_fraction)) {}
    double operator()(const Vec3& x, const Domain& domain) const {
        const double share = std::clamp(x[axis] / domain.size[axis], 0.0, 1.0);
        return (1.0 - share) * lower + share * upper; // this form gives `upper` exactly at the far side
    }
};

using PrescribedPorosity = std::variant<UniformPorosity, LinearPorosity>;

/// Fluid fraction at position x [m].
inline double porosity_at(const PrescribedPorosity& porosity, const Vec3& x, const Domain& domain) {
    return std::visit([&](const auto& law) { return law(x, domain); }, porosity);
}

} // namespace plumb
