// Everything the grains' motion needs, as plain data.
#pragma once

#include "core/domain.hpp"
#include "core/walls.hpp"
#include "dem/contact_model.hpp"
#include "dem/grains.hpp"
#include "dem/injectors.hpp"
#include "dem/neighbours.hpp"
#include "dem/wall_contacts.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace plumb {

enum class Integrator : std::uint8_t { velocity_verlet, semi_implicit_euler };

struct GrainSystem {
    Domain domain;
    std::vector<GrainGroup> groups;
    std::vector<WallBody> walls;
    ContactModel contact;
    std::vector<Injector> injectors;
    Integrator integrator = Integrator::velocity_verlet;

    // what changes in time
    Grains grains;
    Neighbours neighbours;
    WallContacts wall_contacts;
    std::vector<Injected> injected; // one per injector
    std::int64_t step = 0;          // steps done
    double time = 0.0;              // step * dt [s]
    double listed_time = 0.0;       // when the neighbour and wall lists were built [s]
    bool started = false;           // the lists and accelerations exist
};

/// True if grains of some group move as one.
inline bool has_block(const GrainSystem& system) {
    return std::any_of(system.groups.begin(), system.groups.end(),
                       [](const GrainGroup& g) { return g.motion == Motion::block; });
}

} // namespace plumb
