#include "run/provenance.hpp"

#include "core/parallel.hpp"
#include "run/build_info.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <sys/resource.h>

namespace plumb {

namespace {

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.rfind("model name", 0) == 0) {
            const std::size_t colon = line.find(':');
            const std::size_t begin = line.find_first_not_of(' ', colon + 1);
            return begin == std::string::npos ? std::string() : line.substr(begin);
        }
    return "unknown";
}

double seconds(const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); }

} // namespace

Cost CostMeter::now() const {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    Cost cost = before_;
    cost.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    cost.cpu_s += seconds(usage.ru_utime) + seconds(usage.ru_stime);
    cost.peak_bytes = std::max<std::int64_t>(cost.peak_bytes, 1024 * std::int64_t{usage.ru_maxrss}); // Linux counts KiB
    return cost;
}

std::string iso_time() { return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))); }

std::string version_text() {
    const std::string commit(build_info::commit.empty() ? "no commit" : build_info::commit.substr(0, 12));
    return fmt::format("plumb {} ({}{}, {})", build_info::version, commit, build_info::dirty ? ", changed" : "",
                       build_info::compiler);
}

std::string provenance_json(const Scene& scene, const Simulation& simulation, const std::string& start,
                            const Cost& cost, std::optional<int> exit) {
    nlohmann::ordered_json j;
    j["version"] = build_info::version;
    j["commit"] = build_info::commit;
    j["dirty"] = build_info::dirty;
    j["compiler"] = build_info::compiler;
    j["flags"] = build_info::flags;
    j["scene"] = scene.text;
    j["scene_hash"] = scene.hash;
    j["scene_path"] = scene.path;
    j["overrides"] = scene.overrides;
    j["threads"] = thread_count();
    j["processor"] = processor_name();
    j["start"] = start;
    j["wall_s"] = cost.wall_s;
    j["cpu_s"] = cost.cpu_s;
    j["peak_bytes"] = cost.peak_bytes;
    j["steps"] = simulation.grains.step;
    j["updates"] = cost.updates;
    j["step"] = simulation.timing.dt;
    j["ruling_limit"] = simulation.timing.ruling;
    j["limits"] = nlohmann::ordered_json::object(); // an infinite limit is written as null
    for (const StepLimit& limit : simulation.timing.limits) j["limits"][limit.name] = limit.seconds;
    if (simulation.fluid) {
        const RangeUse& use = simulation.fluid->range_use;
        j["drag_range"] = {{"re_min", use.re_min},
                           {"re_max", use.re_max},
                           {"inside", use.inside},
                           {"outside", use.outside},
                           {"dry", use.dry}};
    }
    if (simulation.coupling) {
        const Coupling& c = *simulation.coupling;
        const Vec3& gradient = simulation.fluid->mean_gradient;
        j["coupling"] = {{"kernel_width", c.weights.h.spread},
                         {"gather_width", c.weights.h.gather},
                         {"porosity_width", c.weights.h.porosity},
                         {"porosity", law_name(c.weights.porosity)},
                         {"own_volume", c.weights.own_volume ? "included" : "excluded"},
                         {"grain_steps", c.grain_steps},
                         {"clamped_porosities", c.clamped},
                         {"at_greatest_viscosity", c.at_greatest},
                         {"mean_pressure_gradient", {gradient[0], gradient[1], gradient[2]}}};
    }
    if (simulation.grid_coupling) {
        const GridCoupling& c = *simulation.grid_coupling;
        const Vec3& gradient = simulation.fluid->mean_gradient;
        j["coupling"] = {{"kernel", law_name(c.weights.kernel)},
                         {"kernel_width", c.weights.width},
                         {"grain_steps", c.grain_steps},
                         {"bounded_porosities", c.bounded},
                         {"mean_pressure_gradient", {gradient[0], gradient[1], gradient[2]}}};
    }
    if (simulation.sph) {
        const SphFluid& f = *simulation.sph;
        j["sph"] = {{"particles", f.particles},
                    {"boundary_particles", f.boundary.size()},
                    {"put_back", f.put_back},
                    {"capped_lengths", f.lengths.capped},
                    {"h", f.h},
                    {"sound_speed", f.sound_speed},
                    {"artificial_nu", artificial_nu(f)}};
    }
    if (simulation.grid) {
        const GridFluid& f = *simulation.grid;
        const double steps = static_cast<double>(std::max<std::int64_t>(simulation.grains.step, 1));
        j["grid"] = {{"cells", f.unknown_pressures},
                     {"unknowns", f.unknowns[0] + f.unknowns[1] + f.unknowns[2] + f.unknown_pressures},
                     {"iterations_per_step", static_cast<double>(f.iterations) / steps},
                     {"greatest_residual", f.greatest_residual}};
    }
    j["exit"] = exit ? nlohmann::ordered_json(*exit) : nlohmann::ordered_json(nullptr);
    // A path may be no valid UTF-8; JSON must be.
    return j.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace plumb
