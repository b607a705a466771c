// Structure factors S(k) of equal grains: what the neighbours of a grain take away from its own disturbance, because
// they are missing where it sits and answer to it everywhere else. 1 for short waves.
#pragma once

#include "core/laws.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace plumb {

/// S = 1: one grain, or grains that are placed independently of each other.
struct LoneGrain {
    static constexpr std::string_view name = "lone";
    static constexpr LawInfo info{"S = 1", "one grain, or a dilute suspension", "-"};
    double fraction = 0.0; // of the volume that the other grains take
    double operator()(double /*k*/, double /*d*/) const { return 1.0; }
};

/// Hard spheres in equilibrium, 1/S = 1 + 24 phi Int_0^1 (A + 6 phi B x + phi A x^3/2) x^2 sin(k d x)/(k d x) dx with A
/// = (1 + 2 phi)^2/(1 - phi)^4, B = -(1 + phi/2)^2/(1 - phi)^4.
struct HardSpheres {
    static constexpr std::string_view name = "percus_yevick";
    static constexpr LawInfo info{"1/S = 1 - n c(k), c of hard spheres", "random suspensions, fraction < 0.45",
                                  "Wertheim 1963, Phys. Rev. Lett. 10, 321; Thiele 1963"};
    double fraction = 0.0; // phi
    explicit HardSpheres(Table& t) : fraction(t.number("fraction", {0.0, 0.64, false, true})) {}
    double operator()(double k, double d) const {
        const double phi = fraction, solid4 = std::pow(1.0 - phi, 4);
        const double a = (1.0 + 2.0 * phi) * (1.0 + 2.0 * phi) / solid4;
        const double b = -6.0 * phi * (1.0 + 0.5 * phi) * (1.0 + 0.5 * phi) / solid4, c = 0.5 * phi * a;
        constexpr int n = 400; // midpoints; k d is 12 d/h at most
        double sum = 0.0;
        for (int i = 0; i < n; ++i) {
            const double x = (i + 0.5) / n, z = k * d * x;
            sum += (a + x * (b + c * x * x)) * x * x * (z < 1e-2 ? 1.0 - z * z / 6.0 : std::sin(z) / z) / n;
        }
        return 1.0 / (1.0 + 24.0 * phi * sum);
    }
};

/// A cubic lattice, as far as a function of |k| can say it: 0 below the first reciprocal vector, where the sum over all
/// grains is the mean, and 1 beyond.
struct LatticeOrder {
    static constexpr std::string_view name = "lattice";
    static constexpr LawInfo info{"S = 0 for k < 2 pi (n)^(1/3), 1 beyond", "a cubic lattice", "-"};
    double fraction = 0.0; // of the volume that the grains take
    explicit LatticeOrder(Table& t) : fraction(t.number("fraction", {0.0, 0.75, true, false})) {}
    double operator()(double k, double d) const {
        const double spacing = d * std::cbrt(std::numbers::pi / 6.0 / fraction);
        return k * spacing < 2.0 * std::numbers::pi ? 0.0 : 1.0;
    }
};

using StructureFactor = std::variant<LoneGrain, HardSpheres, LatticeOrder>;

} // namespace plumb
