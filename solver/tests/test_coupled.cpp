// Smoothed particles and grains together: momentum, determinism, limits of the exchange, scenes.
#include "coupled_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;
using Bench = CoupledBench;

// An exchange in which the fluid does not lose what the grains receive: sub-cycled, with contacts, blocks or any force.
TEST(Coupled, MomentumIsKept) {
    const std::string contact =
        "{law = \"linear_spring\", stiffness = 1e-3, restitution = 0.9, tangential_stiffness = 0.0, "
        "friction = 0.0}";
    for (const Keys& keys :
         {Keys{}, Keys{{"time.grain_step", "3e-5"}}, Keys{{"coupling.exchange", "\"implicit\""}},
          Keys{{"time.integrator", "\"damped_midpoint\""}},
          Keys{{"coupling.forces", "[\"buoyancy\", \"pressure_gradient\", \"virtual_mass\"]"}},
          Keys{{"coupling.forces", "[\"buoyancy\", \"pressure_gradient\", \"saffman_mei\"]"}},
          Keys{{"coupling.forces", "[\"buoyancy\", \"pressure_gradient\", \"li_ahmadi\"]"},
               {"time.grain_step", "3e-5"}},
          Keys{{"coupling.porosity", "\"overlap\""}, {"coupling.own_volume", "\"excluded\""}},
          Keys{{"coupling.porosity", "\"deconvolved\""}, {"coupling.porosity_width", "{times_diameter = 1.5}"}},
          Keys{{"grains.motion", "\"block\""}}, Keys{{"coupling.gather_width", "{times_diameter = 1.5}"}},
          Keys{{"fluid.operators", "\"variable_h\""}},
          Keys{{"fluid.operators", "\"variable_h\""}, {"coupling.fluid_mass", "\"pure\""}}}) {
        SCOPED_TRACE(keys.empty() ? "standard" : keys.begin()->first + " = " + keys.begin()->second);
        Bench bench(keys);
        expect_momentum(bench);
    }
}

