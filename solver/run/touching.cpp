#include "run/touching.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace plumb {

namespace {

double spring_energy(const NoContact& /*law*/, double /*overlap*/, double /*inverse_radius*/, double /*slide_sq*/) {
    return 0.0;
}
/// Energy of a tangential spring; friction bounds its force by mu times the elastic normal force.
double tangential_energy(double stiffness, double slide_sq, double limit) {
    return stiffness > 0.0 ? std::min(0.5 * stiffness * slide_sq, 0.5 * limit * limit / stiffness) : 0.0;
}
double spring_energy(const LinearSpring& law, double overlap, double /*inverse_radius*/, double slide_sq) {
    const auto& p = law.parameters;
    return 0.5 * p.stiffness * overlap * overlap +
           tangential_energy(p.tangential_stiffness, slide_sq, p.friction * p.stiffness * overlap);
}
double spring_energy(const LinearSpringCoulomb& law, double overlap, double /*inverse_radius*/, double /*slide_sq*/) {
    return 0.5 * law.parameters.stiffness * overlap * overlap;
}
double spring_energy(const HertzMindlin& law, double overlap, double inverse_radius, double slide_sq) {
    const double patch = std::sqrt(overlap / inverse_radius); // contact radius sqrt(R* o) [m]
    // 8/15 E* sqrt(R*) o^(5/2), the integral of Hertz's 4/3 E* sqrt(R*) o^(3/2)
    const double normal_force = 4.0 / 3.0 * law.parameters.modulus * patch * overlap;
    return 0.4 * normal_force * overlap + tangential_energy(8.0 * law.parameters.shear_modulus * patch, slide_sq,
                                                            law.parameters.friction * normal_force);
}

double rolling_energy(const NoRolling& /*law*/, double /*bend_sq*/) { return 0.0; }
double rolling_energy(const ConstantTorque& /*law*/, double /*bend_sq*/) { return 0.0; }
double rolling_energy(const ElasticPlastic& law, double bend_sq) { return 0.5 * law.parameters.stiffness * bend_sq; }

/// Relative motion of two surfaces at their contact, without the parts along the normal.
struct Sliding {
    Vec3 slip;     // [m/s]
    Vec3 rotation; // [rad/s]
};

Vec3 tangential(const Vec3& v, const Vec3& normal) { return v - v.dot(normal) * normal; }

/// Square of the part of a remembered stretch that belongs to the end of the step.
template <class Memory>
double stretch_now_sq(const Memory& memory, std::size_t first, const Vec3& rate, const Vec3& normal, double dt) {
    const Vec3 kept(memory[first], memory[first + 1], memory[first + 2]);
    return tangential(kept - 0.5 * dt * rate, normal).squaredNorm();
}

template <class Memory>
double contact_energy(const ContactModel& model, std::int32_t a, std::int32_t b, double overlap, double inverse_radius,
                      const Memory& memory, const Sliding& sliding, const Vec3& normal, double dt) {
    return std::visit(
        [&](const auto& contact, const auto& rolling) {
            using Law = typename std::decay_t<decltype(contact.laws)>::value_type;
            using RollingLawType = typename std::decay_t<decltype(rolling.laws)>::value_type;
            double slide_sq = 0.0, bend_sq = 0.0;
            if constexpr (Law::history > 0)
                if (contact.of(a, b).parameters.friction > 0.0) // else the spring never carries anything
                    slide_sq = stretch_now_sq(memory, 0, sliding.slip, normal, dt);
            if constexpr (RollingLawType::history > 0)
                bend_sq = stretch_now_sq(memory, Law::history, sliding.rotation, normal, dt);
            return spring_energy(contact.of(a, b), overlap, inverse_radius, slide_sq) +
                   rolling_energy(rolling.of(a, b), bend_sq);
        },
        model.contact, model.rolling);
}

/// Energy of a bridge [J], 0 without one.
double bridge_energy(const ContactModel& model, std::int32_t a, std::int32_t b, double overlap, double inverse_radius,
                     double liquid) {
    const auto* bridges = liquid_bridges(model);
    if (bridges == nullptr || !(liquid > 0.0)) return 0.0;
    const LiquidBridge& law = bridges->of(a, b);
    const double at_contact = LiquidBridge::attraction(law.parameters, 0.0, liquid, inverse_radius);
    return -law.work_to_rupture(std::max(-overlap, 0.0), liquid, inverse_radius) - at_contact * std::max(overlap, 0.0);
}

std::array<double, 6> pair_memory(const Neighbours& list, std::size_t pair) {
    std::array<double, 6> memory{};
    for (int h = 0; h < list.history; ++h) memory[static_cast<std::size_t>(h)] = list.remembered(pair, h);
    return memory;
}

} // namespace

