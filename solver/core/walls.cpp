#include "core/walls.hpp"

#include <fmt/format.h>

#include <limits>
#include <set>

namespace plumb {

namespace {

/// A place or direction: two numbers in a scene of two dimensions (make_walls has checked), else three.
Vec3 components(Table& table, std::string_view key) {
    return table.length(key) == 2 ? table.components(key, 2) : table.vector(key);
}

Vec3 direction(Table& table, std::string_view key) {
    const Vec3 given = components(table, key);
    const double length = given.stableNorm();
    if (!(length > 0.0)) table.fail(key, "is zero; expected a direction");
    return (given / length).normalized(); // twice: the first quotient of a denormal length is inexact
}

} // namespace

Plane::Plane(Table& table) : point(components(table, "point")), normal(direction(table, "normal")) {}

BoredPlane::BoredPlane(Table& table)
    : point(components(table, "point")), normal(direction(table, "normal")), sideways(normal.unitOrthogonal()),
      radius(table.number("radius", positive)) {
    if (table.length("point") == 2) table.fail("shape", "\"bored_plane\" in a scene of two dimensions");
}

namespace {

/// Faces of a box from its table; none across the plane.
void read_faces(const Table& table, Vec3& lower, Vec3& upper) {
    if (table.length("lower") == 2) {
        lower[2] = -std::numeric_limits<double>::infinity();
        upper[2] = -lower[2];
    }
    for (Eigen::Index c = 0; c < 3; ++c)
        if (!(lower[c] < upper[c]))
            table.fail("upper", fmt::format("component {} is {}, not above lower, {}",
                                            axis_names[static_cast<std::size_t>(c)], upper[c], lower[c]));
}

} // namespace

Box::Box(Table& table) : lower(components(table, "lower")), upper(components(table, "upper")) {
    read_faces(table, lower, upper);
}

SolidBox::SolidBox(Table& table) : lower(components(table, "lower")), upper(components(table, "upper")) {
    read_faces(table, lower, upper);
}

Cylinder::Cylinder(Table& table)
    : point(components(table, "point")), axis(table.length("point") == 2 ? Vec3::UnitZ() : direction(table, "axis")),
      sideways(axis.unitOrthogonal()), radius(table.number("radius", positive)),
      sign(table.choice("side", {"inside", "outside"}) == "inside" ? -1.0 : 1.0) {}

SphereWall::SphereWall(Table& table)
    : centre(components(table, "centre")), radius(table.number("radius", positive)),
      sign(table.choice("side", {"inside", "outside"}) == "inside" ? -1.0 : 1.0) {}

namespace {

void check_dimensions(const Table& table, int dimensions) {
    for (const char* key : {"point", "centre", "normal", "lower", "upper", "velocity"})
        if (table.type(key) == toml::node_type::array && table.length(key) != static_cast<std::size_t>(dimensions))
            table.fail(key, fmt::format("{} numbers in a scene of {} dimensions", table.length(key), dimensions));
}

} // namespace

std::vector<WallBody> make_walls(std::vector<Table>& tables, int dimensions) {
    std::vector<WallBody> walls;
    std::set<std::string> names;
    for (Table& table : tables) {
        check_dimensions(table, dimensions);
        std::string name = table.text("name");
        if (!names.insert(name).second) table.fail("name", fmt::format("\"{}\" is used by two walls", name));
        auto shape = make_family<Wall>(table, "shape"); // "law" would say nothing in a [[wall]] table
        const Vec3 velocity = table.has("velocity") ? components(table, "velocity") : Vec3::Zero();
        walls.push_back(WallBody{std::move(name), std::move(shape), velocity});
    }
    return walls;
}

std::vector<Table> walls_that_hold(const std::vector<Table>& tables, std::string_view what) {
    std::vector<Table> holding;
    for (Table table : tables)
        if (!table.has("holds") || table.choice("holds", {"fluid", "grains"}) == what) holding.push_back(table);
    return holding;
}

} // namespace plumb