// Lift of the shear that is there, not of none or of its transpose: where the fluid's velocity is U sin(k y) along x, a
// grain that lags it along x is lifted along y and nowhere else, towards the faster side.
TEST(Coupled, ShearLiftsGrains) {
    Bench bench(Keys{{"coupling.forces", "[\"pressure_gradient\", \"saffman_mei\"]"},
                     {"coupling.mean_pressure_gradient", ""},
                     {"domain.gravity", "[0.0, 0.0, 0.0]"},
                     {"grains.arrange", "{law = \"single\", position = [0.8e-3, 0.1e-3, 0.8e-3]}"}});
    stir(bench);
    bench.grains().v[0] = Vec3::Zero(); // the fluid: about 2e-3 m/s sin(pi/8), growing with y
    advance(bench.simulation, 1);
    const FluidOnGrains& fluid = *bench.simulation.fluid;
    const double shear = 2e-3 * 2.0 * std::numbers::pi / 1.6e-3 * std::cos(std::numbers::pi / 8.0);
    const Eigen::Matrix3d gradient = fluid.at_grains.gradient[0];
    EXPECT_GT(gradient(0, 1), 0.7 * shear); // smoothed: a kernel of variance s takes exp(-k^2 s/2), s < 0.4 h^2
    EXPECT_LT(gradient(0, 1), shear);
    EXPECT_LT(gradient.norm(), 1.05 * gradient(0, 1));
    EXPECT_GT(bench.grains().v[0].y(), 0.0);
    EXPECT_LT(std::abs(bench.grains().v[0].z()), 0.1 * bench.grains().v[0].y());
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
    for (const Keys& keys : {Keys{{"coupling.forces", "[\"buoyancy\", \"pressure_gradient\", \"saffman_mei\"]"},
                                  {"coupling.porosity", "\"overlap\""},
                                  {"coupling.own_volume", "\"excluded\""}},
                             Keys{{"fluid.operators", "\"variable_h\""}}}) {
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

// Drag beside other forces is exchanged to second order too: the fluid's velocity in the middle of a step knows what
// all of them took from it. Halving the step quarters the change.
TEST(Coupled, ExchangeIsOfSecondOrder) {
    for (const char* motion : {"\"free\"", "\"fixed\""}) {
        const auto speed = [&](int steps) {
            Bench bench(
                Keys{{"grains.motion", motion},
                     {"grains.arrange", "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = "
                                        "[1.6e-3, 1.6e-3, 1.6e-3], spacing = 1.3333333333333333e-4}"},
                     {"coupling.forces", "[\"pressure_gradient\"]"},
                     {"coupling.mean_pressure_gradient", "[0.0, 0.0, -4000.0]"},
                     {"fluid.sound_speed", "1.0"},
                     {"time.step", fmt::format("{:.17g}", 8e-4 / steps)},
                     {"time.output_interval", "8e-4"},
                     {"time.end", "8e-4"}});
            advance(bench.simulation, steps);
            return bench.fluid().v[2][0];
        };
        const double coarse = speed(16), middle = speed(32), fine = speed(64);
        EXPECT_GT((coarse - middle) / (middle - fine), 3.4) << motion;
        EXPECT_LT((coarse - middle) / (middle - fine), 4.6) << motion;
    }
}

// A grain with no particle in reach falls freely: neither drag of a fluid that is not there nor its buoyancy.
TEST(Coupled, GrainsWithoutFluidFallFreely) {
    const Keys keys{{"domain.size", "[1.6e-3, 1.6e-3, 4e-3]"},
                    {"domain.periodic", "[true, true, false]"},
                    {"domain.gravity", "[0.0, 0.0, -9.81]"},
                    {"fluid.pressure", "\"full\""},
                    {"fluid.free_surface", "true"},
                    {"fluid.fill", "{law = \"box\", lower = [0.0, 0.0, 0.0], upper = [1.6e-3, 1.6e-3, 1.6e-3]}"},
                    {"grains.arrange", "{law = \"single\", position = [0.8e-3, 0.8e-3, 3.5e-3]}"},
                    {"coupling.forces", "[\"pressure_gradient\"]"},
                    {"coupling.mean_pressure_gradient", ""}};
    Bench bench(coupled_scene_text(keys) + "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0.0, 0.0, 0.0]\n"
                                           "normal = [0.0, 0.0, 1.0]\nslip = \"no_slip\"\ncontact = \"none\"\n");
    advance(bench.simulation, 10);
    EXPECT_NEAR(bench.grains().v[0][2], -9.81 * 10 * 2e-4, 1e-15);
    EXPECT_EQ(bench.simulation.fluid->range_use.dry, 10);
}

// The friction of a particle acts on the mass that it has.
TEST(Coupled, ViscousLimitKnowsThePorosity) {
    const auto limit = [](const char* mass) {
        Bench bench(Keys{{"coupling.fluid_mass", mass},
                         {"grains.arrange", "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = "
                                            "[1.6e-3, 1.6e-3, 1.6e-3], spacing = 1.3333333333333333e-4}"}});
        for (const StepLimit& one : bench.simulation.timing.limits)
            if (one.name == "viscous") return one.seconds;
        return 0.0;
    };
    const double eps = 1.0 - sphere_volume(1e-4) / std::pow(1.6e-3 / 12.0, 3);
    EXPECT_NEAR(limit("\"displaced\"") / limit("\"pure\""), eps, 1e-3);
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
    refused({{"coupling.porosity", "\"median\""}}, {"coupling.porosity", "median", "overlap"});
    refused({{"coupling.porosity", "\"deconvolved\""}}, {"domain.size", "twice the reach"});
    refused({{"coupling.own_volume", "\"none\""}}, {"coupling.own_volume", "excluded"});
    refused({{"coupling.self_disturbance",
              "{law = \"oseen_brinkman\", history = \"steady\", advection = \"slip\", structure = \"lone\"}"},
             {"coupling.own_volume", "\"excluded\""}},
            {"coupling.own_volume", "self_disturbance"});
    refused({{"coupling.direction", "\"both\""}}, {"coupling.direction", "two_way", "one_way"});
    refused({{"coupling.direction", ""}}, {"coupling.direction: missing"});
    for (const std::string key :
         {"fluid_mass", "porosity", "own_volume", "self_disturbance", "suspension_viscosity"}) // no hidden default
        refused({{"coupling." + key, ""}}, {("coupling." + key + ": missing").c_str()});
    refused({{"coupling.drag", "\"darcy\""}}, {"coupling.drag", "darcy", "di_felice"});
    refused({{"coupling.forces", "[\"buoyancy\"]"}}, {"coupling.mean_pressure_gradient", "pressure_gradient"});
    refused({{"coupling.direction", "\"one_way\""}}, {"coupling.mean_pressure_gradient", "one_way", "vector"});
    refused({{"fluid.pressure", "\"full\""}}, {"coupling.forces", "buoyancy", "full"});
    refused({{"coupling.forces", "[\"pressure_gradient\", \"virtual_mass\"]"}, {"fluid.pressure", "\"full\""}},
            {"coupling.forces", "virtual_mass", "weight"});
    refused({{"fluid.operators", "\"corrected\""}}, {"coupling.direction", "corrected"});
    refused({{"fluid.operators", "{law = \"variable_h\", greatest_growth = 1.01}"}},
            {"coupling.porosity_width", "eps", "greatest_growth = 1.08"});
    refused({{"fluid.operators", "{law = \"variable_h\", greatest_growth = 0.9}"}}, {"fluid.operators", "0.9"});
    refused({{"fluid.density_diffusion", "0.1"}, {"fluid.operators", "{law = \"variable_h\", greatest_growth = 1.3}"}},
            {"coupling.direction", "density_diffusion", "variable_h"});
    refused({{"time.grain_step", ""}}, {"time.grain_step: missing"});
    refused({{"time.grain_step", "-1.0"}}, {"time.grain_step", "-1"});
    refused({{"grains.arrange", "\"none\""}}, {"grains"});
}
