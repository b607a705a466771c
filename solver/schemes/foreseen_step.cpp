#include "schemes/foreseen_step.hpp"

namespace plumb {

namespace {

constexpr double held = 1e-6; // a freedom below which a grain is taken as held fast: mobility and rate would underflow

/// The fluid at a grain as if it were to stand still from now on, without stress.
LocalFluid without_change(const FluidOnGrains& f, std::size_t id) {
    LocalFluid local = gathered_fluid(f, id);
    local.stress = -f.mean_gradient;
    local.acceleration.setZero();
    return local;
}

} // namespace

Vec3 force_without_reaction(const FluidOnGrains& f, const LocalFluid& local, double d, const Vec3& gravity) {
    Vec3 force = Vec3::Zero();
    for (const OtherForce& law : f.forces)
        if (std::holds_alternative<PressureGradient>(law) || std::holds_alternative<Buoyancy>(law))
            force += force_on_grain(law, local, {d, Vec3::Zero()}, gravity);
    return force;
}

ForeseenStep foreseen_step(const FluidOnGrains& f, const GrainSystem& system, double freedom, std::size_t k,
                           double dt) {
    const Grains& g = system.grains;
    const auto id = static_cast<std::size_t>(g.id[k]);
    const double d = 2.0 * g.radius[k];
    const Vec3 &v = g.v[k], &gravity = system.domain.gravity;
    const LocalFluid local = without_change(f, id);
    const auto resistance = [&](double slip) {
        return drag_resistance(f.drag, f.density, f.viscosity, d, local.eps, slip);
    };
    const Vec3 slip = v - local.u;
    ForeseenStep one;
    if (std::holds_alternative<ExplicitExchange>(f.exchange)) {
        one.known = resistance(slip.norm()) * slip;
        return one;
    }
    Vec3 known = Vec3::Zero();
    for (const OtherForce& law : f.forces) known += force_on_grain(law, local, {d, v}, gravity);
    const Vec3 of_fluid = known - force_without_reaction(f, local, d, gravity);
    known += g.mass[k] * gravity;
    // B ((u' - u)/dt + g u) of the virtual mass is B/dt u' + carried
    const double added = has_virtual_mass(f) ? VirtualMass::mass(f.density, d) : 0.0;
    const Vec3 moves_on = local.gradient * local.u, carried = added * (moves_on - local.u / dt);
    const double mobility = freedom * g.mobility[k];
    if (mobility < held * g.mobility[k] || mobility == 0.0) {
        const double b = resistance(slip.norm());
        one.rate = b + added / dt;
        one.known = b * v - carried - of_fluid;
        return one;
    }
    const double volume = feels_stress(f) ? sphere_volume(d) : 0.0; // on which the stress acts
    const Vec3 acceleration =
        mobility * (known + volume * f.at_grains.stress[id] + added * moves_on); // nothing changes
    std::visit(
        [&](const auto& exchange) {
            const double rate = mid_step_rate(
                exchange, [&](double speed) { return mobility * resistance(speed); }, slip, acceleration, dt);
            const StepWeights w = exchange(rate * dt);
            const double b = rate / mobility, share = w.phi1 * (1.0 - mobility * added);
            one.rate = share * (b + added / dt);
            one.known = share * (b * v - carried) + (1.0 - share) * known - of_fluid;
            one.hands_on = (1.0 - share) * volume;
            one.follows = 1.0 - w.phi1 + w.phi2 * mobility * added;
            one.yields = dt * w.phi2 * mobility * volume;
            one.drift = dt * w.phi2 * mobility * (known + added * moves_on) - (1.0 - w.phi1) * slip;
        },
        f.exchange);
    return one;
}

} // namespace plumb
