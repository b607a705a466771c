// The scenes of the benchmarks, made ready to run.
#pragma once

#include "schemes/simulation.hpp"

#include <cstddef>

namespace plumb {

/// Periodic face-centred cubic lattice of 17^3 cells: 19 652 grains, each pressed against twelve others.
Simulation pressed_lattice();

/// Settled random bed of 20 000 grains on a plane. The first call pours it, which takes a minute or two, and keeps the
/// positions in the build folder under a name that contains the hash of the pouring scene.
Simulation settled_bed();

/// The driven cavity on a grid of 1024^2 cells.
Simulation driven_cavity();

/// Grains that have settled on the mud cake's plug, more of which are injected. The first call takes some seconds.
Simulation mud_cake();

/// Memory that the state and the lists of a system hold [bytes], measured by the capacities of their containers.
struct Memory {
    std::size_t grains = 0; // what grows with the grains
    std::size_t pairs = 0;  // what grows with the listed pairs
};
Memory memory(const GrainSystem& system);

} // namespace plumb
