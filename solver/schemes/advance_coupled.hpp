// One step of smoothed particles and grains together.
#pragma once

#include "coupling/self_disturbance.hpp"
#include "coupling/suspension_viscosity.hpp"
#include "coupling/weights.hpp"
#include "dem/grain_system.hpp"
#include "schemes/fluid_on_grains.hpp"

#include <cstdint>
#include <optional>

namespace plumb {

/// How the fluid and the grains of a scene act on each other.
struct Coupling {
    Weights weights;
    std::optional<SelfDisturbance> self; // taken out of what the grains gather
    SuspensionViscosity viscosity;       // of the fluid among the grains
    std::int64_t at_greatest = 0;        // particles whose viscosity was at the law's greatest, over all steps
    bool two_way = true;                 // false: the grains feel the fluid, which feels their porosity only
    std::int64_t grain_steps = 1;        // of the grains in one of the fluid
    std::int64_t clamped = 0;            // porosities below the densest packing, or above 1 at a grain, set to it
    GrainPlaces places;                  // by id, at the middle of the present step
    std::vector<double> mass;            // of the grains by id [kg]
    std::vector<Vec3> velocity;          // of the grains by id, at the start of the present step [m/s]; for `self`
};

/// Before the first step: lists, porosity and the mass of the fluid's particles, which is theirs at rest (`displaced`:
/// the grains have displaced fluid) or that of pure fluid. The fluid's initial state is there; start() comes after.
void couple(Coupling& coupling, SphFluid& fluid, const GrainSystem& grains, bool displaced);

/// The mirrors of the grains' places in the walls, for new lists.
void choose_mirrors(Coupling& coupling, const SphFluid& fluid, const GrainSystem& grains);

/// Advances both by one step of the fluid; `step` counts from 1. Readable as the scheme:
///     fluid and grains to the middle of the step, porosity there, accelerations of the fluid without the grains'
///     forces, the fluid gathered at the grains (less their own disturbance), the grains' step under its forces, their
///     momentum given back, the fluid's step.
void advance_coupled(Coupling& coupling, SphFluid& fluid, FluidOnGrains& at_grains, GrainSystem& grains, double dt,
                     std::int64_t step);

} // namespace plumb
