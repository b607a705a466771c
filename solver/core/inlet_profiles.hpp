// How fast fluid comes in through an inlet.
//
// To add one: write the struct, name it in InletProfile at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"

#include <variant>

namespace plumb {

/// The same speed everywhere.
struct UniformProfile {
    static constexpr std::string_view name = "uniform";
    static constexpr LawInfo info{"u = speed", "slip walls or none", "definition"};
    double speed; // [m/s]
    explicit UniformProfile(Table& table) : speed(table.number("speed", positive)) {}
    double operator()(double /*from_axis*/, int /*dimensions*/) const { return speed; }
};

/// Developed laminar flow between plates (in the plane) or in a round pipe around the side's point.
struct ParabolicProfile {
    static constexpr std::string_view name = "parabolic";
    static constexpr LawInfo info{"u = 3/2 (plane) or 2 (pipe) mean (1 - s^2/radius^2), s from the axis",
                                  "0 beyond the radius", "Poiseuille 1840"};
    double mean_speed, radius; // [m/s], [m]: half the width of a plane channel
    explicit ParabolicProfile(Table& table)
        : mean_speed(table.number("mean_speed", positive)), radius(table.number("radius", positive)) {}
    double operator()(double from_axis, int dimensions) const {
        const double s = from_axis / radius;
        return s < 1.0 ? (dimensions == 2 ? 1.5 : 2.0) * mean_speed * (1.0 - s * s) : 0.0;
    }
};

using InletProfile = std::variant<UniformProfile, ParabolicProfile>;

} // namespace plumb
