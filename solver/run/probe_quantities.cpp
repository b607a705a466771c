#include "run/probe_quantities.hpp"

#include "run/sphere_overlap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace plumb {

namespace {

/// One number per grain, in the order of ids.
template <class Value> std::vector<double> by_id(const Sample& s, Value&& value) {
    std::vector<double> values(s.place.size());
    parallel_for(values.size(), [&](std::size_t id) { values[id] = value(s.at(id)); });
    return values;
}

/// Of those contacts that are more than a bridge.
template <class Contacts> std::ptrdiff_t number_touching(const Contacts& contacts) {
    return std::count_if(contacts.begin(), contacts.end(), [](const auto& c) { return c.overlap > 0.0; });
}

void demand_constant_count(const Simulation& s, const Table& t) {
    if (!s.grains.injectors.empty())
        t.fail("quantity", "one value per grain needs a constant number of grains; the scene has an injector");
}

void demand_fluid(const Simulation& s, const Table& t) {
    if (!s.fluid) t.fail("quantity", "needs a [fluid] table");
}

} // namespace

Component::Component(Table& table)
    : axis(static_cast<Eigen::Index>(axis_names.find(table.choice("axis", {"x", "y", "z"})))) {}

OneGrain::OneGrain(Table& table)
    : id(static_cast<std::size_t>(table.integer("grain", 0, std::numeric_limits<std::int32_t>::max()))) {}

void OneGrain::bind(const Simulation& simulation, const Table& table) const {
    const std::size_t n = simulation.grains.grains.size();
    if (id >= n) table.fail("grain", fmt::format("{} is not a grain; the scene starts with {}", id, n));
}

Members::Members(Table& table) {
    if (table.has("group")) name = table.text("group");
}

void Members::bind(const Simulation& simulation, const Table& table) {
    if (!name) return;
    const auto& groups = simulation.grains.groups;
    for (std::size_t k = 0; k < groups.size(); ++k)
        if (groups[k].name == *name) group = static_cast<std::int32_t>(k);
    if (group < 0) table.fail("group", fmt::format("there is no [[grains]] named \"{}\"", *name));
}

double Members::count(const Sample& sample) const {
    return sample.sum(0.0, [&](std::size_t k) { return contain(sample.grains, k) ? 1.0 : 0.0; });
}

double GrainPosition::operator()(const Sample& s) const {
    return component.of(unwrapped(s.grains, s.simulation.grains.domain, s.at(grain.id)));
}

double GrainForce::operator()(const Sample& s) const {
    return component.of(contact_forces(s.simulation.grains)[s.at(grain.id)]);
}

double GrainMeanPosition::operator()(const Sample& s) const {
    const double sum = s.sum(0.0, [&](std::size_t k) {
        return members.contain(s.grains, k) ? component.of(unwrapped(s.grains, s.simulation.grains.domain, k)) : 0.0;
    });
    return sum / members.count(s);
}

double GrainMeanVelocity::operator()(const Sample& s) const {
    const double sum =
        s.sum(0.0, [&](std::size_t k) { return members.contain(s.grains, k) ? component.of(s.grains.v[k]) : 0.0; });
    return sum / members.count(s);
}

double GrainKineticEnergy::operator()(const Sample& s) const {
    const Grains& g = s.grains;
    return s.sum(0.0, [&](std::size_t k) {
        if (!members.contain(g, k)) return 0.0;
        return 0.5 * g.mass[k] * g.v[k].squaredNorm() +
               0.5 * sphere_inertia(g.mass[k], 2.0 * g.radius[k]) * g.omega[k].squaredNorm();
    });
}

double GrainContactEnergy::operator()(const Sample& s) const {
    double sum = 0.0;
    for (const TouchingPair& pair : s.pairs()) sum += pair.energy;
    for (const TouchingWall& contact : s.walls()) sum += contact.energy;
    return sum;
}

double GrainPotentialEnergy::operator()(const Sample& s) const {
    const Domain& domain = s.simulation.grains.domain;
    return s.sum(0.0, [&](std::size_t k) {
        if (!members.contain(s.grains, k)) return 0.0;
        return -s.grains.mass[k] * domain.gravity.dot(unwrapped(s.grains, domain, k));
    });
}

void GrainTotalEnergy::bind(const Simulation& /*simulation*/, const Table& t) const {
    // Contacts between groups belong to neither, so a group has no total energy of its own.
    if (kinetic.members.name) t.fail("group", "the total energy is that of all grains");
}

double GrainMomentum::operator()(const Sample& s) const {
    return s.sum(0.0, [&](std::size_t k) {
        return members.contain(s.grains, k) ? s.grains.mass[k] * component.of(s.grains.v[k]) : 0.0;
    });
}

void GrainAngularMomentum::bind(const Simulation& s, const Table& t) {
    members.bind(s, t);
    for (Eigen::Index c = 0; c < 3; ++c)
        if (c != component.axis && s.grains.domain.periodic[static_cast<std::size_t>(c)])
            t.fail("axis", fmt::format("angular momentum has no meaning in a box that is periodic along {}",
                                       axis_names[static_cast<std::size_t>(c)]));
}

double GrainAngularMomentum::operator()(const Sample& s) const {
    const Grains& g = s.grains;
    return s.sum(0.0, [&](std::size_t k) {
        if (!members.contain(g, k)) return 0.0;
        return component.of(g.mass[k] * g.x[k].cross(g.v[k]) +
                            sphere_inertia(g.mass[k], 2.0 * g.radius[k]) * g.omega[k]);
    });
}

