// Grains: spheres of any sizes, their state and what they are made of.
#pragma once

#include "core/domain.hpp"
#include "core/sphere.hpp"
#include "core/vec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

enum class Motion : std::uint8_t {
    free,  // follows the forces on it
    fixed, // keeps its velocity: infinite mass
    block, // all grains of the group move as one rigid body without rotation
};

/// What the grains of one [[grains]] table share.
struct GrainGroup {
    std::string name;
    double density = 0.0; // [kg/m3]
    bool rotation = true;
    Motion motion = Motion::free;
};

/// State of all grains, one entry per grain. The order follows the cells of the neighbour search and changes when the
/// neighbour list is rebuilt; `id` (order of creation) never does.
struct Grains {
    std::vector<Vec3> x;          // centre [m]; brought back into a periodic box when the neighbour list is rebuilt
    std::vector<Vec3> turns;      // whole box lengths taken off x so far along periodic axes
    std::vector<Vec3> v;          // velocity [m/s]
    std::vector<Vec3> a;          // acceleration by contacts and gravity [m/s2], of the state x, v
    std::vector<Vec3> omega;      // angular velocity [rad/s]
    std::vector<Vec3> alpha;      // angular acceleration [rad/s2]
    std::vector<Vec3> x_listed;   // positions for which the neighbour list was built [m]
    std::vector<double> radius;   // [m]
    std::vector<double> mass;     // [kg]
    std::vector<double> mobility; // acceleration per force [1/kg]: 1/(m + added mass); 0 for a fixed grain
    std::vector<double>
        spin_mobility;               // angular acceleration per torque [1/(kg m2)]: 1/I; 0 for a grain that cannot turn
    std::vector<std::int32_t> id;    // order of creation
    std::vector<std::int32_t> group; // index into the groups

    std::size_t size() const { return x.size(); }
};

/// Adds one grain at rest contact-wise (a = alpha = 0). Its id is the number of grains before it.
void add_grain(Grains& grains, const std::vector<GrainGroup>& groups, std::int32_t group, double radius, const Vec3& x,
               const Vec3& v, const Vec3& omega);

/// Calls f(field) for every field of `grains`, in one fixed order: for reordering, checkpoints and comparison.
template <class G, class F> void for_each_field(G& grains, F&& f) {
    f("x", grains.x), f("turns", grains.turns), f("v", grains.v), f("a", grains.a), f("omega", grains.omega),
        f("alpha", grains.alpha);
    f("x_listed", grains.x_listed), f("radius", grains.radius), f("mass", grains.mass);
    f("mobility", grains.mobility), f("spin_mobility", grains.spin_mobility), f("id", grains.id),
        f("group", grains.group);
}

/// Position of grain k as if the box had never brought it back [m].
inline Vec3 unwrapped(const Grains& grains, const Domain& domain, std::size_t k) {
    return grains.x[k] + grains.turns[k].cwiseProduct(domain.size);
}

/// New order of a field: entry k becomes the old entry order[k].
template <class FieldType> void reorder(FieldType& field, const std::vector<std::int32_t>& order) {
    FieldType moved = field;
    for (std::size_t k = 0; k < order.size(); ++k) moved[k] = field[static_cast<std::size_t>(order[k])];
    field.swap(moved);
}

/// The same for every field of `grains`.
void reorder(Grains& grains, const std::vector<std::int32_t>& order);

/// Index in the present order of each id: position[id].
std::vector<std::int32_t> positions_of_ids(const Grains& grains);

} // namespace plumb
