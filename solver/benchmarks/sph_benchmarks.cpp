// Rates of the smoothed particles: particle updates (particles times evaluations) and unordered pairs per second.
#include "core/parallel.hpp"
#include "schemes/advance_fluid.hpp"
#include "sph/arrange_fluid.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

namespace plumb {

namespace {

using Clock = std::chrono::steady_clock;

/// A periodic box of n^d particles of 1/n spacing, jitter 0.1 dx, a vortex, h = smoothing dx, water-like numbers.
SphFluid box(int dimensions, int n, double smoothing, bool extras) {
    SphFluid f;
    f.dimensions = dimensions;
    f.domain.size = Vec3(1.0, 1.0, dimensions == 3 ? 1.0 : 0.0);
    f.domain.periodic = {true, true, dimensions == 3};
    f.density = 1.0, f.viscosity = 0.01, f.sound_speed = 10.0;
    f.spacing = 1.0 / n, f.h = smoothing * f.spacing;
    f.mass = f.density * std::pow(f.spacing, dimensions);
    f.viscous_term = Morris(term_scales(f));
    if (extras) {
        f.extras.diffusion = 2.0 * 0.1 * f.h * f.sound_speed;
        f.shifting = 4.0 * f.h * 1.0;
    }
    fill_box(f, 0.1, 1);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const double x = 2.0 * std::numbers::pi * f.x[0][k], y = 2.0 * std::numbers::pi * f.x[1][k];
        f.v[0][k] = std::sin(x) * std::cos(y);
        f.v[1][k] = -std::cos(x) * std::sin(y);
    }
    f.clusters.reach = support(f.kernel) * f.h;
    f.clusters.skin = 0.25 * f.spacing;
    start(f);
    return f;
}

double unordered_pairs(const SphFluid& f) {
    double pairs = 0.0;
    const double reach_sq = f.clusters.reach * f.clusters.reach;
    for (std::size_t k = 0; k < f.slots(); ++k) {
        if (f.id[k] < 0) continue;
        const FluidRecord& a = f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[k])];
        const std::size_t cluster = k / pack_width;
        for (const std::int32_t record : f.clusters.near(cluster)) {
            const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
            const double dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
            const double r_sq = dx * dx + dy * dy + dz * dz;
            if (r_sq < reach_sq && r_sq > 0.0) pairs += 0.5;
        }
    }
    return pairs;
}

template <class T> double bytes(const T& v) {
    return static_cast<double>(v.capacity() * sizeof(typename T::value_type));
}

double held_bytes(const SphFluid& f) {
    double sum = bytes(f.rho) + bytes(f.drho) + bytes(f.drho_spread) + bytes(f.drho_before) + bytes(f.completeness) +
                 bytes(f.spare) + bytes(f.id);
    for (const VectorField* field : {&f.x, &f.v, &f.a, &f.a_before, &f.spread, &f.dv_spread, &f.x_listed})
        for (const auto& component : *field) sum += bytes(component);
    const FluidClusters& c = f.clusters;
    for (const auto& part : c.lists.parts) sum += bytes(part);
    for (const auto& x : c.grid.x) sum += bytes(x);
    return sum + bytes(c.grid.begin) + bytes(c.grid.bin_begin) + bytes(c.lists.part_end) + bytes(c.records) +
           bytes(c.record_of) + bytes(c.image_of) + bytes(c.image_shift);
}

void advance_repeatedly(benchmark::State& state, int dimensions, int n, double smoothing, bool extras, int threads) {
    set_threads(threads);
    SphFluid f = box(dimensions, n, smoothing, extras);
    const auto particles = static_cast<double>(f.particles);
    const double pairs = unordered_pairs(f), dt = 0.25 * f.h / (f.sound_speed + 1.0);
    std::int64_t step = 0;
    for (int warm = 0; warm < 3; ++warm) advance_fluid(f, dt, ++step);
    const Clock::time_point begin = Clock::now();
    constexpr int steps_per_iteration = 20;
    for (auto _ : state)
        for (int s = 0; s < steps_per_iteration; ++s) advance_fluid(f, dt, ++step);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    const double evaluations = steps_per_iteration * static_cast<double>(state.iterations());
    state.counters["particle_updates/s"] = evaluations * particles / seconds;
    state.counters["pairs/s"] = evaluations * pairs / seconds;
    state.counters["pairs_per_particle"] = pairs / particles;
    state.counters["bytes_per_item"] = held_bytes(f) / particles;
}

void find_neighbours(benchmark::State& state, int threads) {
    set_threads(threads);
    SphFluid f = box(3, 64, 1.3, false);
    const auto particles = static_cast<double>(f.particles);
    const Clock::time_point begin = Clock::now();
    for (auto _ : state) renew_lists(f);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    state.counters["particle_updates/s"] = static_cast<double>(state.iterations()) * particles / seconds;
    state.counters["bytes_per_item"] = held_bytes(f) / particles;
}

bool register_all() {
    struct Box {
        const char* name;
        int dimensions, n;
        double smoothing;
        bool extras;
    };
    for (const Box& b : {Box{"sph_box_h13/262144", 3, 64, 1.3, false}, Box{"sph_box_h15/262144", 3, 64, 1.5, false},
                         Box{"sph_box_h13_diffusion_shifting/262144", 3, 64, 1.3, true},
                         Box{"sph_plane_h13/262144", 2, 512, 1.3, false}})
        for (const int threads : {1, 2})
            benchmark::RegisterBenchmark((std::string(b.name) + "/threads:" + std::to_string(threads)).c_str(),
                                         [b, threads](benchmark::State& state) {
                                             advance_repeatedly(state, b.dimensions, b.n, b.smoothing, b.extras,
                                                                threads);
                                         })
                ->Unit(benchmark::kMillisecond);
    for (const int threads : {1, 2})
        benchmark::RegisterBenchmark(("neighbours/262144/threads:" + std::to_string(threads)).c_str(),
                                     [threads](benchmark::State& state) { find_neighbours(state, threads); })
            ->Unit(benchmark::kMillisecond);
    return true;
}

const bool registered = register_all();

} // namespace

} // namespace plumb
