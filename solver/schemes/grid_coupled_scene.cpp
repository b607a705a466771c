#include "schemes/grid_coupled_scene.hpp"

#include "coupling/grid_symbols.hpp"
#include "coupling/suspension_viscosity.hpp"
#include "grid/sums.hpp"
#include "schemes/coupled_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// A width [m], or {times_diameter = x} of the largest grain.
double read_width(Table& coupling, double diameter) {
    const char* const key = "kernel_width";
    if (coupling.type(key) != toml::node_type::table) return coupling.number(key, positive);
    return coupling.table(key).number("times_diameter", positive) * diameter;
}

/// A grain anywhere has to find a node of each kind: none is further away than half the diagonal of the widest cell.
void check_reach(const Table& coupling, const GridFluid& f, double reach) {
    double diagonal_sq = 0.0;
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        double widest = 0.0;
        for (int k = 0; k < f.grid.axis[c].cells(); ++k) widest = std::max(widest, f.grid.axis[c].width(k));
        diagonal_sq += widest * widest;
    }
    if (reach < 0.5 * std::sqrt(diagonal_sq))
        coupling.fail("kernel_width", fmt::format("the kernel reaches {:.4g} m, less than half the diagonal of the "
                                                  "widest cell, {:.4g} m: a grain may meet no node",
                                                  reach, 0.5 * std::sqrt(diagonal_sq)));
}

/// All weight, less what carries it from outside, over the volume of what feels the gradient [Pa/m].
Vec3 balancing_gradient(const GridFluid& f, const GridCoupling& c, const FluidOnGrains& on_grains,
                        const GrainSystem& system) {
    double volume = 0.0;
    Vec3 weight = Vec3::Zero();
    for (std::size_t k = 0; k < f.eps.size(); ++k) {
        volume += c.weights.cell_volume[k];
        weight += f.density * f.eps[k] * c.weights.cell_volume[k] * f.body_force;
    }
    const Grains& g = system.grains;
    for (const std::int32_t place : positions_of_ids(g)) {
        const auto k = static_cast<std::size_t>(place);
        weight +=
            g.mass[k] * system.domain.gravity + force_from_outside(on_grains, 2.0 * g.radius[k], system.domain.gravity);
    }
    return weight / volume;
}

/// Width of the cells where they are equal cubes [m].
std::optional<double> cube(const GridFluid& f) {
    const double first = f.grid.axis[0].width(0);
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (int k = 0; k < f.grid.axis[c].cells(); ++k)
            if (std::abs(f.grid.axis[c].width(k) - first) > 1e-6 * first) return std::nullopt;
    return first;
}

/// The correction, or `none`.
void read_self_disturbance(Table& coupling, GridCoupling& c, const GridFluid& f, const GrainSystem& grains) {
    constexpr double least_deviation = 0.75; // in cells: waves beyond what the grid knows are then .4 % of the kernel
    const char* const key = "self_disturbance";
    const auto law = make_family<SelfDisturbanceLaw>(coupling.law(key));
    const auto* theory = std::get_if<OseenBrinkman>(&law);
    if (theory == nullptr) return;
    if (!c.two_way) coupling.fail(key, "grains that do not push the fluid have no wake to take out");
    if (f.grid.dimensions != 3) coupling.fail(key, "the wake is that of three dimensions; the fluid has two");
    const std::optional<double> cell = cube(f);
    if (!cell) coupling.fail(key, "on a grid the wake is known for cells that are equal cubes");
    if (!c.own_volume)
        coupling.fail("own_volume", "\"excluded\" does what self_disturbance does with a grain's own volume");
    if (std::holds_alternative<CellCounting>(c.weights.kernel))
        coupling.fail(key, "what a grain gathers by \"cell_counting\" depends on its place in the cell");
    const double deviation = deviation_in_widths(c.weights.kernel) * c.weights.width;
    if (deviation < least_deviation * *cell)
        coupling.fail("kernel_width",
                      fmt::format("the kernel deviates by {:.4g} m; self_disturbance needs {} cells, {:.4g} m",
                                  deviation, least_deviation, least_deviation * *cell));
    const std::vector<double>& r = grains.grains.radius;
    if (!std::holds_alternative<LoneGrain>(theory->structure) &&
        std::any_of(r.begin(), r.end(), [&](double one) { return one != r.front(); }))
        coupling.fail(key, "a structure factor is that of equal grains");
    c.self = self_disturbance(*theory, {f.density, f.viscosity, *cell, c.weights.width, c.weights.kernel},
                              largest_diameter(grains));
}

} // namespace

GridCoupling read_grid_coupling(Table& coupling, const GridFluid& fluid, const GrainSystem& grains) {
    GridCoupling c;
    c.two_way = coupling.choice("direction", {"two_way", "one_way"}) == "two_way";
    c.weights.kernel = make_family<GridKernel>(coupling.law("kernel"));
    if (!std::holds_alternative<CellCounting>(c.weights.kernel)) {
        c.weights.width = read_width(coupling, largest_diameter(grains));
        check_reach(coupling, fluid, reach_in_widths(c.weights.kernel) * c.weights.width);
    }
    c.own_volume = coupling.choice("own_volume", {"included", "excluded"}) == "included";
    c.least_porosity = coupling.number("least_porosity", {0.0, 1.0, false, false});
    read_self_disturbance(coupling, c, fluid, grains);
    if (!std::holds_alternative<PureFluidViscosity>(
            make_family<SuspensionViscosity>(coupling.law("suspension_viscosity"))))
        coupling.fail("suspension_viscosity", "only \"none\" is known on a grid");
    return c;
}

FluidOnGrains fluid_on_grains(Table& coupling, const GridFluid& fluid, bool full_pressure) {
    FluidOnGrains f = fluid_on_grains(coupling, fluid.density, fluid.viscosity, full_pressure);
    f.at_grains.wants_gradient |= has_virtual_mass(f); // u . grad u
    return f;
}

void drive(Table& coupling, GridFluid& fluid, FluidOnGrains& on_grains, const GridCoupling& state,
           const GrainSystem& grains) {
    on_grains.mean_gradient = read_mean_gradient(coupling, on_grains, state.two_way,
                                                 [&] { return balancing_gradient(fluid, state, on_grains, grains); });
    fluid.body_force -= on_grains.mean_gradient / fluid.density;
}

} // namespace plumb
