#include "schemes/fluid_on_grains.hpp"

#include "core/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace plumb {

namespace {

// What a history force keeps per grain besides its exponentials: the slip before the step (x, y, z), the slip with
// which it entered the fluid (x, y, z), the force at the start of the step without that of the entry (x, y, z), and the
// number of steps since.
constexpr std::size_t history_extra = 10;

// Share of the history force taken at the end of the step; 1/2 is second order.
constexpr double theta = 0.5;

/// Forcing of one grain before grains of a block share theirs.
struct OneForcing {
    double rate = 0.0;         // beta [1/s]
    Vec3 other = Vec3::Zero(); // acceleration by all forces but drag [m/s2], contacts and gravity not included
    Vec3 u = Vec3::Zero();     // fluid velocity at the middle of the step [m/s]
    double re = 0.0;           // superficial, at the middle of the step
    double eps = 1.0;
    bool dry = false; // no fluid is near
};

LocalFluid local_fluid(const FluidOnGrains& f, const Domain& domain, const Vec3& x, double t) {
    LocalFluid local;
    static_cast<FlowPoint&>(local) = std::visit([&](const auto& flow) { return flow(x, t); }, f.flow);
    local.stress = f.density * local.acceleration;
    local.eps = porosity_at(f.porosity, domain.wrapped(x), domain);
    local.density = f.density;
    local.viscosity = f.viscosity;
    return local;
}

/// The fluid that grain k sees at the middle of the step.
LocalFluid fluid_at_grain(const FluidOnGrains& f, const GrainSystem& system, std::size_t k, double dt) {
    const Grains& g = system.grains;
    if (!f.gathers) return local_fluid(f, system.domain, g.x[k] + (0.5 * dt) * g.v[k], system.time + 0.5 * dt);
    const auto id = static_cast<std::size_t>(g.id[k]);
    LocalFluid local = gathered_fluid(f, id);
    local.u += (0.5 * dt) * f.at_grains.a[id];
    return local;
}

/// Carries the history of one grain over the step that has just ended, and returns the force of the coming one that
/// does not depend on its new velocity [N].
Vec3 history_drive(const BassetKernel& kernel, double coefficient, std::span<double> memory, const Vec3& slip,
                   const Vec3& slip_change_of_fluid) {
    const auto states = memory.first(kernel.state_size());
    double* extra = memory.data() + kernel.state_size();
    Eigen::Map<Vec3> slip_before(extra), entry(extra + 3), force_now(extra + 6);
    double& steps = extra[9];
    if (steps == 0.0) {
        entry = slip;
    } else {
        const Vec3 change = slip - slip_before;
        force_now = kernel.force_from_past(states, coefficient) + kernel.implicit_coefficient(coefficient) * change;
        kernel.advance(states, change);
    }
    slip_before = slip;
    // The entry's force K entry/sqrt(t) is singular: its exact mean over the step, with implicit_coefficient = 2
    // K/sqrt(dt).
    const Vec3 of_entry =
        (kernel.implicit_coefficient(coefficient) * (std::sqrt(steps + 1.0) - std::sqrt(steps))) * entry;
    steps += 1.0;
    return of_entry + (1.0 - theta) * force_now +
           theta * (kernel.force_from_past(states, coefficient) +
                    kernel.implicit_coefficient(coefficient) * slip_change_of_fluid);
}

/// The same for grain k, which sees `local` at the middle of the step; zero without a history force.
Vec3 history_of_grain(FluidOnGrains& f, const GrainSystem& system, const BassetKernel* kernel, std::size_t k,
                      const LocalFluid& local, double dt) {
    if (kernel == nullptr) return Vec3::Zero();
    const Grains& g = system.grains;
    const LocalFluid now = local_fluid(f, system.domain, g.x[k], system.time);
    const Vec3 change_of_fluid = dt * (local.acceleration + local.gradient * (g.v[k] - local.u)); // along its path
    return history_drive(*kernel, basset_coefficient(f.density, f.viscosity, 2.0 * g.radius[k]),
                         {f.forcing.memory.data() + k * f.forcing.memory_size, f.forcing.memory_size}, now.u - g.v[k],
                         change_of_fluid);
}

/// Sum of the forces that do not depend on the rate of drag [N].
Vec3 other_forces(const FluidOnGrains& f, const LocalFluid& local, const LocalGrain& grain, const Vec3& gravity) {
    Vec3 sum = Vec3::Zero();
    for (const OtherForce& law : f.forces) sum += force_on_grain(law, local, grain, gravity);
    return sum;
}

/// Where the fluid is a computed one: mass of grains over that of the fluid which drags them; no fluid is near.
double load_of(const FluidOnGrains& f, std::int32_t id) {
    return f.gathers ? f.at_grains.load[static_cast<std::size_t>(id)] : 0.0;
}
bool is_dry(const FluidOnGrains& f, std::int32_t id) {
    return f.gathers && f.at_grains.dry[static_cast<std::size_t>(id)] != 0;
}

/// Share of a grain that is wet.
double wet_share(const FluidOnGrains& f, std::int32_t id) {
    return f.at_grains.wet.empty() ? 1.0 : f.at_grains.wet[static_cast<std::size_t>(id)];
}

/// Nothing acts on a grain without fluid.
OneForcing no_forcing(const Vec3& velocity) {
    OneForcing one;
    one.u = velocity;
    one.dry = true;
    return one;
}

/// The part of the pressure's force on a grain that its fluid does not lose, since it never had it [N].
Vec3 shared_force(const FluidOnGrains& f, std::int32_t id, double diameter) {
    if (!f.shares_pressure) return Vec3::Zero();
    return sphere_volume(diameter) * f.at_grains.stress[static_cast<std::size_t>(id)];
}

OneForcing forcing_of_grain(FluidOnGrains& f, const GrainSystem& system, const BassetKernel* kernel, std::size_t k,
                            double dt) {
    const Grains& g = system.grains;
    const double d = 2.0 * g.radius[k], mobility = g.mobility[k];
    const Vec3 v = g.v[k];
    if (is_dry(f, g.id[k])) return no_forcing(v);
    const LocalFluid local = fluid_at_grain(f, system, k, dt);
    // Where grains of mass load times that of the fluid around drag it along, the slip w = v - u obeys
    //     dw/dt = g - a - (1 + load) beta w,    and v = c + w/(1 + load)
    // with the velocity c of both together, which drag does not change: the grain relaxes (1 + load) times as fast,
    // towards c.
    const double load = load_of(f, g.id[k]), both = 1.0 + load;
    const Vec3 outside = load > 0.0 ? force_from_outside(f, d, system.domain.gravity) : Vec3(Vec3::Zero());
    OneForcing one;
    one.eps = local.eps;
    const Vec3 history = history_of_grain(f, system, kernel, k, local, dt);
    const double wet = wet_share(f, g.id[k]);
    const auto rate = [&](double slip) {
        return wet * both * mobility * drag_resistance(f.drag, f.density, f.viscosity, d, local.eps, both * slip);
    };
    // Lift depends on the velocity: a first pass at the start of the step finds the velocity at its middle.
    const int passes = std::any_of(f.forces.begin(), f.forces.end(), needs_gradient) ? 2 : 1;
    LocalGrain grain{d, v};
    for (int pass = 0; pass < passes; ++pass) {
        one.other = mobility * (other_forces(f, local, grain, system.domain.gravity) + history);
        const Vec3 acceleration = g.a[k] + one.other;
        // What the grain receives but by drag the fluid loses: its mass times the acceleration, less what comes from
        // contacts, gravity and outside; `local.u` does not know of it.
        const Vec3 lost =
            acceleration - g.a[k] / (mobility * g.mass[k]) - (outside + shared_force(f, g.id[k], d)) / g.mass[k];
        one.u = (local.u + load * (v + (0.5 * dt) * (acceleration - lost))) / both;
        std::visit(
            [&](const auto& exchange) {
                one.rate = mid_step_rate(exchange, rate, v - one.u, acceleration, dt);
                const StepWeights half = exchange(0.5 * one.rate * dt);
                grain.velocity = one.u + half.phi0 * (v - one.u) + (0.5 * dt * half.phi1) * acceleration;
            },
            f.exchange);
    }
    one.re = f.density * d * local.eps * both * (grain.velocity - one.u).norm() / f.viscosity;
    return one;
}

/// Grains of a block move as one: their rates and drives are averaged with their inertia.
void share_in_blocks(const GrainSystem& system, std::vector<OneForcing>& all) {
    const Grains& g = system.grains;
    std::vector<double> inertia(system.groups.size(), 0.0);
    std::vector<OneForcing> mean(system.groups.size());
    const auto is_block = [&](std::size_t k) {
        return system.groups[static_cast<std::size_t>(g.group[k])].motion == Motion::block;
    };
    for (const std::int32_t place : positions_of_ids(g)) {
        const auto k = static_cast<std::size_t>(place);
        if (!is_block(k)) continue;
        const auto q = static_cast<std::size_t>(g.group[k]);
        const double m = 1.0 / g.mobility[k];
        inertia[q] += m;
        mean[q].rate += m * all[k].rate;
        mean[q].other += m * all[k].other;
        mean[q].u += m * all[k].rate * all[k].u; // weighted with the drag it causes
    }
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (!is_block(k)) continue;
        const auto q = static_cast<std::size_t>(g.group[k]);
        all[k].u = mean[q].rate > 0.0 ? Vec3(mean[q].u / mean[q].rate) : Vec3::Zero();
        all[k].rate = mean[q].rate / inertia[q];
        all[k].other = mean[q].other / inertia[q];
    }
}

