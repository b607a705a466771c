// Fluid fractions that are given, not computed from the grains: those of a prescribed fluid, and of a porous medium
// that fills the fluid on a grid.
//
// Each law maps a position [m] in the box and a time [s] to eps in (0, 1]; `steady` says that time does not matter.
// To add a porosity: write the struct, name it in a family at the end, add its test and its README row.
#pragma once

#include "core/domain.hpp"
#include "core/laws.hpp"
#include "core/named_axis.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
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
    static constexpr bool steady = true;
    double operator()(const Vec3& /*x*/, double /*t*/, const Vec3& /*size*/) const { return value; }
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
    static constexpr bool steady = true;
    double operator()(const Vec3& x, double /*t*/, const Vec3& size) const {
        const double share = std::clamp(x[axis] / size[axis], 0.0, 1.0);
        return (1.0 - share) * lower + share * upper; // this form gives `upper` exactly at the far side
    }
};

/// A plane wave of whole numbers of waves along the axes of the plane, which moves one wave on in `period`.
struct WavePorosity {
    static constexpr std::string_view name = "wave";
    static constexpr LawInfo info{"eps = mean + amplitude sin(2 pi (m x/Lx + n y/Ly - t/period)), waves = [m, n]",
                                  "0 < mean - amplitude, mean + amplitude <= 1", "definition"};
    double mean, amplitude;
    Vec3 waves;
    double period; // [s]

    explicit WavePorosity(Table& table)
        : mean(table.number("mean", positive_fraction)), amplitude(table.number("amplitude", non_negative)),
          waves(table.components("waves", 2)), period(table.number("period", positive)) {
        if (mean - amplitude <= 0.0 || mean + amplitude > 1.0)
            table.fail("amplitude", "mean - amplitude and mean + amplitude have to be in (0, 1]");
        if (waves != waves.array().round().matrix() || waves.isZero())
            table.fail("waves", "expected whole numbers, not both 0");
    }
    static constexpr bool steady = false;
    /// Phase of the sine.
    double angle(const Vec3& x, double t, const Vec3& size) const {
        return 2.0 * std::numbers::pi * (waves[0] * x[0] / size[0] + waves[1] * x[1] / size[1] - t / period);
    }
    double operator()(const Vec3& x, double t, const Vec3& size) const {
        return mean + amplitude * std::sin(angle(x, t, size));
    }
};

/// Around grains that a prescribed fluid carries.
using PrescribedPorosity = std::variant<UniformPorosity, LinearPorosity>;
/// Of what fills a grid.
using MediumPorosity = std::variant<UniformPorosity, LinearPorosity, WavePorosity>;

/// Fluid fraction at position x [m] and time t [s] in a box of this size [m].
inline double porosity_at(const MediumPorosity& porosity, const Vec3& x, double t, const Vec3& size) {
    return std::visit([&](const auto& law) { return law(x, t, size); }, porosity);
}
inline double porosity_at(const PrescribedPorosity& porosity, const Vec3& x, const Domain& domain) {
    return std::visit([&](const auto& law) { return law(x, 0.0, domain.size); }, porosity);
}
inline bool is_steady(const MediumPorosity& porosity) {
    return std::visit([](const auto& law) { return law.steady; }, porosity);
}

} // namespace plumb
