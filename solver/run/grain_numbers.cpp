#include "run/grain_numbers.hpp"

#include "core/sphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plumb {

namespace {

constexpr double noticeable = 0.01; // share of the drag or the inertia from which a model is named

Vec3 middle(const Simulation& s) { return 0.5 * s.grains.domain.size; }

bool chosen(const FluidOnGrains& fluid, std::string_view force) {
    return std::any_of(fluid.forces.begin(), fluid.forces.end(),
                       [&](const OtherForce& law) { return law_name(law) == force; });
}

/// Rate at which the flow changes as seen by a grain [1/s]: its gradient or its frequency.
double flow_rate(const FluidOnGrains& fluid) {
    if (const auto* shear = std::get_if<ShearFlow>(&fluid.flow)) return std::abs(shear->rate);
    if (const auto* parabolic = std::get_if<ParabolicFlow>(&fluid.flow))
        return 4.0 * std::abs(parabolic->peak) / (parabolic->upper - parabolic->lower); // at the walls
    if (const auto* oscillating = std::get_if<OscillatingFlow>(&fluid.flow))
        return 2.0 * std::numbers::pi * oscillating->frequency;
    return 0.0;
}

bool has_gradient(const FluidOnGrains& fluid) {
    return std::holds_alternative<ShearFlow>(fluid.flow) || std::holds_alternative<ParabolicFlow>(fluid.flow);
}
bool accelerates(const FluidOnGrains& fluid) { return std::holds_alternative<OscillatingFlow>(fluid.flow); }

GrainNumbers numbers_of(const Simulation& s, std::size_t group, double radius) {
    const FluidOnGrains& fluid = *s.fluid;
    const double g = s.grains.domain.gravity.norm(), d = 2.0 * radius;
    const double rho = s.grains.groups[group].density, volume = sphere_volume(d);
    const double eps = porosity_at(fluid.porosity, middle(s), s.grains.domain);
    GrainNumbers n;
    n.group = s.grains.groups[group].name;
    n.diameter = d;
    n.density_ratio = rho / fluid.density;
    n.tau_p = rho * d * d / (18.0 * fluid.viscosity); // m/(3 pi mu d), Stokes' drag
    const bool in_pressure = s.sph && s.sph->extras.stratified && chosen(fluid, PressureGradient::name);
    const double buoyant = chosen(fluid, Buoyancy::name) || in_pressure ? fluid.density : 0.0;
    n.terminal_velocity = terminal_slip(fluid, d, eps, std::abs(rho - buoyant) * volume * g);
    n.re = fluid.density * d * eps * n.terminal_velocity / fluid.viscosity;
    n.drag_in_range = within(drag_range(fluid.drag), n.re, eps);
    n.st_impact = n.density_ratio * n.re / 9.0; // Gondret, Lance & Petit 2002, Phys. Fluids 14, 643
    n.st_flow = n.tau_p * flow_rate(fluid);
    n.galileo = std::sqrt(std::abs(n.density_ratio - 1.0) * g * d * d * d) * fluid.density / fluid.viscosity;
    return n;
}

std::string percent(double share) { return fmt::format("{:.2g} %", 100.0 * share); }

void remark_on_lift(const FluidOnGrains& fluid, double diameter, std::vector<Remark>& remarks) {
    const double nu = fluid.viscosity / fluid.density;
    // Saffman's lift 1.615 d^2 sqrt(rho mu G) u over Stokes' drag 3 pi mu d u
    const double lift = 1.615 / (3.0 * std::numbers::pi) * diameter * std::sqrt(flow_rate(fluid) / nu);
    if (has_gradient(fluid) && lift > noticeable && !chosen(fluid, SaffmanMei::name) && !chosen(fluid, LiAhmadi::name))
        remarks.push_back({"saffman_mei", fmt::format("Saffman's lift reaches {} of the drag", percent(lift))});
}

/// Contact laws of any pair that has a parameter for which `test` holds.
template <class Pairs, class Test> bool any_law(const Pairs& pairs, Test&& test) {
    return std::visit([&](const auto& table) { return std::any_of(table.laws.begin(), table.laws.end(), test); },
                      pairs);
}

void remark_on_idle_forces(const FluidOnGrains& fluid, const Domain& domain, std::vector<Remark>& remarks) {
    for (const OtherForce& law : fluid.forces) {
        const std::string name = law_name(law);
        if (name == Buoyancy::name && domain.gravity.norm() == 0.0) remarks.push_back({name, "there is no gravity"});
        if (name == PressureGradient::name && !accelerates(fluid) && !fluid.gathers)
            remarks.push_back({name, "the prescribed flow does not accelerate: Du/Dt = 0"});
        if ((name == SaffmanMei::name || name == LiAhmadi::name) && !has_gradient(fluid) && !fluid.gathers)
            remarks.push_back({name, "the prescribed flow has no gradient"});
    }
    if (law_name(fluid.drag) == "none") remarks.push_back({"exchange", "there is no drag to exchange"});
}

void remark_on_idle_contacts(const GrainSystem& system, std::vector<Remark>& remarks) {
    const bool rolls = !std::holds_alternative<PairLaws<NoRolling>>(system.contact.rolling);
    const bool turns = std::any_of(system.groups.begin(), system.groups.end(),
                                   [](const GrainGroup& g) { return g.rotation && g.motion == Motion::free; });
    const bool rubs = any_law(system.contact.contact, [](const auto& law) { return law.parameters.friction > 0.0; });
    if (rolls && !turns) remarks.push_back({"rolling", "no group of grains can rotate"});
    if (rolls && turns && !rubs) remarks.push_back({"rolling", "without friction no contact makes a grain turn"});
    if (contactless(system.contact) && !system.walls.empty())
        remarks.push_back({"wall", "the contact law is \"none\": grains pass through walls"});
    if (!contactless(system.contact) && system.grains.size() == 1 && system.walls.empty() && system.injectors.empty())
        remarks.push_back({"contact", "a single grain without walls touches nothing"});
}

} // namespace

