// What initial fields and sources are told about the fluid, and what they answer.
#pragma once

#include "core/equation_of_state.hpp"
#include "core/vec.hpp"

namespace plumb {

/// Velocity [m/s] and pressure [Pa] at one place.
struct FlowState {
    Vec3 u = Vec3::Zero();
    double p = 0.0;
};

/// What an initial field or a source may need to know of the fluid.
struct FluidNumbers {
    Vec3 size;          // of the box [m]
    double density;     // [kg/m3]
    double sound_speed; // [m/s]
    double viscosity;   // dynamic [Pa s]
    Vec3 gravity;       // that the particles feel [m/s2]
    EquationOfState equation_of_state;
};

} // namespace plumb
