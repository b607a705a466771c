// The wake of a grain's own push: symbols, structure factors, the sums over waves, and what is left of it in a scene.
#include "coupling/self_disturbance.hpp"
#include "sph/symbols.hpp"

#include "coupled_fixtures.hpp"

#include <gtest/gtest.h>

using namespace plumb;
using namespace plumb::fixture;
using Bench = CoupledBench;

namespace {

constexpr double d = 1e-4, h = 2e-4, nu = 8.9e-7;
const double volume = std::numbers::pi / 6.0 * d * d * d;

SphFluid water(const ViscousTerm& term) {
    SphFluid f;
    f.density = 1000.0, f.viscosity = 1000.0 * nu, f.h = h, f.sound_speed = 1.0;
    f.viscous_term = term;
    return f;
}

OseenBrinkman law(const std::string& history, const std::string& advection, const std::string& structure) {
    toml::table keys = toml::parse(fmt::format(
        "law = 'oseen_brinkman'\nhistory = '{}'\nadvection = '{}'\nstructure = {}", history, advection, structure));
    Table table(keys, "coupling.self_disturbance", "scene.toml");
    return OseenBrinkman(table);
}

SelfDisturbance wake(const OseenBrinkman& law, std::size_t grains = 1) {
    SelfDisturbance self = self_disturbance(law, water(Morris{}), WendlandC2{}, {h, h, h}, KernelPorosity{}, d);
    self.memory.assign(grains * wake_size(), 0.0);
    return self;
}

/// After `steps` of dt with a constant push.
Vec3 velocity(SelfDisturbance self, const Push& push, double dt, int steps) {
    self.memory.assign(wake_size(), 0.0);
    for (int k = 0; k < steps; ++k) remember(self, {push}, dt);
    return own_fluid(self, 0, 0.0).u; // of no volume: without the backflow
}

} // namespace

TEST(Symbols, LongWavesDecayAsInTheFluid) {
    const double k = 0.05 / h;
    for (const ViscousTerm& term :
         {ViscousTerm(Morris{}), ViscousTerm(MonaghanGingold{}), ViscousTerm(DoubleGradient{})})
        EXPECT_NEAR(transverse_decay(water(term), k) / (nu * k * k), 1.0, 5e-4) << law_name(term);
    EXPECT_NEAR(transverse_decay(water(Cleary{}), k) / (nu * k * k), 0.992666, 5e-4); // its factor over theory's 10
    EXPECT_EQ(transverse_decay(water(Inviscid{}), k), 0.0);
}

// Integrals of Morris' term done elsewhere, with another rule: .984, .936, .772, .573 of nu k^2 at k h = .5, 1, 2, 3.
TEST(Symbols, MorrisTermIsWeakForShortWaves) {
    const std::array<double, 4> kh{0.5, 1.0, 2.0, 3.0}, ratio{0.984, 0.936, 0.772, 0.573};
    for (std::size_t n = 0; n < kh.size(); ++n) {
        const double k = kh[n] / h;
        EXPECT_NEAR(transverse_decay(water(Morris{}), k) / (nu * k * k), ratio[n], 6e-4);
    }
}

TEST(Symbols, TransformsAreOneLessTheVarianceOfTheKernel) {
    for (const Kernel& kernel :
         {Kernel(WendlandC2{}), Kernel(WendlandC4{}), Kernel(CubicSpline{}), Kernel(QuinticSpline{})}) {
        EXPECT_NEAR(kernel_transform(kernel, 0.0), 1.0, 1e-6);
        const double moment =
            std::visit([](const auto& one) { return second_moment<std::decay_t<decltype(one)>>(3); }, kernel);
        EXPECT_NEAR(1.0 - kernel_transform(kernel, 0.1), 0.005 * moment, 0.005 * moment * 2e-3) << law_name(kernel);
    }
}

