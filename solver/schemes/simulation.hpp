// A scene made ready to run, and the one verb that moves it forward.
#pragma once

#include "core/scene.hpp"
#include "dem/grain_system.hpp"
#include "schemes/advance_coupled.hpp"
#include "schemes/advance_fluid.hpp"
#include "schemes/advance_grid.hpp"
#include "schemes/advance_grid_coupled.hpp"
#include "schemes/fluid_on_grains.hpp"
#include "schemes/stable_step.hpp"

#include <cstdint>
#include <optional>

namespace plumb {

struct Simulation {
    GrainSystem grains;
    std::optional<FluidOnGrains> fluid; // what grains feel of a fluid, if there is one
    std::optional<SphFluid> sph;        // fluid.method = "sph"
    std::optional<GridFluid> grid;      // fluid.method = "grid"
    std::optional<Coupling> coupling;   // of smoothed particles and grains
    std::optional<GridCoupling> grid_coupling;
    Timing timing; // steps, outputs and limits, fixed for the whole run

    /// No grains are in the scene, nor can be.
    bool fluid_alone() const { return (sph || grid) && !coupling && !grid_coupling; }
};

/// Builds everything `scene` describes except the probes, which stay to be read from scene.root.
/// Throws InputError for whatever cannot be meant.
Simulation make_simulation(Scene& scene);

/// Advances by `steps` steps of timing.dt; injections due at the start of a step happen before it.
/// Throws Diverged naming the step limit that is most likely broken.
void advance(Simulation& simulation, std::int64_t steps);

} // namespace plumb
