// Particles that continue the fluid beyond a wall or an open side. They are passive (clusters.hpp): their state is made
// from that of the fluid at a mirror point inside it.
#pragma once

#include "core/fluid_wall.hpp"
#include "core/vec.hpp"
#include "sph/clusters.hpp"

#include <cstdint>
#include <vector>

namespace plumb {

/// How the state behind a wall follows from the fluid's at the mirror point:
///     u = turn u_m + offset,    p = p_m + rho_0 f . (x - x_m)
/// with the body force f: a wall holds against it.
struct Continuation {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Vec3 offset = Vec3::Zero(); // [m/s]
};

struct BoundaryParticles {
    VectorField x;                         // [m]
    VectorField mirror;                    // [m]
    VectorField velocity, mirror_velocity; // with which they move [m/s]
    VectorField x_listed, mirror_listed;   // where they were when the lists were built [m]
    std::vector<std::int32_t> side;        // index of the open side, -1 of walls; walls come first
    std::vector<Continuation> rule;        // of walls: the velocity that friction sees
    std::vector<Continuation> slip; // of walls: the velocity that the continuity equation sees, as if all slipped
    // of walls: into the fluid, cosine of the contact angle, and the share of the fluid around the mirror point
    VectorField normal;
    Field<double> cos_contact, cover;
    VectorField excess; // the latter less the former, at present [m/s]
    // of open sides: slow means at the mirror point of the velocity along the flow and of the pressure; NaN until known
    Field<double> mean_speed, mean_pressure;
    // of open sides among grains: mass over that of a particle of pure fluid, and the fluid fraction at the plane; else
    // 1
    Field<double> share, eps;
    Field<double> rho;      // of the last evaluation [kg/m3]
    double fastest = 0.0;   // greatest of the velocities [m/s]
    double travelled = 0.0; // way of the fastest one since the lists were built [m]

    // Groups of eight mirror points and the fluid particles near them; renewed with the clusters.
    std::vector<std::int32_t> member; // [lanes] boundary particle of each lane; the last group is filled up
    NeighbourLists near_mirror;
    std::vector<std::int32_t> of_record;     // [records] boundary particle of each record, -1 for the fluid's
    std::vector<std::int32_t> near_clusters; // clusters with boundary particles in their neighbourhood

    std::size_t size() const { return side.size(); }
};

/// One of them, to be appended.
struct BoundaryParticle {
    Vec3 x, mirror, velocity, mirror_velocity;
    std::int32_t side = -1;
    Continuation rule, slip;
    Vec3 normal = Vec3::Zero();
    double cos_contact = 0.0;
};

void append_boundary_particle(BoundaryParticles& boundary, int dimensions, const BoundaryParticle& particle);

/// Keeps those numbered in `kept`, ascending.
void keep_boundary_particles(BoundaryParticles& boundary, int dimensions, const std::vector<std::int32_t>& kept);

struct SphFluid;

/// Sorts the mirror points into groups and lists the fluid's particles near each; after the clusters were rebuilt.
void list_mirrors(SphFluid& fluid);

/// The state of the boundary particles from that of the fluid, into their records, `since` [s] after the last time (for
/// the means of open sides). The fluid's records, with images, are up to date; the images of the boundary particles are
/// not, afterwards.
void continue_state(SphFluid& fluid, double since);

/// Takes what sticking walls seem to add to the divergence out of the density rates. A wall's friction is that of a
/// velocity continued antisymmetrically; its component along the wall jumps where walls of different speed meet (the
/// corners of a driven cavity), which the continuity equation would take for a source. There only the normal component
/// is turned round (Marrone et al. 2011, Comput. Methods Appl. Mech. Eng. 200, 1526).
void correct_continuity(SphFluid& fluid);

/// Moves boundary particles and mirror points by `dt` [s].
void move_boundary(SphFluid& fluid, double dt);

} // namespace plumb
