#include "schemes/stable_step.hpp"

#include "core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb {

namespace {

// Steps per contact: velocity Verlet then keeps the restitution of a damped linear contact within 1 %, and stays a
// factor of six inside its stability bound 2/omega = (2/pi) t_c (a grain with several contacts is stiffer).
constexpr double steps_per_contact = 20.0;

/// Speed at which grains may meet [m/s]: only Hertzian contacts ask for it.
double impact_speed(const GrainSystem& system, double fluid_speed) {
    double fastest = fluid_speed;
    for (const Vec3& v : system.grains.v) fastest = std::max(fastest, v.norm());
    for (const WallBody& wall : system.walls) fastest = std::max(fastest, wall.velocity.norm());
    for (const Injector& injector : system.injectors) fastest = std::max(fastest, injector.velocity.norm());
    const double fall = std::sqrt(2.0 * system.domain.gravity.cwiseAbs().dot(system.domain.size));
    return 2.0 * fastest + fall;
}

/// Lightest and smallest grain of every group, there or to come: those with the shortest contacts.
struct Extremes {
    double mass = std::numeric_limits<double>::infinity();
    double radius = std::numeric_limits<double>::infinity();
};

constexpr double most_steps = 1e15; // in one interval: more would not end, and doubles count whole numbers to 9e15

/// Least number of whole steps that are not longer than `limit`.
std::int64_t whole_steps(Table& time, double interval, double limit) {
    const double steps = std::ceil(interval / limit * (1.0 - 1e-12));
    if (!(steps < most_steps))
        time.fail("step", fmt::format("the limit of {} s makes more than {:.0e} steps of one output interval", limit,
                                      most_steps));
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(steps));
}

/// interval/dt when it is whole within rounding; InputError otherwise.
std::int64_t whole_ratio(Table& time, std::string_view key, double interval, double dt, std::string_view of) {
    const double ratio = interval / dt;
    if (!(ratio < most_steps))
        time.fail(key, fmt::format("{} s is more than {:.0e} {} of {} s", interval, most_steps, of, dt));
    if (std::abs(ratio - std::nearbyint(ratio)) > 1e-9 * ratio || ratio < 0.5)
        time.fail(key, fmt::format("{} s is not a whole number of {} of {} s", interval, of, dt));
    return static_cast<std::int64_t>(std::nearbyint(ratio));
}

/// The longest time of which the output interval and all probe intervals are whole multiples, by Euclid's algorithm on
/// numbers that are equal within their rounding.
double common_interval(Table& time, double output_interval, const std::vector<double>& probe_intervals, double limit) {
    double common = output_interval;
    for (const double interval : probe_intervals) {
        double a = std::max(common, interval), b = std::min(common, interval);
        const double least = 1e-3 * std::min(b, limit);
        for (double rest = std::abs(std::remainder(a, b)); rest > 1e-9 * b; rest = std::abs(std::remainder(a, b))) {
            if (rest < least)
                time.fail("step",
                          fmt::format("\"auto\" needs a step that divides both {} s and the probe interval {} s; "
                                      "the longest is a thousand times shorter than needed",
                                      output_interval, interval));
            a = b, b = rest;
        }
        common = b;
    }
    return common;
}

} // namespace

std::vector<SizePair> least_pairs(const GrainSystem& system) {
    std::vector<Extremes> least(system.groups.size());
    for (std::size_t k = 0; k < system.grains.size(); ++k) {
        Extremes& e = least[static_cast<std::size_t>(system.grains.group[k])];
        e.mass = std::min(e.mass, system.grains.mass[k]);
        e.radius = std::min(e.radius, system.grains.radius[k]);
    }
    for (const Injector& injector : system.injectors) { // grains that are yet to come
        const auto group = static_cast<std::size_t>(injector.group);
        double d = std::visit([](const auto& law) { return law.smallest(); }, injector.diameter);
        for (const double listed : injector.point_diameter) d = d > 0.0 ? std::min(d, listed) : listed;
        least[group].radius = std::min(least[group].radius, 0.5 * d);
        least[group].mass = std::min(least[group].mass, system.groups[group].density * sphere_volume(d));
    }
    const std::size_t groups = system.groups.size(), materials = groups + system.walls.size();
    std::vector<SizePair> pairs;
    for (std::size_t a = 0; a < groups; ++a)
        for (std::size_t b = a; b < materials; ++b) {
            if (!std::isfinite(least[a].mass) || (b < groups && !std::isfinite(least[b].mass))) continue;
            const bool wall = b >= groups;
            const double inverse_mass = 1.0 / least[a].mass + (wall ? 0.0 : 1.0 / least[b].mass);
            const double inverse_radius = 1.0 / least[a].radius + (wall ? 0.0 : 1.0 / least[b].radius);
            const double smaller = wall ? least[a].radius : std::min(least[a].radius, least[b].radius);
            const double lighter = wall ? least[a].mass : std::min(least[a].mass, least[b].mass);
            pairs.push_back({a, b, inverse_mass, inverse_radius, smaller, lighter});
        }
    return pairs;
}

