#include "core/walls.hpp"

#include <fmt/format.h>

#include <set>

namespace plumb {

namespace {

Vec3 direction(Table& table, std::string_view key) {
    const Vec3 given = table.vector(key);
    const double length = given.stableNorm();
    if (!(length > 0.0)) table.fail(key, "is zero; expected a direction");
    return (given / length).normalized(); // twice: the first quotient of a denormal length is inexact
}

} // namespace

Plane::Plane(Table& table) : point(table.vector("point")), normal(direction(table, "normal")) {}

Box::Box(Table& table) : lower(table.vector("lower")), upper(table.vector("upper")) {
    for (Eigen::Index c = 0; c < 3; ++c)
        if (!(lower[c] < upper[c]))
            table.fail("upper", fmt::format("component {} is {}, not above lower, {}",
                                            axis_names[static_cast<std::size_t>(c)], upper[c], lower[c]));
}

Cylinder::Cylinder(Table& table)
    : point(table.vector("point")), axis(direction(table, "axis")), sideways(axis.unitOrthogonal()),
      radius(table.number("radius", positive)),
      sign(table.choice("side", {"inside", "outside"}) == "inside" ? -1.0 : 1.0) {}

std::vector<WallBody> make_walls(std::vector<Table>& tables) {
    std::vector<WallBody> walls;
    std::set<std::string> names;
    for (Table& table : tables) {
        std::string name = table.text("name");
        if (!names.insert(name).second) table.fail("name", fmt::format("\"{}\" is used by two walls", name));
        auto shape = make_family<Wall>(table, "shape"); // "law" would say nothing in a [[wall]] table
        const Vec3 velocity = table.has("velocity") ? table.vector("velocity") : Vec3::Zero();
        walls.push_back(WallBody{std::move(name), std::move(shape), velocity});
    }
    return walls;
}

} // namespace plumb
