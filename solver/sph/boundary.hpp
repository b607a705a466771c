// Particles that continue the fluid beyond a wall or an open side. They are passive (clusters.hpp): their state is made
// from that of the fluid at a mirror point inside it.
#pragma once

#include "core/vec.hpp"
#include "core/walls.hpp"
#include "sph/clusters.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

/// How a boundary particle's state follows from the fluid's at its mirror point:
///     u = turn u_m + offset,    p = share p_m + pressure + rho_0 f . (x - x_m)
/// with the body force f: a wall holds against it.
struct Continuation {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    Vec3 offset = Vec3::Zero(); // [m/s]
    double share = 1.0;
    double pressure = 0.0; // [Pa]
};

/// A wall as the fluid meets it.
struct FluidWall {
    WallBody body;
    bool slips = false;           // free slip; otherwise the fluid sticks
    bool fluid_is_inside = false; // of a closed mesh; other shapes know their side
};

struct BoundaryParticles {
    VectorField x;                       // [m]
    VectorField mirror;                  // [m]
    VectorField velocity;                // with which x and mirror move [m/s]
    VectorField x_listed, mirror_listed; // where they were when the lists were built [m]
    std::vector<Continuation> rule;
    double fastest = 0.0;   // greatest of the velocities [m/s]
    double travelled = 0.0; // way of the fastest one since the lists were built [m]

    // Groups of eight mirror points and the fluid particles near them; renewed with the clusters.
    std::vector<std::int32_t> member; // [lanes] boundary particle of each lane; the last group is filled up
    NeighbourLists near_mirror;

    std::size_t size() const { return rule.size(); }
};

struct SphFluid;

/// Sorts the mirror points into groups and lists the fluid's particles near each; after the clusters were rebuilt.
void list_mirrors(SphFluid& fluid);

/// The state of the boundary particles from that of the fluid, into their records. The fluid's records, with images,
/// are up to date; the images of the boundary particles are not, afterwards.
void continue_state(SphFluid& fluid);

/// Moves boundary particles and mirror points by `dt` [s].
void move_boundary(SphFluid& fluid, double dt);

} // namespace plumb
