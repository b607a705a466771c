#include "schemes/advance_fluid.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "sph/vector_at.hpp"
#include "sph/wall_particles.hpp"

#include <algorithm>
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

/// Records of the state half a step ahead of v and rho, `since` after the last ones; x is there already.
void fill_records(SphFluid& f, double half, double since) {
    const Prediction rate{half * (1.0 + f.memory), -half * f.memory};
    const bool remembers = f.memory > 0.0;
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
                record.p_over_rho_sq = law.pressure(rho, f.density, f.sound_speed) / (rho * rho);
                record.volume = f.mass / rho;
                f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[k])] = record;
            });
        },
        f.equation_of_state);
    update_images(f.clusters, f.domain);
    if (f.boundary.size() == 0) return;
    continue_state(f, since);
    update_images(f.clusters, f.domain);
}

/// Keeps the rates of the last evaluation, if the predictor wants them, while new ones are made.
void remember_rates(SphFluid& f) {
    if (f.memory == 0.0) return;
    for_each_axis(f, [&](std::size_t c) { std::swap(f.a[c], f.a_before[c]); });
    std::swap(f.drho, f.drho_before);
}

[[noreturn]] void report_divergence(const SphFluid& f, std::size_t k, std::int64_t step, double dt, double speed) {
    const double time = dt * static_cast<double>(step);
    const std::int32_t id = f.id[k] >= 0 ? f.id[k] : f.id[k / pack_width * pack_width];
    if (!(speed <= f.sound_speed))
        throw Diverged(step, time, "fluid velocity", id, speed, "more than the speed of sound");
    throw Diverged(step, time, "fluid density", id, f.rho[k], "changed by more than half");
}

/// Moves a particle down the gradient of the concentration, by a tenth of the spacing at most, and gives it the
/// velocity and density of the new place.
void shift_particle(SphFluid& f, std::size_t k, double shift) {
    double length_sq = 0.0;
    for_each_axis(f, [&](std::size_t c) { length_sq += f.spread[c][k] * f.spread[c][k]; });
    const double length = shift * std::sqrt(length_sq), most = 0.1 * f.spacing;
    double factor = length > most ? shift * most / length : shift;
    // The gradient of the concentration points out of a free surface: fading from whole to a fifth of the neighbours
    // gone.
    if (f.free_surface) factor *= std::clamp((f.completeness[k] - 0.8) / 0.15, 0.0, 1.0);
    for_each_axis(f, [&](std::size_t c) {
        f.x[c][k] += factor * f.spread[c][k];
        f.v[c][k] += factor * f.dv_spread[c][k];
    });
    f.rho[k] += factor * f.drho_spread[k];
}

/// v, rho and x at the end of the step, with the rates of its middle.
void correct(SphFluid& f, double dt, std::int64_t step) {
    const double shift = f.shifting * dt;
    parallel_for(f.slots(), [&](std::size_t k) {
        double speed_sq = 0.0;
        for_each_axis(f, [&](std::size_t c) {
            f.v[c][k] += dt * f.a[c][k];
            f.x[c][k] += 0.5 * dt * f.v[c][k];
            speed_sq += f.v[c][k] * f.v[c][k];
        });
        f.rho[k] += dt * f.drho[k];
        if (shift > 0.0) shift_particle(f, k, shift);
        const bool sound = speed_sq <= f.sound_speed * f.sound_speed && // written so that NaN fails
                           std::abs(f.rho[k] - f.density) <= 0.5 * f.density;
        if (!sound) report_divergence(f, k, step, dt, std::sqrt(speed_sq));
    });
}

/// Particles behind a wall. Lone ones, at a free surface, meet no pressure that could stop them: they are put back to
/// the surface and lose the velocity into the wall. In the bulk, one that is a spacing deep has diverged.
void stop_at_walls(SphFluid& f, double dt, std::int64_t step) {
    if (f.walls.empty()) return;
    const double time = dt * (static_cast<double>(step) - 0.5);
    parallel_for(f.slots(), [&](std::size_t k) {
        const Vec3 x = vector_at(f.x, k, f.dimensions), v = vector_at(f.v, k, f.dimensions);
        const Penetration p = penetration(f.walls, x, time, 2.0 * f.spacing);
        if (p.depth == 0.0) return;
        if (!f.free_surface) {
            if (p.depth < f.spacing) return;
            throw Diverged(step, dt * static_cast<double>(step), "fluid position", f.id[k], p.depth,
                           "behind a wall by more than a spacing");
        }
        const double into = std::min((v - p.wall_velocity).dot(p.normal), 0.0);
        for_each_axis(f, [&](std::size_t c) {
            const double n = p.normal[static_cast<Eigen::Index>(c)];
            f.x[c][k] += p.depth * n;
            f.v[c][k] -= into * n;
        });
    });
}

} // namespace

void advance_fluid(SphFluid& f, double dt, std::int64_t step) {
    move_boundary(f, 0.5 * dt);
    if (drift(f, 0.5 * dt) || f.boundary.travelled > 0.5 * f.clusters.skin) {
        stop_at_walls(f, dt, step);
        pass_open_sides(f);
        renew_lists(f);
    }
    fill_records(f, 0.5 * dt, dt);
    remember_rates(f);
    evaluate_terms(f);
    keep_mean_density(f);
    add_sources(f, (static_cast<double>(step) - 0.5) * dt);
    correct(f, dt, step);
    move_boundary(f, 0.5 * dt);
}

void start(SphFluid& f) {
    for_each_axis(f, [&](std::size_t c) { f.a[c].assign(f.slots(), 0.0); });
    f.drho.assign(f.slots(), 0.0);
    if (f.memory > 0.0) {
        f.a_before = f.a;
        f.drho_before = f.drho;
    }
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
