// Walls of the fluid as layers of boundary particles.
#pragma once

#include "core/walls.hpp"
#include "sph/fluid.hpp"

#include <vector>

namespace plumb {

/// True behind any of the walls, where they are at t = 0. Meshes have to be closed.
bool is_solid(const std::vector<FluidWall>& walls, const Vec3& x);

/// Lines the walls with boundary particles as deep as the kernel reaches: the lattice of fill_box goes on into the
/// wall. A particle's mirror point is its reflection in every wall it lies behind; there the fluid's state is continued
/// antisymmetrically (no slip) or symmetrically (free slip, with the normal component turned round).
void line_walls(SphFluid& fluid, const std::vector<FluidWall>& walls);

/// How deep a particle lies behind a wall at `time` [s]; 0 in front of all. A mesh is asked only within `near` [m] of
/// it.
struct Penetration {
    double depth = 0.0;
    Vec3 normal = Vec3::Zero();        // of that wall, into the fluid
    Vec3 wall_velocity = Vec3::Zero(); // [m/s]
};
Penetration penetration(const std::vector<FluidWall>& walls, const Vec3& x, double time, double near);

} // namespace plumb
