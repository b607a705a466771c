#include "run/checkpoint.hpp"

#include "core/errors.hpp"
#include "run/checkpoint_fields.hpp"
#include "run/hdf5_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <type_traits>

namespace plumb {

namespace {

/// Reads one checkpoint; everything that does not fit together is damage.
class Loader {
public:
    explicit Loader(const std::string& path) : file_(path) {
        if (!file_.has_attribute("/", "format") || file_.text("/", "format") != format_name)
            fail("is no plumb checkpoint");
        const std::int64_t version = file_.integer("/", "format_version");
        if (version != format_version)
            throw InputError(fmt::format("{}: checkpoint of format {}; this program reads format {}", path, version,
                                         format_version));
    }
    Run load();

private:
    [[noreturn]] void fail(const std::string& what) const { throw IoError(fmt::format("{}: {}", file_.path(), what)); }
    void demand(bool holds, const char* what) const {
        if (!holds) fail(fmt::format("is damaged: {}", what));
    }
    std::vector<std::int64_t> integers(const std::string& name, std::size_t count) const {
        std::vector<std::int64_t> values = file_.integers(name);
        demand(values.size() == count, name.c_str());
        return values;
    }
    std::vector<double> doubles(const std::string& name, std::size_t count) const {
        std::vector<double> values = file_.doubles(name);
        demand(values.size() == count, name.c_str());
        return values;
    }
    std::int32_t index(std::int64_t value, std::size_t count, const char* what) const {
        demand(value >= 0 && value < static_cast<std::int64_t>(count), what);
        return static_cast<std::int32_t>(value);
    }
    template <class T> void read_field(const std::string& name, std::vector<T>& field, std::size_t n) const;
    void load_grains(GrainSystem& system) const;
    std::vector<RememberedContact> pairs(std::size_t n, bool wet) const;
    std::vector<WallContact> walls(std::size_t n, std::size_t walls, bool wet) const;
    void load_fluid(FluidOnGrains& fluid, std::size_t n) const;
    void load_boundary(BoundaryParticles& boundary, int dimensions) const;
    void load_sph(SphFluid& fluid) const;
    void load_grid(GridFluid& fluid) const;
    void load_coupling(Coupling& coupling, const SphFluid& fluid, const GrainSystem& grains) const;
    void load_coupling(GridCoupling& coupling, std::size_t n) const;
    void load_outputs(Run& run, const nlohmann::json& saved) const;

