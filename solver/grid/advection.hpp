// What the fluid that crosses a face of a control volume carries.
//
// To add one: write the struct, name it in Advection at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"

#include <variant>

namespace plumb {

/// u_face = own + next (u_next - own) + second (u_second - own): `next` is across the face, `second` the one upstream
/// of whichever of the two is upstream.
struct Carried {
    double next = 0.0, second = 0.0;
};

// A law is told the flux out of the control volume and, as `reach`, how far the face is from the upstream side, over
// the distance from there to the second upstream one; 0 where there is none.

/// What the upstream side has: first order, bounded, with a viscosity of u dx/2 of its own.
struct Upwind {
    static constexpr std::string_view name = "upwind";
    static constexpr LawInfo info{"u_face = upstream u", "any cell Reynolds number; numerical viscosity u dx/2",
                                  "Courant, Isaacson & Rees 1952, Comm. Pure Appl. Math. 5, 243"};
    Carried operator()(double outward, double /*reach*/) const { return {outward < 0.0 ? 1.0 : 0.0, 0.0}; }
};

/// Continued from two upstream sides to the face: second order; where there is no second one, as `upwind`.
struct LinearUpwind {
    static constexpr std::string_view name = "linear_upwind";
    static constexpr LawInfo info{"u_face = upstream u continued linearly from the one before it",
                                  "any cell Reynolds number, not bounded; dispersion, damping with dx^3",
                                  "Warming & Beam 1976, AIAA J. 14, 1241"};
    Carried operator()(double outward, double reach) const { return {outward < 0.0 ? 1.0 + reach : 0.0, -reach}; }
};

/// The mean of both sides: second order, conserves energy.
struct Central {
    static constexpr std::string_view name = "central";
    static constexpr LawInfo info{"u_face = (u + u_next)/2", "cell Reynolds number below 2, else it may oscillate",
                                  "Harlow & Welch 1965, Phys. Fluids 8, 2182"};
    Carried operator()(double /*outward*/, double /*reach*/) const { return {0.5, 0.0}; }
};

/// Creeping flow: nothing is carried.
struct NoAdvection {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"rho u . grad u = 0", "Re << 1", "Stokes 1851"};
    Carried operator()(double /*outward*/, double /*reach*/) const { return {}; }
};

using Advection = std::variant<Upwind, LinearUpwind, Central, NoAdvection>;

} // namespace plumb
