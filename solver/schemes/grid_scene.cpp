#include "schemes/grid_scene.hpp"

#include "core/initial_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

namespace {

constexpr double most_cells = 1e8; // in all: their numbers, and those of their faces, have to fit an int
constexpr double on_side = 1e-9;   // times the box: how near to a side a plane has to be to be it

/// The side of the box that a plane through `point` with `normal` into the fluid is, or nothing.
struct SideNumber {
    std::size_t axis, end;
};
std::optional<SideNumber> side_of_plane(const Domain& domain, const Vec3& point, const Vec3& normal) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(domain.dimensions); ++c) {
        const auto k = static_cast<Eigen::Index>(c);
        if (std::abs(std::abs(normal[k]) - 1.0) > on_side) continue;
        const std::size_t end = normal[k] > 0.0 ? 0 : 1;
        if (std::abs(point[k] - (end == 0 ? 0.0 : domain.size[k])) < on_side * domain.size[k])
            return SideNumber{c, end};
    }
    return std::nullopt;
}

/// A side that the scene has named.
GridSide& name_side(GridFluid& f, std::vector<std::string>& named, const SideNumber& number, const Table& table,
                    const std::string& name) {
    const std::string side = fmt::format("{} end of {}", number.end == 0 ? "lower" : "upper", axis_names[number.axis]);
    if (f.domain.periodic[number.axis]) table.fail("point", fmt::format("lies on the {}, which is periodic", side));
    std::string& owner = named[2 * number.axis + number.end];
    if (!owner.empty()) table.fail("point", fmt::format("lies on the {}, as \"{}\" does", side, owner));
    owner = name;
    return f.sides[number.axis][number.end];
}

/// An axis whose cells are `times` the spacing wide at the places `at`, and in between linearly.
Axis read_stretch(Table& fluid, const std::string& key, const GridFluid& f, std::size_t c, double spacing) {
    Table table = fluid.table(key);
    const double length = f.domain.size[static_cast<Eigen::Index>(c)];
    const std::vector<double> at = table.numbers("at");
    std::vector<double> times = table.numbers("times", positive);
    if (at.size() < 2 || at.size() != times.size())
        table.fail("times", "expected as many numbers as in `at`, 2 at least");
    if (at.front() != 0.0 || at.back() != length || !std::is_sorted(at.begin(), at.end(), std::less_equal<>()))
        table.fail("at", fmt::format("expected ascending places from 0 to {}, the length of the box", length));
    for (double& t : times) t *= spacing;
    const double least = *std::min_element(times.begin(), times.end());
    if (length / least > most_cells)
        table.fail("times", fmt::format("cells of {:.4g} m make more than {:.0e} along the axis", least, most_cells));
    return stretched_axis(at, times, f.domain.periodic[c]);
}

/// One spacing, or one along each axis [m]; `stretch_x`, `stretch_y` and `stretch_z` widen the cells of theirs.
void read_axes(Table& table, GridFluid& f) {
    const bool alike = table.type("spacing") != toml::node_type::array;
    const Vec3 spacing = alike ? Vec3::Constant(table.number("spacing", positive))
                               : table.components("spacing", f.grid.dimensions, positive);
    double count = 1.0;
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const auto k = static_cast<Eigen::Index>(c);
        if (const std::string key = fmt::format("stretch_{}", axis_names[c]); table.has(key)) {
            f.grid.axis[c] = read_stretch(table, key, f, c, spacing[k]);
            count *= f.grid.axis[c].cells();
            continue;
        }
        const double length = f.domain.size[k], cells = length / spacing[k];
        count *= cells;
        if (std::abs(cells - std::nearbyint(cells)) > 1e-6 * cells || cells < 0.5 || count > most_cells)
            table.fail("spacing",
                       fmt::format("the box measures {:.9g} spacings along {}; a whole number is needed, and "
                                   "no more than 1e8 cells in all",
                                   cells, axis_names[c]));
        f.grid.axis[c] = even_axis(length, static_cast<int>(std::lround(cells)), f.domain.periodic[c]);
    }
    if (count > most_cells) table.fail("spacing", fmt::format("{:.3g} cells; {:.0e} are possible", count, most_cells));
    if (f.grid.dimensions == 3) return;
    const bool slab = f.domain.dimensions == 3;
    f.grid.axis[2].node = slab ? std::vector<double>{0.0, f.domain.size[2]} : std::vector<double>{-0.5, 0.5};
}

