// Rates of the coupling's sums: weights of the matrix P per second.
#include "core/parallel.hpp"
#include "core/random.hpp"
#include "coupling/weights.hpp"
#include "sph/arrange_fluid.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <string>

namespace plumb {

namespace {

using Clock = std::chrono::steady_clock;

/// A periodic box of n^3 particles of 1/n spacing, h = 1.5 spacings, jitter 0.1 dx, and 100 000 grains at random
/// places, which take a fifth of the room.
struct Scene {
    SphFluid fluid;
    Weights weights;
    GrainPlaces grains;
    std::vector<double> mass;
    std::vector<Vec3> force;
    GatheredFluid at_grains;

    explicit Scene(int n) {
        constexpr std::size_t count = 100'000;
        fluid.dimensions = 3;
        fluid.domain.size = Vec3::Ones();
        fluid.domain.periodic = {true, true, true};
        fluid.density = 1.0, fluid.viscosity = 0.01, fluid.sound_speed = 10.0;
        fluid.spacing = 1.0 / n, fluid.h = 1.5 * fluid.spacing;
        fluid.mass = std::pow(fluid.spacing, 3);
        fill_box(fluid, 0.1, 1);
        fluid.share.assign(fluid.slots(), 1.0);
        fluid.clusters.reach = support(fluid.kernel) * fluid.h;
        fluid.clusters.skin = 0.25 * fluid.spacing;
        weights.h = {fluid.h, fluid.h, fluid.h};
        fluid.clusters.images = fluid.clusters.reach;
        renew_lists(fluid);
        Random random(2);
        for (std::size_t j = 0; j < count; ++j) {
            grains.x.emplace_back(random.uniform(), random.uniform(), random.uniform());
            grains.volume.push_back(0.2 / static_cast<double>(count));
        }
        mass.assign(count, 1.0 / static_cast<double>(count));
        force.assign(count, Vec3(0.0, 0.0, 1.0));
        renew_weights(weights, fluid, grains);
    }

    /// Weights that are not zero: pairs of a grain and a particle within the kernel's reach.
    double count() const {
        const double reach = support(weights.kernel) * weights.h.spread;
        const double in_reach = 4.0 / 3.0 * 3.14159265358979 * reach * reach * reach;
        return static_cast<double>(grains.size()) * in_reach / fluid.mass * fluid.density;
    }
};

/// What one step of a two-way scene does with P: build it, gather and scatter. In steps between renewals of the lists
/// grains are put where they are, S_j and porosity are summed, the fluid is gathered (with the load: two more passes)
/// and the forces are spread.
void couple_repeatedly(benchmark::State& state, int n, int threads) {
    set_threads(threads);
    Scene s(n);
    const Clock::time_point begin = Clock::now();
    for (auto _ : state) {
        place_grains(s.weights, s.fluid.domain, s.grains);
        set_porosity(s.fluid, s.weights);
        gather(s.weights, s.fluid, s.mass, true, s.at_grains);
        spread(s.fluid, s.weights, s.force);
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    // built, gathered, scattered: three uses of each weight; that the load takes two more is not counted
    state.counters["weights/s"] = 3.0 * static_cast<double>(state.iterations()) * s.count() / seconds;
    state.counters["weights_per_grain"] = s.count() / static_cast<double>(s.grains.size());
}

/// New lists of who is near whom.
void list_repeatedly(benchmark::State& state, int n, int threads) {
    set_threads(threads);
    Scene s(n);
    const Clock::time_point begin = Clock::now();
    for (auto _ : state) renew_weights(s.weights, s.fluid, s.grains);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    state.counters["weights/s"] = static_cast<double>(state.iterations()) * s.count() / seconds;
    state.counters["weights_per_grain"] = s.count() / static_cast<double>(s.grains.size());
}

bool register_all() {
    struct Box {
        const char* name;
        int n;
    };
    // 10 and 0.1 grains per particle
    for (const Box& b : {Box{"coupled_dense", 22}, Box{"coupled_dilute", 100}})
        for (const int threads : {1, 2}) {
            const std::string tail = "/100000/threads:" + std::to_string(threads);
            benchmark::RegisterBenchmark((b.name + tail).c_str(), [b, threads](benchmark::State& s) {
                couple_repeatedly(s, b.n, threads);
            })->Unit(benchmark::kMillisecond);
            benchmark::RegisterBenchmark((std::string(b.name) + "_lists" + tail).c_str(), [b, threads](
                                                                                              benchmark::State& s) {
                list_repeatedly(s, b.n, threads);
            })->Unit(benchmark::kMillisecond);
        }
    return true;
}

const bool registered = register_all();

} // namespace

} // namespace plumb
