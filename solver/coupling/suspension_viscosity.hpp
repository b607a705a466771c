// Closures for the viscosity of a fluid full of grains: what the averaged equations call the effective viscosity,
// mu_eff = ratio(eps) mu. The scheme of Robinson, Luding & Ramaioli has none; the mixture theories it is compared with
// do.
//
// To add one: write the struct, name it in SuspensionViscosity, and its row in the README.
#pragma once

#include "core/laws.hpp"
#include "coupling/weights.hpp"

#include <cmath>
#include <variant>

namespace plumb {

/// Grains do not change the fluid's viscosity.
struct PureFluidViscosity {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"mu_eff = mu", "dilute suspensions", "-"};
    double operator()(double /*eps*/) const { return 1.0; }
    double greatest() const { return 1.0; }
};

/// mu_eff/mu = (1 - (1 - eps)/packing)^(-2.5 packing), at most `greatest`: it has a pole at the densest random packing,
/// and the step is chosen for the greatest.
struct KriegerDougherty {
    static constexpr std::string_view name = "krieger_dougherty";
    static constexpr LawInfo info{"mu_eff/mu = (1 - (1 - eps)/packing)^(-2.5 packing)", "below packing, Re_p < 1",
                                  "Krieger & Dougherty 1959, Trans. Soc. Rheol. 3, 137"};
    double packing, limit;
    explicit KriegerDougherty(Table& t)
        : packing(t.number("packing", {0.1, 0.75, false, false})),
          limit(t.number("greatest", {1.0, 1e6, true, false})) {}
    double operator()(double eps) const {
        const double room = 1.0 - std::min((1.0 - eps) / packing, 1.0 - 1e-12);
        return std::min(std::pow(room, -2.5 * packing), limit);
    }
    double greatest() const { return limit; }
};

using SuspensionViscosity = std::variant<PureFluidViscosity, KriegerDougherty>;

/// Adds to the accelerations what the grains add to the friction of Morris' term, mu (ratio_a + ratio_b - 2) in place
/// of 2 mu, for the state in the records and the porosity of now; pairs with particles of walls count ratio_a twice.
/// Returns how many particles were at the greatest ratio.
std::int64_t add_suspension_viscosity(SphFluid& fluid, const Weights& weights, const SuspensionViscosity& law);

} // namespace plumb
