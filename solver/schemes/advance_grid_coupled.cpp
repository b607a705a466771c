#include "schemes/advance_grid_coupled.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "schemes/advance_grid.hpp"
#include "schemes/foreseen_step.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// Where the grains will be `ahead` [s] from now, with their present velocities, or where this ends in a wall, a half,
/// a quarter or nothing of the way towards it; their columns of P. Grains that are new have no debts and are free.
void set_places(GridCoupling& c, const GridFluid& fluid, const GrainSystem& system, double ahead) {
    const Grains& g = system.grains;
    c.places.x.resize(g.size());
    c.places.volume.resize(g.size());
    c.reached.assign(g.size(), 1.0);
    c.owed.resize(g.size(), Vec3::Zero());
    c.freedom.resize(g.size(), 1.0);
    if (c.self) {
        c.self->memory.resize(g.size() * wake_size(), 0.0);
        c.self->before.resize(g.size() * waves_before_size(), 0.0);
    }
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        c.places.x[id] = g.x[k] + ahead * g.v[k];
        for (const double share : {0.5, 0.25, 0.0})
            if (ahead > 0.0 && !is_open(fluid, c.places.x[id])) {
                c.places.x[id] = g.x[k] + (share * ahead) * g.v[k];
                c.reached[id] = share;
            }
        c.places.volume[id] = sphere_volume(2.0 * g.radius[k]);
    });
    set_weights(c.weights, fluid, c.places.x);
    BoundedPorosity found = porosity(fluid, c.weights, c.places.volume, c.least_porosity);
    c.bounded += found.bounded;
    c.eps = std::move(found.eps);
    c.relief = std::move(found.relief);
}

bool is_dry(const GridCoupling& c, std::size_t id) {
    const GridWeights& w = c.weights;
    if (w.cells.empty(id)) return true;
    for (const SparseColumns& faces : w.faces)
        if (faces.begin.size() > 1 && !faces.empty(id)) return false;
    return true;
}

/// Fluid fraction at a grain, with its own part in it or without.
double gathered_porosity(const GridCoupling& c, std::size_t id) {
    const GridWeights& w = c.weights;
    double eps = w.cells.gathered(id, 0.0, [&](std::size_t k) { return c.eps[k]; });
    if (!c.own_volume)
        w.cells.spread(
            id, [&](std::size_t k, double weight) { eps += c.places.volume[id] * weight * weight / w.cell_volume[k]; });
    return std::min(eps, 1.0);
}

/// The fluid as it is now at all grains.
void gather(const GridCoupling& c, const GridFluid& fluid, GatheredFluid& at, bool with_stress) {
    const std::size_t n = c.places.size();
    at.u.resize(n);
    at.a.assign(n, Vec3::Zero());
    at.stress.assign(n, Vec3::Zero());
    at.eps.assign(n, 1.0);
    at.dry.assign(n, 0);
    at.load.assign(n, 0.0);
    at.along.clear(); // of the last step
    if (at.wants_gradient) at.gradient.assign(n, Eigen::Matrix3d::Zero());
    CellFields fields = with_stress || at.wants_gradient ? cell_fields(fluid, at.wants_gradient) : CellFields{};
    if (!fields.stress.empty() && c.two_way) c.relief.gather(fields.stress);
    parallel_for(n, [&](std::size_t id) {
        at.dry[id] = is_dry(c, id) ? 1 : 0;
        if (at.dry[id] != 0) return;
        const SparseColumns& cells = c.weights.cells;
        at.u[id] = gathered_velocity(c.weights, fluid.u, id);
        at.eps[id] = gathered_porosity(c, id);
        if (!fields.stress.empty())
            at.stress[id] = cells.gathered(id, Vec3(Vec3::Zero()), [&](std::size_t k) { return fields.stress[k]; });
        if (at.wants_gradient)
            at.gradient[id] = cells.gathered(id, Eigen::Matrix3d(Eigen::Matrix3d::Zero()),
                                             [&](std::size_t k) { return fields.gradient[k]; });
    });
}