double terminal_slip(const FluidOnGrains& fluid, double diameter, double eps, double weight) {
    if (!(weight > 0.0)) return 0.0;
    const auto drag = [&](double slip) {
        return slip * drag_resistance(fluid.drag, fluid.density, fluid.viscosity, diameter, eps, slip);
    };
    // Bisection on the logarithm between bounds found by doubling; drag rises with slip.
    double high = weight / (3.0 * std::numbers::pi * fluid.viscosity * diameter);
    for (int k = 0; k < 200 && drag(high) < weight; ++k) high *= 2.0;
    if (drag(high) < weight) return std::numeric_limits<double>::infinity();
    double low = high;
    for (int k = 0; k < 200 && drag(low) > weight; ++k) low *= 0.5;
    for (int k = 0; k < 100; ++k) {
        const double slip = std::sqrt(low * high);
        (drag(slip) < weight ? low : high) = slip;
    }
    return high;
}

std::vector<GrainNumbers> grain_numbers(const Simulation& simulation) {
    std::vector<GrainNumbers> all;
    if (!simulation.fluid) return all;
    const Grains& g = simulation.grains.grains;
    for (std::size_t group = 0; group < simulation.grains.groups.size(); ++group) {
        double least = std::numeric_limits<double>::infinity(), largest = 0.0;
        for (std::size_t k = 0; k < g.size(); ++k)
            if (static_cast<std::size_t>(g.group[k]) == group) {
                least = std::min(least, g.radius[k]);
                largest = std::max(largest, g.radius[k]);
            }
        if (largest == 0.0) continue; // grains of an injector only
        all.push_back(numbers_of(simulation, group, least));
        if (largest > least) all.push_back(numbers_of(simulation, group, largest));
    }
    return all;
}

std::vector<Remark> missing_models(const Simulation& simulation) {
    std::vector<Remark> remarks;
    if (!simulation.fluid) return remarks;
    const FluidOnGrains& fluid = *simulation.fluid;
    double ratio = std::numeric_limits<double>::infinity(), diameter = 0.0; // of the lightest, of the largest grain
    for (const GrainNumbers& n : grain_numbers(simulation)) {
        ratio = std::min(ratio, n.density_ratio);
        diameter = std::max(diameter, n.diameter);
        if (!n.drag_in_range)
            remarks.push_back({"drag", fmt::format("{} is outside the range of its source at Re = {:.3g} (group {})",
                                                   law_name(fluid.drag), n.re, n.group)});
    }
    if (!std::isfinite(ratio)) return remarks;
    const bool moves = simulation.grains.domain.gravity.norm() > 0.0 || flow_rate(fluid) > 0.0;
    const bool in_gradient =
        simulation.sph && simulation.sph->extras.stratified && chosen(fluid, PressureGradient::name);
    if (simulation.grains.domain.gravity.norm() > 0.0 && 1.0 / ratio > noticeable && !in_gradient &&
        !chosen(fluid, Buoyancy::name))
        remarks.push_back({"buoyancy", fmt::format("it carries {} of the weight", percent(1.0 / ratio))});
    if (accelerates(fluid) && 1.0 / ratio > noticeable && !chosen(fluid, PressureGradient::name))
        remarks.push_back({"pressure_gradient", fmt::format("fluid / grain density is {:.3g}", 1.0 / ratio)});
    if (moves && 0.5 / ratio > noticeable && !chosen(fluid, VirtualMass::name))
        remarks.push_back({"virtual_mass", fmt::format("it adds {} to the inertia", percent(0.5 / ratio))});
    // K u/sqrt(tau_p) over 3 pi mu d u with K = (3/2) d^2 sqrt(pi rho mu): 1.197 sqrt(fluid / grain density)
    const double basset = 0.5 * std::sqrt(18.0 / std::numbers::pi / ratio);
    if (moves && basset > noticeable && !fluid.history)
        remarks.push_back(
            {"basset", fmt::format("after one tau_p the history force is about {} of the drag", percent(basset))});
    remark_on_lift(fluid, diameter, remarks);
    return remarks;
}

std::vector<Remark> idle_models(const Simulation& simulation) {
    std::vector<Remark> remarks;
    if (simulation.fluid) remark_on_idle_forces(*simulation.fluid, simulation.grains.domain, remarks);
    if (!simulation.fluid_alone()) remark_on_idle_contacts(simulation.grains, remarks);
    return remarks;
}

} // namespace plumb
