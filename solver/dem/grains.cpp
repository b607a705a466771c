#include "dem/grains.hpp"

namespace plumb {

void add_grain(Grains& grains, const std::vector<GrainGroup>& groups, std::int32_t group, double radius, const Vec3& x,
               const Vec3& v, const Vec3& omega) {
    const GrainGroup& made_of = groups[static_cast<std::size_t>(group)];
    const double mass = made_of.density * sphere_volume(2.0 * radius);
    const auto id = static_cast<std::int32_t>(grains.size());
    grains.x.push_back(x);
    grains.turns.push_back(Vec3::Zero());
    grains.v.push_back(v);
    grains.a.push_back(Vec3::Zero());
    grains.omega.push_back(omega);
    grains.alpha.push_back(Vec3::Zero());
    grains.x_listed.push_back(x);
    grains.radius.push_back(radius);
    grains.mass.push_back(mass);
    grains.mobility.push_back(made_of.motion == Motion::fixed ? 0.0 : 1.0 / mass);
    const bool turns = made_of.rotation && made_of.motion == Motion::free;
    grains.spin_mobility.push_back(turns ? 1.0 / sphere_inertia(mass, 2.0 * radius) : 0.0);
    grains.id.push_back(id);
    grains.group.push_back(group);
}

void reorder(Grains& grains, const std::vector<std::int32_t>& order) {
    for_each_field(grains, [&](const char* /*name*/, auto& field) { reorder(field, order); });
}

std::vector<std::int32_t> positions_of_ids(const Grains& grains) {
    std::vector<std::int32_t> position(grains.size());
    for (std::size_t k = 0; k < grains.size(); ++k)
        position[static_cast<std::size_t>(grains.id[k])] = static_cast<std::int32_t>(k);
    return position;
}

} // namespace plumb
