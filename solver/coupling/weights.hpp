// The matrix P between the particles a of the fluid and the grains j,
//     P_aj = V_a W(|x_a - x_j|, h)/S_j,    S_j = sum_a V_a W(|x_a - x_j|, h),
// whose columns sum to one: q P gathers a field of the fluid at the grains, f P^T spreads forces of the grains over the
// fluid, so that the fluid loses what the grains receive, to round-off. Spreading and gathering may have kernels of
// different width. P is not stored: lists of who is near whom are, and the sums evaluate the kernel eight times at
// once, grains side by side when gathering and particles when spreading.
#pragma once

#include "core/vec.hpp"
#include "coupling/mirrored_grains.hpp"
#include "coupling/porosity_laws.hpp"
#include "coupling/radial_table.hpp"
#include "sph/fluid.hpp"

#include <vector>

namespace plumb {

/// Smoothing lengths [m] of the coupling's kernels.
struct CouplingWidths {
    double spread = 0.0, gather = 0.0, porosity = 0.0;
};

/// Places and sizes of all grains, by id.
struct GrainPlaces {
    std::vector<Vec3> x;        // [m], inside the box or not
    std::vector<double> volume; // [m3]
    MirroredGrains mirrored;    // in walls, where the scene says so
    std::size_t size() const { return x.size(); }
};

/// What the fluid reads of one grain.
struct alignas(64) CouplingRecord {
    double x, y, z;    // [m]
    double volume;     // [m3]
    double fx, fy, fz; // force to be spread over S_j [N/m3]
    double mass;       // over S_j [kg/m3]
};

struct Weights {
    Kernel kernel;
    CouplingWidths h;
    PorosityLaw porosity;          // what a grain takes from the fluid fraction around it
    bool own_volume = true;        // of a grain in the fluid fraction gathered at it
    double largest_diameter = 0.0; // [m]

    Clusters grains; // in groups of eight, as the fluid's particles are
    Field<CouplingRecord> records;
    std::vector<std::int32_t> id;             // [slots] of the grain, -1 in the copies that fill a group
    std::vector<Vec3> x_listed;               // by id: where the grains were when the lists were built, in the box [m]
    std::vector<Vec3> mirrored_listed;        // by mirror, likewise
    NeighbourLists fluid_near, grains_near;   // records of the fluid near groups of grains, and the other way round
    NeighbourLists porosity_near;             // likewise with mirrored grains, if there are any or it reaches further
    NeighbourLists fluid_near_mirrors;        // records of the fluid near groups of mirrored grains
    NeighbourLists fluid_far;                 // and near groups of grains, if the porosity reaches further
    NeighbourLists all_near;                  // records of fluid and boundary near groups of grains, where some are wet
    NeighbourLists open_near;                 // of grains, mirrored ones too, near the planes of open sides
    std::vector<std::int32_t> open_member;    // [lanes of open_near] particle of a buffer; the last group is filled up
    std::vector<std::int32_t> slot_of_record; // of the fluid's particle behind a record
    Field<double> sum, gather_sum; // S_j of the spreading and of the gathering kernel, by slot, over sigma/h^3
    Field<double> load;            // mass of grains over mass of fluid, by slot of the fluid
    RadialTables tables;           // of the porosity's law, but for `kernel`
    std::vector<std::int32_t> table_of_grain; // by id
    std::vector<std::int32_t> table_of;       // [records]; empty without tables

    const NeighbourLists& porosity_lists() const { return porosity_near.parts.empty() ? grains_near : porosity_near; }
    const NeighbourLists& fluid_near_porosity() const { return fluid_far.parts.empty() ? fluid_near : fluid_far; }
};

/// What the fluid is at the grains, by id.
struct GatheredFluid {
    std::vector<Vec3> u;      // velocity at the start of the step [m/s]
    std::vector<Vec3> a;      // acceleration without the forces of the grains [m/s2]
    std::vector<Vec3> stress; // -grad P + div tau [N/m3]
    std::vector<Vec3> along;  // Du/Dt over the step [m/s2]; empty where it is not known but by the stress
    std::vector<double> eps;  // fluid fraction
    std::vector<char> dry;    // 1 where no particle is in reach
    std::vector<double> wet;  // share of the room around a grain that fluid fills, at most 1; empty: it is all around
    std::vector<double> load; // mass of grains over mass of fluid, where the grain's force goes; 0 one way. Grains
                              // count as far as they are wet, and so does this one

    bool wants_gradient = false;           // set where a force needs it
    std::vector<Eigen::Matrix3d> gradient; // (i, j) = d u_i/d x_j of the velocity at the middle of the step [1/s]
};

/// How far the kernels of P reach, and how far a grain's part in the fluid fraction does [m].
inline double exchange_reach(const Weights& w) { return support(w.kernel) * std::max(w.h.spread, w.h.gather); }
double porosity_reach(const Weights& weights);
inline double reach(const Weights& w) { return std::max(exchange_reach(w), porosity_reach(w)); }

/// Whether some grain has moved so far that the lists may miss a neighbour.
bool outdated(const Weights& weights, const Domain& domain, const GrainPlaces& grains);

/// New lists for the fluid's present lists and the grains' present places; the fluid's images (FluidClusters::images)
/// go as far as the kernels.
void renew_weights(Weights& weights, const SphFluid& fluid, const GrainPlaces& grains);

/// Puts the grains where they are now.
void place_grains(Weights& weights, const Domain& domain, const GrainPlaces& grains);

/// Tables of the porosity's law for all grains, whose sizes never change.
void tabulate_porosity(Weights& weights, const GrainPlaces& grains);

/// eps_a = 1 - sum_j V_j G(|x_a - x_j|) at every particle of the fluid, and for those of the buffers of open sides
/// where their way meets the plane; returns how many were below what the densest packing of equal spheres leaves, 1 -
/// pi/sqrt 18, and were set to it.
std::int64_t set_porosity(SphFluid& fluid, const Weights& weights);

/// Takes out of the fluid fractions gathered at the grains what each has taken from its own: V_j sum_a P_aj G(|x_a -
/// x_j|). The sums of weights are there.
void take_out_own_volume(const Weights& weights, const SphFluid& fluid, std::vector<double>& eps);

/// Sets fluid fractions above 1 to it; returns how many were, by more than rounding.
std::int64_t bound_porosity(std::vector<double>& eps);

/// The fluid at the grains, and the S_j. `mass` of all grains by id [kg], for `load`, if it is wanted. Returns how many
/// fluid fractions were above 1 and were set to it.
std::int64_t gather(Weights& weights, const SphFluid& fluid, const std::vector<double>& mass, bool with_load,
                    GatheredFluid& at_grains);

/// Adds the accelerations by forces on the fluid that are given by the id of the grain they belong to [N].
void spread(SphFluid& fluid, Weights& weights, const std::vector<Vec3>& force);

} // namespace plumb
