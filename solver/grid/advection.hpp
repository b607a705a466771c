// What the fluid that crosses a face of a control volume carries.
//
// To add one: write the struct, name it in Advection at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"

#include <variant>

namespace plumb {

/// What the upstream side has: first order, bounded, with a viscosity of u dx/2 of its own.
struct Upwind {
    static constexpr std::string_view name = "upwind";
    static constexpr LawInfo info{"u_face = upstream u", "any cell Reynolds number; numerical viscosity u dx/2",
                                  "Courant, Isaacson & Rees 1952, Comm. Pure Appl. Math. 5, 243"};
    /// Weight of the neighbour in u_face, for a flux out of the control volume.
    double operator()(double outward) const { return outward < 0.0 ? 1.0 : 0.0; }
};

/// The mean of both sides: second order, conserves energy.
struct Central {
    static constexpr std::string_view name = "central";
    static constexpr LawInfo info{"u_face = (u + u_next)/2", "cell Reynolds number below 2, else it may oscillate",
                                  "Harlow & Welch 1965, Phys. Fluids 8, 2182"};
    double operator()(double /*outward*/) const { return 0.5; }
};

/// Creeping flow: nothing is carried.
struct NoAdvection {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"rho u . grad u = 0", "Re << 1", "Stokes 1851"};
    double operator()(double /*outward*/) const { return 0.0; }
};

using Advection = std::variant<Upwind, Central, NoAdvection>;

} // namespace plumb