/// Step weights and drive of grain k, and the drag and other forces it will feel on average.
void write_forcing(FluidOnGrains& f, const GrainSystem& system, std::size_t k, const OneForcing& own,
                   const OneForcing& shared, double dt, std::int64_t parts) {
    const Grains& g = system.grains;
    const auto weights = [&](double seconds) {
        return std::visit([&](const auto& e) { return e(shared.rate * seconds); }, f.exchange);
    };
    const StepWeights w = weights(dt), part = parts == 1 ? w : weights(dt / static_cast<double>(parts));
    f.forcing.phi0[k] = part.phi0;
    f.forcing.phi1[k] = part.phi1;
    f.forcing.phi2[k] = part.phi2;
    f.forcing.drive[k] = shared.other + shared.rate * shared.u;
    const Vec3 mean_velocity = w.phi1 * g.v[k] + (dt * w.phi2) * (g.a[k] + f.forcing.drive[k]);
    const auto id = static_cast<std::size_t>(g.id[k]);
    const double inertia = 1.0 / g.mobility[k];
    f.last_drag[id] = (own.rate * inertia) * (own.u - mean_velocity);
    // The added mass times the acceleration is missing until the new velocity is known.
    f.last_fluid_force[id] = f.last_drag[id] + inertia * own.other + (inertia - g.mass[k]) * g.v[k] / dt;
}