/// What all grains do to the fluid in the coming step, by id.
std::vector<ForeseenStep> foresee(const GridCoupling& c, const FluidOnGrains& f, const GrainSystem& system, double dt) {
    const Grains& g = system.grains;
    std::vector<ForeseenStep> all(g.size());
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        if (f.at_grains.dry[id] != 0) return;
        all[id] = foreseen_step(f, system, c.freedom[id], k, dt);
        all[id].drift += (1.0 - c.reached[id]) * g.v[k]; // from where it has been placed
    });
    return all;
}

/// Without fluid near a grain its debt waits.
void push_fluid(const GridCoupling& c, GridFluid& fluid, const std::vector<ForeseenStep>& all,
                const std::vector<char>& dry, double dt) {
    for (std::size_t q = 0; q < fluid.dimensions(); ++q) {
        const auto axis = static_cast<Eigen::Index>(q);
        fluid.drag[q].assign(fluid.u[q].size(), 0.0);
        fluid.push[q].assign(fluid.u[q].size(), 0.0);
        for (std::size_t id = 0; id < all.size(); ++id)
            if (dry[id] == 0)
                c.weights.faces[q].spread(id, [&](std::size_t k, double weight) {
                    fluid.drag[q][k] += weight * all[id].rate;
                    fluid.push[q][k] += weight * (all[id].known[axis] - c.owed[id][axis] / dt);
                });
    }
}

/// What the grains' ways do to the fluid's equations.
void make_room(const GridCoupling& c, GridFluid& fluid, const std::vector<ForeseenStep>& all) {
    std::vector<double> of_grains(all.size());
    const auto sum = [&](auto&& of) {
        for (std::size_t id = 0; id < all.size(); ++id) of_grains[id] = of(id, all[id]);
        return per_volume(c.weights, c.relief, of_grains);
    };
    const std::vector<double>& volume = c.places.volume;
    ForeseenGrains& room = fluid.foreseen;
    room.follows = sum([&](std::size_t id, const ForeseenStep& one) { return volume[id] * one.follows; });
    room.hands_on = sum([](std::size_t /*id*/, const ForeseenStep& one) { return one.hands_on; });
    room.yields = sum([&](std::size_t id, const ForeseenStep& one) { return volume[id] * one.yields; });
    room.drift.assign(room.follows.size(), Vec3::Zero());
    for (std::size_t q = 0; q < fluid.dimensions(); ++q) {
        const auto axis = static_cast<Eigen::Index>(q);
        const Field<double> drift =
            sum([&](std::size_t id, const ForeseenStep& one) { return volume[id] * one.drift[axis]; });
        for (std::size_t k = 0; k < drift.size(); ++k) room.drift[k][axis] = drift[k];
    }
}

std::vector<Vec3> velocities(const Grains& g) {
    std::vector<Vec3> v(g.size());
    for (std::size_t k = 0; k < g.size(); ++k) v[static_cast<std::size_t>(g.id[k])] = g.v[k];
    return v;
}

/// What the fluid has done in a step, by id: its force by what has been foreseen, and what it has of itself already
/// [N].
struct Given {
    std::vector<Vec3> foreseen, without;
};
Given given_by_fluid(const FluidOnGrains& f, const GrainSystem& system, const std::vector<ForeseenStep>& foreseen) {
    const Grains& g = system.grains;
    Given given{std::vector<Vec3>(g.size(), Vec3::Zero()), std::vector<Vec3>(g.size(), Vec3::Zero())};
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        if (f.at_grains.dry[id] != 0) return;
        given.foreseen[id] = foreseen[id].given(f.at_grains.u[id], f.at_grains.stress[id]);
        given.without[id] = force_without_reaction(f, gathered_fluid(f, id), 2.0 * g.radius[k], system.domain.gravity);
    });
    return given;
}

