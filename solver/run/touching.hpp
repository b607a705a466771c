// Who touches whom now, or is held by a liquid bridge, and the energy of each contact: what several probes need.
#pragma once

#include "dem/grain_system.hpp"

#include <cstdint>
#include <vector>

namespace plumb {

/// Two grains in contact or joined by a bridge, first < second (ids).
struct TouchingPair {
    std::int32_t first, second;
    double overlap; // > 0 in contact; the separation, negative, where only a bridge joins them [m]
    double energy;  // elastic, and of the bridge [J]
    double bridge;  // liquid between them [m3], 0 without a bridge
};

/// One contact point of a grain with a wall, or a bridge to it.
struct TouchingWall {
    std::int32_t grain, wall, element;
    double overlap; // > 0 in contact; the separation, negative, where only a bridge holds the grain [m]
    double energy;  // elastic, and of the bridge [J]
    Vec3 force;     // last force on the grain [N]
    double bridge;  // liquid between them [m3], 0 without a bridge
};

/// All contacts of the present state in order of ids, hence whatever the order of the grains. A tangential or rolling
/// spring is remembered for the middle of the step and taken back to its end with the present velocity: the energy is
/// second order in dt [s]. A bridge that pulls with f has the energy -(integral of f ds from s to rupture), 0 when it
/// breaks, and in contact -f(0) o less: it is the energy that a pair lacks to part.
std::vector<TouchingPair> touching_pairs(const GrainSystem& system, double dt);
std::vector<TouchingWall> touching_walls(const GrainSystem& system, double dt);

/// Energy of the springs of one contact [J]: 1/2 k o^2 + 1/2 k_t s^2, or for Hertz 8/15 E* sqrt(R*) o^(5/2) +
/// 1/2 S_t s^2 with S_t = 8 G* sqrt(R* o); `slide_sq` = s^2 [m2], inverse_radius = 1/R* [1/m].
double elastic_energy(const ContactLaw& law, double overlap, double inverse_radius, double slide_sq);

} // namespace plumb