/// Mean slip over the step of a grain of given velocity: a computed fluid near it slows down, by the drag at `load`
/// times the rate per mass of grains, and by the other forces.
Vec3 mean_slip(const FluidOnGrains& f, const LocalFluid& local, const Grains& g, std::size_t k, const Vec3& other,
               double dt) {
    Vec3 slip = local.u - g.v[k];
    if (!f.gathers) return slip;
    const auto id = static_cast<std::size_t>(g.id[k]);
    const double d = 2.0 * g.radius[k], load = load_of(f, g.id[k]), wet = wet_share(f, g.id[k]);
    const Vec3 start = f.at_grains.u[id] - g.v[k], a = f.at_grains.a[id] - (load / g.mass[k]) * other;
    for (int pass = 0; pass < 4; ++pass) { // the rate is that of the mean slip
        const double rate =
            wet * load / g.mass[k] * drag_resistance(f.drag, f.density, f.viscosity, d, local.eps, slip.norm());
        const StepWeights w = std::visit([&](const auto& exchange) { return exchange(rate * dt); }, f.exchange);
        slip = w.phi1 * start + (dt * w.phi2) * a;
    }
    return slip;
}

/// A fixed grain does not respond, but it feels the fluid: the forces are those at its given velocity.
OneForcing write_fixed(FluidOnGrains& f, const GrainSystem& system, const BassetKernel* kernel, std::size_t k,
                       double dt) {
    const Grains& g = system.grains;
    f.forcing.phi0[k] = f.forcing.phi1[k] = 1.0;
    f.forcing.phi2[k] = 0.5;
    f.forcing.drive[k].setZero();
    const double d = 2.0 * g.radius[k];
    const auto id = static_cast<std::size_t>(g.id[k]);
    if (is_dry(f, g.id[k])) {
        f.last_drag[id] = f.last_fluid_force[id] = Vec3::Zero();
        return no_forcing(g.v[k]);
    }
    const LocalFluid local = fluid_at_grain(f, system, k, dt);
    const Vec3 other = other_forces(f, local, {d, g.v[k]}, system.domain.gravity);
    const Vec3 not_lost = force_from_outside(f, d, system.domain.gravity) + shared_force(f, g.id[k], d);
    const Vec3 slip = mean_slip(f, local, g, k, other - not_lost, dt);
    const double wet = wet_share(f, g.id[k]);
    f.last_drag[id] = wet * drag_resistance(f.drag, f.density, f.viscosity, d, local.eps, slip.norm()) * slip;
    f.last_fluid_force[id] = f.last_drag[id] + other + history_of_grain(f, system, kernel, k, local, dt);
    OneForcing one;
    one.re = f.density * d * local.eps * slip.norm() / f.viscosity;
    one.eps = local.eps;
    return one;
}

