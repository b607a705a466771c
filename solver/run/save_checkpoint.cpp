#include "run/checkpoint.hpp"
#include "run/checkpoint_fields.hpp"
#include "run/hdf5_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace plumb {

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double), "fields of vectors are written as they lie in memory");

void write_field(Hdf5Writer& file, const std::string& name, const std::vector<Vec3>& field) {
    const auto* numbers = reinterpret_cast<const double*>(field.data());
    file.write(name, std::span(numbers, 3 * field.size()), {field.size(), 3});
}
template <class T> void write_field(Hdf5Writer& file, const std::string& name, const std::vector<T>& field) {
    file.write(name, field);
}

void write_contacts(Hdf5Writer& file, const GrainSystem& system) {
    std::vector<std::int32_t> ids;
    std::vector<double> values;
    const std::vector<RememberedContact> pairs = remembered_contacts(system.neighbours, system.grains);
    for (const RememberedContact& c : pairs) {
        ids.insert(ids.end(), {c.first, c.second});
        values.insert(values.end(), c.stretch.begin(), c.stretch.end());
    }
    file.write("contacts/ids", std::span<const std::int32_t>(ids), {pairs.size(), 2});
    file.write("contacts/stretch", std::span<const double>(values), {pairs.size(), 6});
    const bool wet = system.neighbours.bridges;
    std::vector<double> liquid;
    for (const RememberedContact& c : pairs) liquid.push_back(c.bridge);
    if (wet) file.write("contacts/bridge", liquid);
    ids.clear();
    values.clear();
    const std::vector<WallContact> walls = all_wall_contacts(system.wall_contacts);
    for (const WallContact& c : walls) {
        ids.insert(ids.end(), {c.grain, c.wall, c.element});
        values.insert(values.end(), c.stretch.begin(), c.stretch.end());
        values.insert(values.end(), c.force.begin(), c.force.end());
        values.insert(values.end(), c.torque.begin(), c.torque.end());
        values.push_back(c.overlap);
    }
    file.write("wall_contacts/ids", std::span<const std::int32_t>(ids), {walls.size(), 3});
    file.write("wall_contacts/values", std::span<const double>(values), {walls.size(), 13});
    liquid.clear();
    for (const WallContact& c : walls) liquid.push_back(c.bridge);
    if (wet) file.write("wall_contacts/bridge", liquid);
}

void write_fluid(Hdf5Writer& file, const FluidOnGrains& fluid) {
    const std::size_t width = fluid.forcing.memory_size;
    const std::size_t rows = width == 0 ? 0 : fluid.forcing.memory.size() / width;
    file.write("fluid/memory", std::span<const double>(fluid.forcing.memory), {rows, width});
    write_field(file, "fluid/last_drag", fluid.last_drag);
    write_field(file, "fluid/last_fluid_force", fluid.last_fluid_force);
    file.write("fluid/re_range", std::vector<double>{fluid.range_use.re_min, fluid.range_use.re_max});
    file.write("fluid/range_use",
               std::vector<std::int64_t>{fluid.range_use.inside, fluid.range_use.outside, fluid.range_use.dry});
}

void write_grid(Hdf5Writer& file, const GridFluid& f) {
    for_each_grid_field(f, [&](const std::string& name, const Field<double>& field) {
        file.write(name, std::span<const double>(field), {field.size()});
    });
    file.write("grid/two_steps", std::vector<std::int64_t>{f.u_before[0].empty() ? 0 : 1, f.eps_before.empty() ? 0 : 1,
                                                           f.eps_taken.empty() ? 0 : 1});
    file.write("grid/iterations", std::vector<std::int64_t>{f.iterations});
    file.write("grid/residual", std::vector<double>{f.greatest_residual});
}

void write_grid_coupling(Hdf5Writer& file, const GridCoupling& c) {
    write_field(file, "coupling/owed", c.owed);
    write_field(file, "coupling/freedom", c.freedom);
    if (c.self) {
        file.write("coupling/wakes", c.self->memory);
        file.write("coupling/waves_before", c.self->before);
    }
    file.write("coupling/bounded", std::vector<std::int64_t>{c.bounded});
}