// The compressibility of hard spheres, (1 - phi)^4/(1 + 2 phi)^2, and both ends of the lattice.
TEST(StructureFactors, TendToTheirLimits) {
    for (const double phi : {0.1, 0.3, 0.45}) {
        const OseenBrinkman one = law("steady", "none", fmt::format("{{law = 'percus_yevick', fraction = {}}}", phi));
        const auto& s = std::get<HardSpheres>(one.structure);
        EXPECT_NEAR(s(1e-3 / d, d), std::pow(1.0 - phi, 4) / std::pow(1.0 + 2.0 * phi, 2), 1e-4);
        EXPECT_NEAR(s(200.0 / d, d), 1.0, 1e-2);
    }
    const OseenBrinkman dilute = law("steady", "none", "{law = 'percus_yevick', fraction = 1e-9}");
    EXPECT_NEAR(std::get<HardSpheres>(dilute.structure)(1.0 / d, d), 1.0, 1e-6);
    const OseenBrinkman regular = law("steady", "none", "{law = 'lattice', fraction = 0.2}");
    const auto& s = std::get<LatticeOrder>(regular.structure);
    const double first = 2.0 * std::numbers::pi / std::cbrt(volume / 0.2);
    EXPECT_EQ(s(0.999 * first, d), 0.0);
    EXPECT_EQ(s(1.001 * first, d), 1.0);
}

// 0.608 d/h of Stokes' velocity with Morris' term (and 0.537 with nu k^2): integrals done elsewhere.
TEST(SelfDisturbance, SteadyCreepingWakeIsThatOfTheory) {
    const Push push{Vec3(0.0, 0.0, 1e-9), Vec3::Zero(), 0.0};
    const double stokes = 1e-9 / (3.0 * std::numbers::pi * 1000.0 * nu * d);
    const Vec3 u = velocity(wake(law("steady", "none", "'lone'")), push, 1e-4, 1);
    EXPECT_NEAR(u[2] / stokes, 0.608 * d / h, 0.608 * d / h * 3e-3);
    EXPECT_NEAR(u.head<2>().norm(), 0.0, 1e-15 * stokes);
    SelfDisturbance exact = self_disturbance(law("steady", "none", "'lone'"), water(DoubleGradient{}), WendlandC2{},
                                             {h, h, h}, KernelPorosity{}, d);
    EXPECT_NEAR(velocity(exact, push, 1e-4, 1)[2] / stokes, 0.537 * d / h, 0.537 * d / h * 3e-3);
}

// Share of its own volume that a grain sees: 0.0785 (d/h)^3.
TEST(SelfDisturbance, OwnVolume) {
    const SelfDisturbance self = wake(law("unsteady", "slip", "'lone'"));
    EXPECT_NEAR(volume * self.own_porosity, 0.0785 / 8.0, 0.0785 / 8.0 * 2e-3);
    EXPECT_NEAR(self.own_porosity, self.own_spread, 1e-12 * self.own_spread);
}

// A wake that grows under a constant push ends as the steady one, in creeping flow and with slip.
TEST(SelfDisturbance, UnsteadyWakeBecomesSteady) {
    for (const double slip : {0.0, 5e-3}) {
        const Push push{Vec3(0.0, 0.0, 1e-9), Vec3(0.0, 0.0, -slip), 0.0};
        const Vec3 last = velocity(wake(law("steady", "slip", "'lone'")), push, 1e-4, 1);
        const double time = 2000.0 * h * h / nu;
        const Vec3 u = velocity(wake(law("unsteady", "slip", "'lone'")), push, time / 40000.0, 40000);
        EXPECT_NEAR(u[2] / last[2], 1.0, slip == 0.0 ? 2e-2 : 3e-3); // the tail of creeping flow fades as 1/sqrt(t)
    }
}

// A step of the wake is exact for a constant push without slip, and second order with it.
TEST(SelfDisturbance, StepsOfAnyLength) {
    const OseenBrinkman one = law("unsteady", "slip", "'lone'");
    const Push still{Vec3(1e-9, 0.0, 0.0), Vec3::Zero(), 0.0}, moving{Vec3(1e-9, 0.0, 0.0), Vec3(-5e-3, 0.0, 0.0), 0.0};
    const double time = h * h / nu;
    const double fine = velocity(wake(one), still, time / 64.0, 64)[0];
    EXPECT_NEAR(velocity(wake(one), still, time, 1)[0], fine, 1e-12 * fine);
    const auto error = [&](int steps) {
        return std::abs(velocity(wake(one), moving, time / steps, steps)[0] /
                            velocity(wake(one), moving, time / 512, 512)[0] -
                        1.0);
    };
    EXPECT_GT(error(8) / error(16), 3.6);
    EXPECT_LT(error(16), 2e-2);
}