void count_range(FluidOnGrains& f, const std::vector<OneForcing>& all) {
    const DragRange& range = drag_range(f.drag);
    for (const OneForcing& one : all) {
        if (one.dry) {
            ++f.range_use.dry;
            continue;
        }
        f.range_use.re_min = std::min(f.range_use.re_min, one.re);
        f.range_use.re_max = std::max(f.range_use.re_max, one.re);
        ++(within(range, one.re, one.eps) ? f.range_use.inside : f.range_use.outside);
    }
}

template <class Law> bool has(const FluidOnGrains& f) {
    return std::any_of(f.forces.begin(), f.forces.end(),
                       [](const OtherForce& law) { return std::holds_alternative<Law>(law); });
}

} // namespace

bool feels_stress(const FluidOnGrains& f) { return has<PressureGradient>(f); }
bool has_virtual_mass(const FluidOnGrains& f) { return has<VirtualMass>(f); }

void read_coupling_laws(Table& coupling, FluidOnGrains& f) {
    f.drag = make_family<DragLaw>(coupling.law("drag"));
    f.exchange = make_family<Exchange>(coupling.law("exchange"));
    std::set<std::string> seen;
    for (const std::string& name : coupling.texts("forces")) {
        if (!seen.insert(name).second) coupling.fail("forces", fmt::format("\"{}\" is named twice", name));
        if (name == "basset") {
            f.history = make_family<HistoryForce>(coupling.law("basset"));
            continue;
        }
        const std::vector<LawEntry> known = law_entries<OtherForce>();
        if (std::none_of(known.begin(), known.end(), [&](const LawEntry& law) { return law.name == name; })) {
            std::string names = "\"basset\"";
            for (const LawEntry& law : known) names += fmt::format(", \"{}\"", law.name);
            coupling.fail("forces", fmt::format("\"{}\" is not one of {}", name, names));
        }
        f.forces.push_back(
            make_family<OtherForce>(Table(toml::table{{"law", name}}, coupling.path() + ".forces", coupling.file())));
    }
}

FluidOnGrains read_fluid_on_grains(Table& fluid, Table& coupling) {
    fluid.choice("method", {"prescribed"});
    coupling.choice("direction", {"one_way"});
    FluidOnGrains f;
    f.density = fluid.number("density", positive);
    f.viscosity = fluid.number("viscosity", positive);
    f.flow = make_family<PrescribedFlow>(fluid.law("flow"));
    if (coupling.has("porosity")) f.porosity = make_family<PrescribedPorosity>(coupling.law("porosity"));
    read_coupling_laws(coupling, f);
    return f;
}

