#include "run/check.hpp"

#include "core/parallel.hpp"
#include "run/bridge_numbers.hpp"
#include "run/grain_numbers.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb {

namespace {

using Json = nlohmann::ordered_json;

// Rough rates of one core of about 3 GHz, for a prediction to within a factor of a few; measured ones are in
// solver/benchmarks.
constexpr double contact_rate = 2e7; // grain steps per second with contacts
constexpr double fluid_rate = 2e6;   // with a fluid: drag law and step weights of every grain
constexpr double particle_rate = 4e6, particle_rate_plane = 1e7; // particle updates of smoothed particles
constexpr double bytes_per_particle = 450.0;
constexpr double cell_rate = 2e5, bytes_per_cell = 2000.0; // of a grid, a step of ten iterations; 50 bytes each of them
constexpr double weight_rate = 2e8, bytes_per_weight = 4.0; // of the coupling, each used three times a step
constexpr double wake_cost = 1e-6;                          // of a grain's own wake [s]
constexpr double step_cost = 2e-6;                          // fixed cost of a step [s]

// Memory [bytes]: what the fields and lists of the engine take, with six neighbours per grain in the list.
constexpr double bytes_per_grain = 500.0, bytes_per_pair = 150.0, pairs_per_grain = 6.0, bytes_of_program = 2e7;

double injected_grains(const Simulation& s) {
    double all = 0.0;
    for (const Injector& injector : s.grains.injectors)
        all += static_cast<double>(injector.events_due(s.timing.end)) * static_cast<double>(injector.points.size());
    return all;
}

double most_grains(const Simulation& s) { return static_cast<double>(s.grains.grains.size()) + injected_grains(s); }

Json grains_part(const Simulation& s) {
    const Grains& g = s.grains.grains;
    Json part{{"count", g.size()}, {"injected_at_most", injected_grains(s)}, {"groups", Json::array()}};
    for (std::size_t q = 0; q < s.grains.groups.size(); ++q) {
        double least = std::numeric_limits<double>::infinity(), largest = 0.0, mass = 0.0;
        std::int64_t count = 0;
        for (std::size_t k = 0; k < g.size(); ++k) {
            if (static_cast<std::size_t>(g.group[k]) != q) continue;
            ++count;
            mass += g.mass[k];
            least = std::min(least, 2.0 * g.radius[k]);
            largest = std::max(largest, 2.0 * g.radius[k]);
        }
        Json group{{"name", s.grains.groups[q].name}, {"count", count}, {"density", s.grains.groups[q].density}};
        if (count > 0) group.update({{"diameter", {least, largest}}, {"mass", mass}});
        part["groups"].push_back(group);
    }
    const double volume = s.grains.domain.size.prod();
    double filled = 0.0;
    for (const double r : g.radius) filled += sphere_volume(2.0 * r);
    part["volume_fraction"] = filled / volume;
    return part;
}

/// Contact times of all pairs of materials, at 1 m/s where they depend on the speed (Hertz).
Json contact_times_part(const GrainSystem& system) {
    const auto name = [&](std::size_t m) {
        const std::size_t groups = system.groups.size();
        return m < groups ? system.groups[m].name : system.walls[m - groups].name;
    };
    Json times = Json::array();
    for (const PairTime& pair : contact_times(system, 1.0))
        times.push_back({{"between", {name(pair.a), name(pair.b)}}, {"seconds", pair.seconds}});
    return times;
}

Json bridges_part(const GrainSystem& system) {
    Json part = Json::array();
    for (const BridgeNumbers& n : bridge_numbers(system))
        part.push_back({{"between", {n.a, n.b}},
                        {"attraction", n.attraction},
                        {"Bo", n.bond},
                        {"largest_Bo", n.largest_bond},
                        {"volume_over_R3", n.volume_ratio},
                        {"rupture_distance", n.rupture_distance},
                        {"sticking_speed", n.sticking_speed}});
    return part;
}

Json step_part(const Simulation& s) {
    const Timing& t = s.timing;
    Json part{{"step", t.dt}, {"ruling_limit", t.ruling}, {"limits", Json::object()}};
    for (const StepLimit& limit : t.limits)
        part["limits"][limit.name] = {{"seconds", limit.seconds}, {"formula", limit.formula}};
    part["steps"] = total_steps(t);
    part["steps_per_output"] = t.steps_per_output;
    part["outputs"] = t.outputs + 1;
    if (s.fluid_alone()) return part;
    part["contact_law"] = std::visit([](const auto& pairs) { return law_name(ContactLaw(pairs.laws.front())); },
                                     s.grains.contact.contact);
    part["contact_times"] = contact_times_part(s.grains);
    if (liquid_bridges(s.grains.contact) != nullptr) part["bridges"] = bridges_part(s.grains);
    return part;
}

Json fluid_part(const Simulation& s) {
    Json part{{"drag", law_name(s.fluid->drag)},
              {"flow", s.fluid->gathers ? "computed" : law_name(s.fluid->flow)},
              {"grains", Json::array()}};
    for (const GrainNumbers& n : grain_numbers(s))
        part["grains"].push_back({{"group", n.group},
                                  {"diameter", n.diameter},
                                  {"density_ratio", n.density_ratio},
                                  {"tau_p", n.tau_p},
                                  {"terminal_velocity", n.terminal_velocity},
                                  {"Re", n.re},
                                  {"drag_law_in_range", n.drag_in_range},
                                  {"St_impact", n.st_impact},
                                  {"St_flow", n.st_flow},
                                  {"Ga", n.galileo},
                                  {"step_over_tau_p", s.timing.dt / n.tau_p}});
    return part;
}

/// Numbers of the smoothed particles. The speed is the greatest at the start.
Json sph_part(const Simulation& s) {
    const SphFluid& f = *s.sph;
    double fastest = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k)
        fastest = std::max(fastest, std::hypot(f.v[0][k], f.v[1][k], f.dimensions == 3 ? f.v[2][k] : 0.0));
    const double nu = f.viscosity / f.density, none = std::numeric_limits<double>::infinity();
    Json part{{"particles", f.particles},
              {"dimensions", f.dimensions},
              {"kernel", law_name(f.kernel)},
              {"h", f.h},
              {"sound_speed", f.sound_speed},
              {"speed", fastest},
              {"Mach", fastest / f.sound_speed},
              {"Re_per_m", nu > 0.0 ? fastest / nu : none},
              {"acoustic_Re", nu > 0.0 ? f.h * f.sound_speed / nu : none},
              {"artificial_nu", artificial_nu(f)}};
    const double tension = surface_tension(f.surface), g = f.body_force.norm();
    if (tension == 0.0) return part;
    part["tension"] = tension;
    part["Laplace_per_m"] = f.viscosity > 0.0 ? f.density * tension / (f.viscosity * f.viscosity) : none;
    part["capillary_length"] = g > 0.0 ? std::sqrt(tension / (f.density * g)) : none;
    part["Weber_of_h"] = f.density * fastest * fastest * f.h / tension;
    part["capillary_Mach_of_h"] = std::sqrt(tension / (f.density * f.h)) / f.sound_speed;
    return part;
}

