#include "dem/wall_contacts.hpp"

#include "core/parallel.hpp"

#include <algorithm>

namespace plumb {

namespace {

Space<double> space(const Vec3& a) { return {a[0], a[1], a[2]}; }
Vec3 vec(const Space<double>& a) { return {a.x, a.y, a.z}; }

Space<double> remembered(const WallContact& contact, std::size_t first) {
    return {contact.stretch[first], contact.stretch[first + 1], contact.stretch[first + 2]};
}
void remember(WallContact& contact, std::size_t first, const Space<double>& stretch) {
    contact.stretch[first] = stretch.x;
    contact.stretch[first + 1] = stretch.y;
    contact.stretch[first + 2] = stretch.z;
}

/// Force and torque of one wall point, for one pair of laws. A wall is a body of infinite mass and radius.
template <class Law, class RollingLawType>
void apply_laws(WallContact& contact, const WallPoint& point, const Law& law, const RollingLawType& rolling,
                const GrainRecord& grain, const SpinRecord& spin, const Vec3& wall_velocity, double dt) {
    const Vec3 v(grain.vx, grain.vy, grain.vz), surface(spin.x, spin.y, spin.z); // surface = R omega
    const Space<double> n = space(point.normal);
    const double lever = point.distance / grain.radius;
    const Space<double> still{0.0, 0.0, 0.0}; // the normal of a plane does not turn; on a curve springs are first order
    const Contact<double> state{grain.radius - point.distance,
                                n,
                                space(v - wall_velocity) - lever * cross(space(surface), n),
                                grain.inverse_mass,
                                1.0 / grain.radius,
                                dt,
                                still};
    Space<double> stretch = remembered(contact, 0);
    const ContactForce<double> f = Law::force(state, law.parameters, stretch);
    if constexpr (Law::history > 0) remember(contact, 0, stretch);
    contact.force = vec(f.normal * n + f.tangential);
    contact.torque = -point.distance * point.normal.cross(vec(f.tangential));
    if constexpr (!std::is_same_v<RollingLawType, NoRolling>) {
        const Vec3 omega = surface / grain.radius;
        const double r = grain.radius;
        const Rolling<double> turning{n,
                                      space(omega - omega.dot(point.normal) * point.normal),
                                      std::max(f.normal, 0.0),
                                      r,
                                      2.5 * grain.inverse_mass / (r * r),
                                      dt,
                                      still};
        Space<double> bend = remembered(contact, Law::history);
        contact.torque += vec(RollingLawType::torque(turning, rolling.parameters, bend));
        if constexpr (RollingLawType::history > 0) remember(contact, Law::history, bend);
    }
}

/// Forms the bridge of a grain that touches, breaks that of one too far away, and adds what it pulls.
void apply_bridge(WallContact& contact, const WallPoint& point, const LiquidBridge& law, double radius) {
    const LiquidBridge::Parameters<double>& p = law.parameters;
    const double s = std::max(-contact.overlap, 0.0);
    if (contact.overlap > 0.0 && contact.bridge == 0.0) contact.bridge = LiquidBridge::formed_volume(p, radius);
    if (!LiquidBridge::holds(p, s, contact.bridge)) contact.bridge = 0.0;
    if (contact.bridge > 0.0)
        contact.force -= LiquidBridge::attraction(p, s, contact.bridge, 1.0 / radius) * point.normal;
}

/// Replaces the contacts of one grain by those of now, each taking over the memory of its forerunner.
template <class Law, class RollingLawType, class CohesionType>
void update_grain(WallContacts& near_walls, std::size_t q, const std::vector<WallBody>& walls,
                  const PairLaws<Law>& laws, const PairLaws<RollingLawType>& rolling,
                  const PairLaws<CohesionType>& cohesion, const Grains& grains, const Neighbours& list, double time,
                  double dt) {
    constexpr bool wet = std::is_same_v<CohesionType, LiquidBridge>;
    const auto place = static_cast<std::size_t>(near_walls.near[q]);
    std::vector<WallContact>& contacts = near_walls.contacts[q];
    static thread_local std::vector<WallContact> before; // a handful at most; keeps its memory from call to call
    before.clear();
    before.swap(contacts);
    const GrainRecord& grain = list.records[place];
    if (grain.inverse_mass == 0.0) return; // a fixed grain and a wall: two bodies of infinite mass
    const Vec3 x(grain.x, grain.y, grain.z);
    const auto material = static_cast<std::int32_t>(list.spins[place].material);
    for (std::size_t e = near_walls.walls_begin[q]; e < near_walls.walls_begin[q + 1]; ++e) {
        const std::int32_t number = near_walls.walls[e];
        const WallBody& wall = walls[static_cast<std::size_t>(number)];
        wall.touch(x, wet ? grain.radius + list.reach : grain.radius, time, [&](const WallPoint& point) {
            WallContact now{grains.id[place], number, point.element};
            now.overlap = grain.radius - point.distance;
            const bool touches = point.distance < grain.radius;
            for (const WallContact& old : before)
                if (old.wall == now.wall && old.element == now.element) {
                    if (touches) now.stretch = old.stretch;
                    now.bridge = old.bridge;
                }
            if (touches)
                apply_laws(now, point, laws.of(material, wall.material), rolling.of(material, wall.material), grain,
                           list.spins[place], wall.velocity, dt);
            if constexpr (wet) apply_bridge(now, point, cohesion.of(material, wall.material), grain.radius);
            if (touches || now.bridge > 0.0) contacts.push_back(now);
        });
    }
}

} // namespace

std::vector<WallContact> all_wall_contacts(const WallContacts& near_walls) {
    std::vector<WallContact> all;
    for (const auto& contacts : near_walls.contacts) all.insert(all.end(), contacts.begin(), contacts.end());
    std::stable_sort(all.begin(), all.end(),
                     [](const WallContact& a, const WallContact& b) { return a.grain < b.grain; });
    return all;
}

void rebuild(WallContacts& near_walls, const std::vector<WallBody>& walls, const Grains& grains, double margin,
             double time, const std::vector<WallContact>& memory) {
    near_walls.near.clear();
    near_walls.contacts.clear();
    near_walls.slot.clear();
    near_walls.walls_begin.assign(1, 0);
    near_walls.walls.clear();
    if (walls.empty()) return;
    near_walls.slot.assign(grains.size(), -1);
    for (std::size_t k = 0; k < grains.size(); ++k) {
        for (std::size_t w = 0; w < walls.size(); ++w) {
            bool close = false;
            walls[w].touch(grains.x[k], grains.radius[k] + margin, time, [&](const WallPoint&) { close = true; });
            if (close) near_walls.walls.push_back(static_cast<std::int32_t>(w));
        }
        if (near_walls.walls.size() == near_walls.walls_begin.back()) continue;
        near_walls.walls_begin.push_back(near_walls.walls.size());
        near_walls.slot[k] = static_cast<std::int32_t>(near_walls.near.size());
        near_walls.near.push_back(static_cast<std::int32_t>(k));
    }
    near_walls.contacts.resize(near_walls.near.size());
    const std::vector<std::int32_t> place = positions_of_ids(grains);
    for (const WallContact& contact : memory) {
        const auto k = static_cast<std::size_t>(place[static_cast<std::size_t>(contact.grain)]);
        if (near_walls.slot[k] >= 0)
            near_walls.contacts[static_cast<std::size_t>(near_walls.slot[k])].push_back(contact);
    }
}

void evaluate_wall_contacts(WallContacts& near_walls, const std::vector<WallBody>& walls, const ContactModel& model,
                            const Grains& grains, const Neighbours& list, double time, double dt) {
    std::visit(
        [&](const auto& laws, const auto& rolling, const auto& cohesion) {
            using Law = typename std::decay_t<decltype(laws.laws)>::value_type;
            if constexpr (!std::is_same_v<Law, NoContact>)
                parallel_chunks(
                    near_walls.near.size(),
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t q = begin; q < end; ++q)
                            update_grain(near_walls, q, walls, laws, rolling, cohesion, grains, list, time, dt);
                    },
                    64);
        },
        model.contact, model.rolling, model.cohesion);
}

} // namespace plumb
