#include "dem/advance_grains.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "dem/contact_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

namespace {

// Skin of the neighbour list in radii of the smallest grain: a wider one is rebuilt less often but holds more pairs
// that do not touch (measured in solver/benchmarks). Grains that are injected fly, at a speed that takes them out of a
// narrow skin in a few steps, and have few neighbours for most of their way.
constexpr double skin_in_radii = 0.1, skin_of_injected = 0.5;
constexpr double far_away = 1e30; // [m] position of the record that pads the list; it touches nothing

/// Inverse mass as a contact feels it: a block moves as a whole, a fixed grain not at all.
std::vector<double> inverse_contact_masses(const GrainSystem& system) {
    std::vector<double> block_mass(system.groups.size(), 0.0);
    const Grains& g = system.grains;
    for (std::size_t k = 0; k < g.size(); ++k) block_mass[static_cast<std::size_t>(g.group[k])] += g.mass[k];
    std::vector<double> inverse(g.size());
    for (std::size_t k = 0; k < g.size(); ++k) {
        const auto group = static_cast<std::size_t>(g.group[k]);
        const Motion motion = system.groups[group].motion;
        inverse[k] = motion == Motion::fixed ? 0.0 : 1.0 / (motion == Motion::block ? block_mass[group] : g.mass[k]);
    }
    return inverse;
}

[[gnu::always_inline]] inline void write_record(Neighbours& list, std::size_t k, HalfPack x, HalfPack v,
                                                HalfPack surface) {
    store3(&list.records[k].x, x);
    store3(&list.records[k].vx, v);
    store3(&list.spins[k].x, surface);
}

/// Records of all grains in the present order; positions and velocities are those of the present state.
void fill_records(GrainSystem& system) {
    const Grains& g = system.grains;
    const std::vector<double> inverse_mass = inverse_contact_masses(system);
    Neighbours& list = system.neighbours;
    list.records.resize(g.size() + 1);
    list.spins.resize(g.size() + 1);
    for (std::size_t k = 0; k < g.size(); ++k) {
        list.records[k].radius = g.radius[k];
        list.records[k].inverse_mass = inverse_mass[k];
        list.spins[k].material = g.group[k];
        write_record(list, k, load3(g.x[k].data()), load3(g.v[k].data()), g.radius[k] * load3(g.omega[k].data()));
    }
    list.records[g.size()] = {far_away, far_away, far_away, -1.0, 0.0, 0.0, 0.0, 1.0};
    list.spins[g.size()] = {0.0, 0.0, 0.0, 0.0};
}

/// The step functions of one grain: those of the fluid exchange, or plain velocity Verlet without a fluid.
struct StepFunctions {
    double phi0 = 1.0, phi1 = 1.0, phi2 = 0.5;
    HalfPack drive{};
};
[[gnu::always_inline]] inline StepFunctions step_functions(const FluidForcing* forcing, std::size_t k) {
    if (forcing == nullptr) return {};
    return {forcing->phi0[k], forcing->phi1[k], forcing->phi2[k], load3(forcing->drive[k].data())};
}

/// What moves a grain, in registers.
struct MotionState {
    HalfPack v, a, omega, alpha;
};
[[gnu::always_inline]] inline MotionState motion_state(const Grains& g, std::size_t k) {
    return {load3(g.v[k].data()), load3(g.a[k].data()), load3(g.omega[k].data()), load3(g.alpha[k].data())};
}

/// Velocity at the end of the step if the contacts stayed as they are; the contacts of the new positions see this one.
[[gnu::always_inline]] inline HalfPack predicted_velocity(const MotionState& m, const StepFunctions& f, double dt) {
    return f.phi0 * m.v + (dt * f.phi1) * (m.a + f.drive);
}

[[noreturn]] void report_divergence(const GrainSystem& system, std::size_t k, double dt, double moved) {
    const Grains& g = system.grains;
    if (!std::isfinite(moved))
        throw Diverged(system.step + 1, dt * static_cast<double>(system.step + 1), "position", g.id[k], moved,
                       "not finite");
    throw Diverged(system.step + 1, dt * static_cast<double>(system.step + 1), "displacement in one step", g.id[k],
                   moved, "more than its radius");
}

/// Moves grain k to the end of the step and writes its record. Returns the distance squared moved in this step.
[[gnu::always_inline]] inline double drift_grain(GrainSystem& system, std::size_t k, const MotionState& m, double dt,
                                                 const FluidForcing* forcing, bool verlet) {
    Grains& g = system.grains;
    const StepFunctions f = step_functions(forcing, k);
    const HalfPack predicted = predicted_velocity(m, f, dt);
    const HalfPack omega = m.omega + dt * m.alpha;
    HalfPack moved = dt * predicted;
    if (verlet) {
        moved = (dt * f.phi1) * m.v + (dt * dt * f.phi2) * (m.a + f.drive);
    } else {
        store3(g.v[k].data(), predicted);
        store3(g.omega[k].data(), omega);
    }
    const HalfPack x = load3(g.x[k].data()) + moved;
    store3(g.x[k].data(), x);
    write_record(system.neighbours, k, x, predicted, g.radius[k] * omega);
    // A spin that is not a number would only show in the next contact; here it spoils the sum and is found.
    return dot3(moved, moved) + 0.0 * dot3(omega, omega);
}

/// Force and torque of all contacts on a grain, in registers.
struct Wrench {
    HalfPack force, torque;
};

/// Those of grain k: its own pairs, those in which it is the second, both in the order of the list, then the walls.
[[gnu::always_inline]] inline Wrench contact_wrench(const GrainSystem& system, std::size_t k) {
    const Neighbours& list = system.neighbours;
    PairForce own{}, incoming{};
    const PairForce* force = list.force.data();
    const std::int32_t* pair = list.incoming.data();
    constexpr std::int32_t width = ForceSlots::width;
    if (!list.slots.empty()) { // without contacts there is no list
        const ForceSlots& slots = list.slots[k];
        for (std::size_t q = 0; q < width; ++q) own += force[slots.own[q]], incoming += force[slots.incoming[q]];
    }
    for (std::int32_t p = list.own[k] + width; p < list.own[k + 1]; ++p) own += force[p];
    for (std::int32_t q = list.incoming_begin[k] + width; q < list.incoming_begin[k + 1]; ++q)
        incoming += force[pair[q]];
    const PairForce reaction{-1, -1, -1, 1, 1, 1, 0, 0}; // forces are opposite, torques per radius the same
    const PairForce sum = own + reaction * incoming;
    Wrench wrench{__builtin_shufflevector(sum, sum, 0, 1, 2, 6),
                  system.grains.radius[k] * __builtin_shufflevector(sum, sum, 3, 4, 5, 7)};
    if (list.rolls) {
        for (std::int32_t p = list.own[k]; p < list.own[k + 1]; ++p)
            wrench.torque += list.couple[static_cast<std::size_t>(p)];
        for (std::int32_t q = list.incoming_begin[k]; q < list.incoming_begin[k + 1]; ++q)
            wrench.torque -= list.couple[static_cast<std::size_t>(pair[q])];
    }
    const WallContacts& walls = system.wall_contacts;
    if (!walls.slot.empty() && walls.slot[k] >= 0)
        for (const WallContact& contact : walls.contacts[static_cast<std::size_t>(walls.slot[k])]) {
            wrench.force += load3(contact.force.data());
            wrench.torque += load3(contact.torque.data());
        }
    return wrench;
}

/// Acceleration of every block group: all its grains share it.
std::vector<Vec3> block_accelerations(const GrainSystem& system) {
    const Grains& g = system.grains;
    std::vector<Vec3> force(system.groups.size(), Vec3::Zero());
    std::vector<double> inertia(system.groups.size(), 0.0);
    for (const std::int32_t place : positions_of_ids(g)) {
        const auto k = static_cast<std::size_t>(place);
        const auto group = static_cast<std::size_t>(g.group[k]);
        if (system.groups[group].motion != Motion::block) continue;
        const HalfPack sum = contact_wrench(system, k).force;
        force[group] += Vec3(sum[0], sum[1], sum[2]) + g.mass[k] * system.domain.gravity;
        inertia[group] += 1.0 / g.mobility[k];
    }
    for (std::size_t q = 0; q < force.size(); ++q)
        if (inertia[q] > 0.0) force[q] /= inertia[q];
    return force;
}

/// Ends the step of grain k with the forces of the last evaluation and returns its new state, which stays in registers
/// for the next drift: reading back what has just been stored in parts would stall. `corrects` is false when there was
/// no step.
[[gnu::always_inline]] inline MotionState kick_grain(GrainSystem& system, std::size_t k, double dt,
                                                     FluidForcing* forcing, const std::vector<Vec3>& block,
                                                     bool corrects) {
    Grains& g = system.grains;
    const Wrench wrench = contact_wrench(system, k);
    MotionState now = motion_state(g, k);
    const MotionState before = now;
    now.a = g.mobility[k] * (wrench.force + g.mass[k] * load3(system.domain.gravity.data()));
    if (!block.empty() && system.groups[static_cast<std::size_t>(g.group[k])].motion == Motion::block)
        now.a = load3(block[static_cast<std::size_t>(g.group[k])].data());
    now.alpha = g.spin_mobility[k] * wrench.torque;
    if (corrects) {
        const StepFunctions f = step_functions(forcing, k);
        now.v = predicted_velocity(before, f, dt) + (dt * f.phi2) * (now.a - before.a);
        now.omega += (0.5 * dt) * (before.alpha + now.alpha);
        store3(g.v[k].data(), now.v);
        store3(g.omega[k].data(), now.omega);
        if (forcing != nullptr && !forcing->impulse.empty() && g.mobility[k] > 0.0) {
            const HalfPack others = (0.5 * dt / g.mobility[k]) * (before.a + now.a);
            const HalfPack received = g.mass[k] * (now.v - before.v) - others;
            forcing->impulse[k] += Vec3(received[0], received[1], received[2]);
        }
    }
    store3(g.a[k].data(), now.a);
    store3(g.alpha[k].data(), now.alpha);
    return now;
}

/// How far a grain may be from where it was listed at the end of the coming step [m]; negative if walls have moved
/// more.
double allowed_distance(const GrainSystem& system, double dt) {
    double fastest_wall = 0.0;
    for (const WallBody& wall : system.walls) fastest_wall = std::max(fastest_wall, wall.velocity.norm());
    const double since = dt * static_cast<double>(system.step + 1) - system.listed_time;
    return 0.5 * system.neighbours.skin - fastest_wall * since;
}

/// One pass over all grains: ends a step (kicks), begins the next (drifts), or both. Returns true when the neighbour
/// list does not hold for the new positions. `corrects` as for kick_grain.
template <bool kicks, bool drifts>
bool move_grains(GrainSystem& system, double dt, FluidForcing* forcing, bool corrects) {
    Grains& g = system.grains;
    const std::vector<Vec3> block = kicks && has_block(system) ? block_accelerations(system) : std::vector<Vec3>();
    const bool collide = !contactless(system.contact);
    const bool verlet = system.integrator == Integrator::velocity_verlet;
    const double allowed = allowed_distance(system, dt);
    const double allowed_sq = allowed > 0.0 ? allowed * allowed : -1.0;
    std::vector<std::uint8_t> left((g.size() + parallel_chunk - 1) / parallel_chunk, 0);
    parallel_chunks(g.size(), [&](std::size_t begin, std::size_t end) {
        bool leaves = false;
        for (std::size_t k = begin; k < end; ++k) {
            const MotionState now = kicks ? kick_grain(system, k, dt, forcing, block, corrects) : motion_state(g, k);
            if (!drifts && dt > 0.0) { // the last kick of a run: nothing later would notice
                const double size = dot3(now.v, now.v) + dot3(now.omega, now.omega) + 0.0 * dot3(now.a, now.a);
                if (!std::isfinite(size))
                    throw Diverged(system.step, system.time, "velocity", g.id[k], std::sqrt(size), "not finite");
            }
            if constexpr (drifts) {
                const double moved_sq = drift_grain(system, k, now, dt, forcing, verlet);
                // written so that NaN is caught; without contacts a grain may move as far as it likes
                const bool sound = collide ? moved_sq <= g.radius[k] * g.radius[k] : std::isfinite(moved_sq);
                if (!sound) report_divergence(system, k, dt, std::sqrt(moved_sq));
                const HalfPack away = load3(g.x[k].data()) - load3(g.x_listed[k].data());
                leaves |= dot3(away, away) > allowed_sq;
            }
        }
        left[begin / parallel_chunk] = leaves ? 1 : 0;
    });
    return collide && std::any_of(left.begin(), left.end(), [](std::uint8_t l) { return l != 0; });
}

/// The forcing in the new order of the grains. Grains that have been added since it was made stand at the end of the
/// old order; theirs is unset, and their memory empty.
void reorder_forcing(FluidForcing& forcing, const std::vector<std::int32_t>& order) {
    const std::size_t n = order.size();
    for (auto* field : {&forcing.phi0, &forcing.phi1, &forcing.phi2}) field->resize(n);
    forcing.drive.resize(n, Vec3::Zero());
    forcing.memory.resize(n * forcing.memory_size, 0.0);
    for (auto* field : {&forcing.phi0, &forcing.phi1, &forcing.phi2}) reorder(*field, order);
    reorder(forcing.drive, order);
    if (!forcing.impulse.empty()) {
        forcing.impulse.resize(n, Vec3::Zero());
        reorder(forcing.impulse, order);
    }
    const std::vector<double> before = forcing.memory;
    const std::size_t size = forcing.memory_size;
    for (std::size_t k = 0; k < order.size(); ++k)
        std::copy_n(before.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(order[k]) * size), size,
                    forcing.memory.begin() + static_cast<std::ptrdiff_t>(k * size));
}

