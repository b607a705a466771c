// Rates of the fluid on a grid, without and with grains: cells and grain steps per second of wall time, a whole step
// with its projection, and with all that a grain costs.
#include "benchmarks/benchmark_scenes.hpp"
#include "core/parallel.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <string>

namespace plumb {

namespace {

constexpr std::int64_t first_steps = 5; // pages and caches are warm, two steps are known

using Clock = std::chrono::steady_clock;

void step_repeatedly(benchmark::State& state, int threads) {
    set_threads(threads);
    Simulation simulation = driven_cavity();
    const auto cells = static_cast<double>(simulation.grid->unknown_pressures);
    advance(simulation, first_steps);
    const std::int64_t iterations = simulation.grid->iterations;
    const Clock::time_point start = Clock::now();
    for (auto _ : state) advance(simulation, 1);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const auto steps = static_cast<double>(state.iterations());
    state.counters["cells/s"] = steps * cells / seconds;
    state.counters["iterations_per_step"] = static_cast<double>(simulation.grid->iterations - iterations) / steps;
}

/// Each step with the thousand steps of its grains and the grains that are injected before it.
void step_mud_cake(benchmark::State& state) {
    set_threads(1);
    Simulation simulation = mud_cake();
    const auto cells = static_cast<double>(simulation.grid->unknown_pressures);
    const std::int64_t iterations = simulation.grid->iterations;
    double grain_steps = 0.0;
    const Clock::time_point start = Clock::now();
    for (auto _ : state) {
        advance(simulation, 1);
        grain_steps += static_cast<double>(simulation.grains.grains.size()) *
                       static_cast<double>(simulation.grid_coupling->grain_steps);
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const auto steps = static_cast<double>(state.iterations());
    state.counters["grain_steps/s"] = grain_steps / seconds;
    state.counters["cells/s"] = steps * cells / seconds;
    state.counters["grains"] = grain_steps / steps / static_cast<double>(simulation.grid_coupling->grain_steps);
    state.counters["iterations_per_step"] = static_cast<double>(simulation.grid->iterations - iterations) / steps;
}

bool register_all() {
    benchmark::RegisterBenchmark("mud_cake_step/threads:1", step_mud_cake)->Unit(benchmark::kMillisecond);
    for (const int threads : {1, 2})
        benchmark::RegisterBenchmark(("grid_step/1048576/threads:" + std::to_string(threads)).c_str(),
                                     [threads](benchmark::State& state) { step_repeatedly(state, threads); })
            ->Unit(benchmark::kMillisecond);
    return true;
}

const bool registered = register_all();

} // namespace

} // namespace plumb
