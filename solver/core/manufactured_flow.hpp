// The flow of verification/mms: waves on a square, chosen so that every term of the equations is of order one and no
// two axes or components can be exchanged.
#pragma once

#include "core/flow_state.hpp"
#include "core/table.hpp"

namespace plumb {

/// v = curl psi + divergence * grad chi with psi, chi and p from verification/mms, equation 2; the same along z in
/// space.
struct ManufacturedFlow {
    double speed = 0.0;      // U [m/s]
    double divergence = 0.0; // d [-]; 0 for a solenoidal flow

    ManufacturedFlow() = default;
    explicit ManufacturedFlow(Table& table)
        : speed(table.number("speed", positive)), divergence(table.number("divergence", non_negative)) {}

    /// The flow at a place and a time with the derivatives that the equations of motion ask for.
    struct State {
        Vec3 v, v_rate;   // [m/s], dv/dt at a fixed place [m/s2]
        Vec3 convection;  // v . grad v [m/s2]
        Vec3 laplacian;   // of v [1/(m s)]
        double div_v;     // [1/s]
        double p, p_rate; // [Pa], dp/dt at a fixed place [Pa/s]
        Vec3 p_gradient;  // [Pa/m]
    };
    State at(const Vec3& x, double t, const FluidNumbers& fluid) const;
};

} // namespace plumb