/// New lists for the present positions. The velocities in the records, which may be predicted ones, move along.
void renew_lists(GrainSystem& system, FluidForcing* forcing) {
    Neighbours& list = system.neighbours;
    const std::vector<WallContact> on_walls = all_wall_contacts(system.wall_contacts);
    const Field<GrainRecord> records = list.records;
    const Field<SpinRecord> spins = list.spins;
    const std::vector<std::int32_t> order =
        rebuild(list, system.grains, system.groups, system.domain, remembered_contacts(list, system.grains));
    rebuild(system.wall_contacts, system.walls, system.grains, list.reach + list.skin, system.time, on_walls);
    system.listed_time = system.time;
    if (forcing != nullptr) reorder_forcing(*forcing, order);
    fill_records(system);
    if (records.size() != list.records.size()) return; // the first list, or grains were added: nothing predicted yet
    for (std::size_t k = 0; k < order.size(); ++k) {
        const GrainRecord& record = records[static_cast<std::size_t>(order[k])];
        const SpinRecord& spin = spins[static_cast<std::size_t>(order[k])];
        write_record(list, k, load3(system.grains.x[k].data()), load3(&record.vx), load3(&spin.x));
    }
}

void evaluate_contacts(GrainSystem& system, double dt) {
    evaluate_pairs(system.neighbours, system.contact, system.domain, dt);
    evaluate_wall_contacts(system.wall_contacts, system.walls, system.contact, system.grains, system.neighbours,
                           system.time, dt);
}

