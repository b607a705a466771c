// Attraction of two grains, in contact and beyond it. A law is a pure function of one pair, for a double or a pack of
// eight; what it remembers of a pair is one number, the volume of liquid between the two grains: 0 without a bridge.
#pragma once

#include "core/laws.hpp"
#include "core/simd.hpp"

#include <cmath>
#include <numbers>

namespace plumb {

/// Grains that do not attract each other.
struct NoCohesion {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"f = 0", "any", "-"};
    template <class T> struct Parameters { T unused{}; };
    explicit NoCohesion(Table& /*table*/) {}
    NoCohesion() = default;
    Parameters<double> parameters;
};

/// A capillary bridge of constant volume V between wet spheres. It forms when they touch, pulls as at s = 0 while they
/// do, and breaks when the separation s exceeds the rupture distance; after that they must touch again.
///
///     f = 2 pi R gamma cos(theta) / (1 + 1.05 s^ + 2.5 s^^2),    s^ = s sqrt(R/V),    R = 2 R_i R_j/(R_i + R_j)
///     rupture: s_c = (1 + theta/2) V^(1/3), theta in rad
///
/// Willett et al. (2000), eq. 12, write 1 + 2.1 S^ + 10 S^^2 with half the separation, S = s/2. R is Derjaguin's for
/// unequal spheres; against a plane it is twice the sphere's radius. The rupture distance is that of Lian, Thornton &
/// Adams (1993). How far both are from the equation of Young and Laplace: verification/liquid_bridge.
struct LiquidBridge {
    static constexpr std::string_view name = "liquid_bridge";
    static constexpr LawInfo info{
        "f = -2 pi R gamma cos(theta) / (1 + 1.05 s^ + 2.5 s^^2), s^ = s sqrt(R/V), R = 2 R_i R_j/(R_i + R_j); from "
        "the "
        "first contact (s = 0 there) until s > (1 + theta/2) V^(1/3)",
        "V <= 0.1 R^3, theta < pi/2; best for V <= 1e-3 R^3; quasi-static, without gravity on the liquid",
        "Willett, Adams, Johnson & Seville 2000, Langmuir 16, 9396, eq. 12; Lian, Thornton & Adams 1993, J. Colloid "
        "Interface Sci. 161, 138"};
    static constexpr double linear = 1.05, square = 2.5; // Willett et al. 2000, eq. 12, for the whole separation
    static constexpr double largest_volume = 0.1;        // V/R^3 up to which Willett et al. 2000 fit the force

    template <class T> struct Parameters {
        T tension;         // 2 pi gamma cos(theta) [N/m]
        T rupture_cubed;   // (1 + theta/2)^3
        T volume;          // [m3] of a bridge, when given as a number
        T volume_per_cube; // V/d^3 with d of the smaller grain, when given so
    };
    explicit LiquidBridge(Table& table);
    /// Dry pairs in a scene where others are wet: bridges without liquid.
    LiquidBridge() : parameters{0.0, 1.0, 0.0, 0.0} {}
    Parameters<double> parameters;

    /// Liquid that gathers between two grains that touch [m3]; `smaller` is the lesser radius. A grain's wetness, when
    /// it can change, belongs here.
    template <class T> [[gnu::always_inline]] static T formed_volume(const Parameters<T>& p, const T& smaller_radius) {
        return p.volume + p.volume_per_cube * (broadcast<T>(8.0) * smaller_radius * smaller_radius * smaller_radius);
    }

    /// Has a bridge of this volume [m3] not broken yet at the separation s >= 0 [m]? Free of roots: s^3 <= s_c^3.
    template <class T> [[gnu::always_inline]] static auto holds(const Parameters<T>& p, const T& s, const T& volume) {
        return s * s * s <= p.rupture_cubed * volume;
    }

    /// Attraction [N] at the separation s >= 0 [m]; volume > 0 [m3], inverse_radius = 1/R_i + 1/R_j [1/m].
    template <class T>
    [[gnu::always_inline]] static T attraction(const Parameters<T>& p, const T& s, const T& volume,
                                               const T& inverse_radius) {
        const T radius = broadcast<T>(2.0) / inverse_radius;
        const T scaled = s * square_root(radius / volume);
        return p.tension * radius /
               (broadcast<T>(1.0) + scaled * (broadcast<T>(linear) + broadcast<T>(square) * scaled));
    }

    /// Separation at which a bridge of this volume breaks [m].
    double rupture_distance(double volume) const { return std::cbrt(parameters.rupture_cubed * volume); }
    /// Work of pulling the grains from the separation s to rupture [J]; in contact s = 0.
    double work_to_rupture(double s, double volume, double inverse_radius) const;
    /// Greatest slope |df/ds| [N/m]; it is at s^ = 0.13.
    double greatest_slope(double volume, double inverse_radius) const;
};

using CohesionLaw = std::variant<NoCohesion, LiquidBridge>;

} // namespace plumb
