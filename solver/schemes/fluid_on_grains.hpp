// Grains in a prescribed fluid: what the [fluid] and [coupling] tables say, and the forcing of the next step.
#pragma once

#include "core/table.hpp"
#include "coupling/drag_laws.hpp"
#include "coupling/exchange.hpp"
#include "coupling/history_force.hpp"
#include "coupling/other_forces.hpp"
#include "coupling/prescribed_flows.hpp"
#include "coupling/prescribed_porosity.hpp"
#include "dem/advance_grains.hpp"

#include <optional>
#include <vector>

namespace plumb {

/// How far a run left the range in which the source of its drag law says it holds.
struct RangeUse {
    double re_min = std::numeric_limits<double>::infinity(), re_max = 0.0; // superficial
    std::int64_t inside = 0, outside = 0;                                  // evaluations
};

struct FluidOnGrains {
    double density = 0.0;   // [kg/m3]
    double viscosity = 0.0; // dynamic [Pa s]
    PrescribedFlow flow;
    PrescribedPorosity porosity;
    DragLaw drag;
    std::vector<OtherForce> forces;
    std::optional<HistoryForce> history;
    Exchange exchange;

    std::optional<BassetKernel> kernel; // of `history` for the step in use: set by set_inertia

    // what changes in time
    FluidForcing forcing;               // by present order
    std::vector<Vec3> last_drag;        // mean drag of the last step [N], by id
    std::vector<Vec3> last_fluid_force; // mean of all forces of the fluid in the last step [N], by id
    RangeUse range_use;
};

/// Reads the [fluid] table with method "prescribed" and the [coupling] table.
FluidOnGrains read_fluid_on_grains(Table& fluid, Table& coupling);

/// Gives every grain the inertia it has in the fluid: its mass, the added mass, and the part of the history force that
/// acts like one in steps of `dt`. Needed before the first step and after grains have been added, or when dt changes.
void set_inertia(FluidOnGrains& fluid, GrainSystem& system, double dt);

/// Drive and step weights of all grains for the step of `dt` that starts now.
void update_forcing(FluidOnGrains& fluid, GrainSystem& system, double dt);

/// After the step: completes last_fluid_force, whose inertial part depends on the new velocities.
void complete_fluid_forces(FluidOnGrains& fluid, const GrainSystem& system, double dt);

} // namespace plumb
