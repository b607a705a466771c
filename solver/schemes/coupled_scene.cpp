#include "schemes/coupled_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

namespace {

double largest_diameter(const GrainSystem& system) {
    double d = 0.0;
    for (const double r : system.grains.radius) d = std::max(d, 2.0 * r);
    return d;
}

/// A smoothing length [m], or {times_diameter = x} of the largest grain, or {times_smoothing = x} of the fluid's.
double read_width(Table& coupling, const std::string& key, const SphFluid& fluid, double diameter) {
    if (coupling.type(key) != toml::node_type::table) return coupling.number(key, positive);
    Table relative = coupling.table(key);
    return relative.has("times_diameter") ? relative.number("times_diameter", positive) * diameter
                                          : relative.number("times_smoothing", positive) * fluid.h;
}

} // namespace

Coupling read_coupling(Table& coupling, const SphFluid& fluid, const GrainSystem& grains) {
    if (!fluid.open_sides.empty()) coupling.fail("direction", "grains know no open sides yet");
    if (std::holds_alternative<CorrectedOperators>(fluid.operators))
        coupling.fail("direction", "grains need fluid.operators = \"plain\" or \"variable_h\"");
    if (!grains.injectors.empty()) coupling.fail("direction", "injected grains know no smoothed particles yet");
    Coupling c;
    c.two_way = coupling.choice("direction", {"two_way", "one_way"}) == "two_way";
    c.weights.kernel = make_family<Kernel>(coupling.law("kernel"));
    const double d = largest_diameter(grains), spread = read_width(coupling, "kernel_width", fluid, d);
    const auto other = [&](const char* key) {
        return coupling.has(key) ? read_width(coupling, key, fluid, d) : spread;
    };
    c.weights.h = {spread, other("gather_width"), other("porosity_width")};
    const double narrowest = std::min({c.weights.h.spread, c.weights.h.gather, c.weights.h.porosity});
    const double reach = support(c.weights.kernel) * narrowest;
    if (reach < fluid.spacing)
        coupling.fail("kernel_width",
                      fmt::format("the kernel reaches {:.4g} m, less than the fluid's spacing of {:.4g} m: a grain may "
                                  "meet no particle",
                                  reach, fluid.spacing));
    if (reach < 0.5 * d)
        coupling.fail(
            "kernel_width",
            fmt::format("the kernel reaches {:.4g} m, less than the radius of a grain of {:.4g} m", reach, d));
    check_periodic_sides(fluid.domain, support(c.weights.kernel) * c.weights.h.greatest() + fluid.clusters.skin,
                         coupling.file());
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

FluidOnGrains fluid_on_grains(Table& coupling, const SphFluid& fluid, const GrainSystem& /*grains*/) {
    FluidOnGrains f;
    f.density = fluid.density;
    f.viscosity = fluid.viscosity;
    f.gathers = true;
    if (f.viscosity == 0.0) coupling.fail("drag", "the fluid has no viscosity");
    read_coupling_laws(coupling, f);
    if (f.history) coupling.fail("forces", "\"basset\" needs a given flow");
    for (const OtherForce& law : f.forces) {
        const std::string name = law_name(law);
        if (name == "saffman_mei" || name == "li_ahmadi")
            coupling.fail("forces", fmt::format("\"{}\" needs the gradient of a given flow", name));
        if (name == "buoyancy" && fluid.extras.stratified)
            coupling.fail("forces", "\"buoyancy\" is in the gradient of a \"full\" pressure already");
    }
    return f;
}

void drive(Table& coupling, SphFluid& fluid, FluidOnGrains& on_grains, const Coupling& state,
           const GrainSystem& grains) {
    if (!coupling.has("mean_pressure_gradient")) return;
    const auto pushes = [](const OtherForce& law) { return std::holds_alternative<PressureGradient>(law); };
    if (std::none_of(on_grains.forces.begin(), on_grains.forces.end(), pushes))
        coupling.fail("mean_pressure_gradient", "needs \"pressure_gradient\" among the forces");
    if (coupling.type("mean_pressure_gradient") == toml::node_type::string) {
        coupling.choice("mean_pressure_gradient", {"balances_weight"});
        // All weight, over the volume of what feels the gradient.
        double volume = 0.0;
        Vec3 weight = Vec3::Zero();
        for (std::size_t k = 0; k < fluid.slots(); ++k) {
            if (fluid.id[k] < 0) continue;
            const double mass = fluid.mass * fluid.share[k];
            volume += mass / fluid.density;
            weight += mass * fluid.body_force;
        }
        for (std::size_t id = 0; id < state.mass.size(); ++id) {
            volume += state.places.volume[id];
            weight += state.mass[id] * grains.domain.gravity;
            for (const OtherForce& law : on_grains.forces)
                if (std::holds_alternative<Buoyancy>(law))
                    weight -= fluid.density * state.places.volume[id] * grains.domain.gravity;
        }
        on_grains.mean_gradient = weight / volume;
    } else {
        on_grains.mean_gradient = coupling.components("mean_pressure_gradient", 3);
    }
    fluid.body_force -= on_grains.mean_gradient / fluid.density;
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