/// Seconds on one core and bytes that the grains of a coupled scene add to a step of the fluid.
struct CouplingCost {
    double seconds = 0.0, bytes = 0.0;
};
CouplingCost coupling_cost(const Simulation& s) {
    if (!s.coupling) return {};
    const double n = static_cast<double>(s.grains.grains.size()),
                 reach_in_spacings = reach(s.coupling->weights) / s.sph->spacing;
    const double weights = n * 4.0 / 3.0 * std::numbers::pi * std::pow(reach_in_spacings, 3);
    const bool corrected = s.coupling->self.has_value();
    return {3.0 * weights / weight_rate + static_cast<double>(s.coupling->grain_steps) * n / contact_rate +
                n / fluid_rate + (corrected ? n * wake_cost : 0.0),
            n * (bytes_per_grain + (corrected ? 8.0 * static_cast<double>(wake_size()) : 0.0)) +
                bytes_per_weight * weights};
}

Json sph_cost_part(const Run& run) {
    const Simulation& s = run.simulation;
    const double n = static_cast<double>(s.sph->particles), steps = static_cast<double>(total_steps(s.timing));
    const double rate = s.sph->dimensions == 2 ? particle_rate_plane : particle_rate;
    const CouplingCost grains = coupling_cost(s);
    return {{"grain_steps", n * steps},
            {"memory_bytes", bytes_of_program + bytes_per_particle * n + grains.bytes},
            {"wall_s", steps * (step_cost + (n / rate + grains.seconds) / thread_count())},
            {"nominal_rate", rate},
            {"threads", thread_count()}};
}

