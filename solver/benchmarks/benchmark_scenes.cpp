#include "benchmarks/benchmark_scenes.hpp"

#include "core/parallel.hpp"
#include "run/aside_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

namespace plumb {

namespace {

// In a pressed packing grains stay in their cages and the neighbour list would hold for ever. A velocity common to all
// (and to the floor) changes no force, but grains leave their place in the list as they do in a flow: with it the
// lists are renewed about every hundred steps, in the peers as well. [m/s]
const Vec3 lattice_drift{0.1, 0.06, 0.045};
const Vec3 bed_drift{0.0625, 0.0, 0.0}; // that of the floor in scenes/dem_bed.toml

std::string scene_path(const std::string& name) { return PLUMB_BENCHMARK_SCENES "/" + name; }

Simulation simulation(const std::string& name, const std::vector<std::string>& overrides, const Vec3& drift) {
    Scene scene = load_scene(scene_path(name), overrides);
    Simulation made = make_simulation(scene);
    for (Vec3& v : made.grains.grains.v) v += drift;
    return made;
}

/// Lets the grains of the pouring scene fall until they are at rest and writes where they are.
void pour(Scene& scene, const std::string& path) {
    Simulation s = make_simulation(scene);
    advance(s, s.timing.outputs * s.timing.steps_per_output);
    const Grains& grains = s.grains.grains;
    std::string text = "x [m], y [m], z [m]\n";
    for (const std::int32_t place : positions_of_ids(grains)) {
        const Vec3 x = s.grains.domain.wrapped(grains.x[static_cast<std::size_t>(place)]);
        fmt::format_to(std::back_inserter(text), "{:.17g}, {:.17g}, {:.17g}\n", x[0], x[1], x[2]);
    }
    write_text(path, text);
}

template <class FieldType> std::size_t bytes(const FieldType& field) {
    return field.capacity() * sizeof(typename FieldType::value_type);
}

} // namespace

Simulation pressed_lattice() { return simulation("dem_fcc.toml", {}, lattice_drift); }

Simulation settled_bed() {
    Scene pouring = load_scene(scene_path("dem_bed_pour.toml"), {});
    const std::string hash = pouring.hash.substr(pouring.hash.find(':') + 1);
    const std::string path = fmt::format("{}/bed_20000_{}.csv", PLUMB_BENCHMARK_CACHE, hash);
    if (!std::filesystem::exists(path)) pour(pouring, path);
    return simulation("dem_bed.toml", {fmt::format("grains.arrange.path='{}'", path)}, bed_drift);
}

Simulation driven_cavity() { return simulation("grid_cavity.toml", {}, Vec3::Zero()); }

Simulation mud_cake() {
    constexpr std::int64_t settling = 15; // steps of 1e-2 s, for the 25 mm that the highest of them fall
    Simulation s = simulation("mud_cake_step.toml", {}, Vec3::Zero());
    advance(s, settling);
    return s;
}

Memory memory(const GrainSystem& system) {
    Memory sum;
    for_each_field(system.grains, [&](const char* /*name*/, const auto& field) { sum.grains += bytes(field); });
    const Neighbours& list = system.neighbours;
    sum.grains +=
        bytes(list.own) + bytes(list.incoming_begin) + bytes(list.slots) + bytes(list.records) + bytes(list.spins);
    const WallContacts& walls = system.wall_contacts;
    sum.grains += bytes(walls.near) + bytes(walls.slot) + bytes(walls.contacts);
    for (const auto& contacts : walls.contacts) sum.grains += bytes(contacts);
    sum.pairs = bytes(list.i) + bytes(list.j) + bytes(list.incoming) + bytes(list.crosses) + bytes(list.stretch) +
                bytes(list.bridge) + bytes(list.force) + bytes(list.couple);
    return sum;
}

} // namespace plumb
