// Contacts between grains and walls.
#pragma once

#include "core/domain.hpp"
#include "core/walls.hpp"
#include "dem/contact_model.hpp"
#include "dem/grains.hpp"
#include "dem/neighbours.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

/// One contact point of a grain with a wall, or the bridge that it has left, with its memory and its last force.
struct WallContact {
    std::int32_t grain;              // id
    std::int32_t wall;               // index
    std::int32_t element;            // of the wall
    std::array<double, 6> stretch{}; // tangential, then rolling
    Vec3 force = Vec3::Zero();       // on the grain [N]
    Vec3 torque = Vec3::Zero();      // on the grain about its centre [N m]
    double overlap = 0.0;            // [m]; negative where only a bridge holds the grain
    double bridge = 0.0;             // liquid between grain and wall [m3], 0 without a bridge
};

/// Grains near a wall, by place in the present order, and their contacts.
struct WallContacts {
    std::vector<std::int32_t> near;                 // places, ascending
    std::vector<std::int32_t> slot;                 // by place: q of near[q], or -1; empty without walls
    std::vector<std::vector<WallContact>> contacts; // of near[q]
    std::vector<std::size_t> walls_begin;           // of near[q] in `walls`, and the end
    std::vector<std::int32_t> walls;                // those that near[q] may touch, ascending
};

/// All contacts with a memory or a force, in order of grain id: for checkpoints and probes.
std::vector<WallContact> all_wall_contacts(const WallContacts& walls);

/// Finds the grains that may touch a wall, or be held by one, before the neighbour list is rebuilt, keeping `memory`:
/// those within `margin` [m] of a wall.
void rebuild(WallContacts& near_walls, const std::vector<WallBody>& walls, const Grains& grains, double margin,
             double time, const std::vector<WallContact>& memory);

/// Forces of the walls on the grains near them, from the records of the sweep over pairs (positions and the velocities
/// predicted for time `time`); the springs advance by dt.
void evaluate_wall_contacts(WallContacts& near_walls, const std::vector<WallBody>& walls, const ContactModel& model,
                            const Grains& grains, const Neighbours& list, double time, double dt);

} // namespace plumb
