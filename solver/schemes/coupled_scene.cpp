#include "schemes/coupled_scene.hpp"

#include "coupling/wetting_laws.hpp"
#include "schemes/sph_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace plumb {

namespace {

/// A law that differs from grain to grain keeps a table for every size.
void check_number_of_sizes(const Table& coupling, const GrainSystem& system) {
    constexpr std::size_t most = 256; // 4 MB of tables, some seconds to make them
    const std::set<double> sizes(system.grains.radius.begin(), system.grains.radius.end());
    if (sizes.size() > most)
        coupling.fail("porosity",
                      fmt::format("makes a table for every diameter: {} are too many, at most {}", sizes.size(), most));
}

/// A smoothing length [m], or {times_diameter = x} of the largest grain, or {times_smoothing = x} of the fluid's.
double read_width(Table& coupling, const std::string& key, const SphFluid& fluid, double diameter) {
    if (coupling.type(key) != toml::node_type::table) return coupling.number(key, positive);
    Table relative = coupling.table(key);
    return relative.has("times_diameter") ? relative.number("times_diameter", positive) * diameter
                                          : relative.number("times_smoothing", positive) * fluid.h;
}

/// The correction, or `none`.
void read_self_disturbance(Table& coupling, Coupling& c, const SphFluid& fluid, const GrainSystem& grains) {
    const char* const key = "self_disturbance";
    const auto law = make_family<SelfDisturbanceLaw>(coupling.law(key));
    const auto* theory = std::get_if<OseenBrinkman>(&law);
    if (theory == nullptr) return;
    if (!c.two_way) coupling.fail(key, "grains that do not push the fluid have no wake to take out");
    if (std::holds_alternative<Inviscid>(fluid.viscous_term))
        coupling.fail(key, "the theory needs a viscous term in the fluid");
    const std::vector<double>& r = grains.grains.radius;
    if (!c.weights.own_volume)
        coupling.fail("own_volume", "\"excluded\" does what self_disturbance does with a grain's own volume");
    const bool of_size = !std::holds_alternative<LoneGrain>(theory->structure) || by_diameter(c.weights.porosity);
    if (of_size && std::any_of(r.begin(), r.end(), [&](double one) { return one != r.front(); }))
        coupling.fail(key, "a structure factor and the porosity \"overlap\" are those of equal grains");
    c.self =
        self_disturbance(*theory, fluid, c.weights.kernel, c.weights.h, c.weights.porosity, c.weights.largest_diameter);
    c.self->memory.assign(r.size() * wake_size(), 0.0);
}

/// Whether walls mirror the grains' room. Without the key they do not: a kernel that reaches behind a wall leaves some
/// of it there.
void read_walls(Table& coupling, Coupling& c, const GrainSystem& grains) {
    const char* const key = "at_walls";
    c.places.mirrored.wanted = coupling.has(key) && coupling.choice(key, {"mirrored", "cut"}) == "mirrored";
    if (!c.places.mirrored.wanted) return;
    for (const WallBody& wall : grains.walls)
        if (!has_mirror(wall.shape) || wall.velocity.norm() > 0.0)
            coupling.fail(key, fmt::format("\"mirrored\" knows planes, boxes, cylinders and spheres at rest, and wall "
                                           "\"{}\" is none of them",
                                           wall.name));
}

/// A round wall that holds grains inside mirrors them beyond itself, as far as its middle.
void check_mirrors(Table& coupling, const Coupling& c, const GrainSystem& grains) {
    if (!c.places.mirrored.wanted) return;
    const double reach = porosity_reach(c.weights);
    for (const WallBody& wall : grains.walls)
        std::visit(
            [&](const auto& shape) {
                using Shape = std::decay_t<decltype(shape)>;
                if constexpr (std::is_same_v<Shape, Cylinder> || std::is_same_v<Shape, SphereWall>)
                    if (shape.sign < 0.0 && shape.radius <= reach)
                        coupling.fail("at_walls",
                                      fmt::format("\"mirrored\": wall \"{}\" of radius {:.4g} m is narrower than the "
                                                  "kernel's reach of {:.4g} m",
                                                  wall.name, shape.radius, reach));
            },
            wall.shape);
}

/// How the pressure acts on grains. Without the key they gather its gradient and hand their part on.
void read_pressure_force(Table& coupling, const Coupling& c, const GrainSystem& grains, SphFluid& fluid) {
    const char* const key = "pressure_force";
    fluid.shares_pressure = coupling.has(key) && coupling.choice(key, {"shared", "gathered"}) == "shared";
    if (!fluid.shares_pressure && fluid.background_pressure > 0.0)
        coupling.fail(key, "grains would feel fluid.background_pressure; it goes with \"shared\"");
    if (!fluid.shares_pressure) return;
    if (!std::holds_alternative<KernelPorosity>(c.weights.porosity))
        coupling.fail(key, "\"shared\" needs porosity = \"kernel\"");
    if (!grains.walls.empty() && !c.places.mirrored.wanted)
        coupling.fail(key, "\"shared\" needs at_walls = \"mirrored\" beside walls: where the grains' room is cut, a "
                           "constant pressure would push them to the wall");
    if (c.self) coupling.fail(key, "\"shared\" and self_disturbance: the wake's pressure is not known to its theory");
    const std::vector<std::string> forces = coupling.texts("forces");
    if (std::find(forces.begin(), forces.end(), "pressure_gradient") == forces.end())
        coupling.fail(key, "\"shared\" needs \"pressure_gradient\" among the forces: the fluid has only its own part");
}

/// Capillarity of the bed's surface; without the key there is none.
void read_wetting(Table& coupling, const GrainSystem& grains, SphFluid& fluid) {
    const char* const key = "wetting";
    if (!coupling.has(key)) return;
    const auto law = make_family<WettingLaw>(coupling.law(key));
    if (std::holds_alternative<NoWetting>(law)) return;
    if (!fluid.shares_pressure) coupling.fail(key, "goes with pressure_force = \"shared\", whose energy it adds to");
    if (!fluid.free_surface) coupling.fail(key, "without fluid.free_surface = true there is none that could move");
    const std::vector<double>& r = grains.grains.radius;
    if (std::any_of(r.begin(), r.end(), [&](double one) { return one != r.front(); }))
        coupling.fail(key, "is that of grains of one diameter");
    fluid.wetting_pressure = std::visit([&](const auto& one) { return one(2.0 * r.front()); }, law);
}

/// The closure for the fluid's viscosity among the grains, or `none`.
void read_suspension_viscosity(Table& coupling, Coupling& c, const SphFluid& fluid) {
    const char* const key = "suspension_viscosity";
    c.viscosity = make_family<SuspensionViscosity>(coupling.law(key));
    if (!std::holds_alternative<PureFluidViscosity>(c.viscosity) && !std::holds_alternative<Morris>(fluid.viscous_term))
        coupling.fail(key, "needs fluid.viscous_term = \"morris\"");
}

/// All weight, less what carries it from outside, over the volume of what feels the gradient [Pa/m].
Vec3 balancing_gradient(const SphFluid& fluid, const FluidOnGrains& on_grains, const GrainSystem& system) {
    // Sums of many alike: rounded as doubles, they would leave a drift of 1e-12 of the weight with 30 000 grains.
    long double volume = 0.0L;
    Eigen::Matrix<long double, 3, 1> weight = Eigen::Matrix<long double, 3, 1>::Zero();
    for (std::size_t k = 0; k < fluid.slots(); ++k) {
        if (fluid.id[k] < 0) continue;
        const double mass = fluid.mass * fluid.share[k];
        volume += mass / fluid.density;
        weight += (mass * fluid.body_force).cast<long double>();
    }
    const Grains& g = system.grains;
    for (const std::int32_t place : positions_of_ids(g)) {
        const auto k = static_cast<std::size_t>(place);
        const double d = 2.0 * g.radius[k];
        volume += sphere_volume(d);
        weight += (g.mass[k] * system.domain.gravity).cast<long double>();
        weight += force_from_outside(on_grains, d, system.domain.gravity).cast<long double>();
    }
    return (weight / volume).cast<double>();
}

} // namespace

