// The step of a fluid on a grid with grains in it, each acting on the other.
#pragma once

#include "coupling/grid_weights.hpp"
#include "coupling/self_disturbance.hpp"
#include "coupling/weights.hpp"
#include "schemes/fluid_on_grains.hpp"

namespace plumb {

/// What couples the grid and the grains besides the laws in FluidOnGrains.
struct GridCoupling {
    bool two_way = true;
    bool own_volume = true;      // of a grain in the fluid fraction at it
    double least_porosity = 0.0; // of a cell
    GridWeights weights;
    std::int64_t grain_steps = 1; // in one of the fluid

    GrainPlaces places; // where the present velocities take the grains in the step, by id; one way, in half of it
    std::vector<double> reached; // share of that way, by id: less than 1 where a wall is in it
    Field<double> eps;           // by cell, of these places; the fluid's own where it feels the grains
    Relief relief;               // of these places

    // by id, over the steps
    std::vector<Vec3> owed; // what a grain has received and the fluid has not given yet, or the reverse [kg m/s]
    // Share of what acts on a grain, contacts apart, that sets it in motion: 1 for a free grain, 0 for one that its
    // neighbours hold. Of the last step.
    std::vector<double> freedom;
    std::optional<SelfDisturbance> self; // taken out of what the grains gather
    std::int64_t bounded = 0;            // cells of all steps that held more than they may
};

/// The porosity of the grains' present places, as if they had always been there.
void couple(GridCoupling& coupling, GridFluid& fluid, const GrainSystem& grains);

/// One step of `dt`. In the fluid's equations a grain is what its exchange law makes of it (foreseen_step) under the
/// velocity and the stress at the end of the step, u' and s', gathered where its present velocity takes it. What it
/// receives and its way are both linear in u' and p': the way is in the mass equation, so that no step is too long for
/// the slip, the stress, the mass of fluid that grains carry along or the room that they make for each other. What its
/// neighbours hold does not follow. The grains then take their own steps in the fluid found. What they receive, and
/// where they go, otherwise than foreseen the fluid gives, and makes room for, in its next step.
///
/// With `self` drag is that of the velocity without the grain's own wake, u' - past - R F: what the past has left and
/// what the step's own push F will add, which is linear in the drag, so that the equations stay linear in u' and no
/// step is too long for the slip. The step ends (Diverged) where a grain's own disturbance would carry it all, R times
/// the rate foreseen > 0.9.
void advance_grid_coupled(GridCoupling& coupling, GridFluid& fluid, FluidOnGrains& at_grains, GrainSystem& grains,
                          double dt, std::int64_t step);

} // namespace plumb
