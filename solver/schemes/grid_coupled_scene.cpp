#include "schemes/grid_coupled_scene.hpp"

#include "coupling/self_disturbance.hpp"
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
    if (!std::holds_alternative<NoSelfDisturbance>(make_family<SelfDisturbanceLaw>(coupling.law("self_disturbance"))))
        coupling.fail("self_disturbance", "only \"none\" is known on a grid");
    if (!std::holds_alternative<PureFluidViscosity>(
            make_family<SuspensionViscosity>(coupling.law("suspension_viscosity"))))
        coupling.fail("suspension_viscosity", "only \"none\" is known on a grid");
    return c;
}

FluidOnGrains fluid_on_grains(Table& coupling, const GridFluid& fluid, bool full_pressure) {
    return fluid_on_grains(coupling, fluid.density, fluid.viscosity, full_pressure);
}

void drive(Table& coupling, GridFluid& fluid, FluidOnGrains& on_grains, const GridCoupling& state,
           const GrainSystem& grains) {
    on_grains.mean_gradient = read_mean_gradient(coupling, on_grains, state.two_way,
                                                 [&] { return balancing_gradient(fluid, state, on_grains, grains); });
    fluid.body_force -= on_grains.mean_gradient / fluid.density;
}

} // namespace plumb
