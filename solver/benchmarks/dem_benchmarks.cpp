// Rates of the grain engine. Never bare times: grain steps and contacts per second of wall time.
#include "benchmarks/benchmark_scenes.hpp"
#include "core/parallel.hpp"
#include "run/touching.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <string>

namespace plumb {

namespace {

constexpr std::int64_t steps_per_iteration = 200; // about two renewals of the lists

using MakeSimulation = Simulation (*)();
using Clock = std::chrono::steady_clock;

/// Counters are divided by wall time here: Google Benchmark would divide by the CPU time of one thread, or add the kind
/// of time to the name.
void advance_repeatedly(benchmark::State& state, MakeSimulation make, int threads) {
    set_threads(threads);
    Simulation simulation = make();
    const auto grains = static_cast<double>(simulation.grains.grains.size());
    const auto contacts = static_cast<double>(touching_pairs(simulation.grains, simulation.timing.dt).size());
    advance(simulation, steps_per_iteration); // pages, caches and clock rate
    const Clock::time_point start = Clock::now();
    for (auto _ : state) advance(simulation, steps_per_iteration);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double steps = static_cast<double>(steps_per_iteration) * static_cast<double>(state.iterations());
    const Memory held = memory(simulation.grains);
    state.counters["grain_steps/s"] = steps * grains / seconds;
    state.counters["contacts/s"] = steps * contacts / seconds;
    state.counters["bytes_per_item"] = static_cast<double>(held.grains + held.pairs) / grains;
    state.counters["bytes_per_grain_alone"] = static_cast<double>(held.grains) / grains;
    state.counters["bytes_per_contact"] = static_cast<double>(held.pairs) / contacts;
    state.counters["contacts_per_grain"] = contacts / grains;
}

/// The thread count is part of the name; the threads are plumb's own, not Google Benchmark's.
bool register_all() {
    const std::pair<const char*, MakeSimulation> scenes[] = {{"dem_fcc/19652", pressed_lattice},
                                                             {"dem_bed/20000", settled_bed}};
    for (const auto& [name, make] : scenes)
        for (const int threads : {1, 2})
            benchmark::RegisterBenchmark(
                (std::string(name) + "/threads:" + std::to_string(threads)).c_str(),
                [make = make, threads](benchmark::State& state) { advance_repeatedly(state, make, threads); })
                ->Unit(benchmark::kMillisecond);
    return true;
}

const bool registered = register_all();

} // namespace

} // namespace plumb