/// What every fluid has, at rest everywhere.
void read_numbers(Table& table, GridFluid& f) {
    f.density = table.number("density", positive);
    f.viscosity = table.number("viscosity", positive);
    f.advection = make_family<Advection>(table.law("advection"));
    f.residual = table.number("residual", {0.0, 1e-2, false, true});
    const bool full = table.choice("pressure", {"full", "dynamic"}) == "full";
    f.body_force = full ? f.domain.gravity : Vec3::Zero();
    if (table.has("body_force")) f.body_force += table.components("body_force", f.domain.dimensions);
    if (table.has("source")) f.source = make_family<GridSource>(table.law("source"));
    for (std::size_t c = 0; c < 3; ++c) f.u[c].assign(f.grid.faces(c).size(), 0.0);
    f.p.assign(f.grid.cells().size(), 0.0);
    f.eps.assign(f.grid.cells().size(), 1.0);
    if (!table.has("porosity")) return;
    f.medium = make_family<MediumPorosity>(table.law("porosity"));
    f.resistance = make_family<Resistance>(table.law("resistance"));
    f.eps = medium_porosity(f, 0.0);
}

/// Positive outside of all walls, else the distance to their surface, negative. How far the open places are is not
/// asked, so that an array of cylinders is not visited as a whole for each of them.
double depth_in(const std::vector<WallBody>& walls, const Vec3& x) {
    constexpr double touching = std::numeric_limits<double>::min();
    double least = std::numeric_limits<double>::infinity();
    for (const WallBody& wall : walls)
        wall.touch(x, touching, 0.0, [&](const WallPoint& point) { least = std::min(least, point.distance); });
    return least;
}

void read_walls(Table& fluid, GridFluid& f, const std::vector<FluidWall>& walls, std::vector<std::string>& named) {
    std::vector<WallBody> immersed;
    for (const FluidWall& wall : walls) {
        const auto* plane = std::get_if<Plane>(&wall.body.shape);
        const auto number = plane ? side_of_plane(f.domain, plane->point, plane->normal) : std::nullopt;
        if (number) {
            GridSide& side = name_side(f, named, *number, fluid, wall.body.name);
            side.kind = wall.slips ? GridSide::Kind::free_slip : GridSide::Kind::no_slip;
            side.velocity = wall.body.velocity;
            if (wall.body.velocity.dot(plane->normal) != 0.0)
                fluid.fail("method",
                           fmt::format("\"grid\" has no walls that leave their place: \"{}\"", wall.body.name));
            continue;
        }
        if (wall.slips || wall.body.velocity.norm() > 0.0)
            fluid.fail("method",
                       fmt::format("\"grid\" has immersed walls that stick and rest only: \"{}\"", wall.body.name));
        immersed.push_back(wall.body);
    }
    f.open =
        immersed.empty() ? open_grid(f.grid) : cut_grid(f.grid, [&](const Vec3& x) { return depth_in(immersed, x); });
}

std::optional<SideNumber> side_of(Table& table, const GridFluid& f) {
    const Vec3 point = table.components("point", f.domain.dimensions);
    Vec3 normal = table.components("normal", f.domain.dimensions);
    if (!(normal.norm() > 0.0)) table.fail("normal", "is zero; expected a direction");
    const auto number = side_of_plane(f.domain, point, normal.normalized());
    if (!number) table.fail("point", "is on no side of the box: those of a grid are its open sides");
    return number;
}

void read_open_sides(GridFluid& f, std::vector<Table>& inlets, std::vector<Table>& outlets,
                     std::vector<std::string>& named) {
    for (Table& table : inlets) {
        const SideNumber number = *side_of(table, f);
        name_side(f, named, number, table, table.text("name")).kind = GridSide::Kind::inflow;
        const Vec3 point = table.components("point", f.domain.dimensions);
        const auto profile = make_family<InletProfile>(table.law("profile"));
        const Block faces = f.grid.faces(number.axis);
        const int at = number.end == 0 ? 0 : f.grid.axis[number.axis].cells();
        for_each_place(faces, [&](const Place& p, std::size_t k) {
            if (p[number.axis] != at) return;
            Vec3 across = f.grid.face_centre(number.axis, p) - point;
            across[static_cast<Eigen::Index>(number.axis)] = 0.0;
            if (f.grid.dimensions == 2) across[2] = 0.0;
            const double speed =
                std::visit([&](const auto& law) { return law(across.norm(), f.grid.dimensions); }, profile);
            f.u[number.axis][k] = number.end == 0 ? speed : -speed;
        });
    }
    for (Table& table : outlets) {
        GridSide& side = name_side(f, named, *side_of(table, f), table, table.text("name"));
        side.kind = GridSide::Kind::outflow;
        side.pressure = table.number("pressure");
    }
}

