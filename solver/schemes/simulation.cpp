#include "schemes/simulation.hpp"

#include "core/errors.hpp"
#include "dem/advance_grains.hpp"
#include "dem/arrange.hpp"
#include "schemes/coupled_scene.hpp"
#include "schemes/grid_coupled_scene.hpp"
#include "schemes/grid_scene.hpp"
#include "schemes/sph_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace plumb {

namespace {

Domain read_domain(Table table) {
    Domain domain;
    domain.dimensions = table.length("size") == 2 ? 2 : 3;
    domain.size = table.components("size", domain.dimensions, positive);
    domain.periodic = table.component_flags("periodic", domain.dimensions);
    domain.gravity = table.components("gravity", domain.dimensions);
    return domain;
}

/// Contact tables of the groups, then of the walls, then the pairs between them.
ContactModel read_contacts(Table& root, const GrainSystem& system, std::vector<Table>& grain_tables,
                           std::vector<Table>& wall_tables) {
    std::vector<std::string> names;
    std::vector<std::optional<MaterialContact>> own;
    for (std::size_t q = 0; q < grain_tables.size(); ++q) {
        names.push_back(system.groups[q].name);
        own.emplace_back(read_contact(grain_tables[q].law("contact")));
    }
    for (std::size_t w = 0; w < wall_tables.size(); ++w) {
        names.push_back(system.walls[w].name);
        if (wall_tables[w].type("contact") == toml::node_type::string && wall_tables[w].text("contact") == "as_grains")
            own.emplace_back(std::nullopt);
        else
            own.emplace_back(read_contact(wall_tables[w].law("contact")));
    }
    std::vector<PairContact> pairs;
    for (Table& table : root.tables("contact")) {
        const std::vector<std::string> between = table.texts("between");
        if (between.size() != 2) table.fail("between", "expected two names");
        pairs.push_back({between[0], between[1], read_contact(table)});
    }
    return contact_model(names, own, system.groups.size(), pairs, root.file());
}

Integrator read_integrator(Table& time) {
    return time.choice("integrator", {"velocity_verlet", "semi_implicit_euler"}) == "velocity_verlet"
               ? Integrator::velocity_verlet
               : Integrator::semi_implicit_euler;
}

void read_grain_system(Table& root, GrainSystem& system) {
    if (system.domain.dimensions != 3) root.fail("domain", "grains need a box of three dimensions");
    std::vector<Table> wall_tables = walls_that_hold(root.tables("wall"), "grains");
    std::vector<Table> grain_tables = root.tables("grains");
    if (grain_tables.empty()) root.fail("grains", "missing; expected one [grains] table or several [[grains]]");
    system.walls = make_walls(wall_tables);
    for (std::size_t w = 0; w < system.walls.size(); ++w)
        system.walls[w].material = static_cast<std::int32_t>(grain_tables.size() + w);
    add_grains(system.grains, system.groups, grain_tables, system.domain, system.walls);
    system.contact = read_contacts(root, system, grain_tables, wall_tables);
    const bool touching = !contactless(system.contact);
    check_start(system.grains, system.groups, grain_tables, system.domain, system.walls,
                [touching](std::int32_t /*a*/, std::int32_t /*b*/) { return touching; });
    for (Table& table : root.tables("injector")) {
        system.injectors.push_back(make_injector(table, system.groups, system.domain, system.walls));
        system.injected.push_back(nothing_injected(system.injectors.back()));
    }
    check_bridges(system, root.file());
    if (system.grains.size() == 0 && system.injectors.empty())
        root.fail("grains", "no grains at the start and no injector");
}

/// Bound of the explicit exchange: twice the relaxation time of the grain that relaxes fastest. The other choices have
/// none.
StepLimit drag_limit(const FluidOnGrains& fluid, const GrainSystem& system) {
    double fastest = 0.0; // [1/s]
    for (std::size_t k = 0; k < system.grains.size(); ++k) {
        const Vec3& x = system.grains.x[k];
        const double eps = porosity_at(fluid.porosity, x, system.domain);
        const double slip =
            (std::visit([&](const auto& flow) { return flow(x, 0.0); }, fluid.flow).u - system.grains.v[k]).norm();
        fastest =
            std::max(fastest, system.grains.mobility[k] * drag_resistance(fluid.drag, fluid.density, fluid.viscosity,
                                                                          2.0 * system.grains.radius[k], eps, slip));
    }
    return {"drag", fastest > 0.0 ? 2.0 / fastest : std::numeric_limits<double>::infinity(),
            "2 tau_p, explicit exchange only"};
}

/// The same in a computed fluid at rest, at the least porosity of its particles: where grains drag fluid of less mass
/// along, the slip relaxes (1 + load) times as fast.
StepLimit drag_limit(const FluidOnGrains& on_grains, const GrainSystem& system, const SphFluid& fluid) {
    const double eps = *std::min_element(fluid.eps.begin(), fluid.eps.end());
    double fastest = 0.0; // [1/s]
    for (std::size_t k = 0; k < system.grains.size(); ++k) {
        const double d = 2.0 * system.grains.radius[k];
        const double load = system.grains.mass[k] / sphere_volume(d) * (1.0 - eps) / (fluid.density * eps);
        fastest = std::max(fastest, (1.0 + load) * system.grains.mobility[k] *
                                        drag_resistance(on_grains.drag, fluid.density, fluid.viscosity, d, eps, 0.0));
    }
    return {"drag", fastest > 0.0 ? 2.0 / fastest : std::numeric_limits<double>::infinity(),
            "2 tau_p/(1 + mass of grains over mass of fluid), explicit exchange only"};
}

std::vector<double> probe_intervals(Table& root) {
    std::vector<double> intervals;
    for (Table& probe : root.tables("probe"))
        if (probe.has("interval")) intervals.push_back(probe.number("interval", positive));
    return intervals;
}

/// Forces at t = 0 for the probes, without touching the state of the run.
void show_initial_forces(FluidOnGrains& fluid, const GrainSystem& system, double dt) {
    FluidOnGrains copy = fluid;
    GrainSystem now = system;
    update_forcing(copy, now, dt);
    fluid.last_drag = copy.last_drag;
    for (std::size_t k = 0; k < now.grains.size(); ++k) { // no acceleration yet, hence no inertial part
        const double added = now.grains.mobility[k] > 0.0 ? 1.0 / now.grains.mobility[k] - now.grains.mass[k] : 0.0;
        copy.last_fluid_force[static_cast<std::size_t>(now.grains.id[k])] -= (added / dt) * now.grains.v[k];
    }
    fluid.last_fluid_force = copy.last_fluid_force;
}

/// Says which step limit a diverged run most likely broke.
[[noreturn]] void name_limit(const Diverged& what, const Timing& timing) {
    std::string blame = what.likely_limit;
    for (const StepLimit& limit : timing.limits)
        if (timing.dt > limit.seconds)
            blame += fmt::format("; the step of {:.6g} s breaks the {} limit of {:.6g} s ({})", timing.dt, limit.name,
                                 limit.seconds, limit.formula);
    throw Diverged(what.step, what.time, what.field, what.index, what.value, blame);
}

std::size_t inject_due(GrainSystem& system) {
    std::size_t added = 0;
    for (std::size_t q = 0; q < system.injectors.size(); ++q)
        added +=
            inject(system.grains, system.injected[q], system.injectors[q], system.groups, system.domain, system.time);
    return added;
}

void advance_one(Simulation& s) {
    const double dt = s.timing.dt;
    if (inject_due(s.grains) > 0 && s.fluid) set_inertia(*s.fluid, s.grains, dt);
    start(s.grains, dt, s.fluid ? &s.fluid->forcing : nullptr);
    if (!s.fluid) return advance_grains(s.grains, 1, dt);
    update_forcing(*s.fluid, s.grains, dt);
    advance_grains(s.grains, 1, dt, &s.fluid->forcing);
    complete_fluid_forces(*s.fluid, s.grains, dt);
}

/// True when the scene asks for this kind of fluid; a [fluid] table that does not say is left to its own reader.
bool is_method(Table& root, std::string_view method) {
    if (!root.has("fluid") || root.type("fluid") != toml::node_type::table) return false;
    Table fluid = root.table("fluid");
    return fluid.has("method") && fluid.choice("method", {"prescribed", "sph", "grid"}) == method;
}

void refuse_grain_tables(const Table& root) {
    for (const char* key : {"injector", "contact", "coupling"})
        if (root.has(key)) root.fail(key, "there are no [grains] in this scene");
}

/// The fluid on a grid, without what grains there may be.
void make_grid(Table& root, Simulation& s) {
    Table fluid = root.table("fluid"), time = root.table("time");
    std::vector<Table> wall_tables = walls_that_hold(root.tables("wall"), "fluid"), inlets = root.tables("inlet"),
                       outlets = root.tables("outlet");
    s.grid = read_grid_fluid(fluid, s.grains.domain, read_fluid_walls(wall_tables, s.grains.domain), inlets, outlets);
    s.grid->second_order = time.choice("integrator", {"implicit_euler", "bdf2"}) == "bdf2";
}

/// A scene of the fluid on a grid alone.
void make_grid_alone(Table& root, Simulation& s) {
    refuse_grain_tables(root);
    make_grid(root, s);
    Table time = root.table("time");
    s.timing = timing(time, grid_limits(*s.grid), probe_intervals(root));
}

/// The fluid on a grid and grains, each acting on the other.
void make_grid_coupled(Table& root, Simulation& s) {
    make_grid(root, s);
    if (s.grid->medium) root.table("fluid").fail("porosity", "is that of the [grains] in a scene with grains");
    read_grain_system(root, s.grains);
    s.grains.integrator = Integrator::velocity_verlet;
    Table coupling = root.table("coupling"), time = root.table("time"), fluid = root.table("fluid");
    s.grid_coupling = read_grid_coupling(coupling, *s.grid, s.grains);
    s.fluid = fluid_on_grains(coupling, *s.grid, fluid.text("pressure") == "full");
    if (!s.grains.injectors.empty() && !has_outflow(*s.grid))
        root.fail("injector", "the fluid that injected grains displace has no outlet to leave by");
    couple(*s.grid_coupling, *s.grid, s.grains);
    drive(coupling, *s.grid, *s.fluid, *s.grid_coupling, s.grains);
    s.timing = timing(time, grid_limits(*s.grid), probe_intervals(root));
    for (std::size_t q = 0; q < s.grains.injectors.size();
         ++q) // grains enter between the fluid's steps, one at a point
        if (s.grains.injectors[q].interval < s.timing.dt * (1.0 - 1e-9))
            root.tables("injector")[q].fail(
                "interval", fmt::format("is shorter than the fluid's step of {:.6g} s: grains would wait and be fewer",
                                        s.timing.dt));
    s.grid_coupling->grain_steps = grain_steps(time, s.timing.dt, grain_limits(s.grains, greatest_speed(*s.grid)));
    set_inertia(*s.fluid, s.grains, s.timing.dt);
    start(s.grains, s.timing.dt / static_cast<double>(s.grid_coupling->grain_steps));
    s.fluid->last_drag.assign(s.grains.grains.size(), Vec3::Zero());
    s.fluid->last_fluid_force.assign(s.grains.grains.size(), Vec3::Zero());
}

/// Smoothed particles, without what grains there may be.
void make_sph(Table& root, Simulation& s) {
    Table fluid = root.table("fluid");
    std::vector<Table> wall_tables = walls_that_hold(root.tables("wall"), "fluid");
    std::vector<Table> inlets = root.tables("inlet"), outlets = root.tables("outlet");
    s.sph = read_sph_fluid(fluid, s.grains.domain, read_fluid_walls(wall_tables, s.grains.domain),
                           read_open_sides(inlets, outlets, s.grains.domain));
    check_periodic_sides(s.grains.domain, s.sph->clusters.reach + s.sph->clusters.skin, root.file());
    Table time = root.table("time");
    s.sph->memory = time.choice("integrator", {"midpoint", "damped_midpoint"}) == "midpoint" ? 0.0 : 0.5;
}

/// A scene of smoothed particles alone.
void make_sph_alone(Table& root, Simulation& s) {
    refuse_grain_tables(root);
    make_sph(root, s);
    Table time = root.table("time");
    s.timing = timing(time, fluid_limits(*s.sph), probe_intervals(root));
    start(*s.sph);
}

/// Smoothed particles and grains, each acting on the other.
void make_coupled(Table& root, Simulation& s) {
    make_sph(root, s);
    if (surface_tension(s.sph->surface) > 0.0)
        root.table("fluid").fail("surface", "grains know no surface tension yet");
    read_grain_system(root, s.grains);
    s.grains.integrator = Integrator::velocity_verlet;
    Table coupling = root.table("coupling"), time = root.table("time");
    s.coupling = read_coupling(coupling, *s.sph, s.grains);
    s.fluid = fluid_on_grains(coupling, *s.sph);
    s.fluid->shares_pressure = s.sph->shares_pressure;
    couple(*s.coupling, *s.sph, s.grains, coupling.choice("fluid_mass", {"displaced", "pure"}) == "displaced");
    check_growth(coupling, *s.sph);
    drive(coupling, *s.sph, *s.fluid, *s.coupling, s.grains);
    std::vector<StepLimit> limits = coupled_limits(*s.sph, *s.coupling);
    if (std::holds_alternative<ExplicitExchange>(s.fluid->exchange))
        limits.push_back(drag_limit(*s.fluid, s.grains, *s.sph));
    s.timing = timing(time, std::move(limits), probe_intervals(root));
    s.coupling->grain_steps = grain_steps(time, s.timing.dt, grain_limits(s.grains, s.sph->sound_speed * 0.1));
    set_inertia(*s.fluid, s.grains, s.timing.dt);
    start(*s.sph);
    start(s.grains, s.timing.dt / static_cast<double>(s.coupling->grain_steps));
    s.fluid->last_drag.assign(s.grains.grains.size(), Vec3::Zero());
    s.fluid->last_fluid_force.assign(s.grains.grains.size(), Vec3::Zero());
}

} // namespace

