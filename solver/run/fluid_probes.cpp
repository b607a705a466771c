#include "run/fluid_probes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

std::size_t axis_of(Table& table, std::string_view key) { return axis_names.find(table.choice(key, {"x", "y", "z"})); }

/// 1/n sum of term(slot) in the order of ids.
template <class Term> double mean(const SphFluid& f, Term&& term) {
    const std::vector<std::int32_t> slot = ordered_slots(f);
    const double sum =
        ordered_sum(slot.size(), 0.0, [&](std::size_t id) { return term(static_cast<std::size_t>(slot[id])); });
    return sum / static_cast<double>(slot.size());
}

double speed_sq(const SphFluid& f, std::size_t k) {
    double sum = 0.0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) sum += f.v[c][k] * f.v[c][k];
    return sum;
}

} // namespace

void demand_particles(const Simulation& s, const Table& t) {
    if (!s.sph) t.fail("quantity", "needs a fluid with method \"sph\"");
    for (const char* key : {"axis", "along"})
        if (s.sph->dimensions == 2 && t.type(key) == toml::node_type::string && Table(t).text(key) == "z")
            t.fail(key, "\"z\" in a scene of two dimensions");
}

double FluidKineticEnergy::operator()(const Sample& s) const {
    const SphFluid& f = *s.simulation.sph;
    return mean(f, [&](std::size_t k) { return 0.5 * speed_sq(f, k); });
}

FluidMeanVelocity::FluidMeanVelocity(Table& table) : axis(axis_of(table, "axis")) {}
double FluidMeanVelocity::operator()(const Sample& s) const {
    const SphFluid& f = *s.simulation.sph;
    return mean(f, [&](std::size_t k) { return f.v[axis][k]; });
}

double FluidGreatestSpeed::operator()(const Sample& s) const {
    const SphFluid& f = *s.simulation.sph;
    double largest = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k) largest = std::max(largest, speed_sq(f, k));
    return std::sqrt(largest);
}

FluidVelocityWave::FluidVelocityWave(Table& table)
    : axis(axis_of(table, "axis")), along(axis_of(table, "along")),
      waves(static_cast<double>(table.integer("waves", 1, 1000))),
      sine(table.choice("shape", {"sin", "cos"}) == "sin") {}
double FluidVelocityWave::operator()(const Sample& s) const {
    const SphFluid& f = *s.simulation.sph;
    const double k = 2.0 * std::numbers::pi * waves / f.domain.size[static_cast<Eigen::Index>(along)];
    return 2.0 * mean(f, [&](std::size_t q) {
               const double phase = k * f.x[along][q];
               return f.v[axis][q] * (sine ? std::sin(phase) : std::cos(phase));
           });
}

} // namespace plumb
