// Scenes of smoothed particles and grains for tests.
#pragma once

#include "run/probes.hpp"
#include "schemes/simulation.hpp"

#include "fluid_fixtures.hpp"

#include <fmt/format.h>

#include <map>

namespace plumb::fixture {

using Keys = std::map<std::string, std::string>;

/// Water and grains of 0.1 mm on a lattice, in a periodic cube of 1.6 mm; h = 0.2 mm.
inline std::string coupled_scene_text(const Keys& changes = {}) {
    std::map<std::string, Keys> tables{
        {"domain",
         {{"size", "[1.6e-3, 1.6e-3, 1.6e-3]"}, {"periodic", "[true, true, true]"}, {"gravity", "[1.0, 0.0, -9.81]"}}},
        {"fluid",
         {{"method", "\"sph\""},
          {"density", "1000.0"},
          {"viscosity", "8.9e-4"},
          {"spacing", "1.3333333333333333e-4"},
          {"smoothing", "1.5"},
          {"kernel", "\"wendland_c2\""},
          {"equation_of_state", "\"linear\""},
          {"sound_speed", "0.2"},
          {"pressure", "\"dynamic\""},
          {"operators", "\"plain\""},
          {"viscous_term", "\"morris\""},
          {"arrange", "\"lattice\""},
          {"initial", "\"rest\""}}},
        {"grains",
         {{"name", "\"grain\""},
          {"diameter", "1e-4"},
          {"density", "2500.0"},
          {"rotation", "false"},
          {"motion", "\"free\""},
          {"velocity", "[0.0, 0.0, 0.0]"},
          {"contact", "\"none\""},
          {"arrange",
           "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = [1.6e-3, 1.6e-3, 1.6e-3], "
           "spacing = 2e-4}"}}},
        {"coupling",
         {{"direction", "\"two_way\""},
          {"kernel", "\"wendland_c2\""},
          {"kernel_width", "{times_diameter = 2.0}"},
          {"fluid_mass", "\"displaced\""},
          {"drag", "\"di_felice\""},
          {"forces", "[\"buoyancy\", \"pressure_gradient\"]"},
          {"exchange", "\"exponential\""},
          {"porosity", "\"kernel\""},
          {"own_volume", "\"included\""},
          {"self_disturbance", "\"none\""},
          {"suspension_viscosity", "\"none\""},
          {"mean_pressure_gradient", "\"balances_weight\""}}},
        {"time",
         {{"end", "1e-2"},
          {"output_interval", "1e-3"},
          {"integrator", "\"midpoint\""},
          {"step", "2e-4"},
          {"grain_step", "\"auto\""}}}};
    for (const auto& [key, value] : changes) {
        const std::size_t dot = key.find('.');
        tables[key.substr(0, dot)][key.substr(dot + 1)] = value;
    }
    std::string text;
    for (const auto& [name, keys] : tables) {
        text += fmt::format("[{}]\n", name);
        for (const auto& [key, value] : keys)
            if (!value.empty()) text += fmt::format("{} = {}\n", key, value);
    }
    return text;
}

struct CoupledBench {
    Scene scene;
    Simulation simulation;
    explicit CoupledBench(const std::string& text)
        : scene(scene_from_text(text, "scene.toml", "/")), simulation(make_simulation(scene)) {
        scene.root.finish();
    }
    explicit CoupledBench(const Keys& changes = {}) : CoupledBench(coupled_scene_text(changes)) {}
    SphFluid& fluid() { return simulation.sph.value(); }
    Grains& grains() { return simulation.grains.grains; }
};

/// Gives every grain another velocity, and the fluid a vortex.
inline void stir(CoupledBench& bench) {
    Grains& g = bench.grains();
    const bool alike = has_block(bench.simulation.grains); // grains of a block have one velocity
    for (std::size_t k = 0; k < g.size(); ++k) {
        const double s = alike ? 1.0 : static_cast<double>(g.id[k]);
        g.v[k] = 3e-3 * Vec3(std::sin(s), std::cos(2.0 * s), std::sin(3.0 * s));
    }
    SphFluid& f = bench.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k)
        f.v[0][k] = 2e-3 * std::sin(2.0 * std::numbers::pi * f.x[1][k] / 1.6e-3);
}

inline Vec3 momentum(CoupledBench& bench) {
    Vec3 sum = Vec3::Zero();
    const SphFluid& f = bench.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) sum += f.mass * f.share[k] * Vec3(f.v[0][k], f.v[1][k], f.v[2][k]);
    const Grains& g = bench.grains();
    for (std::size_t k = 0; k < g.size(); ++k) sum += g.mass[k] * g.v[k];
    return sum;
}

inline void expect_same_state(CoupledBench& a, CoupledBench& b) {
    expect_same_bits(a.fluid(), b.fluid());
    for (std::size_t k = 0; k < a.grains().size(); ++k) {
        ASSERT_EQ(a.grains().x[k], b.grains().x[k]);
        ASSERT_EQ(a.grains().v[k], b.grains().v[k]);
    }
}

/// Twenty steps of a stirred scene keep the momentum of fluid and grains, to 1e-12 of the weight's impulse (steps of
/// 2e-4 s).
inline void expect_momentum(CoupledBench& bench) {
    stir(bench);
    const Vec3 before = momentum(bench);
    advance(bench.simulation, 20);
    const Grains& g = bench.grains();
    const double weight = 20.0 * 2e-4 * g.mass[0] * static_cast<double>(g.size()) * 9.81;
    EXPECT_LT((momentum(bench) - before).norm(), 1e-12 * weight);
}

/// They do, and have the same bits for one thread and four.
inline void expect_momentum_and_bits(const Keys& keys) {
    CoupledBench one(keys), four(keys);
    const auto run = [](CoupledBench& bench, int n) {
        const Threads threads(n);
        expect_momentum(bench);
    };
    run(one, 1), run(four, 4);
    expect_same_state(one, four);
}

} // namespace plumb::fixture
