#include "schemes/advance_fluid.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"

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

/// Records of the state half a step ahead of v and rho; x is there already.
void fill_records(SphFluid& f, double half) {
    std::visit(
        [&](const auto& law) {
            parallel_for(f.slots(), [&](std::size_t k) {
                if (f.id[k] < 0) return; // a copy
                const double rho = f.rho[k] + half * f.drho[k];
                FluidRecord record{};
                double* const position = &record.x;
                double* const velocity = &record.u;
                for_each_axis(f, [&](std::size_t c) {
                    position[c] = f.x[c][k];
                    velocity[c] = f.v[c][k] + half * f.a[c][k];
                });
                record.p_over_rho_sq = law.pressure(rho, f.density, f.sound_speed) / (rho * rho);
                record.volume = f.mass / rho;
                f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[k])] = record;
            });
        },
        f.equation_of_state);
    update_images(f.clusters, f.domain);
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
    const double factor = length > most ? shift * most / length : shift;
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

} // namespace

void advance_fluid(SphFluid& f, double dt, std::int64_t step) {
    if (drift(f, 0.5 * dt)) renew_lists(f);
    fill_records(f, 0.5 * dt);
    evaluate_terms(f);
    add_sources(f, (static_cast<double>(step) - 0.5) * dt);
    correct(f, dt, step);
}

void start(SphFluid& f) {
    for_each_axis(f, [&](std::size_t c) { f.a[c].assign(f.slots(), 0.0); });
    f.drho.assign(f.slots(), 0.0);
    renew_lists(f);
    fill_records(f, 0.0);
    evaluate_terms(f);
    add_sources(f, 0.0);
}

} // namespace plumb
