// Smoothed particles and grains together: momentum, determinism, limits of the exchange, scenes.
#include "run/probes.hpp"
#include "schemes/simulation.hpp"

#include "fluid_fixtures.hpp"

#include <fmt/format.h>

#include <map>

using namespace plumb;
using namespace plumb::fixture;

namespace {

using Keys = std::map<std::string, std::string>;

/// Water and grains of 0.1 mm on a lattice, in a periodic cube of 1.6 mm; h = 0.2 mm.
std::string scene_text(const Keys& changes = {}) {
    std::map<std::string, Keys> tables{
        {"domain",
         {{"size", "[1.6e-3, 1.6e-3, 1.6e-3]"}, {"periodic", "[true, true, true]"}, {"gravity", "[1.0, 0.0, -9.81]"}}},
        {"fluid",
         {{"method", "\"sph\""},
          {"density", "1000.0"},
          {"viscosity", "8.9e-4"},
          {"spacing", "1.3333333333333333e-4"},
          {"smoothing", "1.5"},
          {"kernel", "\"wendland_c2\""},
          {"equation_of_state", "\"linear\""},
          {"sound_speed", "0.2"},
          {"pressure", "\"dynamic\""},
          {"operators", "\"plain\""},
          {"viscous_term", "\"morris\""},
          {"arrange", "\"lattice\""},
          {"initial", "\"rest\""}}},
        {"grains",
         {{"name", "\"grain\""},
          {"diameter", "1e-4"},
          {"density", "2500.0"},
          {"rotation", "false"},
          {"motion", "\"free\""},
          {"velocity", "[0.0, 0.0, 0.0]"},
          {"contact", "\"none\""},
          {"arrange",
           "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = [1.6e-3, 1.6e-3, 1.6e-3], "
           "spacing = 2e-4}"}}},
        {"coupling",
         {{"direction", "\"two_way\""},
          {"kernel", "\"wendland_c2\""},
          {"kernel_width", "{times_diameter = 2.0}"},
          {"fluid_mass", "\"displaced\""},
          {"drag", "\"di_felice\""},
          {"forces", "[\"buoyancy\", \"pressure_gradient\"]"},
          {"exchange", "\"exponential\""},
          {"mean_pressure_gradient", "\"balances_weight\""}}},
        {"time",
         {{"end", "1e-2"},
          {"output_interval", "1e-3"},
          {"integrator", "\"midpoint\""},
          {"step", "2e-4"},
          {"grain_step", "\"auto\""}}}};
    for (const auto& [key, value] : changes) {
        const std::size_t dot = key.find('.');
        tables[key.substr(0, dot)][key.substr(dot + 1)] = value;
    }
    std::string text;
    for (const auto& [name, keys] : tables) {
        text += fmt::format("[{}]\n", name);
        for (const auto& [key, value] : keys)
            if (!value.empty()) text += fmt::format("{} = {}\n", key, value);
    }
    return text;
}

struct Bench {
    Scene scene;
    Simulation simulation;
    explicit Bench(const std::string& text)
        : scene(scene_from_text(text, "scene.toml", "/")), simulation(make_simulation(scene)) {
        scene.root.finish();
    }
    explicit Bench(const Keys& changes = {}) : Bench(scene_text(changes)) {}
    SphFluid& fluid() { return simulation.sph.value(); }
    Grains& grains() { return simulation.grains.grains; }
};

/// Gives every grain another velocity, and the fluid a vortex.
void stir(Bench& bench) {
    Grains& g = bench.grains();
    const bool alike = has_block(bench.simulation.grains); // grains of a block have one velocity
    for (std::size_t k = 0; k < g.size(); ++k) {
        const double s = alike ? 1.0 : static_cast<double>(g.id[k]);
        g.v[k] = 3e-3 * Vec3(std::sin(s), std::cos(2.0 * s), std::sin(3.0 * s));
    }
    SphFluid& f = bench.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k)
        f.v[0][k] = 2e-3 * std::sin(2.0 * std::numbers::pi * f.x[1][k] / 1.6e-3);
}