double elastic_energy(const ContactLaw& law, double overlap, double inverse_radius, double slide_sq) {
    return std::visit([&](const auto& l) { return spring_energy(l, overlap, inverse_radius, slide_sq); }, law);
}

std::vector<TouchingPair> touching_pairs(const GrainSystem& system, double dt) {
    const Grains& g = system.grains;
    const Neighbours& list = system.neighbours;
    std::vector<TouchingPair> pairs;
    if (contactless(system.contact)) return pairs;
    for (std::size_t p = 0; p < list.count; ++p) {
        const auto i = static_cast<std::size_t>(list.i[p]), j = static_cast<std::size_t>(list.j[p]);
        const Vec3 dx = system.domain.minimum_image(g.x[i] - g.x[j]);
        const double distance = dx.norm(), reach = g.radius[i] + g.radius[j];
        const double liquid = list.bridges ? list.bridge[p] : 0.0;
        if (!(distance < reach) && !(liquid > 0.0)) continue;
        const Vec3 normal = dx / distance;
        const Vec3 spin = g.radius[i] * g.omega[i] + g.radius[j] * g.omega[j];
        const Vec3 velocity = g.v[i] - g.v[j] - (distance / reach) * spin.cross(normal);
        const Sliding sliding{tangential(velocity, normal), tangential(g.omega[i] - g.omega[j], normal)};
        const double overlap = reach - distance, inverse_radius = 1.0 / g.radius[i] + 1.0 / g.radius[j];
        double energy = bridge_energy(system.contact, g.group[i], g.group[j], overlap, inverse_radius, liquid);
        if (overlap > 0.0)
            energy += contact_energy(system.contact, g.group[i], g.group[j], overlap, inverse_radius,
                                     pair_memory(list, p), sliding, normal, dt);
        pairs.push_back({std::min(g.id[i], g.id[j]), std::max(g.id[i], g.id[j]), overlap, energy, liquid});
    }
    std::sort(pairs.begin(), pairs.end(), [](const TouchingPair& a, const TouchingPair& b) {
        return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    });
    return pairs;
}

std::vector<TouchingWall> touching_walls(const GrainSystem& system, double dt) {
    const Grains& g = system.grains;
    std::vector<TouchingWall> contacts;
    if (contactless(system.contact)) return contacts;
    for (std::size_t q = 0; q < system.wall_contacts.near.size(); ++q) {
        const auto k = static_cast<std::size_t>(system.wall_contacts.near[q]);
        for (const WallContact& contact : system.wall_contacts.contacts[q]) {
            const WallBody& wall = system.walls[static_cast<std::size_t>(contact.wall)];
            const auto note = [&](const WallPoint& point) {
                if (point.element != contact.element || (!(point.distance < g.radius[k]) && !(contact.bridge > 0.0)))
                    return;
                const Vec3 surface = g.radius[k] * g.omega[k];
                const Vec3 velocity =
                    g.v[k] - wall.velocity - (point.distance / g.radius[k]) * surface.cross(point.normal);
                const Sliding sliding{tangential(velocity, point.normal), tangential(g.omega[k], point.normal)};
                const double overlap = g.radius[k] - point.distance;
                double energy = bridge_energy(system.contact, g.group[k], wall.material, overlap, 1.0 / g.radius[k],
                                              contact.bridge);
                if (overlap > 0.0)
                    energy += contact_energy(system.contact, g.group[k], wall.material, overlap, 1.0 / g.radius[k],
                                             contact.stretch, sliding, point.normal, dt);
                contacts.push_back(
                    {contact.grain, contact.wall, contact.element, overlap, energy, contact.force, contact.bridge});
            };
            wall.touch(g.x[k], g.radius[k] + system.neighbours.reach, system.time, note);
        }
    }
    std::sort(contacts.begin(), contacts.end(), [](const TouchingWall& a, const TouchingWall& b) {
        return std::tie(a.grain, a.wall, a.element) < std::tie(b.grain, b.wall, b.element);
    });
    return contacts;
}

} // namespace plumb
