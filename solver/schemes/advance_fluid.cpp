#include "schemes/advance_fluid.hpp"

#include "core/errors.hpp"
#include "core/packed_field.hpp"
#include "core/parallel.hpp"
#include "sph/even_outlets.hpp"
#include "sph/filling.hpp"
#include "sph/vector_at.hpp"
#include "sph/wall_particles.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

namespace plumb {

namespace {

template <class Body> void for_each_axis(const SphFluid& f, Body&& body) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) body(c);
}

/// x <- x + half v. Returns true when a particle has left the place where the lists expect it.
bool drift(SphFluid& f, double half) {
    const double allowed_sq = 0.25 * f.clusters.skin * f.clusters.skin;
    std::vector<std::uint8_t> left((f.slots() + parallel_chunk - 1) / parallel_chunk, 0);
    parallel_chunks(f.slots(), [&](std::size_t begin, std::size_t end) {
        bool leaves = false;
        for (std::size_t k = begin; k < end; ++k) {
            double away_sq = 0.0;
            for_each_axis(f, [&](std::size_t c) {
                f.x[c][k] += half * f.v[c][k];
                const double away = f.x[c][k] - f.x_listed[c][k];
                away_sq += away * away;
            });
            leaves |= !(away_sq <= allowed_sq);
        }
        left[begin / parallel_chunk] = leaves ? 1 : 0;
    });
    return std::any_of(left.begin(), left.end(), [](std::uint8_t l) { return l != 0; });
}

/// Rates with which v and rho are predicted half a step ahead: the last ones, or a blend with those before.
struct Prediction {
    double last, before;
};

/// The fluid fraction by record, images too.
void tell_records_eps(SphFluid& f) {
    f.eps_of_record.resize(f.clusters.records.size());
    parallel_for(f.slots(), [&](std::size_t k) {
        if (f.id[k] >= 0) f.eps_of_record[static_cast<std::size_t>(f.clusters.record_of[k])] = f.eps[k];
    });
    parallel_for(f.clusters.records.size(), [&](std::size_t r) {
        const auto origin = static_cast<std::size_t>(f.clusters.image_of[r]);
        if (origin != r) f.eps_of_record[r] = f.eps_of_record[origin];
    });
}

/// Records of the state half a step ahead of v and rho, `since` after the last ones; x is there already.
void fill_records(SphFluid& f, double half, double since) {
    const Prediction rate{half * (1.0 + f.memory), -half * f.memory};
    const bool remembers = f.memory > 0.0, grains = f.among_grains();
    std::visit(
        [&](const auto& law) {
            parallel_for(f.slots(), [&](std::size_t k) {
                if (f.id[k] < 0) return; // a copy
                const double rho =
                    f.rho[k] + rate.last * f.drho[k] + (remembers ? rate.before * f.drho_before[k] : 0.0);
                FluidRecord record{};
                double* const position = &record.x;
                double* const velocity = &record.u;
                for_each_axis(f, [&](std::size_t c) {
                    position[c] = f.x[c][k];
                    velocity[c] =
                        f.v[c][k] + rate.last * f.a[c][k] + (remembers ? rate.before * f.a_before[c][k] : 0.0);
                });
                const double own = grains ? rho * f.share[k] / f.eps[k] : rho;
                const double p = law.pressure(own, f.density, f.sound_speed);
                record.pressure = pressure_entry(f, pushing_pressure(f, p, grains ? f.eps[k] : 1.0), rho);
                record.volume = f.mass / rho;
                f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[k])] = record;
            });
        },
        f.equation_of_state);
    update_images(f.clusters, f.domain);
    if (f.boundary.size() == 0) return;
    if (f.shares_pressure) tell_records_eps(f);
    continue_state(f, since);
    update_images(f.clusters, f.domain);
}

/// Keeps the rates of the last evaluation, if the predictor wants them, while new ones are made.
void remember_rates(SphFluid& f) {
    if (f.memory == 0.0) return;
    for_each_axis(f, [&](std::size_t c) { std::swap(f.a[c], f.a_before[c]); });
    std::swap(f.drho, f.drho_before);
}