TEST(SelfDisturbance, TurnsWithItsFrame) {
    const Eigen::Quaterniond q = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
    const OseenBrinkman one = law("unsteady", "slip", "'lone'");
    const Push push{Vec3(1e-9, 3e-10, 0.0), Vec3(0.0, 0.0, -5e-3), 0.0};
    const Push turned{q * push.force, q * push.slip, 0.0};
    const Vec3 u = velocity(wake(one), push, 1e-3, 30), v = velocity(wake(one), turned, 1e-3, 30);
    EXPECT_LT((q * u - v).norm(), 1e-12 * u.norm());
    // across the slip a wake is carried off as well, but half of it stays pressure's share
    EXPECT_GT(u[0], 0.0);
}

// A lattice that the kernel does not resolve has nothing to take out; screening and neighbours weaken a wake.
TEST(SelfDisturbance, NeighboursWeakenIt) {
    const Push push{Vec3(0.0, 0.0, 1e-9), Vec3::Zero(), 0.0},
        screened{Vec3(0.0, 0.0, 1e-9), Vec3::Zero(), nu / (h * h)};
    const double lone = velocity(wake(law("steady", "none", "'lone'")), push, 1e-4, 1)[2];
    EXPECT_LT(velocity(wake(law("steady", "none", "{law = 'lattice', fraction = 0.2}")), push, 1e-4, 1)[2],
              2e-3 * lone);
    EXPECT_LT(velocity(wake(law("steady", "none", "{law = 'percus_yevick', fraction = 0.2}")), push, 1e-4, 1)[2],
              0.5 * lone);
    EXPECT_LT(velocity(wake(law("steady", "none", "'lone'")), screened, 1e-4, 1)[2], 0.7 * lone);
}

namespace {
const std::string corrected =
    "{law = \"oseen_brinkman\", history = \"unsteady\", advection = \"slip\", structure = \"lone\"}";
const Keys alone{{"grains.arrange", "{law = \"single\", position = [0.75e-3, 0.8e-3, 0.83e-3]}"},
                 {"domain.gravity", "[0.0, 0.0, -9.81]"},
                 {"fluid.sound_speed", "1.0"},
                 {"time.step", "5e-5"}};
Keys with(Keys keys, const std::string& key, const std::string& value) {
    keys[key] = value;
    return keys;
}
} // namespace

// A lone grain falls at the speed of its drag law in fluid at rest, not with its wake: ten relaxation times. The walls
// of a wrong sign, a lost factor or a second pressure force are 5 % and more apart.
TEST(SelfDisturbance, CorrectedGrainFallsAsTheLawSays) {
    const auto speed = [&](const std::string& correction) {
        Bench bench(with(alone, "coupling.self_disturbance", correction));
        advance(bench.simulation, 320);
        return -bench.grains().v[0][2];
    };
    const double u_t = 7.609e-3; // Di Felice, this grain in water
    EXPECT_NEAR(speed(corrected) / u_t, 1.0, 5e-3);
    EXPECT_GT(speed("\"none\"") / u_t, 1.04);
}

TEST(SelfDisturbance, KeepsMomentumAndBits) { expect_momentum_and_bits({{"coupling.self_disturbance", corrected}}); }

TEST(SelfDisturbance, BadScenesAreInputErrors) {
    const auto refused = [](Keys keys, std::initializer_list<std::string_view> parts) {
        if (keys.count("coupling.self_disturbance") == 0) keys["coupling.self_disturbance"] = corrected;
        expect_error([&] { Bench bench(keys); }, parts);
    };
    refused({{"coupling.direction", "\"one_way\""}, {"coupling.mean_pressure_gradient", ""}},
            {"coupling.self_disturbance", "wake"});
    refused({{"coupling.self_disturbance", "\"oseen_brinkman\""}}, {"coupling.self_disturbance.history: missing"});
    refused({{"coupling.self_disturbance", "\"stokeslet\""}}, {"coupling.self_disturbance", "oseen_brinkman", "none"});
    refused({{"fluid.viscous_term", "\"none\""}, {"fluid.viscosity", "0.0"}}, {"coupling.self_disturbance", "viscous"});
}
