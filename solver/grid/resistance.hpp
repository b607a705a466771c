// Resistance of a porous medium at rest that fills the grid: the force on the fluid per volume of the whole is -beta u.
//
// beta [kg/(m3 s)] is such that the superficial velocity eps u obeys the law that it is named after: where nothing else
// acts, -eps grad p = beta u. Each law maps eps, the interstitial speed [m/s], and the fluid's density and viscosity to
// beta and to what beta grows by when the speed doubles at its slope: the step needs both to be stable however long it
// is. To add one: write the struct, name it in Resistance at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"

#include <variant>

namespace plumb {

struct Resisted {
    double beta = 0.0, rise = 0.0; // beta and speed dbeta/dspeed [kg/(m3 s)]
};

/// Nothing is in the way.
struct NoResistance {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"beta = 0", "any", "definition"};
    Resisted operator()(double /*eps*/, double /*speed*/, double /*density*/, double /*viscosity*/) const { return {}; }
};

/// eps u = -(K/mu) grad p with one permeability K everywhere.
struct DarcyResistance {
    static constexpr std::string_view name = "darcy";
    static constexpr LawInfo info{"beta = eps^2 mu/permeability", "Re << 1 in the pores", "Darcy 1856"};
    double permeability; // [m2]
    explicit DarcyResistance(double k) : permeability(k) {}
    explicit DarcyResistance(Table& table) : permeability(table.number("permeability", positive)) {}
    Resisted operator()(double eps, double /*speed*/, double /*density*/, double viscosity) const {
        return {eps * eps * viscosity / permeability, 0.0};
    }
};

/// Darcy's law with K = d^2 eps^3/(180 (1 - eps)^2).
struct KozenyCarmanResistance {
    static constexpr std::string_view name = "kozeny_carman";
    static constexpr LawInfo info{"beta = 180 mu (1 - eps)^2/(eps d^2)", "packed beds of spheres, Re << 1",
                                  "Carman 1937, Trans. Inst. Chem. Eng. 15, 150"};
    double diameter; // [m]
    explicit KozenyCarmanResistance(double d) : diameter(d) {}
    explicit KozenyCarmanResistance(Table& table) : diameter(table.number("diameter", positive)) {}
    Resisted operator()(double eps, double /*speed*/, double /*density*/, double viscosity) const {
        const double phi = 1.0 - eps;
        return {180.0 * viscosity * phi * phi / (eps * diameter * diameter), 0.0}; // 180: Carman 1937
    }
};

/// -grad p = 150 mu phi^2 U/(d^2 eps^3) + 1.75 rho phi U^2/(d eps^3), U = eps u, phi = 1 - eps.
struct ErgunResistance {
    static constexpr std::string_view name = "ergun";
    static constexpr LawInfo info{"beta = 150 mu (1 - eps)^2/(eps d^2) + 1.75 rho (1 - eps) u/d",
                                  "packed beds, 0.36 <= eps <= 0.65, Re <= 1000",
                                  "Ergun 1952, Chem. Eng. Prog. 48, 89"};
    double diameter; // [m]
    explicit ErgunResistance(double d) : diameter(d) {}
    explicit ErgunResistance(Table& table) : diameter(table.number("diameter", positive)) {}
    Resisted operator()(double eps, double speed, double density, double viscosity) const {
        const double phi = 1.0 - eps, viscous = 150.0 * viscosity * phi * phi / (eps * diameter * diameter);
        const double inertial = 1.75 * density * phi * speed / diameter; // 150, 1.75: Ergun 1952
        return {viscous + inertial, inertial};
    }
};

using Resistance = std::variant<NoResistance, DarcyResistance, KozenyCarmanResistance, ErgunResistance>;

} // namespace plumb
