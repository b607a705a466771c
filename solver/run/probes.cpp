#include "run/probes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace plumb {

namespace {

// A whole number of steps, up to the rounding of the decimal numbers in the scene.
constexpr double interval_tolerance = 1e-9;

template <class Quantity>
constexpr bool is_per_grain = std::is_same_v<std::invoke_result_t<const Quantity&, const Sample&>, std::vector<double>>;

std::string checked_name(Table& table, std::set<std::string>& used) {
    std::string name = table.text("name");
    const bool plain = !name.empty() && name.front() != '.' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
               c == '.';
    });
    if (!plain) table.fail("name", fmt::format("\"{}\" must be made of letters, digits, \"_\", \"-\" and \".\"", name));
    if (!used.insert(name).second) table.fail("name", fmt::format("\"{}\" is used by another probe", name));
    return name;
}

std::int64_t steps_between_records(Table& table, const Timing& timing) {
    if (!table.has("interval")) return timing.steps_per_output;
    const double interval = table.number("interval", positive);
    const double steps = interval / timing.dt, whole = std::nearbyint(steps);
    if (whole < 1.0 || std::abs(steps - whole) > interval_tolerance * whole || whole > 9e15)
        table.fail("interval", fmt::format("{} s is {:.9g} steps of {:.9g} s; a whole number is needed", interval,
                                           steps, timing.dt));
    return static_cast<std::int64_t>(whole);
}

} // namespace

bool Probe::per_grain() const {
    return std::visit([](const auto& q) { return is_per_grain<std::decay_t<decltype(q)>>; }, quantity);
}

std::string Probe::units() const {
    return std::visit([](const auto& q) { return std::string(q.units); }, quantity);
}

std::vector<Probe> read_probes(Scene& scene, const Simulation& simulation) {
    std::vector<Probe> probes;
    std::set<std::string> names;
    for (Table& table : scene.root.tables("probe")) {
        std::string name = checked_name(table, names);
        auto quantity = make_family<ProbeQuantity>(table, "quantity");
        std::visit(
            [&](auto& q) {
                if constexpr (requires { q.bind(simulation, table); }) q.bind(simulation, table);
            },
            quantity);
        const std::int64_t steps = steps_between_records(table, simulation.timing);
        probes.push_back({std::move(name), std::move(quantity), steps, {}, {}, 1});
        if (probes.back().per_grain()) probes.back().width = simulation.grains.grains.size();
    }
    return probes;
}

void record(std::vector<Probe>& probes, const Simulation& simulation) {
    const std::int64_t step = simulation.grains.step;
    if (std::none_of(probes.begin(), probes.end(), [&](const Probe& p) { return step % p.steps == 0; })) return;
    const Sample sample(simulation);
    for (Probe& probe : probes) {
        if (step % probe.steps != 0) continue;
        probe.time.push_back(static_cast<double>(step) * simulation.timing.dt);
        std::visit(
            [&](const auto& quantity) {
                if constexpr (is_per_grain<std::decay_t<decltype(quantity)>>) {
                    const std::vector<double> values = quantity(sample);
                    probe.value.insert(probe.value.end(), values.begin(), values.end());
                } else {
                    probe.value.push_back(quantity(sample));
                }
            },
            probe.quantity);
    }
}

std::int64_t next_record(const std::vector<Probe>& probes, std::int64_t step, std::int64_t end) {
    std::int64_t next = end;
    for (const Probe& probe : probes) next = std::min(next, (step / probe.steps + 1) * probe.steps);
    return next;
}

} // namespace plumb