void set_inertia(FluidOnGrains& fluid, GrainSystem& system, double dt) {
    Grains& g = system.grains;
    if (fluid.history && (!fluid.kernel || fluid.kernel->step() != dt))
        fluid.kernel = history_kernel(*fluid.history, dt);
    const std::optional<BassetKernel>& kernel = fluid.kernel;
    for (std::size_t k = 0; k < g.size(); ++k) {
        if (g.mobility[k] == 0.0) continue; // fixed
        const double d = 2.0 * g.radius[k];
        double inertia = g.mass[k];
        for (const OtherForce& law : fluid.forces) inertia += added_mass(law, fluid.density, d);
        if (kernel)
            inertia += theta * dt * kernel->implicit_coefficient(basset_coefficient(fluid.density, fluid.viscosity, d));
        g.mobility[k] = 1.0 / inertia;
    }
}

Vec3 force_from_outside(const FluidOnGrains& f, double diameter, const Vec3& gravity) {
    LocalFluid fluid;
    fluid.density = f.density;
    Vec3 force = Vec3::Zero();
    for (const OtherForce& law : f.forces)
        force += force_from_outside(law, fluid, {diameter, Vec3::Zero()}, gravity, f.mean_gradient);
    return force;
}

LocalFluid gathered_fluid(const FluidOnGrains& f, std::size_t id) {
    LocalFluid local;
    local.u = f.at_grains.u[id];
    local.stress = f.at_grains.stress[id] - f.mean_gradient;
    local.acceleration = f.at_grains.along.empty() ? Vec3(local.stress / f.density) : f.at_grains.along[id];
    if (f.at_grains.wants_gradient) local.gradient = f.at_grains.gradient[id];
    local.eps = f.at_grains.eps[id];
    local.density = f.density;
    local.viscosity = f.viscosity;
    return local;
}

void update_forcing(FluidOnGrains& fluid, GrainSystem& system, double dt, std::int64_t parts) {
    const Grains& g = system.grains;
    const std::size_t n = g.size();
    const std::optional<BassetKernel>& kernel = fluid.kernel;
    FluidForcing& forcing = fluid.forcing;
    forcing.drive.resize(n);
    for (auto* field : {&forcing.phi0, &forcing.phi1, &forcing.phi2}) field->resize(n);
    forcing.memory_size = kernel ? kernel->state_size() + history_extra : 0;
    forcing.memory.resize(n * forcing.memory_size, 0.0); // grains that were added stand at the end
    fluid.last_drag.resize(n);
    fluid.last_fluid_force.resize(n);
    std::vector<OneForcing> own(n);
    parallel_for(n, [&](std::size_t k) {
        const BassetKernel* history = kernel ? &*kernel : nullptr;
        own[k] = g.mobility[k] == 0.0 ? write_fixed(fluid, system, history, k, dt)
                                      : forcing_of_grain(fluid, system, history, k, dt);
    });
    const bool shares = has_block(system);
    std::vector<OneForcing> of_blocks;
    if (shares) {
        of_blocks = own;
        share_in_blocks(system, of_blocks);
    }
    const std::vector<OneForcing>& shared = shares ? of_blocks : own;
    parallel_for(n, [&](std::size_t k) {
        if (g.mobility[k] != 0.0) write_forcing(fluid, system, k, own[k], shared[k], dt, parts);
    });
    count_range(fluid, own);
}

void complete_fluid_forces(FluidOnGrains& fluid, const GrainSystem& system, double dt) {
    const Grains& g = system.grains;
    parallel_for(g.size(), [&](std::size_t k) {
        if (g.mobility[k] == 0.0) return;
        const double added = 1.0 / g.mobility[k] - g.mass[k];
        fluid.last_fluid_force[static_cast<std::size_t>(g.id[k])] -= (added / dt) * g.v[k];
    });
}

void advance_gathered(FluidOnGrains& fluid, GrainSystem& system, double dt, std::int64_t step, std::int64_t parts) {
    update_forcing(fluid, system, dt, parts);
    fluid.forcing.impulse.assign(system.grains.size(), Vec3::Zero());
    system.step = (step - 1) * parts; // its own steps; the run counts the fluid's
    advance_grains(system, parts, dt / static_cast<double>(parts), &fluid.forcing);
    system.step = step;
    system.time = dt * static_cast<double>(step);
    complete_fluid_forces(fluid, system, dt);
}

} // namespace plumb