/// Numbers of the fluid on a grid; the speed is the greatest known before the run.
Json grid_part(const Simulation& s) {
    const GridFluid& f = *s.grid;
    double fastest = 0.0, widest = 0.0;
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        for (const double u : f.u[c]) fastest = std::max(fastest, std::abs(u));
        for (int k = 0; k < f.grid.axis[c].cells(); ++k) widest = std::max(widest, f.grid.axis[c].width(k));
    }
    for (const auto& ends : f.sides)
        for (const GridSide& side : ends) fastest = std::max(fastest, side.velocity.norm());
    const double nu = f.viscosity / f.density;
    return {{"cells", f.unknown_pressures},       {"dimensions", f.grid.dimensions},
            {"advection", law_name(f.advection)}, {"speed", fastest},
            {"Re_per_m", fastest / nu},           {"cell_Re", fastest * widest / nu}};
}

Json grid_cost_part(const Run& run) {
    const Simulation& s = run.simulation;
    const double n = static_cast<double>(s.grid->unknown_pressures), steps = static_cast<double>(total_steps(s.timing));
    const double grains = s.grid_coupling ? most_grains(s) * static_cast<double>(s.grid_coupling->grain_steps) : 0.0;
    return {{"grain_steps", n * steps},
            {"memory_bytes", bytes_of_program + bytes_per_cell * n},
            {"wall_s", steps * (step_cost + n / cell_rate + grains / contact_rate)},
            {"nominal_rate", cell_rate},
            {"threads", thread_count()}};
}

Json cost_part(const Run& run) {
    if (run.simulation.grid) return grid_cost_part(run);
    if (run.simulation.sph) return sph_cost_part(run);
    const Simulation& s = run.simulation;
    const double n = most_grains(s), steps = static_cast<double>(total_steps(s.timing));
    const double pairs = contactless(s.grains.contact) ? 0.0 : pairs_per_grain * n;
    double series = 0.0;
    for (const Probe& probe : run.probes)
        series += 8.0 * (1.0 + static_cast<double>(probe.width)) * (steps / static_cast<double>(probe.steps) + 1.0);
    const double rate = s.fluid ? fluid_rate : contact_rate;
    const double parallel = n > static_cast<double>(parallel_chunk) ? thread_count() : 1.0;
    return {{"grain_steps", n * steps},
            {"memory_bytes", bytes_of_program + bytes_per_grain * n + bytes_per_pair * pairs + series},
            {"wall_s", steps * (step_cost + n / (rate * parallel))},
            {"nominal_rate", rate},
            {"threads", thread_count()}};
}

Json remarks_part(const std::vector<Remark>& remarks) {
    Json part = Json::array();
    for (const Remark& remark : remarks) part.push_back({{"model", remark.model}, {"reason", remark.reason}});
    return part;
}

