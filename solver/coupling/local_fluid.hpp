// What a grain sees of the fluid where it is.
#pragma once

#include "core/vec.hpp"

namespace plumb {

/// Velocity field of the undisturbed fluid at one point and time.
struct FlowPoint {
    Vec3 u = Vec3::Zero();                              // [m/s]
    Vec3 acceleration = Vec3::Zero();                   // Du/Dt = du/dt + u . grad u, along the fluid's path [m/s2]
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero(); // gradient(i, j) = d u_i / d x_j [1/s]
};

/// The fluid at a grain.
struct LocalFluid : FlowPoint {
    Vec3 stress = Vec3::Zero(); // -grad P + div tau, what acts on a grain's volume; rho Du/Dt of a given flow [N/m3]
    double eps = 1.0;           // fluid fraction
    double density = 0.0;       // [kg/m3]
    double viscosity = 0.0;     // dynamic [Pa s]
};

/// What the forces need to know of the grain.
struct LocalGrain {
    double diameter = 0.0;        // [m]
    Vec3 velocity = Vec3::Zero(); // [m/s]
};

/// curl u [1/s] of a velocity gradient (i, j) = d u_i / d x_j.
inline Vec3 vorticity(const Eigen::Matrix3d& gradient) {
    return {gradient(2, 1) - gradient(1, 2), gradient(0, 2) - gradient(2, 0), gradient(1, 0) - gradient(0, 1)};
}

} // namespace plumb
