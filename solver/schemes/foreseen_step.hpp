// A grain in a step of the fluid on a grid that has not been taken yet.
#pragma once

#include "schemes/fluid_on_grains.hpp"

namespace plumb {

/// What a grain is foreseen to do, linear in the fluid's velocity u' and stress s' at the step's end.
struct ForeseenStep {
    double rate = 0.0;         // what the fluid gives it is rate u' - known - hands_on s' [N s/m]
    Vec3 known = Vec3::Zero(); // [N]
    double hands_on = 0.0;     // [m3]
    double follows = 0.0;      // its way over the step's length is v + drift + follows (u' - u) + yields s'
    double yields = 0.0;       // [m3 s/kg]
    Vec3 drift = Vec3::Zero(); // [m/s]
    Vec3 given(const Vec3& u, const Vec3& stress) const { return rate * u - known - hands_on * stress; }
};

/// Grain k in the coming step of `dt`, in the fluid that has been gathered at its start. With X all forces but drag and
/// what depends on s' and u', L the part of X that the fluid exerts, B = C_m rho V with `virtual_mass` and W = V with
/// `pressure_gradient` (else 0), u the velocity now, g u = u . grad u,
///     (m + B) dv/dt = b (u' - v) + X + W s' + B ((u' - u)/dt + g u) + what contacts give: (freedom - 1) of all this.
/// So with M = (m + B)/freedom, z = b dt/M, phi1 and phi2 of the exchange law
///     way/dt - v = (1 - phi1)(u' - v) + (dt phi2/M)(X + W s' + B ((u' - u)/dt + g u)),
/// and what the fluid gives is the mean of b (u' - v) + L + B ((u' - u)/dt + g u - dv/dt): with c = phi1 (1 - B/M)
///     c (b (u' - v) + B ((u' - u)/dt + g u)) - (1 - c)(X + W s') + L.
/// With explicit exchange nothing is foreseen but the drag of now.
ForeseenStep foreseen_step(const FluidOnGrains& fluid, const GrainSystem& system, double freedom, std::size_t k,
                           double dt);

/// Forces on a grain that the fluid's own equation has already, or that nothing of the scene's fluid exerts: the stress
/// on its volume, which the fluid keeps on its own share, a mean gradient, buoyancy [N].
Vec3 force_without_reaction(const FluidOnGrains& fluid, const LocalFluid& local, double diameter, const Vec3& gravity);

} // namespace plumb
