// Where the fluid's particles are at the start.
#pragma once

#include "core/laws.hpp"
#include "sph/fluid.hpp"

#include <functional>
#include <numbers>

namespace plumb {

/// The cuboid (rectangle) between two corners.
struct BoxFill {
    static constexpr std::string_view name = "box";
    static constexpr LawInfo info{"lower <= x <= upper", "any", "definition"};
    Vec3 lower, upper; // [m]
    explicit BoxFill(Table& table);
    bool operator()(const Vec3& x) const {
        return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
    }
};

/// Below a wavy surface: along the last axis up to depth + amplitude cos(2 pi x/wave_length).
struct WaveFill {
    static constexpr std::string_view name = "wave";
    static constexpr LawInfo info{"height <= depth + amplitude cos(2 pi x/wave_length)", "gravity along the last axis",
                                  "definition"};
    std::size_t axis;                     // of the height
    double depth, amplitude, wave_length; // [m]
    explicit WaveFill(Table& table)
        : axis(table.choice("axis", {"y", "z"}) == "y" ? 1 : 2), depth(table.number("depth", positive)),
          amplitude(table.number("amplitude")), wave_length(table.number("wave_length", positive)) {}
    bool operator()(const Vec3& x) const {
        return x[static_cast<Eigen::Index>(axis)] <=
               depth + amplitude * std::cos(2.0 * std::numbers::pi * x[0] / wave_length);
    }
};

/// A ball or an ellipsoid (circle or ellipse in the plane), axes along those of space.
struct EllipsoidFill {
    static constexpr std::string_view name = "ellipsoid";
    static constexpr LawInfo info{"sum ((x - centre)/semi_axes)^2 <= 1", "any", "definition"};
    Vec3 centre, semi_axes; // [m]
    explicit EllipsoidFill(Table& table);
    bool operator()(const Vec3& x) const { return ((x - centre).array() / semi_axes.array()).square().sum() <= 1.0; }
};

/// Nothing: the vessel is empty until its inlet opens.
struct NoFill {
    static constexpr std::string_view name = "nothing";
    static constexpr LawInfo info{"nowhere", "with an inlet and a free surface", "definition"};
    NoFill() = default;
    bool operator()(const Vec3& /*x*/) const { return false; }
};

using Fill = std::variant<BoxFill, WaveFill, EllipsoidFill, NoFill>;

/// Fills the part of the box where `is_fluid` says so with a square (cubic) lattice of the fluid's spacing, particles
/// in the middle of their cells, each moved by up to `jitter` spacings along every axis (not out of the fluid). At
/// rest, at rho_0; ids run along x fastest. Sides are whole numbers of spacings.
void fill_box(
    SphFluid& fluid, double jitter, std::uint64_t seed,
    const std::function<bool(const Vec3&)>& is_fluid = [](const Vec3&) { return true; });

} // namespace plumb
