#include "schemes/advance_coupled.hpp"

#include "core/parallel.hpp"
#include "coupling/own_density.hpp"
#include "coupling/room_pressure.hpp"
#include "schemes/advance_fluid.hpp"

namespace plumb {

namespace {

/// Where the grains will be `ahead` [s] from now, with their present velocities.
void set_places(Coupling& c, const GrainSystem& system, double ahead) {
    const Grains& g = system.grains;
    c.places.x.resize(g.size());
    c.places.volume.resize(g.size());
    c.mass.resize(g.size());
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        c.places.x[id] = g.x[k] + ahead * g.v[k];
        c.places.volume[id] = sphere_volume(2.0 * g.radius[k]);
        c.mass[id] = g.mass[k];
    });
}

/// Lists that hold for the places, and the porosity there.
void find_porosity(Coupling& c, SphFluid& fluid, const GrainSystem& system, bool new_lists) {
    if (new_lists || outdated(c.weights, fluid.domain, c.places)) {
        choose_mirrors(c, fluid, system);
        renew_weights(c.weights, fluid, c.places);
    } else {
        place_mirrors(c.places.mirrored, system.walls, c.places.x, c.places.volume);
    }
    place_grains(c.weights, fluid.domain, c.places);
    c.clamped += set_porosity(fluid, c.weights);
}

/// What the fluid has received from every grain per second over the step, by id: the reaction of what the grain
/// received, without what came from the outside, buoyancy in a hydrostatic pressure that the scene leaves out and a
/// mean gradient, and without the pressure's force where the fluid has its part of that already [N].
std::vector<Vec3> force_on_fluid(const Coupling& c, const FluidOnGrains& f, const GrainSystem& system,
                                 bool stress_is_returned, double dt) {
    const Grains& g = system.grains;
    std::vector<Vec3> force(g.size());
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        const bool alone =
            g.mobility[k] > 0.0 && system.groups[static_cast<std::size_t>(g.group[k])].motion == Motion::free;
        if (f.at_grains.dry[id] != 0) {
            force[id].setZero();
            return;
        }
        force[id] = force_from_outside(f, 2.0 * g.radius[k], system.domain.gravity) -
                    (alone ? Vec3(f.forcing.impulse[k] / dt) : f.last_fluid_force[id]);
        if (stress_is_returned) force[id] += c.places.volume[id] * f.at_grains.stress[id];
    });
    return force;
}

/// Before the grains' step: their own disturbance out of what they have gathered.
void take_out_own(Coupling& c, const GrainSystem& system, GatheredFluid& at_grains) {
    if (!c.self) return;
    take_out(*c.self, c.mass, c.places.volume, at_grains);
    c.velocity.resize(system.grains.size());
    parallel_for(system.grains.size(), [&](std::size_t k) {
        c.velocity[static_cast<std::size_t>(system.grains.id[k])] = system.grains.v[k];
    });
}

/// After it: the push of every grain, with its slip at the middle of the step, goes into its wake.
void remember_own(Coupling& c, const FluidOnGrains& f, const GrainSystem& system, const std::vector<Vec3>& force,
                  double dt) {
    if (!c.self) return;
    const Grains& g = system.grains;
    std::vector<Push> pushes(g.size());
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        const GatheredFluid& at = f.at_grains;
        Push& push = pushes[id];
        // A mean gradient drives less fluid where the grain is: that part of its weight is a push, too.
        push.force = force[id] + c.places.volume[id] * f.mean_gradient;
        push.slip = at.u[id] + (0.5 * dt) * at.a[id] - 0.5 * (c.velocity[id] + g.v[k]);
        // Grains that settle hand on their weight whatever the fluid does; only held ones resist a wake.
        if (c.self->fraction > 0.0 && g.mobility[k] == 0.0)
            push.screening =
                c.self->fraction / (c.places.volume[id] * f.density) *
                drag_resistance(f.drag, f.density, f.viscosity, 2.0 * g.radius[k], at.eps[id], push.slip.norm());
    });
    remember(*c.self, pushes, dt);
}

} // namespace

void choose_mirrors(Coupling& c, const SphFluid& fluid, const GrainSystem& system) {
    choose_mirrors(c.places.mirrored, system.walls, c.places.x, c.places.volume,
                   porosity_reach(c.weights) + fluid.clusters.skin);
}

void couple(Coupling& c, SphFluid& fluid, const GrainSystem& grains, bool displaced) {
    fluid.has_grains = true;
    fluid.share.assign(fluid.slots(), 1.0);
    fluid.clusters.images = reach(c.weights);
    renew_lists(fluid);
    set_places(c, grains, 0.0);
    find_porosity(c, fluid, grains, true);
    if (!displaced) return;
    fluid.share = fluid.eps;
    fluid.boundary.share = fluid.boundary.eps;
}

void advance_coupled(Coupling& c, SphFluid& fluid, FluidOnGrains& at_grains, GrainSystem& grains, double dt,
                     std::int64_t step) {
    const bool new_lists = go_to_middle(fluid, dt, step);
    set_places(c, grains, 0.5 * dt);
    find_porosity(c, fluid, grains, new_lists);
    evaluate_middle(fluid, dt, step);
    even_out_own_density(fluid, c.weights);
    c.at_greatest += add_suspension_viscosity(fluid, c.weights, c.viscosity);
    if (fluid.shares_pressure) add_room_pressure(fluid, c.weights);
    c.clamped += gather(c.weights, fluid, c.mass, c.two_way, at_grains.at_grains);
    if (fluid.shares_pressure)
        gather_room_pressure(c.weights, fluid, c.places.mirrored, grains.walls, c.places.x, at_grains.at_grains.stress);
    take_out_own(c, grains, at_grains.at_grains);

    advance_gathered(at_grains, grains, dt, step, c.grain_steps);

    if (c.two_way) {
        const std::vector<Vec3> force = force_on_fluid(c, at_grains, grains, fluid.shares_pressure, dt);
        spread(fluid, c.weights, force);
        remember_own(c, at_grains, grains, force, dt);
    }
    go_to_end(fluid, dt, step);
}

} // namespace plumb