Vec3 momentum(Bench& bench) {
    Vec3 sum = Vec3::Zero();
    const SphFluid& f = bench.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) sum += f.mass * f.share[k] * Vec3(f.v[0][k], f.v[1][k], f.v[2][k]);
    const Grains& g = bench.grains();
    for (std::size_t k = 0; k < g.size(); ++k) sum += g.mass[k] * g.v[k];
    return sum;
}

void expect_same_state(Bench& a, Bench& b) {
    expect_same_bits(a.fluid(), b.fluid());
    for (std::size_t k = 0; k < a.grains().size(); ++k) {
        ASSERT_EQ(a.grains().x[k], b.grains().x[k]);
        ASSERT_EQ(a.grains().v[k], b.grains().v[k]);
    }
}

} // namespace

// An exchange in which the fluid does not lose what the grains receive: sub-cycled, with contacts, blocks or any force.
TEST(Coupled, MomentumIsKept) {
    const std::string contact =
        "{law = \"linear_spring\", stiffness = 1e-3, restitution = 0.9, tangential_stiffness = 0.0, "
        "friction = 0.0}";
    for (const Keys& keys :
         {Keys{}, Keys{{"time.grain_step", "3e-5"}}, Keys{{"coupling.exchange", "\"implicit\""}},
          Keys{{"coupling.forces", "[\"buoyancy\", \"pressure_gradient\", \"virtual_mass\"]"}},
          Keys{{"grains.motion", "\"block\""}}, Keys{{"coupling.gather_width", "{times_diameter = 1.5}"}},
          Keys{{"fluid.operators", "\"variable_h\""}},
          Keys{{"fluid.operators", "\"variable_h\""}, {"coupling.fluid_mass", "\"pure\""}}}) {
        SCOPED_TRACE(keys.empty() ? "standard" : keys.begin()->first + " = " + keys.begin()->second);
        Bench bench(keys);
        stir(bench);
        const Vec3 before = momentum(bench);
        advance(bench.simulation, 20);
        const Grains& g = bench.grains();
        const double weight = 20.0 * 2e-4 * g.mass[0] * static_cast<double>(g.size()) * 9.81;
        EXPECT_LT((momentum(bench) - before).norm(), 1e-12 * weight);
    }
}

// A drag that pushes the fluid the wrong way or twice: the slip of a uniform lattice is that of the law.
TEST(Coupled, LatticeSlipsAsTheLawSays) {
    Bench bench(
        Keys{{"grains.arrange", "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = [1.6e-3, "
                                "1.6e-3, 1.6e-3], spacing = 1.3333333333333333e-4}"}}); // as the fluid's
    advance(bench.simulation, 100);
    const SphFluid& f = bench.fluid();
    const Grains& g = bench.grains();
    const double eps = 1.0 - static_cast<double>(g.size()) * sphere_volume(1e-4) / std::pow(1.6e-3, 3);
    const Vec3 slip = Vec3(f.v[0][0], f.v[1][0], f.v[2][0]) - g.v[0];
    const FluidOnGrains& fluid = *bench.simulation.fluid;
    // drag = eps times the weight less buoyancy: the mean pressure gradient carries the rest
    const double drag = drag_resistance(fluid.drag, 1000.0, 8.9e-4, 1e-4, eps, slip.norm()) * slip.norm();
    const double weight = 1500.0 * sphere_volume(1e-4) * Vec3(1.0, 0.0, -9.81).norm();
    EXPECT_NEAR(drag / (eps * weight), 1.0, 2e-3); // the kernel's sum over the lattice is not quite eps
    EXPECT_LT(slip.cross(Vec3(1.0, 0.0, -9.81)).norm(), 1e-6 * slip.norm() * 9.81);
}