    Hdf5Reader file_;
};

template <class T> void Loader::read_field(const std::string& name, std::vector<T>& field, std::size_t n) const {
    field.resize(n);
    if constexpr (std::is_same_v<T, Vec3>) {
        const std::vector<double> values = doubles(name, 3 * n);
        for (std::size_t k = 0; k < n; ++k) field[k] = Vec3(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
    } else if constexpr (std::is_same_v<T, std::int32_t>) {
        const std::vector<std::int64_t> values = integers(name, n);
        for (std::size_t k = 0; k < n; ++k) field[k] = static_cast<std::int32_t>(values[k]);
    } else {
        field = doubles(name, n);
    }
}

void Loader::load_grains(GrainSystem& system) const {
    const std::size_t n = file_.shape("grains/id").at(0);
    for_each_field(system.grains,
                   [&](const char* name, auto& field) { read_field(fmt::format("grains/{}", name), field, n); });
    std::vector<bool> seen(n, false);
    for (const std::int32_t id : system.grains.id) {
        const auto k = static_cast<std::size_t>(index(id, n, "grains/id"));
        demand(!seen[k], "grains/id");
        seen[k] = true;
    }
    for (const std::int32_t group : system.grains.group) index(group, system.groups.size(), "grains/group");
    for (std::size_t q = 0; q < system.injectors.size(); ++q)
        system.injected[q].count = integers(fmt::format("injectors/{}", q), system.injectors[q].points.size());
    const bool wet = liquid_bridges(system.contact) != nullptr;
    restore_lists(system, pairs(n, wet), walls(n, system.walls.size(), wet));
}

std::vector<RememberedContact> Loader::pairs(std::size_t n, bool wet) const {
    const std::size_t count = file_.shape("contacts/ids").at(0);
    const std::vector<std::int64_t> ids = integers("contacts/ids", 2 * count);
    const std::vector<double> stretch = doubles("contacts/stretch", 6 * count);
    const std::vector<double> liquid = wet ? doubles("contacts/bridge", count) : std::vector<double>(count, 0.0);
    std::vector<RememberedContact> memory(count);
    for (std::size_t k = 0; k < count; ++k) {
        memory[k].first = index(ids[2 * k], n, "contacts/ids");
        memory[k].second = index(ids[2 * k + 1], n, "contacts/ids");
        std::copy_n(stretch.begin() + static_cast<std::ptrdiff_t>(6 * k), 6, memory[k].stretch.begin());
        memory[k].bridge = liquid[k];
    }
    return memory;
}

std::vector<WallContact> Loader::walls(std::size_t n, std::size_t walls, bool wet) const {
    const std::size_t count = file_.shape("wall_contacts/ids").at(0);
    const std::vector<std::int64_t> ids = integers("wall_contacts/ids", 3 * count);
    const std::vector<double> values = doubles("wall_contacts/values", 13 * count);
    const std::vector<double> liquid = wet ? doubles("wall_contacts/bridge", count) : std::vector<double>(count, 0.0);
    std::vector<WallContact> memory(count);
    for (std::size_t k = 0; k < count; ++k) {
        WallContact& c = memory[k];
        c.grain = index(ids[3 * k], n, "wall_contacts/ids");
        c.wall = index(ids[3 * k + 1], walls, "wall_contacts/ids");
        c.element = static_cast<std::int32_t>(ids[3 * k + 2]);
        const double* v = values.data() + 13 * k;
        std::copy_n(v, 6, c.stretch.begin());
        c.force = Vec3(v[6], v[7], v[8]);
        c.torque = Vec3(v[9], v[10], v[11]);
        c.overlap = v[12];
        c.bridge = liquid[k];
    }
    return memory;
}

void Loader::load_fluid(FluidOnGrains& fluid, std::size_t n) const {
    const Shape memory = file_.shape("fluid/memory");
    demand(memory.size() == 2 && (memory[1] == 0 || memory[0] == n), "fluid/memory");
    fluid.forcing.memory = file_.doubles("fluid/memory");
    fluid.forcing.memory_size = memory[1];
    read_field("fluid/last_drag", fluid.last_drag, n);
    read_field("fluid/last_fluid_force", fluid.last_fluid_force, n);
    const std::vector<double> re = doubles("fluid/re_range", 2);
    const std::vector<std::int64_t> use = integers("fluid/range_use", 3);
    fluid.range_use.re_min = re[0], fluid.range_use.re_max = re[1];
    fluid.range_use.inside = use[0], fluid.range_use.outside = use[1], fluid.range_use.dry = use[2];
}

void Loader::load_boundary(BoundaryParticles& b, int dimensions) const {
    const std::vector<std::int64_t> side = file_.integers("sph/boundary/side");
    for_each_boundary_field(b, dimensions, [&](const std::string& name, Field<double>& field) {
        const std::vector<double> values = file_.doubles(name); // means may be NaN
        demand(values.size() == side.size(), name.c_str());
        field.assign(values.begin(), values.end());
    });
    b.side.assign(side.begin(), side.end());
    b.rule.resize(side.size()); // those of walls come first and follow from the scene
    b.slip.resize(side.size());
    for (Field<double>& excess : b.excess) excess.assign(side.size(), 0.0);
    const std::vector<double> ways = doubles("sph/boundary/ways", 2);
    b.fastest = ways[0], b.travelled = ways[1];
}

void Loader::load_sph(SphFluid& f) const {
    const std::vector<std::int64_t> ids = file_.integers("sph/id");
    const std::size_t n = ids.size();
    for_each_fluid_field(f, [&](const std::string& name, Field<double>& field) {
        const std::vector<double> values = doubles(name, n);
        field.assign(values.begin(), values.end());
    });
    f.id.assign(ids.begin(), ids.end());
    f.particles = n;
    const std::vector<std::int64_t> counts = integers("sph/counts", 3);
    f.next_id = static_cast<std::int32_t>(counts[0]);
    f.put_back = counts[1];
    f.lengths.capped = counts[2];
    if (f.boundary.size() > 0) load_boundary(f.boundary, f.dimensions);
    restore_lists(f);
}

void Loader::load_grid(GridFluid& f) const {
    const std::vector<std::int64_t> two_steps =
        integers("grid/two_steps", 3); // of the velocity, of the porosity; eps_taken
    if (two_steps[0] != 0) f.u_before = f.u;
    if (two_steps[1] != 0) f.eps_before = f.eps;
    if (two_steps[2] != 0) f.eps_taken = f.eps;
    for_each_grid_field(f, [&](const std::string& name, Field<double>& field) {
        const std::vector<double> values = doubles(name, field.size());
        field.assign(values.begin(), values.end());
    });
    f.iterations = integers("grid/iterations", 1)[0];
    f.greatest_residual = doubles("grid/residual", 1)[0];
}

void Loader::load_coupling(Coupling& coupling, const SphFluid& fluid, const GrainSystem& grains) const {
    read_field("coupling/x_listed", coupling.places.x, coupling.places.size());
    const std::vector<std::int64_t> counts = integers("coupling/counts", 2);
    coupling.clamped = counts[0], coupling.at_greatest = counts[1];
    if (coupling.self) {
        coupling.self->memory = file_.doubles("coupling/wakes");
        demand(coupling.self->memory.size() == coupling.places.size() * wake_size(), "coupling/wakes");
    }
    choose_mirrors(coupling, fluid, grains);
    renew_weights(coupling.weights, fluid, coupling.places);
}

void Loader::load_coupling(GridCoupling& coupling, std::size_t n) const {
    read_field("coupling/owed", coupling.owed, n);
    read_field("coupling/freedom", coupling.freedom, n);
    if (coupling.self) {
        coupling.self->memory = file_.doubles("coupling/wakes");
        coupling.self->before = file_.doubles("coupling/waves_before");
        demand(coupling.self->memory.size() == n * wake_size(), "coupling/wakes");
        demand(coupling.self->before.size() == n * waves_before_size(), "coupling/waves_before");
    }
    coupling.bounded = integers("coupling/bounded", 1)[0];
}

void Loader::load_outputs(Run& run, const nlohmann::json& saved) const {
    for (Probe& probe : run.probes) {
        probe.time = file_.doubles("series/" + probe.name + "/time");
        probe.value = doubles("series/" + probe.name + "/value", probe.width * probe.time.size());
    }
    const std::vector<std::int64_t> grains = file_.integers("snapshots/grains");
    const std::vector<double> times = doubles("snapshots/time", grains.size());
    const std::vector<std::int64_t> particles = integers("snapshots/particles", grains.size());
    if (grains.empty()) return;
    const auto& names = saved.at("snapshots");
    demand(names.size() == grains.size(), "snapshots");
    for (std::size_t k = 0; k < grains.size(); ++k)
        run.snapshots.push_back({names.at(k).get<std::string>(), times[k], static_cast<std::size_t>(grains[k]),
                                 static_cast<std::size_t>(particles[k])});
}

Run Loader::load() {
    const nlohmann::json saved = nlohmann::json::parse(file_.bytes("provenance/run"), nullptr, false);
    demand(!saved.is_discarded(), "provenance/run");
    Scene scene = scene_from_text(saved.at("text").get<std::string>(), saved.at("path").get<std::string>(),
                                  saved.at("folder").get<std::string>());
    demand(scene.hash == saved.at("hash").get<std::string>(), "the scene");
    scene.overrides = saved.at("overrides").get<std::vector<std::string>>();
    Run run = make_run(std::move(scene));
    run.start = saved.at("start").get<std::string>();
    const std::vector<double> cost = doubles("provenance/cost", 4);
    run.cost = {cost[0], cost[1], static_cast<std::int64_t>(cost[2]), cost[3]};

    const double dt = file_.number("/", "dt");
    if (dt != run.simulation.timing.dt)
        throw InputError(fmt::format("{}: was made with steps of {:.17g} s, but the scene now gives {:.17g} s; files "
                                     "that the scene names, or the program, have changed",
                                     file_.path(), dt, run.simulation.timing.dt));
    GrainSystem& system = run.simulation.grains;
    system.step = file_.integer("/", "step");
    system.time = static_cast<double>(system.step) * dt;
    system.listed_time = file_.number("/", "listed_time");
    if (run.simulation.sph) load_sph(*run.simulation.sph);
    if (run.simulation.grid) load_grid(*run.simulation.grid);
    if (!run.simulation.fluid_alone()) load_grains(system);
    if (run.simulation.coupling) load_coupling(*run.simulation.coupling, *run.simulation.sph, system);
    if (run.simulation.grid_coupling) load_coupling(*run.simulation.grid_coupling, system.grains.size());
    if (run.simulation.fluid) load_fluid(*run.simulation.fluid, system.grains.size());
    load_outputs(run, saved);
    run.begun = true;
    return run;
}

} // namespace

Run load_checkpoint(const std::string& path) {
    const auto damaged = [&](const std::exception& e) {
        return IoError(fmt::format("{}: is damaged: {}", path, e.what()));
    };
    try {
        return Loader(path).load();
    } catch (const nlohmann::json::exception& e) {
        throw damaged(e);
    } catch (const std::out_of_range& e) {
        throw damaged(e);
    }
}

} // namespace plumb