Simulation make_simulation(Scene& scene) {
    Table& root = scene.root;
    Simulation s;
    s.grains.domain = read_domain(root.table("domain"));
    if (is_method(root, "grid")) {
        root.has("grains") ? make_grid_coupled(root, s) : make_grid_alone(root, s);
        return s;
    }
    if (is_method(root, "sph")) {
        root.has("grains") ? make_coupled(root, s) : make_sph_alone(root, s);
        return s;
    }
    read_grain_system(root, s.grains);
    if (root.has("fluid")) {
        Table fluid = root.table("fluid");
        Table coupling = root.table("coupling");
        s.fluid = read_fluid_on_grains(fluid, coupling);
        const auto* linear = std::get_if<LinearPorosity>(&s.fluid->porosity);
        if (linear != nullptr && s.grains.domain.periodic[static_cast<std::size_t>(linear->axis)])
            coupling.fail("porosity", "a linear porosity would jump at the periodic side it runs towards");
    }
    Table time = root.table("time");
    s.grains.integrator = read_integrator(time);
    std::vector<StepLimit> limits =
        grain_limits(s.grains, s.fluid ? fastest_speed(s.fluid->flow, s.grains.domain.size) : 0.0);
    if (s.fluid && std::holds_alternative<ExplicitExchange>(s.fluid->exchange))
        limits.push_back(drag_limit(*s.fluid, s.grains));
    s.timing = timing(time, std::move(limits), probe_intervals(root));
    if (s.fluid) set_inertia(*s.fluid, s.grains, s.timing.dt);
    start(s.grains, s.timing.dt);
    if (s.fluid) show_initial_forces(*s.fluid, s.grains, s.timing.dt);
    return s;
}

