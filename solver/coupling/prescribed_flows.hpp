// Velocity fields that are given, not computed: the fluid of scenes with fluid.method = "prescribed".
//
// Each law maps position [m] and time [s] to velocity, Du/Dt and velocity gradient (FlowPoint).
// To add a flow: write the struct, name it in PrescribedFlow at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"
#include "core/named_axis.hpp"
#include "coupling/local_fluid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

namespace plumb {

namespace detail {
/// The two axes of a unidirectional flow; InputError if they are the same (such a flow would not conserve mass).
struct FlowAxes {
    Eigen::Index along, across;
    explicit FlowAxes(Table& table) : along(axis(table, "velocity_axis")), across(axis(table, "gradient_axis")) {
        if (along == across) table.fail("gradient_axis", "must differ from velocity_axis");
    }
    FlowAxes(Eigen::Index velocity_axis, Eigen::Index gradient_axis) : along(velocity_axis), across(gradient_axis) {}

    /// Steady flow of velocity `u` and rate `rate` = du/dx_across; u . grad u vanishes, so Du/Dt = 0.
    FlowPoint point(double u, double rate) const {
        FlowPoint p;
        p.u[along] = u;
        p.gradient(along, across) = rate;
        return p;
    }
};
} // namespace detail

/// u = 0.
struct RestFlow {
    static constexpr std::string_view name = "rest";
    static constexpr LawInfo info{"u = 0", "any", "definition"};
    FlowPoint operator()(const Vec3& /*x*/, double /*t*/) const { return {}; }
    double fastest(const Vec3& /*size*/) const { return 0.0; }
};

/// u = velocity.
struct UniformFlow {
    static constexpr std::string_view name = "uniform";
    static constexpr LawInfo info{"u = velocity", "any", "definition"};
    Vec3 velocity; // [m/s]

    explicit UniformFlow(const Vec3& u) : velocity(u) {}
    explicit UniformFlow(Table& table) : velocity(table.vector("velocity")) {}
    FlowPoint operator()(const Vec3& /*x*/, double /*t*/) const {
        FlowPoint p;
        p.u = velocity;
        return p;
    }
    double fastest(const Vec3& /*size*/) const { return velocity.norm(); }
};

/// u = rate (s - origin) along velocity_axis, s the coordinate along gradient_axis: plane Couette flow.
struct ShearFlow {
    static constexpr std::string_view name = "shear";
    static constexpr LawInfo info{"u = rate (s - origin), s along gradient_axis", "any", "plane Couette flow"};
    double rate;   // [1/s]
    double origin; // where u = 0 [m]
    detail::FlowAxes axes;

    ShearFlow(double shear_rate, Eigen::Index velocity_axis, Eigen::Index gradient_axis, double zero)
        : rate(shear_rate), origin(zero), axes(velocity_axis, gradient_axis) {}
    explicit ShearFlow(Table& table) : rate(table.number("rate")), origin(table.number("origin")), axes(table) {}
    FlowPoint operator()(const Vec3& x, double /*t*/) const {
        return axes.point(rate * (x[axes.across] - origin), rate);
    }
    double fastest(const Vec3& size) const {
        return std::abs(rate) * std::max(std::abs(origin), std::abs(size[axes.across] - origin));
    }
};

/// u = 4 peak (s - lower)(upper - s)/(upper - lower)^2 along velocity_axis: plane Poiseuille flow, zero at both ends.
struct ParabolicFlow {
    static constexpr std::string_view name = "parabolic";
    static constexpr LawInfo info{"u = 4 peak (s - lower)(upper - s)/(upper - lower)^2, s along gradient_axis", "any",
                                  "plane Poiseuille flow"};
    double peak;         // velocity in the middle [m/s]
    double lower, upper; // where u = 0 [m]
    detail::FlowAxes axes;

    ParabolicFlow(double middle, Eigen::Index velocity_axis, Eigen::Index gradient_axis, double low, double high)
        : peak(middle), lower(low), upper(high), axes(velocity_axis, gradient_axis) {}
    explicit ParabolicFlow(Table& table)
        : peak(table.number("peak")), lower(table.number("lower")), upper(table.number("upper")), axes(table) {
        if (!(upper > lower)) table.fail("upper", "must exceed lower");
    }
    FlowPoint operator()(const Vec3& x, double /*t*/) const {
        const double s = x[axes.across], scale = 4.0 * peak / ((upper - lower) * (upper - lower));
        return axes.point(scale * (s - lower) * (upper - s), scale * (lower + upper - 2.0 * s));
    }
    double fastest(const Vec3& size) const { // in the middle, or outside the walls at an end of the box
        const double at_ends = std::max((*this)(Vec3::Zero(), 0.0).u.norm(), (*this)(size, 0.0).u.norm());
        return std::max(std::abs(peak), at_ends);
    }
};

/// u = amplitude sin(2 pi frequency t), the same everywhere; starts from rest.
struct OscillatingFlow {
    static constexpr std::string_view name = "oscillating";
    static constexpr LawInfo info{"u = amplitude sin(2 pi frequency t)", "any", "definition"};
    Vec3 amplitude;   // [m/s]
    double frequency; // [Hz]

    OscillatingFlow(const Vec3& a, double hertz) : amplitude(a), frequency(hertz) {}
    explicit OscillatingFlow(Table& table)
        : amplitude(table.vector("amplitude")), frequency(table.number("frequency", positive)) {}
    FlowPoint operator()(const Vec3& /*x*/, double t) const {
        const double angular = 2.0 * std::numbers::pi * frequency;
        FlowPoint p;
        p.u = amplitude * std::sin(angular * t);
        p.acceleration = amplitude * (angular * std::cos(angular * t)); // u . grad u = 0 in a uniform field
        return p;
    }
    double fastest(const Vec3& /*size*/) const { return amplitude.norm(); }
};

using PrescribedFlow = std::variant<RestFlow, UniformFlow, ShearFlow, ParabolicFlow, OscillatingFlow>;

/// The prescribed flow at position x [m] and time t [s].
inline FlowPoint flow_at(const PrescribedFlow& flow, const Vec3& x, double t) {
    return std::visit([&](const auto& law) { return law(x, t); }, flow);
}

/// Bound of the fluid's speed in a box of `size` [m] at any time [m/s].
inline double fastest_speed(const PrescribedFlow& flow, const Vec3& size) {
    return std::visit([&](const auto& law) { return law.fastest(size); }, flow);
}

} // namespace plumb
