// Free grains in the equations of a step of the fluid on a grid: what they will do is foreseen, linear in the velocity
// and the pressure at the step's end, so that neither has to be taken from the step's start. A dense bed of free grains
// is unstable where it is (verification/near_zero_void).
#pragma once

#include "core/field.hpp"
#include "core/vec.hpp"

#include <vector>

namespace plumb {

/// By cell; all empty where nothing is foreseen. The volume that grains carry through a face beyond what the porosity
/// of the step's end has of it is, per area,
///     drift + follows (u' - u) - yields grad p',
/// of the means on either side of the face, u' and p' the velocity and the pressure at the step's end.
struct ForeseenGrains {
    Field<double> hands_on;  // share of a cell whose stress acts on grains and comes back as drag
    Field<double> follows;   // share of a cell that grains fill which take on the fluid's velocity in the step
    Field<double> yields;    // [m3 s/kg]
    std::vector<Vec3> drift; // [m/s]
};

} // namespace plumb