/// Density of the fluid itself [kg/m3]: among grains not the particle's, which takes more room there.
double own_density(const SphFluid& f, std::size_t k) {
    return f.among_grains() ? f.rho[k] * f.share[k] / f.eps[k] : f.rho[k];
}

[[noreturn]] void report_divergence(const SphFluid& f, std::size_t k, std::int64_t step, double dt, double speed) {
    const double time = dt * static_cast<double>(step);
    const std::int32_t id = f.id[k] >= 0 ? f.id[k] : f.id[k / pack_width * pack_width];
    if (!(speed <= f.sound_speed))
        throw Diverged(step, time, "fluid velocity", id, speed,
                       std::isfinite(speed) ? "more than the speed of sound" : "not a number");
    throw Diverged(step, time, "fluid density", id, own_density(f, k), "changed by more than half");
}

/// Moves eight particles down the gradient of the concentration, by a tenth of the spacing at most, and gives them the
/// velocities and densities of the new places.
void shift_particles(SphFluid& f, std::size_t cluster, double shift) {
    Pack length_sq = broadcast<Pack>(0.0);
    for_each_axis(f, [&](std::size_t c) {
        const Pack spread = load(f.spread[c], cluster);
        length_sq += spread * spread;
    });
    const Pack wanted = broadcast<Pack>(shift), most = broadcast<Pack>(0.1 * f.spacing);
    const Pack length = wanted * square_root(length_sq);
    Pack factor = select(length > most, wanted * most / length, wanted);
    // The gradient of the concentration points out of a free surface: fading from whole to a fifth of the neighbours
    // gone.
    if (f.free_surface) {
        const Pack inside = (load(f.completeness, cluster) - broadcast<Pack>(0.8)) / broadcast<Pack>(0.15);
        factor *= smaller(larger(inside, broadcast<Pack>(0.0)), broadcast<Pack>(1.0));
    }
    for_each_axis(f, [&](std::size_t c) {
        add(f.x[c], cluster, factor * load(f.spread[c], cluster));
        add(f.v[c], cluster, factor * load(f.dv_spread[c], cluster));
    });
    add(f.rho, cluster, factor * load(f.drho_spread, cluster));
}

/// v, rho and x at the end of the step, with the rates of its middle.
void correct(SphFluid& f, double dt, std::int64_t step) {
    assert(f.slots() % pack_width == 0);
    const double shift = f.shifting * dt, slow = f.sound_speed * f.sound_speed, half = 0.5 * f.density;
    const Pack interval = broadcast<Pack>(dt), half_interval = broadcast<Pack>(0.5 * dt);
    parallel_for(f.slots() / pack_width, [&](std::size_t cluster) {
        Pack speed_sq = broadcast<Pack>(0.0);
        for_each_axis(f, [&](std::size_t c) {
            add(f.v[c], cluster, interval * load(f.a[c], cluster));
            const Pack v = load(f.v[c], cluster);
            add(f.x[c], cluster, half_interval * v);
            speed_sq += v * v;
        });
        add(f.rho, cluster, interval * load(f.drho, cluster));
        if (shift > 0.0) shift_particles(f, cluster, shift);
        const auto near = [&](const Pack& rho) { // to the fluid's density, written so that NaN is not
            const Pack change = rho - broadcast<Pack>(f.density);
            return (change <= broadcast<Pack>(half)) & (change >= broadcast<Pack>(-half));
        };
        // A particle that goes into a bed takes more room, one of pure mass starts in one with too little.
        const Pack rho = load(f.rho, cluster);
        PackMask sound = near(rho);
        if (f.among_grains()) sound |= near(rho * load(f.share, cluster) / load(f.eps, cluster));
        sound &= speed_sq <= broadcast<Pack>(slow);
        if (!any(~sound)) return;
        for (int lane = 0; lane < pack_width; ++lane)
            if (sound[lane] == 0)
                report_divergence(f, pack_width * cluster + static_cast<std::size_t>(lane), step, dt,
                                  std::sqrt(speed_sq[lane]));
    });
}