void check_sides(const Table& table, const GridFluid& f, const std::vector<std::string>& named) {
    if (f.grid.dimensions < f.domain.dimensions && !f.domain.periodic[2])
        for (const std::size_t end : {0, 1})
            if (named[4 + end].empty() || f.sides[2][end].kind != GridSide::Kind::free_slip)
                table.fail("dimensions", "a fluid that does not depend on z needs walls with slip = \"free_slip\" at "
                                         "both ends of z, or a periodic z");
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (std::size_t end = 0; end < 2; ++end)
            if (!f.domain.periodic[c] && named[2 * c + end].empty())
                table.fail("method", fmt::format("\"grid\" needs a wall, an inlet or an outlet at the {} end of {}",
                                                 end == 0 ? "lower" : "upper", axis_names[c]));
}

/// The initial field at the faces and cells that are solved for. It need not be free of divergence: the first step is.
void set_initial_state(Table& table, GridFluid& f) {
    const auto initial = make_family<InitialField>(table.law("initial"));
    const FluidNumbers numbers{f.domain.size, f.density, 0.0, f.viscosity, f.body_force, LinearState{}};
    const auto state = [&](const Vec3& x) {
        return std::visit([&](const auto& field) { return field(x, numbers); }, initial);
    };
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
            if (f.unknown[c][k] >= 0) f.u[c][k] = state(f.grid.face_centre(c, p)).u[static_cast<Eigen::Index>(c)];
        });
    for_each_place(f.grid.cells(), [&](const Place& p, std::size_t k) { f.p[k] = state(f.grid.centre(p)).p; });
}

} // namespace

GridFluid read_grid_fluid(Table& table, const Domain& domain, const std::vector<FluidWall>& walls,
                          std::vector<Table>& inlets, std::vector<Table>& outlets) {
    GridFluid f;
    f.domain = domain;
    f.grid.dimensions = domain.dimensions;
    table.choice("method", {"grid"});
    if (domain.dimensions == 3) f.grid.dimensions = static_cast<int>(table.integer("dimensions", 2, 3));
    read_axes(table, f);
    read_numbers(table, f);
    std::vector<std::string> named(6);
    read_walls(table, f, walls, named);
    read_open_sides(f, inlets, outlets, named);
    check_sides(table, f, named);
    number_unknowns(f);
    if (f.unknowns[0] + f.unknowns[1] + f.unknowns[2] == 0) table.fail("spacing", "no face of the grid is open");
    set_initial_state(table, f);
    return f;
}

namespace {
/// Of one component.
double greatest_speed(const GridFluid& f, std::size_t c) {
    double fastest = 0.0;
    for (const double u : f.u[c]) fastest = std::max(fastest, std::abs(u));
    for (const auto& ends : f.sides)
        for (const GridSide& side : ends)
            fastest = std::max(fastest, std::abs(side.velocity[static_cast<Eigen::Index>(c)]));
    return fastest;
}
} // namespace

double greatest_speed(const GridFluid& f) {
    double fastest = 0.0;
    for (std::size_t c = 0; c < f.dimensions(); ++c) fastest = std::max(fastest, greatest_speed(f, c));
    return fastest;
}

std::vector<StepLimit> grid_limits(const GridFluid& f) {
    double rate = 0.0; // cells a second
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        double narrowest = std::numeric_limits<double>::infinity();
        for (int k = 0; k < f.grid.axis[c].cells(); ++k) narrowest = std::min(narrowest, f.grid.axis[c].width(k));
        rate = std::max(rate, greatest_speed(f, c) / narrowest);
    }
    return {{"courant", rate > 0.0 ? 1.0 / rate : std::numeric_limits<double>::infinity(),
             "width of a cell over the greatest speed at the start, of inlets and walls; for accuracy, not stability"}};
}

} // namespace plumb