double GranularTemperature::operator()(const Sample& s) const {
    const Grains& g = s.grains;
    const double mass = s.sum(0.0, [&](std::size_t k) { return members.contain(g, k) ? g.mass[k] : 0.0; });
    const Vec3 momentum = s.sum(Vec3(Vec3::Zero()), [&](std::size_t k) {
        return members.contain(g, k) ? Vec3(g.mass[k] * g.v[k]) : Vec3(Vec3::Zero());
    });
    const Vec3 mean = momentum / mass;
    const double sum = s.sum(
        0.0, [&](std::size_t k) { return members.contain(g, k) ? g.mass[k] * (g.v[k] - mean).squaredNorm() : 0.0; });
    return sum / (3.0 * mass);
}

double ContactCount::operator()(const Sample& s) const {
    return static_cast<double>(number_touching(s.pairs()) + number_touching(s.walls()));
}

double BridgeCount::operator()(const Sample& s) const {
    const auto bridged = [](const auto& c) { return c.bridge > 0.0; };
    return static_cast<double>(std::count_if(s.pairs().begin(), s.pairs().end(), bridged) +
                               std::count_if(s.walls().begin(), s.walls().end(), bridged));
}

double CoordinationNumber::operator()(const Sample& s) const {
    const std::ptrdiff_t ends = 2 * number_touching(s.pairs()) + number_touching(s.walls());
    return static_cast<double>(ends) / static_cast<double>(s.place.size());
}

double MaxOverlap::operator()(const Sample& s) const {
    double largest = 0.0;
    for (const TouchingPair& pair : s.pairs()) largest = std::max(largest, pair.overlap);
    for (const TouchingWall& contact : s.walls()) largest = std::max(largest, contact.overlap);
    return largest;
}

void WallForce::bind(const Simulation& s, const Table& t) {
    for (std::size_t w = 0; w < s.grains.walls.size(); ++w)
        if (s.grains.walls[w].name == wall) index = static_cast<std::int32_t>(w);
    if (index < 0) t.fail("wall", fmt::format("there is no [[wall]] named \"{}\"", wall));
}

double WallForce::operator()(const Sample& s) const {
    double sum = 0.0;
    for (const TouchingWall& contact : s.walls())
        if (contact.wall == index) sum -= component.of(contact.force);
    return sum;
}

void PackingFraction::bind(const Simulation& s, const Table& t) const {
    for (Eigen::Index c = 0; c < 3; ++c) {
        if (!(upper[c] > lower[c])) t.fail("upper", "must exceed lower along every axis");
        if (lower[c] < 0.0 || upper[c] > s.grains.domain.size[c]) t.fail("lower", "the box must lie in the domain");
    }
}

double PackingFraction::operator()(const Sample& s) const {
    const Domain& domain = s.simulation.grains.domain;
    Vec3 low = lower, high = upper;
    std::array<int, 3> images{};
    for (Eigen::Index c = 0; c < 3; ++c) {
        const bool spans = lower[c] == 0.0 && upper[c] == domain.size[c];
        if (spans) low[c] = -std::numeric_limits<double>::infinity(), high[c] = std::numeric_limits<double>::infinity();
        images[static_cast<std::size_t>(c)] = !spans && domain.periodic[static_cast<std::size_t>(c)] ? 1 : 0;
    }
    const double filled = s.sum(0.0, [&](std::size_t k) {
        double part = 0.0;
        for (int a = -images[0]; a <= images[0]; ++a)
            for (int b = -images[1]; b <= images[1]; ++b)
                for (int c = -images[2]; c <= images[2]; ++c) {
                    const Vec3 x = domain.wrapped(s.grains.x[k]) + Vec3(a, b, c).cwiseProduct(domain.size);
                    part += sphere_box_overlap(s.grains.radius[k], low - x, high - x);
                }
        return part;
    });
    return filled / (upper - lower).prod();
}

GrainFluidForce::GrainFluidForce(Table& table) : members(table), component(table) {
    if (!table.has("grain")) return;
    if (members.name) table.fail("grain", "give either grain or group");
    grain.emplace(table);
}

void GrainFluidForce::bind(const Simulation& s, const Table& t) {
    demand_fluid(s, t);
    members.bind(s, t);
    if (grain) grain->bind(s, t);
}

double GrainFluidForce::operator()(const Sample& s) const {
    const std::vector<Vec3>& force = s.simulation.fluid->last_fluid_force; // by id
    if (grain) return component.of(force[grain->id]);
    return s.sum(0.0, [&](std::size_t k) {
        return members.contain(s.grains, k) ? component.of(force[static_cast<std::size_t>(s.grains.id[k])]) : 0.0;
    });
}

void GrainDragForce::bind(const Simulation& s, const Table& t) {
    demand_fluid(s, t);
    demand_constant_count(s, t);
}
std::vector<double> GrainDragForce::operator()(const Sample& s) const {
    const std::vector<Vec3>& drag = s.simulation.fluid->last_drag; // by id
    return by_id(s, [&](std::size_t k) { return component.of(drag[static_cast<std::size_t>(s.grains.id[k])]); });
}

void GrainVelocities::bind(const Simulation& s, const Table& t) { demand_constant_count(s, t); }
std::vector<double> GrainVelocities::operator()(const Sample& s) const {
    return by_id(s, [&](std::size_t k) { return component.of(s.grains.v[k]); });
}

void GrainAngularVelocities::bind(const Simulation& s, const Table& t) { demand_constant_count(s, t); }
std::vector<double> GrainAngularVelocities::operator()(const Sample& s) const {
    return by_id(s, [&](std::size_t k) { return component.of(s.grains.omega[k]); });
}

} // namespace plumb
