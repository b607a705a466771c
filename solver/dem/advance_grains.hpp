// Motion of the grains over any number of steps.
#pragma once

#include "dem/grain_system.hpp"

#include <cstdint>
#include <vector>

namespace plumb {

/// What a fluid does to the grains during a step, frozen at the middle of the step. One entry per grain in the present
/// order. The motion of a grain is dv/dt = a_contacts + drive - rate v; phi0, phi1, phi2 are the functions of
/// z = rate * dt by which the chosen exchange integrates it (exponential: phi0 = exp(-z), phi1 = (1 - phi0)/z,
/// phi2 = (1 - phi1)/z).
struct FluidForcing {
    std::vector<Vec3> drive; // rate * u + other fluid accelerations [m/s2]
    std::vector<double> phi0, phi1, phi2;
    // Momentum that each grain has received from the fluid over the steps since this was last cleared [kg m/s]: what it
    // has gained less what contacts and gravity gave it. Not kept when empty; fixed grains have none.
    std::vector<Vec3> impulse;
    std::vector<double> memory; // whatever the fluid remembers of each grain (Basset history), memory_size numbers each
    std::size_t memory_size = 0;
};

/// Advances `system` by `steps` steps of `dt` seconds. With `forcing`, it acts unchanged in every step; it is reordered
/// along with the grains. Throws Diverged when a grain's state stops being finite, or when a grain that can collide
/// moves further than its radius in one step.
void advance_grains(GrainSystem& system, std::int64_t steps, double dt, FluidForcing* forcing = nullptr);

/// Builds the lists, the accelerations of the present state and the springs of its contacts for steps of `dt`; or the
/// lists only, when grains have been added since. advance_grains calls it; probes of the initial state need it before.
void start(GrainSystem& system, double dt = 0.0, FluidForcing* forcing = nullptr);

/// After the fields of a checkpoint have been put into `system`: builds the lists of the run that was saved.
void restore_lists(GrainSystem& system, const std::vector<RememberedContact>& pairs,
                   const std::vector<WallContact>& walls);

/// Sum of the last contact forces on every grain [N], in the present order.
std::vector<Vec3> contact_forces(const GrainSystem& system);

} // namespace plumb
