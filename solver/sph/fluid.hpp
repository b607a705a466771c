// A weakly compressible fluid as smoothed particles: plain fields, one entry per slot (clusters.hpp), and the models.
#pragma once

#include "core/domain.hpp"
#include "core/equation_of_state.hpp"
#include "core/field.hpp"
#include "sph/boundary.hpp"
#include "sph/clusters.hpp"
#include "sph/corrected_operators.hpp"
#include "sph/kernels.hpp"
#include "sph/open_boundaries.hpp"
#include "sph/pair_terms.hpp"
#include "sph/sources.hpp"
#include "sph/surface_tension.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

struct SphFluid {
    // the models, fixed for the whole run
    int dimensions = 3;
    Domain domain;
    Vec3 body_force = Vec3::Zero(); // acceleration that every particle feels [m/s2]
    double density = 0.0;           // rho_0 [kg/m3]
    double viscosity = 0.0;         // dynamic [Pa s]
    double spacing = 0.0;           // dx [m]
    double h = 0.0;                 // smoothing length [m]
    double sound_speed = 0.0;       // c [m/s]
    double mass = 0.0;              // of a particle: rho_0 dx^d [kg], [kg/m] in the plane
    Kernel kernel;
    Operators operators;
    EquationOfState equation_of_state;
    ViscousTerm viscous_term;
    Extras extras;
    Source source;
    double shifting = 0.0;            // diffusivity of positions [m2/s], 0 without
    double filling_time = 0.0;        // within which densities follow how full the room is [s], 0: never (filling.hpp)
    bool free_surface = false;        // particles near one are not shifted
    bool keeps_mean_density = false;  // of a closed volume: see keep_mean_density
    bool has_grains = false;          // also while no particle has come in yet
    bool shares_pressure = false;     // with grains: eps p of a particle is the fluid's (coupling/room_pressure.hpp)
    double wetting_pressure = 0.0;    // kappa of grains that share it [Pa] (coupling/wetting_laws.hpp)
    double background_pressure = 0.0; // that records hold besides their own, against clumping [Pa]
    double memory = 0.0;              // share of the rates before the last ones in the predictor (advance_fluid.hpp)

    // what changes in time
    VectorField x, v, a;     // position [m], velocity [m/s], acceleration of the last evaluation [m/s2]
    Field<double> rho, drho; // density [kg/m3], its rate in the last evaluation [kg/(m3 s)]
    // Among grains: the mass of a particle over that of a particle of pure fluid, fixed; and the fluid fraction where
    // it is. `rho` is then the mass of pure fluid over the particle's volume: share rho is the superficial density and
    // share rho/eps the density of the fluid itself. Empty without grains.
    Field<double> share, eps;
    Field<double> eps_of_record; // where the pressure is shared and there is a boundary
    VectorField a_before;        // and of the evaluation before that, where memory > 0
    Field<double> drho_before;
    // of the last evaluation, for shifting; empty without: -grad C [1/m], and what v and rho change by along it
    VectorField spread, dv_spread;
    Field<double> drho_spread;
    Field<double> completeness;   // 1 where particles are all around, about half of it at a free surface
    VectorField x_listed;         // where the particles were when the lists were built [m]
    std::vector<std::int32_t> id; // order of creation; -1 in copies and in particles that are about to vanish
    std::int32_t next_id = 0;
    std::size_t particles = 0; // number of them
    std::int64_t put_back = 0; // how often a particle was brought back from behind a wall
    Field<double> spare;       // for sorting the others
    FluidClusters clusters;
    CorrectedFields corrected; // of the last evaluation; empty with plain operators
    VariableLengths lengths;
    Surface surface; // its tension
    std::vector<FluidWall> walls;
    std::vector<OpenSide> open_sides;
    double mass_at_start = 0.0; // of all particles, which even outlets keep [kg]
    BoundaryParticles boundary; // of walls and open sides

    std::size_t slots() const { return id.size(); }
    bool among_grains() const { return has_grains || !share.empty(); }
};

/// Numbers that initial fields and sources may need.
inline FluidNumbers fluid_numbers(const SphFluid& f) {
    return {f.domain.size,
            f.density,
            f.sound_speed,
            f.viscosity,
            f.extras.stratified ? f.domain.gravity : Vec3(Vec3::Zero()),
            f.equation_of_state};
}

inline TermScales term_scales(const SphFluid& f) { return {f.mass, f.viscosity, f.h, f.sound_speed, f.dimensions}; }

/// Kinematic viscosity that the artificial viscosity adds to shear [m2/s]: alpha c h/(4 (d + 2)). For all pairs it
/// would be twice that (Monaghan 2005, Rep. Prog. Phys. 68, 1703, sec. 4.2); the term acts on the approaching half.
inline double artificial_nu(const SphFluid& f) { return f.extras.artificial * f.mass / (4.0 * (f.dimensions + 2)); }

/// What pairs push with where the fluid's own pressure is p: all of it or, where grains share it, its part and what
/// wetting them gives; and the background [Pa].
inline double pushing_pressure(const SphFluid& f, double p, double eps) {
    const double part = f.shares_pressure ? eps * (p - f.wetting_pressure) + f.wetting_pressure : p;
    return part + f.background_pressure;
}

/// The fluid's own pressure of that [Pa].
inline double own_pressure(const SphFluid& f, double pushing, double eps) {
    const double part = pushing - f.background_pressure;
    return f.shares_pressure ? (part - f.wetting_pressure) / eps + f.wetting_pressure : part;
}

/// What a record holds of a pressure p [Pa] that pushes, at a density.
inline double pressure_entry(const SphFluid& f, double p, double rho) {
    const double by = std::holds_alternative<VolumeWeightedOperators>(f.operators) ? f.mass : rho;
    return p / (by * by);
}

/// The pressure of a record that pushes [Pa].
inline double pressure_of(const SphFluid& f, const FluidRecord& record) {
    const bool by_mass = std::holds_alternative<VolumeWeightedOperators>(f.operators);
    const double by = by_mass ? f.mass : f.mass / record.volume;
    return record.pressure * by * by;
}

/// Slots of the particles, ascending by id.
std::vector<std::int32_t> ordered_slots(const SphFluid& fluid);

/// One more particle, in a slot at the end; it has lists from the next renewal on.
void append_particle(SphFluid& fluid, const Vec3& x, const Vec3& v, double rho);

/// Pressure of a density [Pa].
inline double pressure(const SphFluid& f, double rho) {
    return std::visit([&](const auto& law) { return law.pressure(rho, f.density, f.sound_speed); },
                      f.equation_of_state);
}

/// Density of a pressure [kg/m3].
inline double density_of_pressure(const SphFluid& f, double p) {
    return std::visit([&](const auto& law) { return law.density(p, f.density, f.sound_speed); }, f.equation_of_state);
}

/// Sorts the particles and builds new lists for the present positions; all fields move along.
void renew_lists(SphFluid& fluid);

/// After the fields of a checkpoint have been put in (any order of slots, x_listed included): the lists and the order
/// of the run that was saved.
void restore_lists(SphFluid& fluid);

/// Accelerations and density rates of all particles for the state in the records.
void evaluate_terms(SphFluid& fluid);

/// Takes the mean of the density rates out of them. A closed volume keeps its mean density; sums over particles that
/// the flow has disordered let it creep (verification/mms derives how fast), and with it the pressure, by several rho
/// U^2 in a long run.
void keep_mean_density(SphFluid& fluid);

/// Adds the scene's sources at a time [s] to the rates, at the particles' present places.
void add_sources(SphFluid& fluid, double time);

} // namespace plumb