double largest_diameter(const GrainSystem& system) {
    double d = 0.0;
    for (const double r : system.grains.radius) d = std::max(d, 2.0 * r);
    for (const Injector& injector : system.injectors) {
        for (const double one : injector.point_diameter) d = std::max(d, one);
        if (injector.point_diameter.empty())
            d = std::max(d, std::visit([](const auto& law) { return law.largest(); }, injector.diameter));
    }
    return d;
}

Coupling read_coupling(Table& coupling, SphFluid& fluid, const GrainSystem& grains) {
    if (std::holds_alternative<CorrectedOperators>(fluid.operators))
        coupling.fail("direction", "grains do not go with fluid.operators = \"corrected\"");
    if (std::holds_alternative<VariableOperators>(fluid.operators) &&
        (fluid.extras.diffusion > 0.0 || fluid.shifting > 0.0))
        coupling.fail("direction",
                      "among grains fluid.density_diffusion and shifting do not go with operators = \"variable_h\"");
    if (!grains.injectors.empty()) coupling.fail("direction", "injected grains know no smoothed particles yet");
    Coupling c;
    c.two_way = coupling.choice("direction", {"two_way", "one_way"}) == "two_way";
    c.weights.kernel = make_family<Kernel>(coupling.law("kernel"));
    c.weights.porosity = make_family<PorosityLaw>(coupling.law("porosity"));
    read_walls(coupling, c, grains);
    c.weights.own_volume = coupling.choice("own_volume", {"included", "excluded"}) == "included";
    if (by_diameter(c.weights.porosity)) check_number_of_sizes(coupling, grains);
    c.weights.largest_diameter = largest_diameter(grains);
    const double d = c.weights.largest_diameter, spread = read_width(coupling, "kernel_width", fluid, d);
    const auto other = [&](const char* key) {
        return coupling.has(key) ? read_width(coupling, key, fluid, d) : spread;
    };
    c.weights.h = {spread, other("gather_width"), other("porosity_width")};
    const double narrowest = std::min({c.weights.h.spread, c.weights.h.gather, c.weights.h.porosity});
    const double least = support(c.weights.kernel) * narrowest;
    if (least < fluid.spacing)
        coupling.fail("kernel_width",
                      fmt::format("the kernel reaches {:.4g} m, less than the fluid's spacing of {:.4g} m: a grain may "
                                  "meet no particle",
                                  least, fluid.spacing));
    if (least < 0.5 * d)
        coupling.fail(
            "kernel_width",
            fmt::format("the kernel reaches {:.4g} m, less than the radius of a grain of {:.4g} m", least, d));
    if (c.places.mirrored.wanted)
        prepare_mirrors(c.places.mirrored, grains.walls, {c.weights.kernel, c.weights.h.porosity});
    check_mirrors(coupling, c, grains);
    read_self_disturbance(coupling, c, fluid, grains);
    read_pressure_force(coupling, c, grains, fluid);
    read_wetting(coupling, grains, fluid);
    read_suspension_viscosity(coupling, c, fluid);
    check_periodic_sides(fluid.domain, reach(c.weights) + fluid.clusters.skin, coupling.file());
    return c;
}