/// Sizes of the memory that the chosen laws need, and reach and skin of the neighbour list.
void prepare_lists(GrainSystem& system) {
    Neighbours& list = system.neighbours;
    const auto history = [](const auto& laws) { return std::decay_t<decltype(laws.laws)>::value_type::history; };
    list.history = std::visit(history, system.contact.contact) + std::visit(history, system.contact.rolling);
    list.rolls = !std::holds_alternative<PairLaws<NoRolling>>(system.contact.rolling);
    list.bridges = liquid_bridges(system.contact) != nullptr;
    double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
    for (const double r : system.grains.radius) smallest = std::min(smallest, r), largest = std::max(largest, r);
    list.reach = cohesion_reach(system.contact, largest);
    const double skin = system.injectors.empty() ? skin_in_radii : skin_of_injected;
    list.skin = std::isfinite(smallest) ? skin * smallest : 0.0;
}

/// Lists of a system without contacts: only the places in the records are needed.
void list_nothing(GrainSystem& system) {
    system.neighbours.own.assign(system.grains.size() + 1, 0);
    system.neighbours.incoming_begin.assign(system.grains.size() + 1, 0);
}

void check_box(const GrainSystem& system) {
    double largest = 0.0;
    for (const double r : system.grains.radius) largest = std::max(largest, r);
    const double reach = 2.0 * largest + system.neighbours.reach + system.neighbours.skin;
    for (int c = 0; c < 3; ++c)
        if (system.domain.periodic[static_cast<std::size_t>(c)] && system.domain.size[c] < 2.0 * reach)
            throw InputError(fmt::format("domain.size: {} m along periodic {} is too short; grains of radius {} m need "
                                         "at least {:.6g} m, or they would touch two images of each other",
                                         system.domain.size[c], axis_names[static_cast<std::size_t>(c)], largest,
                                         2.0 * reach));
}

} // namespace