// Grains a million times heavier than what they relax in: an exchange that overshoots makes both diverge.
TEST(Coupled, AnyLoadingIsStable) {
    for (const char* exchange : {"\"exponential\"", "\"implicit\""}) {
        Bench bench(Keys{{"fluid.density", "1.18"},
                         {"fluid.viscosity", "1.86e-5"},
                         {"fluid.sound_speed", "5.0"},
                         {"grains.density", "25000.0"},
                         {"domain.gravity", "[0.0, 0.0, 0.0]"},
                         {"coupling.mean_pressure_gradient", ""},
                         {"coupling.exchange", exchange},
                         {"time.step", "1e-5"}});
        for (Vec3& v : bench.grains().v) v = Vec3(0.1, 0.0, 0.0);
        for (int step = 0; step < 200; ++step) {
            advance(bench.simulation, 1);
            const SphFluid& f = bench.fluid();
            for (std::size_t k = 0; k < f.slots(); ++k) ASSERT_LT(f.v[0][k], 0.1001); // never faster than the grains
        }
        EXPECT_GT(bench.fluid().v[0][0], 0.0);
    }
}

TEST(Coupled, SameBitsForAnyNumberOfThreads) {
    for (const char* operators : {"\"plain\"", "\"variable_h\""}) {
        const Keys keys{{"fluid.operators", operators}};
        Bench one(keys), two(keys), four(keys);
        const auto run = [](Bench& bench, int n) {
            const Threads threads(n);
            stir(bench);
            advance(bench.simulation, 30);
        };
        run(one, 1), run(two, 2), run(four, 4);
        expect_same_state(one, two);
        expect_same_state(one, four);
    }
}

// One way: the fluid feels nothing of the grains but the room they take, which moves it to and fro.
TEST(Coupled, OneWayLeavesTheFluidAlone) {
    Bench bench(Keys{{"coupling.direction", "\"one_way\""}, {"coupling.mean_pressure_gradient", ""}});
    advance(bench.simulation, 20);
    const SphFluid& f = bench.fluid();
    double sum = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) sum += f.share[k] * f.v[2][k];
    EXPECT_LT(std::abs(sum) / static_cast<double>(f.particles), 1e-15);
    EXPECT_LT(bench.grains().v[0][2], -1e-3);
}

TEST(Coupled, BadScenesAreInputErrors) {
    const auto refused = [](const Keys& keys, std::initializer_list<std::string_view> parts) {
        SCOPED_TRACE(keys.begin()->first + " = " + keys.begin()->second);
        expect_error([&] { Bench bench(keys); }, parts);
    };
    refused({{"coupling.kernel_width", "1e-5"}}, {"coupling.kernel_width", "spacing"});
    refused({{"coupling.kernel_width", "{times_diameter = 6.0}"}}, {"domain.size", "twice the reach"});
    refused({{"coupling.kernel_width", "{times_radius = 6.0}"}}, {"coupling.kernel_width"});
    refused({{"coupling.direction", "\"both\""}}, {"coupling.direction", "two_way", "one_way"});
    refused({{"coupling.direction", ""}}, {"coupling.direction: missing"});
    refused({{"coupling.fluid_mass", ""}}, {"coupling.fluid_mass: missing"});
    refused({{"coupling.drag", "\"darcy\""}}, {"coupling.drag", "darcy", "di_felice"});
    refused({{"coupling.forces", "[\"saffman_mei\"]"}}, {"coupling.forces", "saffman_mei", "gradient"});
    refused({{"coupling.forces", "[\"buoyancy\"]"}}, {"coupling.mean_pressure_gradient", "pressure_gradient"});
    refused({{"fluid.pressure", "\"full\""}}, {"coupling.forces", "buoyancy", "full"});
    refused({{"fluid.operators", "\"corrected\""}}, {"coupling.direction", "plain"});
    refused({{"fluid.operators", "{law = \"variable_h\", greatest_growth = 1.01}"}},
            {"coupling.porosity_width", "eps", "greatest_growth = 1.08"});
    refused({{"fluid.operators", "{law = \"variable_h\", greatest_growth = 0.9}"}}, {"fluid.operators", "0.9"});
    refused({{"time.grain_step", ""}}, {"time.grain_step: missing"});
    refused({{"time.grain_step", "-1.0"}}, {"time.grain_step", "-1"});
    refused({{"grains.arrange", "\"none\""}}, {"grains"});
}