void check_growth(const Table& coupling, const SphFluid& fluid) {
    if (!std::holds_alternative<VariableOperators>(fluid.operators)) return;
    double least = 1.0;
    for (std::size_t k = 0; k < fluid.slots(); ++k) least = std::min(least, fluid.eps[k]);
    const double needed = std::cbrt(1.0 / least), allowed = greatest_growth(fluid.operators);
    if (needed > allowed)
        coupling.fail("porosity_width",
                      fmt::format("the fluid among the grains, eps = {:.4g} at least, may take room for smoothing "
                                  "lengths of {:.4g} h; say operators = {{law = \"variable_h\", greatest_growth = "
                                  "{:.3g}}} in [fluid] (it is {:.4g})",
                                  least, needed, std::ceil(105.0 * needed) / 100.0, allowed));
}

FluidOnGrains fluid_on_grains(Table& coupling, double density, double viscosity, bool full_pressure) {
    FluidOnGrains f;
    f.density = density;
    f.viscosity = viscosity;
    f.gathers = true;
    if (f.viscosity == 0.0) coupling.fail("drag", "the fluid has no viscosity");
    read_coupling_laws(coupling, f);
    if (f.history) coupling.fail("forces", "\"basset\" needs a given flow");
    for (const OtherForce& law : f.forces) {
        f.at_grains.wants_gradient |= needs_gradient(law);
        if (std::holds_alternative<Buoyancy>(law) && full_pressure)
            coupling.fail("forces", "\"buoyancy\" is in the gradient of a \"full\" pressure already");
    }
    return f;
}