void write_sph(Hdf5Writer& file, const SphFluid& f) {
    const std::vector<std::int32_t> slot = ordered_slots(f);
    for_each_fluid_field(f, [&](const std::string& name, const Field<double>& field) {
        std::vector<double> values(slot.size());
        for (std::size_t k = 0; k < slot.size(); ++k) values[k] = field[static_cast<std::size_t>(slot[k])];
        file.write(name, values);
    });
    std::vector<std::int32_t> id;
    for (const std::int32_t k : slot) id.push_back(f.id[static_cast<std::size_t>(k)]);
    file.write("sph/id", id);
    file.write("sph/counts", std::vector<std::int64_t>{f.next_id, f.put_back, f.lengths.capped});
    if (f.boundary.size() == 0) return;
    for_each_boundary_field(f.boundary, f.dimensions, [&](const std::string& name, const Field<double>& field) {
        file.write(name, std::vector<double>(field.begin(), field.end()));
    });
    file.write("sph/boundary/side", f.boundary.side);
    file.write("sph/boundary/ways", std::vector<double>{f.boundary.fastest, f.boundary.travelled});
}

void write_outputs(Hdf5Writer& file, const Run& run) {
    for (const Probe& probe : run.probes) {
        file.write("series/" + probe.name + "/time", probe.time);
        file.write("series/" + probe.name + "/value", probe.value);
    }
    std::vector<std::int64_t> grains;
    std::vector<double> times;
    std::vector<std::int64_t> particles;
    for (const SnapshotEntry& s : run.snapshots) {
        grains.push_back(static_cast<std::int64_t>(s.grains));
        particles.push_back(static_cast<std::int64_t>(s.particles));
        times.push_back(s.time);
    }
    file.write("snapshots/grains", grains);
    file.write("snapshots/particles", particles);
    file.write("snapshots/time", times);
}

void write_provenance(Hdf5Writer& file, const Run& run, const Cost& cost) {
    nlohmann::json j;
    j["text"] = run.scene.text;
    j["hash"] = run.scene.hash;
    j["path"] = run.scene.path;
    j["folder"] = run.scene.folder;
    j["overrides"] = run.scene.overrides;
    j["start"] = run.start;
    for (const SnapshotEntry& s : run.snapshots) j["snapshots"].push_back(s.file);
    file.write_bytes("provenance/run", j.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    file.write("provenance/cost",
               std::vector<double>{cost.wall_s, cost.cpu_s, static_cast<double>(cost.peak_bytes), cost.updates});
}

} // namespace

void save_checkpoint(const std::string& path, const Run& run, const Cost& cost) {
    const GrainSystem& system = run.simulation.grains;
    Hdf5Writer file(path, true);
    file.attribute("/", "format", std::string(format_name));
    file.attribute("/", "format_version", format_version);
    file.attribute("/", "step", system.step);
    file.attribute("/", "time", system.time);
    file.attribute("/", "dt", run.simulation.timing.dt);
    file.attribute("/", "listed_time", system.listed_time);
    for_each_field(system.grains, [&](const char* name, const auto& field) {
        write_field(file, fmt::format("grains/{}", name), field);
    });
    write_contacts(file, system);
    for (std::size_t q = 0; q < system.injected.size(); ++q)
        file.write(fmt::format("injectors/{}", q), system.injected[q].count);
    if (run.simulation.fluid) write_fluid(file, *run.simulation.fluid);
    if (run.simulation.sph) write_sph(file, *run.simulation.sph);
    if (run.simulation.grid) write_grid(file, *run.simulation.grid);
    if (run.simulation.grid_coupling) write_grid_coupling(file, *run.simulation.grid_coupling);
    if (run.simulation.coupling) {
        write_field(file, "coupling/x_listed", run.simulation.coupling->weights.x_listed);
        file.write("coupling/counts",
                   std::vector<std::int64_t>{run.simulation.coupling->clamped, run.simulation.coupling->at_greatest});
        if (run.simulation.coupling->self) file.write("coupling/wakes", run.simulation.coupling->self->memory);
    }
    write_outputs(file, run);
    write_provenance(file, run, cost);
    file.finish();
}

} // namespace plumb
