// A weakly compressible fluid as smoothed particles: plain fields, one entry per slot (clusters.hpp), and the models.
#pragma once

#include "core/domain.hpp"
#include "core/field.hpp"
#include "sph/boundary.hpp"
#include "sph/clusters.hpp"
#include "sph/equation_of_state.hpp"
#include "sph/kernels.hpp"
#include "sph/pair_terms.hpp"

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
    EquationOfState equation_of_state;
    ViscousTerm viscous_term;
    Extras extras;
    double shifting = 0.0;     // diffusivity of positions [m2/s], 0 without
    bool free_surface = false; // particles near one are not shifted
    double memory = 0.0;       // share of the rates before the last ones in the predictor (advance_fluid.hpp)

    // what changes in time
    VectorField x, v, a;     // position [m], velocity [m/s], acceleration of the last evaluation [m/s2]
    Field<double> rho, drho; // density [kg/m3], its rate in the last evaluation [kg/(m3 s)]
    VectorField a_before;    // and of the evaluation before that, where memory > 0
    Field<double> drho_before;
    // of the last evaluation, for shifting; empty without: -grad C [1/m], and what v and rho change by along it
    VectorField spread, dv_spread;
    Field<double> drho_spread;
    Field<double> completeness;   // 1 where particles are all around, about half of it at a free surface
    VectorField x_listed;         // where the particles were when the lists were built [m]
    std::vector<std::int32_t> id; // order of creation; -1 in copies
    FluidClusters clusters;
    std::vector<FluidWall> walls;
    BoundaryParticles boundary; // of walls and open sides

    std::size_t slots() const { return id.size(); }
};

inline TermScales term_scales(const SphFluid& f) { return {f.mass, f.viscosity, f.h, f.sound_speed, f.dimensions}; }

/// Slot of each particle, by id.
std::vector<std::int32_t> slots_of_ids(const SphFluid& fluid);

/// Number of particles.
std::size_t particle_count(const SphFluid& fluid);

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

} // namespace plumb