/// After the grains' steps: what each has received but for the forces without reaction, less what the fluid has given,
/// and how much of what acted moved it.
void settle(GridCoupling& c, const FluidOnGrains& f, const GrainSystem& system, const Given& given,
            const std::vector<Vec3>& v_before, double dt) {
    const Grains& g = system.grains;
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        if (f.at_grains.dry[id] != 0) return;
        const bool alone =
            g.mobility[k] > 0.0 && system.groups[static_cast<std::size_t>(g.group[k])].motion == Motion::free;
        const Vec3 received = alone ? f.forcing.impulse[k] : Vec3(dt * f.last_fluid_force[id]);
        c.owed[id] = received - dt * given.without[id] - dt * given.foreseen[id];
        if (!alone) return;
        const Vec3 change = g.v[k] - v_before[id];
        const Vec3 force = received + (dt * g.mass[k]) * system.domain.gravity;
        const Vec3 of_contacts = g.mass[k] * change - force;
        const Vec3 acted = force + (1.0 / g.mobility[k] - g.mass[k]) * change; // added mass moves with the grain
        const double square = acted.squaredNorm();
        const bool untouched = of_contacts.squaredNorm() <= 1e-16 * square || square == 0.0; // rounding
        c.freedom[id] = untouched ? 1.0 : std::clamp(1.0 + of_contacts.dot(acted) / square, 0.0, 1.0);
    });
}

/// The fluid that grains see at the start of a step: its velocity, and u . grad u.
struct SeenFluid {
    std::vector<Vec3> u, carried;
};
SeenFluid seen_fluid(const GatheredFluid& at, bool with_carried) {
    SeenFluid seen{at.u, {}};
    if (with_carried)
        for (std::size_t id = 0; id < at.u.size(); ++id) seen.carried.push_back(at.gradient[id] * at.u[id]);
    return seen;
}

/// How it has changed in the step: where it is, and, as has been foreseen, by moving on.
void set_along(GatheredFluid& at, const SeenFluid& before, double dt) {
    at.along.resize(at.u.size());
    parallel_for(at.u.size(),
                 [&](std::size_t id) { at.along[id] = (at.u[id] - before.u[id]) / dt + before.carried[id]; });
}

// --- the grains' own disturbance ---

/// Takes it out of what has been gathered; the fluid there is that of the end of a step, and changes no more.
void take_out_own(const GridCoupling& c, GatheredFluid& at) {
    if (!c.self) return;
    take_out(*c.self, std::vector<double>(c.places.size(), 0.0), c.places.volume, at);
    std::fill(at.a.begin(), at.a.end(), Vec3(Vec3::Zero()));
}

/// Where other grains are held, their drag over the density [1/s] screens a wake.
std::vector<Push> screened_pushes(const GridCoupling& c, const FluidOnGrains& f, const GrainSystem& system) {
    const Grains& g = system.grains;
    std::vector<Push> pushes(g.size());
    if (!c.self || c.self->fraction == 0.0) return pushes;
    parallel_for(g.size(), [&](std::size_t k) {
        const auto id = static_cast<std::size_t>(g.id[k]);
        if (g.mobility[k] != 0.0 || f.at_grains.dry[id] != 0) return;
        pushes[id].screening = c.self->fraction / (c.places.volume[id] * c.self->density) *
                               drag_resistance(f.drag, f.density, f.viscosity, 2.0 * g.radius[k], f.at_grains.eps[id],
                                               (f.at_grains.u[id] - g.v[k]).norm());
    });
    return pushes;
}

/// What pushes the fluid where the grains are but for drag, by id [N]: a mean gradient drives less fluid there, and the
/// stress in the grains' room, which the fluid's equation leaves to them, is missing from it; debts. `at` is as
/// gathered, with the grains' own.
std::vector<Vec3> pushes_besides_drag(const GridCoupling& c, const FluidOnGrains& f, double dt) {
    const GatheredFluid& at = f.at_grains;
    std::vector<Vec3> push(c.places.size(), Vec3::Zero());
    parallel_for(push.size(), [&](std::size_t id) {
        if (at.dry[id] == 0) push[id] = c.places.volume[id] * (f.mean_gradient - at.stress[id]) - c.owed[id] / dt;
    });
    return push;
}