void advance(Simulation& simulation, std::int64_t steps) {
    try {
        if (simulation.coupling) {
            for (std::int64_t k = 0; k < steps; ++k)
                advance_coupled(*simulation.coupling, *simulation.sph, *simulation.fluid, simulation.grains,
                                simulation.timing.dt, simulation.grains.step + 1);
            return;
        }
        if (simulation.grid_coupling) {
            for (std::int64_t k = 0; k < steps; ++k) {
                if (inject_due(simulation.grains) > 0)
                    set_inertia(*simulation.fluid, simulation.grains, simulation.timing.dt);
                advance_grid_coupled(*simulation.grid_coupling, *simulation.grid, *simulation.fluid, simulation.grains,
                                     simulation.timing.dt, simulation.grains.step + 1);
            }
            return;
        }
        if (simulation.fluid_alone()) {
            GrainSystem& clock = simulation.grains;
            for (std::int64_t k = 0; k < steps; ++k) {
                if (simulation.grid)
                    advance_grid(*simulation.grid, simulation.timing.dt, clock.step + 1);
                else
                    advance_fluid(*simulation.sph, simulation.timing.dt, clock.step + 1);
                ++clock.step;
                clock.time = simulation.timing.dt * static_cast<double>(clock.step);
            }
            return;
        }
        if (!simulation.fluid && simulation.grains.injectors.empty())
            return advance_grains(simulation.grains, steps, simulation.timing.dt);
        for (std::int64_t k = 0; k < steps; ++k) advance_one(simulation);
    } catch (const Diverged& what) {
        name_limit(what, simulation.timing);
    }
}

} // namespace plumb
