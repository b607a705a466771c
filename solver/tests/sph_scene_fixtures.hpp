// Scenes of smoothed particles, as text and made ready to run.
#pragma once

#include "run/probes.hpp"
#include "scene_bench.hpp"
#include "schemes/simulation.hpp"

#include "fluid_fixtures.hpp"

#include <map>
#include <numbers>
#include <string>

namespace plumb::fixture::sph_scene {

inline constexpr double pi = std::numbers::pi;
using Keys = std::map<std::string, std::string>; // value as TOML; an empty one takes the key away

/// 20 x 16 (x 12) particles of water, h = 0.075 m, c = 20 m/s, nu = 1e-4 m2/s.
inline std::string scene_text(int dimensions, const Keys& fluid_changes = {}, const Keys& domain_changes = {},
                              const std::string& more = "") {
    Keys domain =
        dimensions == 2
            ? Keys{{"size", "[1.0, 0.8]"}, {"periodic", "[true, true]"}, {"gravity", "[0.0, -9.81]"}}
            : Keys{{"size", "[1.0, 0.8, 0.6]"}, {"periodic", "[true, true, true]"}, {"gravity", "[0.0, 0.0, -9.81]"}};
    Keys fluid{{"method", "\"sph\""},          {"density", "1000.0"},
               {"viscosity", "0.1"},           {"spacing", "0.05"},
               {"smoothing", "1.5"},           {"sound_speed", "20.0"},
               {"kernel", "\"wendland_c2\""},  {"equation_of_state", "\"tait\""},
               {"viscous_term", "\"morris\""}, {"pressure", "\"full\""},
               {"arrange", "\"lattice\""},     {"initial", "\"rest\""},
               {"operators", "\"plain\""}};
    for (const auto& [key, value] : domain_changes) domain[key] = value;
    for (const auto& [key, value] : fluid_changes) fluid[key] = value;
    std::string text = "[domain]\n";
    const auto write = [&](const Keys& keys) {
        for (const auto& [key, value] : keys)
            if (!value.empty()) text.append(key).append(" = ").append(value).append("\n");
    };
    write(domain);
    text += "[fluid]\n";
    write(fluid);
    return text + "[time]\nend = 1e-2\noutput_interval = 1e-3\nintegrator = \"midpoint\"\nstep = 1e-4\n" + more;
}

inline void expect_refused(const std::string& text, std::initializer_list<std::string_view> parts) {
    expect_error([&] { Bench bench(text); }, parts);
}

} // namespace plumb::fixture::sph_scene