std::vector<PairTime> contact_times(const GrainSystem& system, double speed) {
    std::vector<PairTime> times;
    for (const SizePair& pair : least_pairs(system)) {
        const auto time = [&](const auto& pairs) {
            const auto& law = pairs.of(static_cast<std::int32_t>(pair.a), static_cast<std::int32_t>(pair.b));
            return law.contact_time(pair.inverse_mass, pair.inverse_radius, speed);
        };
        times.push_back({pair.a, pair.b, std::visit(time, system.contact.contact)});
    }
    return times;
}

std::vector<PairBridge> least_bridges(const GrainSystem& system) {
    std::vector<PairBridge> bridges;
    const auto* laws = liquid_bridges(system.contact);
    if (laws == nullptr) return bridges;
    for (const SizePair& pair : least_pairs(system)) {
        const LiquidBridge& law = laws->of(static_cast<std::int32_t>(pair.a), static_cast<std::int32_t>(pair.b));
        const double volume = LiquidBridge::formed_volume(law.parameters, pair.smaller_radius);
        if (volume > 0.0) bridges.push_back({pair, law, volume});
    }
    return bridges;
}

void check_bridges(const GrainSystem& system, const std::string& file) {
    for (const PairBridge& bridge : least_bridges(system)) {
        const double radius = 2.0 / bridge.pair.inverse_radius, ratio = bridge.volume / (radius * radius * radius);
        if (ratio > LiquidBridge::largest_volume * (1.0 + 1e-12))
            throw InputError(
                fmt::format("{}: contact.cohesion.volume: {} m3 is {:.3g} R^3 for R = {:.6g} m, the reduced "
                            "radius of the smallest grains; the law holds up to {} R^3",
                            file, bridge.volume, ratio, radius, LiquidBridge::largest_volume));
    }
}

std::vector<StepLimit> grain_limits(const GrainSystem& system, double fluid_speed) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const PairTime& pair : contact_times(system, impact_speed(system, fluid_speed)))
        shortest = std::min(shortest, pair.seconds);
    std::vector<StepLimit> limits{{"contact", shortest / steps_per_contact, "shortest contact time / 20"}};
    const std::vector<PairBridge> bridges = least_bridges(system);
    if (bridges.empty()) return limits;
    double steepest = 0.0; // [1/s2] of slope over mass
    for (const PairBridge& b : bridges)
        steepest = std::max(steepest, b.law.greatest_slope(b.volume, b.pair.inverse_radius) * b.pair.inverse_mass);
    limits.push_back({"bridge", std::numbers::pi / std::sqrt(steepest) / steps_per_contact,
                      "pi sqrt(m*/steepest slope of a bridge's force) / 20"});
    return limits;
}

Timing timing(Table& time, std::vector<StepLimit> limits, const std::vector<double>& probe_intervals) {
    Timing t;
    t.end = time.number("end", positive);
    t.output_interval = time.number("output_interval", positive);
    t.snapshots = time.has("snapshots") && time.flag("snapshots");
    t.outputs = whole_ratio(time, "end", t.end, t.output_interval, "output intervals");
    if (time.has("safety")) {
        Table safety = time.table("safety");
        for (StepLimit& limit : limits)
            if (safety.has(limit.name)) limit.seconds *= safety.number(limit.name, positive);
    }
    t.limits = std::move(limits);
    const auto least = std::min_element(t.limits.begin(), t.limits.end(),
                                        [](const StepLimit& a, const StepLimit& b) { return a.seconds < b.seconds; });
    if (time.type("step") == toml::node_type::string) {
        time.choice("step", {"auto"});
        const double limit = least == t.limits.end() ? std::numeric_limits<double>::infinity() : least->seconds;
        const double common = common_interval(time, t.output_interval, probe_intervals, limit);
        t.steps_per_output = whole_ratio(time, "output_interval", t.output_interval, common, "common intervals") *
                             whole_steps(time, common, limit);
        t.dt = t.output_interval / static_cast<double>(t.steps_per_output);
        t.ruling = limit < common ? least->name : common < t.output_interval ? "probe_interval" : "output_interval";
    } else {
        t.dt = time.number("step", positive);
        t.steps_per_output = whole_ratio(time, "output_interval", t.output_interval, t.dt, "steps");
        t.ruling = "given";
    }
    return t;
}

} // namespace plumb
