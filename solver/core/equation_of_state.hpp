// Pressure of a weakly compressible fluid from its density, and back.
//
// To add one: write the struct, name it in EquationOfState at the end, and its row in the README; the tests find it.
#pragma once

#include "core/laws.hpp"

#include <cmath>
#include <variant>

namespace plumb {

/// p = B [(rho/rho_0)^gamma - 1], B = rho_0 c^2/gamma, gamma = 7.
struct Tait {
    static constexpr std::string_view name = "tait";
    static constexpr LawInfo info{"p = (rho_0 c^2/7) [(rho/rho_0)^7 - 1]", "small changes of density",
                                  "Cole 1948, Underwater explosions; Monaghan 1994, J. Comput. Phys. 110, 399"};
    static constexpr double gamma = 7.0;
    double pressure(double rho, double rho_0, double c) const {
        const double s = rho / rho_0, s2 = s * s;
        return rho_0 * c * c / gamma * (s2 * s2 * s2 * s - 1.0);
    }
    double density(double p, double rho_0, double c) const {
        return rho_0 * std::pow(1.0 + gamma * p / (rho_0 * c * c), 1.0 / gamma);
    }
    double slope(double rho, double rho_0, double c) const { // dp/drho [m2/s2]
        const double s = rho / rho_0;
        return c * c * (s * s * s) * (s * s * s);
    }
    /// Pressure of the fluid at rest where a force has done the work `potential` [m2/s2] since p = 0 (g times depth):
    /// the enthalpy, integral of dp/rho, inverted.
    double hydrostatic_pressure(double potential, double rho_0, double c) const {
        const double enthalpy = 1.0 + (gamma - 1.0) * potential / (c * c);
        return rho_0 * c * c / gamma * (std::pow(enthalpy, gamma / (gamma - 1.0)) - 1.0);
    }
};

/// p = c^2 (rho - rho_0).
struct LinearState {
    static constexpr std::string_view name = "linear";
    static constexpr LawInfo info{"p = c^2 (rho - rho_0)", "small changes of density",
                                  "Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214"};
    double pressure(double rho, double rho_0, double c) const { return c * c * (rho - rho_0); }
    double density(double p, double rho_0, double c) const { return rho_0 + p / (c * c); }
    double slope(double /*rho*/, double /*rho_0*/, double c) const { return c * c; } // dp/drho [m2/s2]
    double hydrostatic_pressure(double potential, double rho_0, double c) const {
        return rho_0 * c * c * std::expm1(potential / (c * c));
    }
};

using EquationOfState = std::variant<Tait, LinearState>;

} // namespace plumb
