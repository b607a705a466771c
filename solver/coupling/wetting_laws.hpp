// What water gains where it wets grains: capillarity in a bed whose pores no particle resolves.
//
// Of a grain's surface A_j the share that the kernel finds water around, C_j = sum_a V_a W(x_j - x_a), counts as wet,
// with the energy E = - gamma cos(theta) sum_j A_j C_j. Its derivatives, for grains of one diameter d with kappa = 6
// gamma cos(theta)/d, are those of the shared pressure (coupling/room_pressure.hpp) with p - kappa in place of p, and
// kappa in every record besides: in a bed eps p + (1 - eps) kappa is what pairs push with, so water ends inside a bed
// where p = - kappa (1 - eps)/eps, the capillary pressure of surface per pore volume (Carman 1941, Soil Sci. 52, 1),
// and above it where p = 0; within water nothing changes. Water and grains receive opposite forces.
//
// To add one: write the struct, name it in WettingLaw, and its row in the README.
#pragma once

#include "core/laws.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace plumb {

/// Water that ends in a bed has the pressure of the air.
struct NoWetting {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"p = 0 at the surface, also among grains", "no capillarity", "-"};
    NoWetting() = default;
    /// kappa [Pa] of grains of diameter d [m].
    double operator()(double /*d*/) const { return 0.0; }
};

/// The surface of the grains has the energy - gamma cos(theta) per area where it is wet.
struct WettedSurface {
    static constexpr std::string_view name = "wetted_surface";
    static constexpr LawInfo info{"p = -6 gamma cos(theta) (1 - eps)/(eps d) at the surface among grains",
                                  "grains of one diameter; a front without hysteresis, thicker than the kernel; no "
                                  "menisci between grains, no tension of the free surface itself",
                                  "White 1982, J. Colloid Interface Sci. 90, 536 (the pressure)"};
    double tension, cos_contact; // gamma [N/m]; [1]
    explicit WettedSurface(Table& t)
        : tension(t.number("tension", positive)),
          cos_contact(std::cos(t.number("contact_angle", {0.0, std::numbers::pi, false, false}))) {}
    double operator()(double d) const { return 6.0 * tension * cos_contact / d; }
};

using WettingLaw = std::variant<NoWetting, WettedSurface>;

} // namespace plumb
