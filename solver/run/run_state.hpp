// One run: the scene, its simulation, its probes and what has been written so far.
#pragma once

#include "run/probes.hpp"
#include "run/provenance.hpp"
#include "run/result_files.hpp"

#include <string>
#include <vector>

namespace plumb {

struct Run {
    Scene scene;
    Simulation simulation;
    std::vector<Probe> probes;
    std::vector<SnapshotEntry> snapshots;
    std::string start;  // ISO time of the first start
    Cost cost;          // before this process took over
    bool begun = false; // the initial state has been recorded
};

/// Everything `scene` describes, ready for its first step. InputError for whatever cannot be meant, unread keys
/// included.
inline Run make_run(Scene scene) {
    Simulation simulation = make_simulation(scene);
    std::vector<Probe> probes = read_probes(scene, simulation);
    scene.root.finish();
    return {std::move(scene), std::move(simulation), std::move(probes), {}, iso_time(), {}, false};
}

/// Particles or open cells of a computed fluid.
inline std::size_t fluid_count(const Simulation& s) {
    if (s.grid) return static_cast<std::size_t>(s.grid->unknown_pressures);
    return s.sph ? s.sph->particles : 0;
}

/// Grains and the fluid's particles or cells: what a step updates.
inline std::size_t item_count(const Simulation& s) { return s.grains.grains.size() + fluid_count(s); }

/// Steps of the whole run.
inline std::int64_t total_steps(const Timing& timing) { return timing.outputs * timing.steps_per_output; }

} // namespace plumb
