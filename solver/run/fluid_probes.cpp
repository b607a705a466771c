#include "run/fluid_probes.hpp"

#include "grid/sums.hpp"

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

/// The same over whatever the scene's fluid is made of: term(velocity along axis, x along `along`).
template <class Term> double fluid_mean(const Simulation& s, std::size_t axis, std::size_t along, Term&& term) {
    if (s.grid)
        return volume_mean(*s.grid, axis,
                           [&](double u, const Vec3& x) { return term(u, x[static_cast<Eigen::Index>(along)]); });
    return mean(*s.sph, [&](std::size_t k) { return term(s.sph->v[axis][k], s.sph->x[along][k]); });
}

} // namespace

void demand_computed_fluid(const Simulation& s, const Table& t) {
    if (!s.sph && !s.grid) t.fail("quantity", "needs a fluid with method \"sph\" or \"grid\"");
    for (const char* key : {"axis", "along"})
        if (s.grains.domain.dimensions == 2 && t.type(key) == toml::node_type::string && Table(t).text(key) == "z")
            t.fail(key, "\"z\" in a scene of two dimensions");
}

double FluidKineticEnergy::operator()(const Sample& s) const {
    if (!s.simulation.grid) {
        const SphFluid& f = *s.simulation.sph;
        return mean(f, [&](std::size_t k) { return 0.5 * speed_sq(f, k); });
    }
    double sum = 0.0;
    for (std::size_t c = 0; c < s.simulation.grid->dimensions(); ++c)
        sum += fluid_mean(s.simulation, c, c, [](double u, double /*x*/) { return 0.5 * u * u; });
    return sum;
}

FluidMeanVelocity::FluidMeanVelocity(Table& table) : axis(axis_of(table, "axis")) {}
double FluidMeanVelocity::operator()(const Sample& s) const {
    return fluid_mean(s.simulation, axis, axis, [](double u, double /*x*/) { return u; });
}

double FluidGreatestSpeed::operator()(const Sample& s) const {
    double largest = 0.0;
    if (s.simulation.grid) {
        const GridFluid& g = *s.simulation.grid;
        for_each_place(g.grid.cells(), [&](const Place& p, std::size_t /*k*/) {
            largest = std::max(largest, centre_velocity(g, p).squaredNorm());
        });
        return std::sqrt(largest);
    }
    const SphFluid& f = *s.simulation.sph;
    for (std::size_t k = 0; k < f.slots(); ++k) largest = std::max(largest, speed_sq(f, k));
    return std::sqrt(largest);
}

FluidVelocityWave::FluidVelocityWave(Table& table)
    : axis(axis_of(table, "axis")), along(axis_of(table, "along")),
      waves(static_cast<double>(table.integer("waves", 1, 1000))),
      sine(table.choice("shape", {"sin", "cos"}) == "sin") {}
double FluidVelocityWave::operator()(const Sample& s) const {
    const double k = 2.0 * std::numbers::pi * waves / s.simulation.grains.domain.size[static_cast<Eigen::Index>(along)];
    return 2.0 * fluid_mean(s.simulation, axis, along,
                            [&](double u, double x) { return u * (sine ? std::sin(k * x) : std::cos(k * x)); });
}

} // namespace plumb
