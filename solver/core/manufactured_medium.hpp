// The flow of verification/mms_grid: an incompressible fluid among something whose porosity is a moving wave, chosen so
// that mass is kept exactly and every term of the momentum equation is of order one.
#pragma once

#include "core/flow_state.hpp"
#include "core/prescribed_porosity.hpp"

namespace plumb {

/// eps u = curl psi + c (eps - mean), c the velocity with which the wave moves along its wave vector, so that
/// d(eps)/dt + div(eps u) = 0; psi and p from verification/mms, equation 2.
struct ManufacturedMedium {
    double speed;          // U [m/s]
    WavePorosity porosity; // eps

    explicit ManufacturedMedium(Table& table)
        : speed(table.number("speed", positive)), porosity(make_porosity(table.law("porosity"))) {}

    /// The flow at a place and a time with the derivatives that the momentum equation asks for.
    struct State {
        double eps;
        Vec3 u, u_rate;  // [m/s], du/dt at a fixed place [m/s2]
        Vec3 convection; // u . grad u [m/s2]
        Vec3 friction;   // div(eps grad u)/eps [1/(m s)]
        double p;        // [Pa]
        Vec3 p_gradient; // [Pa/m]
    };
    /// In a square box.
    State at(const Vec3& x, double t, const Vec3& size, double density) const;

private:
    static WavePorosity make_porosity(Table table) {
        table.choice("law", {WavePorosity::name});
        return WavePorosity(table);
    }
};

} // namespace plumb