Vec3 read_mean_gradient(Table& coupling, const FluidOnGrains& on_grains, bool two_way,
                        const std::function<Vec3()>& balancing) {
    if (!coupling.has("mean_pressure_gradient")) return Vec3::Zero();
    const auto pushes = [](const OtherForce& law) { return std::holds_alternative<PressureGradient>(law); };
    if (std::none_of(on_grains.forces.begin(), on_grains.forces.end(), pushes))
        coupling.fail("mean_pressure_gradient", "needs \"pressure_gradient\" among the forces");
    if (coupling.type("mean_pressure_gradient") == toml::node_type::string) {
        coupling.choice("mean_pressure_gradient", {"balances_weight"});
        if (!two_way)
            coupling.fail(
                "mean_pressure_gradient",
                "nothing hands the grains' weight to a fluid that does not feel them (direction = \"one_way\"): "
                "give a vector [Pa/m], or leave it out");
        return balancing();
    }
    return coupling.components("mean_pressure_gradient", 3);
}

FluidOnGrains fluid_on_grains(Table& coupling, const SphFluid& fluid) {
    return fluid_on_grains(coupling, fluid.density, fluid.viscosity, fluid.extras.stratified);
}

void drive(Table& coupling, SphFluid& fluid, FluidOnGrains& on_grains, const Coupling& state,
           const GrainSystem& grains) {
    if (has_virtual_mass(on_grains) && fluid.body_force.norm() > 0.0)
        coupling.fail("forces", "\"virtual_mass\" takes the stress for the fluid's acceleration among smoothed "
                                "particles, which weight and body forces are not in: leave it out");
    on_grains.mean_gradient = read_mean_gradient(coupling, on_grains, state.two_way,
                                                 [&] { return balancing_gradient(fluid, on_grains, grains); });
    fluid.body_force -= on_grains.mean_gradient / fluid.density;
}

std::vector<StepLimit> coupled_limits(const SphFluid& fluid, const Coupling& coupling) {
    std::vector<StepLimit> limits = fluid_limits(fluid);
    // a particle of less mass than its neighbours' volumes say is slowed down faster
    double least = 1.0;
    for (std::size_t k = 0; k < fluid.slots(); ++k)
        if (fluid.id[k] >= 0) least = std::min(least, fluid.share[k]);
    const double ratio = std::visit([](const auto& law) { return law.greatest(); }, coupling.viscosity) / least;
    for (StepLimit& limit : limits)
        if (limit.name == "viscous") limit.seconds /= ratio;
    return limits;
}

std::int64_t grain_steps(Table& time, double dt, const std::vector<StepLimit>& limits) {
    double longest = dt;
    if (time.type("grain_step") == toml::node_type::string) {
        time.choice("grain_step", {"auto"});
        for (const StepLimit& limit : limits) longest = std::min(longest, limit.seconds);
    } else {
        longest = time.number("grain_step", positive);
    }
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(dt / longest * (1.0 - 1e-12))));
}

} // namespace plumb