Json report(const Run& run) {
    Json all{{"scene", run.scene.path}, {"scene_hash", run.scene.hash}};
    if (!run.simulation.fluid_alone()) all["grains"] = grains_part(run.simulation);
    all["time"] = step_part(run.simulation);
    if (run.simulation.fluid) all["fluid"] = fluid_part(run.simulation);
    if (run.simulation.sph) all["sph"] = sph_part(run.simulation);
    if (run.simulation.grid) all["grid"] = grid_part(run.simulation);
    all["probes"] = run.probes.size();
    all["cost"] = cost_part(run);
    all["missing"] = remarks_part(missing_models(run.simulation));
    all["idle"] = remarks_part(idle_models(run.simulation));
    return all;
}

std::string seconds(const Json& value) {
    const double s = value.get<double>();
    return std::isfinite(s) ? fmt::format("{:.4g} s", s) : "none";
}

void print_grains(const Json& part, std::string& text) {
    text += fmt::format("grains          {}", part["count"].get<std::int64_t>());
    if (part["injected_at_most"] > 0.0)
        text += fmt::format(" + up to {} injected", part["injected_at_most"].get<double>());
    text += fmt::format(", volume fraction {:.4g}\n", part["volume_fraction"].get<double>());
    for (const Json& g : part["groups"]) {
        text += fmt::format("  {:<14}{} of {} kg/m3", g["name"].get<std::string>(), g["count"].get<std::int64_t>(),
                            g["density"].get<double>());
        if (g.contains("diameter"))
            text += fmt::format(", d = {:.4g} to {:.4g} m, {:.4g} kg in all", g["diameter"][0].get<double>(),
                                g["diameter"][1].get<double>(), g["mass"].get<double>());
        text += "\n";
    }
}

void print_bridges(const Json& part, std::string& text) {
    text += "liquid bridges  of the smallest grains (Bo also of the largest)\n";
    for (const Json& b : part) {
        const auto number = [&](const char* name) { return b[name].get<double>(); };
        const std::string most =
            number("largest_Bo") > number("Bo") ? fmt::format(" to {:.4g}", number("largest_Bo")) : "";
        text += fmt::format("  {:<14} f = {:.4g} N at contact, Bo = {:.4g}{}, V/R3 = {:.3g}, breaks at {:.4g} m, holds "
                            "elastic impacts below {:.4g} m/s\n",
                            b["between"][0].get<std::string>() + " " + b["between"][1].get<std::string>(),
                            number("attraction"), number("Bo"), most, number("volume_over_R3"),
                            number("rupture_distance"), number("sticking_speed"));
    }
}

void print_time(const Json& part, std::string& text) {
    text += fmt::format("step            {:.6g} s, ruled by {}; {} steps, {} per output, {} outputs\n",
                        part["step"].get<double>(), part["ruling_limit"].get<std::string>(),
                        part["steps"].get<std::int64_t>(), part["steps_per_output"].get<std::int64_t>(),
                        part["outputs"].get<std::int64_t>());
    for (const auto& [name, limit] : part["limits"].items())
        text += fmt::format("  {:<14}{} ({})\n", name, seconds(limit["seconds"]), limit["formula"].get<std::string>());
    if (!part.contains("contact_law")) return;
    text += fmt::format("contact law     {}\n", part["contact_law"].get<std::string>());
    for (const Json& t : part["contact_times"]) {
        if (!std::isfinite(t["seconds"].get<double>())) continue; // these pass through each other
        text += fmt::format("  {:<14} contact time {}\n",
                            t["between"][0].get<std::string>() + " " + t["between"][1].get<std::string>(),
                            seconds(t["seconds"]));
    }
    if (part.contains("bridges")) print_bridges(part["bridges"], text);
}

