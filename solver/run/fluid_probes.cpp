#include "run/fluid_probes.hpp"

#include "grid/sums.hpp"
#include "sph/vector_at.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

void demand_grid(const Simulation& s, const Table& t) {
    if (!s.grid) t.fail("quantity", "needs a fluid with method \"grid\"");
}

/// A place, of two numbers in a scene of two dimensions.
Vec3 place(Table& table, std::string_view key, double third) {
    Vec3 x = table.length(key) == 2 ? table.components(key, 2) : table.vector(key);
    if (table.length(key) == 2) x[2] = third;
    return x;
}

/// Visits the open cells with centres between two places.
template <class Visit> void for_each_cell(const GridFluid& f, const Vec3& lower, const Vec3& upper, Visit&& visit) {
    for_each_place(f.grid.cells(), [&](const Place& p, std::size_t k) {
        const Vec3 x = f.grid.centre(p);
        if (f.unknown_pressure[k] >= 0 && (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all())
            visit(p, k);
    });
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

FluidSecondMoment::FluidSecondMoment(Table& table) : axis(axis_of(table, "axis")) {}
void FluidSecondMoment::bind(const Simulation& s, const Table& t) {
    if (!s.sph) t.fail("quantity", "needs a fluid with method \"sph\"");
    demand_computed_fluid(s, t);
}
double FluidSecondMoment::operator()(const Sample& s) const {
    const SphFluid& f = *s.simulation.sph;
    const double middle = mean(f, [&](std::size_t k) { return f.x[axis][k]; });
    return mean(f, [&](std::size_t k) { return (f.x[axis][k] - middle) * (f.x[axis][k] - middle); });
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

namespace {

/// Of the particles in a box, each as much as the room it takes; not a number when there is none [Pa].
double mean_pressure(const SphFluid& f, const Vec3& lower, const Vec3& upper) {
    double sum = 0.0, volume = 0.0;
    for (const std::int32_t slot : ordered_slots(f)) {
        const auto k = static_cast<std::size_t>(slot);
        const Vec3 x = vector_at(f.x, k, f.dimensions);
        if ((x.array() < lower.array()).any() || (x.array() >= upper.array()).any()) continue;
        const double own = f.among_grains() ? f.rho[k] * f.share[k] / f.eps[k] : f.rho[k];
        sum += pressure(f, own) / f.rho[k];
        volume += 1.0 / f.rho[k];
    }
    return sum / volume;
}

} // namespace

FluidMeanPressure::FluidMeanPressure(Table& table)
    : lower(place(table, "lower", -std::numeric_limits<double>::infinity())),
      upper(place(table, "upper", std::numeric_limits<double>::infinity())) {}
void FluidMeanPressure::bind(const Simulation& s, const Table& t) const {
    demand_computed_fluid(s, t);
    if (s.sph) return;
    int cells = 0;
    for_each_cell(*s.grid, lower, upper, [&](const Place& /*p*/, std::size_t /*k*/) { ++cells; });
    if (cells == 0) t.fail("upper", "no open cell has its centre between `lower` and `upper`");
}
double FluidMeanPressure::operator()(const Sample& s) const {
    if (s.simulation.sph) return mean_pressure(*s.simulation.sph, lower, upper);
    const GridFluid& f = *s.simulation.grid;
    double sum = 0.0, volume = 0.0;
    for_each_cell(f, lower, upper, [&](const Place& p, std::size_t k) {
        const double open = f.open.cell[k] * f.grid.cell_volume(p);
        sum += open * f.p[k];
        volume += open;
    });
    return sum / volume;
}

void FluidGreatestPressure::bind(const Simulation& s, const Table& t) { demand_grid(s, t); }
double FluidGreatestPressure::operator()(const Sample& s) const {
    const GridFluid& f = *s.simulation.grid;
    double greatest = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < f.p.size(); ++k)
        if (f.unknown_pressure[k] >= 0 && f.open.cell[k] >= 0.5) greatest = std::max(greatest, f.p[k]);
    return greatest;
}

FluidFlowRate::FluidFlowRate(Table& table) : axis(axis_of(table, "axis")), at(table.number("at")) {}
void FluidFlowRate::bind(const Simulation& s, const Table& t) {
    demand_grid(s, t);
    if (axis_names.find(Table(t).text("axis")) >= s.grid->dimensions()) t.fail("axis", "is no axis of the grid");
}
double FluidFlowRate::operator()(const Sample& s) const {
    const GridFluid& f = *s.simulation.grid;
    const Axis& along = f.grid.axis[axis];
    int nearest = 0;
    for (int k = 0; k < along.faces(); ++k)
        if (std::abs(along.node[static_cast<std::size_t>(k)] - at) <
            std::abs(along.node[static_cast<std::size_t>(nearest)] - at))
            nearest = k;
    double sum = 0.0;
    for_each_place(f.grid.faces(axis), [&](const Place& p, std::size_t k) {
        if (p[axis] == nearest && f.open.face[axis][k] > 0.0) sum += open_area(f, axis, p) * f.u[axis][k];
    });
    return sum;
}

} // namespace plumb