/// Particles behind a wall. Lone ones, at a free surface, meet no pressure that could stop them; in the bulk one may be
/// drawn in beside a void, and half a spacing is further than any pressure lets it come. They are put back to the
/// surface, lose the velocity into the wall and are counted. One that is a whole spacing deep all the same has
/// diverged.
void stop_at_walls(SphFluid& f, double dt, std::int64_t step) {
    if (f.walls.empty()) return;
    const double time = dt * (static_cast<double>(step) - 0.5), allowed = f.free_surface ? 0.0 : 0.5 * f.spacing;
    std::atomic<std::int64_t> put_back{0};
    parallel_for(f.slots(), [&](std::size_t k) {
        const Vec3 x = vector_at(f.x, k, f.dimensions), v = vector_at(f.v, k, f.dimensions);
        Penetration p = penetration(f.walls, x, time, 2.0 * f.spacing);
        for (const OpenSide& side : f.open_sides) // nothing goes out through an inlet
            if (side.is_inlet() && -side.distance(x) > p.depth)
                p = {-side.distance(x), side.normal, side.inflow(x, f.dimensions) * side.normal};
        if (p.depth <= allowed) return;
        if (!f.free_surface && p.depth >= f.spacing)
            throw Diverged(step, dt * static_cast<double>(step), "fluid position", f.id[k], p.depth,
                           "behind a wall by more than a spacing");
        if (f.id[k] >= 0) ++put_back;
        const double into = std::min((v - p.wall_velocity).dot(p.normal), 0.0);
        for_each_axis(f, [&](std::size_t c) {
            const double n = p.normal[static_cast<Eigen::Index>(c)];
            f.x[c][k] += p.depth * n;
            f.v[c][k] -= into * n;
        });
    });
    f.put_back += put_back;
}

} // namespace

bool go_to_middle(SphFluid& f, double dt, std::int64_t step) {
    set_openings(f, (static_cast<double>(step) - 0.5) * dt);
    move_boundary(f, 0.5 * dt);
    const bool leaves = drift(f, 0.5 * dt) || f.boundary.travelled > 0.5 * f.clusters.skin;
    if (!leaves) return false;
    stop_at_walls(f, dt, step);
    pass_open_sides(f);
    renew_lists(f);
    return true;
}

void evaluate_middle(SphFluid& f, double dt, std::int64_t step) {
    fill_records(f, 0.5 * dt, dt);
    remember_rates(f);
    evaluate_terms(f);
    follow_filling(f);
    hold_open_pressure(f);
    keep_mean_density(f);
    add_sources(f, (static_cast<double>(step) - 0.5) * dt);
}

void go_to_end(SphFluid& f, double dt, std::int64_t step) {
    correct(f, dt, step);
    move_boundary(f, 0.5 * dt);
}

void advance_fluid(SphFluid& f, double dt, std::int64_t step) {
    go_to_middle(f, dt, step);
    evaluate_middle(f, dt, step);
    go_to_end(f, dt, step);
}

void start(SphFluid& f) {
    for_each_axis(f, [&](std::size_t c) { f.a[c].assign(f.slots(), 0.0); });
    f.drho.assign(f.slots(), 0.0);
    if (f.memory > 0.0) {
        f.a_before = f.a;
        f.drho_before = f.drho;
    }
    f.mass_at_start = mass_inside(f);
    renew_lists(f);
    fill_records(f, 0.0, 0.0);
    evaluate_terms(f);
    if (std::holds_alternative<VariableOperators>(f.operators)) evaluate_terms(f); // now with its Omega
    keep_mean_density(f);
    add_sources(f, 0.0);
    if (f.memory == 0.0) return;
    f.a_before = f.a;
    f.drho_before = f.drho;
}

} // namespace plumb