void print_fluid(const Json& part, std::string& text) {
    text += fmt::format("fluid           flow {}, drag {}\n", part["flow"].get<std::string>(),
                        part["drag"].get<std::string>());
    for (const Json& g : part["grains"])
        text += fmt::format(
            "  {:<14}d = {:.4g} m: tau_p = {:.4g} s (step/tau_p = {:.3g}), u_t = {:.4g} m/s, Re = {:.4g}{}, "
            "St = {:.4g} at impact, {:.4g} in the flow, Ga = {:.4g}, density ratio {:.4g}\n",
            g["group"].get<std::string>(), g["diameter"].get<double>(), g["tau_p"].get<double>(),
            g["step_over_tau_p"].get<double>(), g["terminal_velocity"].get<double>(), g["Re"].get<double>(),
            g["drag_law_in_range"].get<bool>() ? "" : " (outside the law's range)", g["St_impact"].get<double>(),
            g["St_flow"].get<double>(), g["Ga"].get<double>(), g["density_ratio"].get<double>());
}

void print_sph(const Json& part, std::string& text) {
    const auto number = [&](const char* name) { return part[name].get<double>(); };
    text +=
        fmt::format("fluid           {} particles in {} dimensions, kernel {}, h = {:.4g} m, c = {:.4g} m/s\n"
                    "  at the start  speed {:.4g} m/s, Mach {:.3g}, Re/length {:.4g} 1/m, h c/nu {:.4g}, artificial "
                    "viscosity acts like nu = {:.3g} m2/s\n",
                    part["particles"].get<std::int64_t>(), part["dimensions"].get<int>(),
                    part["kernel"].get<std::string>(), number("h"), number("sound_speed"), number("speed"),
                    number("Mach"), number("Re_per_m"), number("acoustic_Re"), number("artificial_nu"));
    if (!part.contains("tension")) return;
    text +=
        fmt::format("  surface       tension {:.4g} N/m, Laplace number/length {:.4g} 1/m, capillary length {:.4g} m; "
                    "of h: Weber number {:.3g}, Mach number sqrt(tension/(rho h))/c {:.3g}\n",
                    number("tension"), number("Laplace_per_m"), number("capillary_length"), number("Weber_of_h"),
                    number("capillary_Mach_of_h"));
}

void print_grid(const Json& part, std::string& text) {
    text += fmt::format("fluid           {} cells in {} dimensions, advection {}\n"
                        "  at the start  speed {:.4g} m/s, Re/length {:.4g} 1/m, cell Reynolds number {:.3g}\n",
                        part["cells"].get<std::int64_t>(), part["dimensions"].get<int>(),
                        part["advection"].get<std::string>(), part["speed"].get<double>(),
                        part["Re_per_m"].get<double>(), part["cell_Re"].get<double>());
}

void print_remarks(const Json& part, std::string_view title, std::string& text) {
    text += fmt::format("{:<16}{}\n", title, part.empty() ? "none" : "");
    for (const Json& r : part)
        text += fmt::format("  {:<14}{}\n", r["model"].get<std::string>(), r["reason"].get<std::string>());
}

} // namespace

std::string check_report(const Run& run, bool json) {
    const Json all = report(run);
    if (json) return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    std::string text = fmt::format("scene           {} ({})\n", run.scene.path, run.scene.hash);
    if (all.contains("grains")) print_grains(all["grains"], text);
    if (all.contains("sph")) print_sph(all["sph"], text);
    if (all.contains("grid")) print_grid(all["grid"], text);
    print_time(all["time"], text);
    if (all.contains("fluid")) print_fluid(all["fluid"], text);
    const Json& cost = all["cost"];
    text += fmt::format(
        "cost            about {:.3g} updates, {:.3g} MB, {:.3g} s at a nominal {:.2g} updates/s a thread\n",
        cost["grain_steps"].get<double>(), 1e-6 * cost["memory_bytes"].get<double>(), cost["wall_s"].get<double>(),
        cost["nominal_rate"].get<double>());
    print_remarks(all["missing"], "could matter", text);
    print_remarks(all["idle"], "idle", text);
    return text;
}

} // namespace plumb