void start(GrainSystem& system, double dt, FluidForcing* forcing) {
    const bool first = !system.started;
    Grains& g = system.grains;
    const std::size_t listed = system.neighbours.records.size();
    if (!first && listed == g.size() + 1) return;
    if (!first) // added grains touch nothing yet: only gravity accelerates them
        for (std::size_t k = listed - 1; k < g.size(); ++k)
            g.a[k] = (g.mobility[k] * g.mass[k]) * system.domain.gravity;
    prepare_lists(system);
    if (contactless(system.contact)) {
        list_nothing(system);
        g.x_listed = g.x;
        fill_records(system);
    } else {
        check_box(system);
        renew_lists(system, forcing);
    }
    if (first) {
        evaluate_contacts(system, 0.0);
        move_grains<true, false>(system, 0.0, forcing, false);
        evaluate_contacts(system, 0.5 * dt); // springs live at half steps; contacts that exist at the start have theirs
    }
    system.started = true;
}

void restore_lists(GrainSystem& system, const std::vector<RememberedContact>& pairs,
                   const std::vector<WallContact>& walls) {
    prepare_lists(system);
    Grains& g = system.grains;
    std::vector<Vec3> x(g.size()); // by id
    for (std::size_t k = 0; k < g.size(); ++k) x[static_cast<std::size_t>(g.id[k])] = g.x[k];
    if (contactless(system.contact)) {
        list_nothing(system);
    } else {
        g.x = g.x_listed;
        rebuild(system.neighbours, g, system.groups, system.domain, pairs);
        rebuild(system.wall_contacts, system.walls, g, system.neighbours.reach + system.neighbours.skin,
                system.listed_time, walls);
        for (std::size_t k = 0; k < g.size(); ++k) g.x[k] = x[static_cast<std::size_t>(g.id[k])];
    }
    fill_records(system);
    system.started = true;
}

void advance_grains(GrainSystem& system, std::int64_t steps, double dt, FluidForcing* forcing) {
    start(system, dt, forcing);
    const bool verlet = system.integrator == Integrator::velocity_verlet;
    bool stale = steps > 0 && move_grains<false, true>(system, dt, forcing, verlet);
    for (std::int64_t s = 1; s <= steps; ++s) {
        ++system.step;
        system.time = dt * static_cast<double>(system.step);
        if (stale) renew_lists(system, forcing);
        evaluate_contacts(system, dt);
        if (s < steps)
            stale = move_grains<true, true>(system, dt, forcing, verlet);
        else
            move_grains<true, false>(system, dt, forcing, verlet);
    }
}

std::vector<Vec3> contact_forces(const GrainSystem& system) {
    std::vector<Vec3> force(system.grains.size());
    for (std::size_t k = 0; k < force.size(); ++k) store3(force[k].data(), contact_wrench(system, k).force);
    return force;
}

} // namespace plumb