/// Drag foreseen as a law of the gathered velocity, in which the grain's own is: with u' - past - R F for u', and the
/// push F = besides - drag. What is handed on of the stress is that of the step's start here.
void see_through_own(GridCoupling& c, const std::vector<Vec3>& besides, const std::vector<Push>& pushes,
                     const WakeStep& wake, std::int64_t step, std::vector<ForeseenStep>& foreseen) {
    constexpr double most = 0.9;
    const std::vector<double> response = fade_wakes(*c.self, pushes, wake);
    for (std::size_t id = 0; id < foreseen.size(); ++id) {
        ForeseenStep& one = foreseen[id];
        const double carried = one.rate * response[id];
        if (!(carried <= most))
            throw Diverged(step, wake.dt * static_cast<double>(step), "share of its slip that a grain's own push makes",
                           static_cast<std::int64_t>(id), carried,
                           "a shorter step or a wider coupling.kernel_width is needed");
        const Vec3 past = own_fluid(*c.self, id, c.places.volume[id]).u;
        one.known = (one.known + one.rate * (past + response[id] * besides[id])) / (1.0 - carried);
        one.rate /= 1.0 - carried;
    }
}

/// After the fluid's step: its pushes.
void push_own(GridCoupling& c, const FluidOnGrains& f, std::vector<Push>& pushes, const Given& given,
              const WakeStep& wake) {
    const std::vector<Vec3> besides = pushes_besides_drag(c, f, wake.dt);
    for (std::size_t id = 0; id < pushes.size(); ++id) pushes[id].force = besides[id] - given.foreseen[id];
    push_wakes(*c.self, pushes, wake);
}

/// After the grains' steps: what carries them out of their wakes.
void set_own_slips(GridCoupling& c, const FluidOnGrains& f, const GrainSystem& system, std::vector<Push>& pushes) {
    for (std::size_t k = 0; k < pushes.size(); ++k) {
        const auto id = static_cast<std::size_t>(system.grains.id[k]);
        if (f.at_grains.dry[id] == 0) pushes[id].slip = f.at_grains.u[id] - system.grains.v[k];
    }
    set_slips(*c.self, pushes);
}

} // namespace

void couple(GridCoupling& c, GridFluid& fluid, const GrainSystem& grains) {
    measure(c.weights, fluid);
    set_places(c, fluid, grains, 0.0);
    if (c.two_way) fluid.eps = c.eps;
}

void advance_grid_coupled(GridCoupling& c, GridFluid& fluid, FluidOnGrains& f, GrainSystem& grains, double dt,
                          std::int64_t step) {
    set_places(c, fluid, grains, c.two_way ? dt : 0.5 * dt);
    if (c.two_way) change_porosity(fluid, c.eps);
    const bool with_stress = feels_stress(f) || c.self;
    gather(c, fluid, f.at_grains, with_stress);
    const WakeStep wake{dt, two_steps_known(fluid)};
    std::vector<Vec3> besides = c.self ? pushes_besides_drag(c, f, dt) : std::vector<Vec3>{};
    const std::vector<Vec3> stress = f.at_grains.stress;
    if (c.self) turn_wakes(*c.self, dt);
    take_out_own(c, f.at_grains);
    const SeenFluid before = seen_fluid(f.at_grains, has_virtual_mass(f));
    std::vector<ForeseenStep> foreseen = foresee(c, f, grains, dt);
    std::vector<Push> pushes = screened_pushes(c, f, grains);
    for (std::size_t id = 0; id < besides.size(); ++id) besides[id] += foreseen[id].hands_on * stress[id];
    if (c.self) see_through_own(c, besides, pushes, wake, step, foreseen);
    if (c.two_way) push_fluid(c, fluid, foreseen, f.at_grains.dry, dt);
    if (c.two_way) make_room(c, fluid, foreseen);
    advance_grid(fluid, dt, step);

    gather(c, fluid, f.at_grains, with_stress);
    const Given given = given_by_fluid(f, grains, foreseen);
    if (c.self) push_own(c, f, pushes, given, wake);
    take_out_own(c, f.at_grains);
    if (has_virtual_mass(f)) set_along(f.at_grains, before, dt);
    const std::vector<Vec3> v_before = velocities(grains.grains);
    advance_gathered(f, grains, dt, step, c.grain_steps);
    if (c.self) set_own_slips(c, f, grains, pushes);
    if (c.two_way) settle(c, f, grains, given, v_before, dt);
}

} // namespace plumb
