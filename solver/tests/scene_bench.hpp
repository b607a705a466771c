// A scene from its text, made ready to run.
#pragma once

#include "run/probes.hpp"
#include "schemes/simulation.hpp"

#include <string>
#include <vector>

namespace plumb::fixture {

/// A scene read to its end, probes included.
struct Bench {
    Scene scene;
    Simulation simulation;
    std::vector<Probe> probes;
    explicit Bench(const std::string& text)
        : scene(scene_from_text(text, "scene.toml", "/")), simulation(make_simulation(scene)),
          probes(read_probes(scene, simulation)) {
        scene.root.finish();
    }
    SphFluid& fluid() { return simulation.sph.value(); }
    Grains& grains() { return simulation.grains.grains; }
};

} // namespace plumb::fixture
