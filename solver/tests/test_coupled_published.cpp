// The published scene of one grain: whole pressure, a free surface over a floor, particles of one mass, smoothing
// lengths that follow the density.
#include "core/sphere.hpp"

#include "checkpoint_scenes.hpp"
#include "fluid_fixtures.hpp"
#include "scene_bench.hpp"

#include <utility>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double density = 1150.0, viscosity = 8.9e-3, diameter = 1e-4, gravity = 9.81, depth = 2.8e-3, sound = 3.0;

/// The scene on an even lattice, with other values.
std::string scene_with(std::initializer_list<std::pair<std::string, std::string>> changes) {
    std::string text = checkpoint_scenes::published;
    const auto put = [&](const std::string& old, const std::string& now) {
        const std::size_t at = text.find(old);
        if (at == std::string::npos) throw std::invalid_argument(old);
        text.replace(at, old.size(), now);
    };
    put("{law = \"jittered\", jitter = 0.1, seed = 1}", "\"lattice\"");
    for (const auto& [old, now] : changes) put(old, now);
    return text;
}

/// Mean of value(bench) over the steps of eight periods of the slowest sound, a quarter wave between floor and surface.
template <class Value> double mean_over_sound(Bench& bench, Value&& value) {
    const std::int64_t steps = std::llround(8 * 4.0 * depth / sound / bench.simulation.timing.dt);
    double sum = 0.0;
    for (std::int64_t k = 0; k < steps; ++k) {
        advance(bench.simulation, 1);
        sum += value(bench);
    }
    return sum / static_cast<double>(steps);
}

} // namespace

// Buoyancy that is not there, counted twice, or made of the superficial density. The fluid is at rest but for its
// sound, so that the gathered stress is its weight on average, whatever the error of the sums' gradient. Of sound with
// a sixth of the weight the mean over n periods of the slowest leaves 1/(12 pi n) at most.
TEST(PublishedScene, BuoyancyOfAHeldGrain) {
    for (const char* operators : {"variable_h", "plain"}) {
        Bench bench(scene_with({{"variable_h", operators}, {"\"free\"", "\"fixed\""}}));
        const double force = mean_over_sound(bench, [](Bench& b) {
            const FluidOnGrains& f = *b.simulation.fluid;
            return f.last_fluid_force[0][2] - f.last_drag[0][2];
        });
        EXPECT_NEAR(force / (density * sphere_volume(diameter) * gravity), 1.0, 0.01) << operators;
    }
}

// The same for a grain that may move: it would fall with 46 % of the speed below without its buoyancy.
TEST(PublishedScene, NeutrallyBuoyantGrainStays) {
    Bench bench(scene_with({{"density = 2500.0", "density = 1150.0"}}));
    const double v = mean_over_sound(bench, [](Bench& b) { return b.grains().v[0][2]; });
    const double speed = density * sphere_volume(diameter) * gravity / (3.0 * std::numbers::pi * viscosity * diameter);
    EXPECT_LT(std::abs(v), 0.01 * speed);
}

// Particles of one mass are compressed by the grain: what they weigh is what they would without it.
TEST(PublishedScene, PureFluidHasTheMassOfItsLattice) {
    Bench bench(scene_with({}));
    for (const double share : bench.fluid().share) ASSERT_EQ(share, 1.0);
    Bench displaced(scene_with({{"\"pure\"", "\"displaced\""}}));
    double missing = 0.0;
    for (const std::size_t k : slots_by_id(displaced.fluid()))
        missing += displaced.fluid().mass * (1.0 - displaced.fluid().share[k]);
    // The lattice's own sum of the kernel, which is not quite 1.
    EXPECT_NEAR(missing / (density * sphere_volume(diameter)), 1.0, 0.03);
}

// An exchange that is the same whether the grain has a limit or not: the explicit one, and it alone, has one here.
TEST(PublishedScene, ExplicitExchangeLimitsTheStep) {
    const auto limit_of = [](const std::string& exchange) {
        Bench bench(scene_with({{"\"explicit\"", exchange}}));
        for (const StepLimit& limit : bench.simulation.timing.limits)
            if (limit.name == "drag") return limit.seconds;
        return 0.0;
    };
    EXPECT_EQ(limit_of("\"exponential\""), 0.0);
    const double tau = 2500.0 * diameter * diameter / (18.0 * viscosity);
    EXPECT_NEAR(limit_of("\"explicit\"") / (2.0 * tau), 1.0, 0.1); // Di Felice's 0.96, and the grain's own porosity
}
