// Grains in a prescribed fluid: what the [fluid] and [coupling] tables say, and the forcing of the next step.
#pragma once

#include "core/prescribed_porosity.hpp"
#include "core/table.hpp"
#include "coupling/drag_laws.hpp"
#include "coupling/exchange.hpp"
#include "coupling/history_force.hpp"
#include "coupling/other_forces.hpp"
#include "coupling/prescribed_flows.hpp"
#include "coupling/weights.hpp"
#include "dem/advance_grains.hpp"

#include <optional>
#include <vector>

namespace plumb {

/// How far a run left the range in which the source of its drag law says it holds.
struct RangeUse {
    double re_min = std::numeric_limits<double>::infinity(), re_max = 0.0; // superficial
    std::int64_t inside = 0, outside = 0;                                  // evaluations
    std::int64_t dry = 0; // evaluations without a particle of the fluid in reach: nothing acts on the grain
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
    bool gathers = false;              // the fluid at the grains is gathered from a computed one, not given
    bool shares_pressure = false;      // that fluid has its part of the pressure already, the grains' is not its loss
    Vec3 mean_gradient = Vec3::Zero(); // of a pressure that drives a computed fluid and its grains alike [Pa/m]

    std::optional<BassetKernel> kernel; // of `history` for the step in use: set by set_inertia

    // what changes in time
    GatheredFluid at_grains;            // of the present step
    FluidForcing forcing;               // by present order
    std::vector<Vec3> last_drag;        // mean drag of the last step [N], by id
    std::vector<Vec3> last_fluid_force; // mean of all forces of the fluid in the last step [N], by id
    RangeUse range_use;
};

/// Whether the stress acts on the grains' volume.
bool feels_stress(const FluidOnGrains& fluid);

bool has_virtual_mass(const FluidOnGrains& fluid);

/// The laws of the [coupling] table: drag, forces, exchange.
void read_coupling_laws(Table& coupling, FluidOnGrains& fluid);

/// Reads the [fluid] table with method "prescribed" and the [coupling] table.
FluidOnGrains read_fluid_on_grains(Table& fluid, Table& coupling);

/// Gives every grain the inertia it has in the fluid: its mass, the added mass, and the part of the history force that
/// acts like one in steps of `dt`. Needed before the first step and after grains have been added, or when dt changes.
void set_inertia(FluidOnGrains& fluid, GrainSystem& system, double dt);

/// What has been gathered of a computed fluid at the grain `id`.
LocalFluid gathered_fluid(const FluidOnGrains& fluid, std::size_t id);

/// Drive and step weights of all grains for the step of `dt` that starts now, which they take in `parts`.
void update_forcing(FluidOnGrains& fluid, GrainSystem& system, double dt, std::int64_t parts = 1);

/// Share of the forces on a grain of diameter d [m] that no fluid of the scene exerts: buoyancy in a hydrostatic
/// pressure and the mean gradient [N].
Vec3 force_from_outside(const FluidOnGrains& fluid, double diameter, const Vec3& gravity);

/// After the step: completes last_fluid_force, whose inertial part depends on the new velocities.
void complete_fluid_forces(FluidOnGrains& fluid, const GrainSystem& system, double dt);

/// The grains' part of step number `step` of a computed fluid, of `dt`: `parts` steps of their own in what has been
/// gathered. What each receives is in the forcing's impulse.
void advance_gathered(FluidOnGrains& fluid, GrainSystem& system, double dt, std::int64_t step, std::int64_t parts);

} // namespace plumb
