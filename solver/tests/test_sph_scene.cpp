// Scenes with fluid.method = "sph": what they mean, what is refused, their step limits and initial state.
#include "core/initial_fields.hpp"
#include "run/probes.hpp"
#include "schemes/simulation.hpp"
#include "schemes/sph_scene.hpp"
#include "sph/arrange_fluid.hpp"

#include "sph_scene_fixtures.hpp"

#include <algorithm>

using namespace plumb;
using namespace plumb::fixture;
using namespace plumb::fixture::sph_scene;

namespace {

double seconds_of(const std::vector<StepLimit>& limits, std::string_view name) {
    const auto found = std::find_if(limits.begin(), limits.end(), [&](const StepLimit& l) { return l.name == name; });
    return found == limits.end() ? -1.0 : found->seconds;
}

Vec3 position(const SphFluid& f, std::int32_t id) {
    return entry(f, f.x, slots_by_id(f)[static_cast<std::size_t>(id)]);
}

} // namespace

// Numbers that end up in the wrong place, lengths in spacings taken for metres, a mass of the wrong dimension.
TEST(SphScene, NumbersAreThoseOfTheTable) {
    for (const int d : {2, 3}) {
        Bench bench(scene_text(d));
        const SphFluid& f = bench.fluid();
        EXPECT_EQ(f.dimensions, d);
        EXPECT_EQ(f.particles, d == 2 ? 320U : 3840U);
        EXPECT_NEAR(f.h, 0.075, 1e-15);
        EXPECT_NEAR(f.mass, d == 2 ? 2.5 : 0.125, 1e-12);
        EXPECT_NEAR(f.clusters.reach, 0.15, 1e-15);
        EXPECT_EQ(f.sound_speed, 20.0);
        EXPECT_EQ(f.viscosity, 0.1);
        EXPECT_EQ(f.body_force, d == 2 ? Vec3(0.0, -9.81, 0.0) : Vec3(0.0, 0.0, -9.81));
        EXPECT_TRUE(std::holds_alternative<WendlandC2>(f.kernel));
        EXPECT_TRUE(std::holds_alternative<Tait>(f.equation_of_state));
        EXPECT_TRUE(std::holds_alternative<Morris>(f.viscous_term));
        EXPECT_TRUE(f.extras.idle());
        EXPECT_EQ(bench.simulation.timing.dt, 1e-4);
        EXPECT_LT((position(f, 0) - Vec3(0.025, 0.025, d == 2 ? 0.0 : 0.025)).norm(), 1e-15); // ids along x first
        EXPECT_LT((position(f, 23) - Vec3(0.175, 0.075, d == 2 ? 0.0 : 0.025)).norm(), 1e-15);
        advance(bench.simulation, 3);
        EXPECT_EQ(bench.simulation.grains.step, 3);
        const Vec3 fall = 3e-4 * f.body_force; // a lattice under no pressure falls freely
        EXPECT_LT((entry(f, f.v, 5) - fall).norm(), 1e-13);
    }
}

// Every law can be named; optional terms get the coefficients of their formulas.
TEST(SphScene, LawsAndExtras) {
    for_each_law<Kernel>([](auto law) {
        Bench bench(scene_text(2, {{"kernel", '"' + std::string(law.name) + '"'}}));
        EXPECT_EQ(law_name(bench.fluid().kernel), law.name);
        EXPECT_NEAR(bench.fluid().clusters.reach, law.support * 0.075, 1e-15);
    });
    for_each_law<EquationOfState>([](auto law) {
        Bench bench(scene_text(2, {{"equation_of_state", '"' + std::string(law.name) + '"'}}));
        EXPECT_EQ(law_name(bench.fluid().equation_of_state), law.name);
    });
    for_each_law<PairViscousTerm>([](auto law) {
        const Keys keys{{"viscous_term", '"' + std::string(law.name) + '"'},
                        {"viscosity", law.name == "none" ? "0.0" : "0.1"}};
        Bench bench(scene_text(3, keys));
        EXPECT_EQ(law_name(bench.fluid().viscous_term), law.name);
    });
    Bench bench(scene_text(2, {{"density_diffusion", "0.1"}, {"artificial_viscosity", "0.02"}}));
    const Extras& extras = bench.fluid().extras;
    EXPECT_NEAR(extras.diffusion, 2.0 * 0.1 * 0.075 * 20.0, 1e-14);
    EXPECT_NEAR(extras.artificial, 0.02 * 20.0 * 0.075 / 2.5, 1e-14);
    EXPECT_NEAR(extras.softening_sq, 0.01 * 0.075 * 0.075, 1e-18);
    EXPECT_EQ(bench.fluid().shifting, 0.0);
    Bench shifted(scene_text(3, {{"shifting", "4.0"}, {"reference_velocity", "0.5"}}));
    EXPECT_NEAR(shifted.fluid().shifting, 4.0 * 0.075 * 0.5, 1e-15); // A h U
}

// Operators and sources that a scene names, and the step limit of the gradient taken twice: the integral of -W' over h
// is 7/3 in the plane (Euler's beta function), times 2/pi for the mean of the cosine, squared.
TEST(SphScene, CorrectedOperatorsAndSources) {
    Bench plain(scene_text(2));
    EXPECT_TRUE(std::holds_alternative<PlainOperators>(plain.fluid().operators));
    EXPECT_TRUE(std::holds_alternative<NoSource>(plain.fluid().source));
    const std::string flow = "{law = \"manufactured\", speed = 0.3, divergence = 0.1}";
    Bench bench(scene_text(2,
                           {{"operators", "\"corrected\""},
                            {"viscous_term", "\"double_gradient\""},
                            {"viscosity", "3.0"},
                            {"source", flow},
                            {"initial", flow}},
                           {{"size", "[1.0, 1.0]"}}));
    const SphFluid& f = bench.fluid();
    EXPECT_TRUE(std::holds_alternative<CorrectedOperators>(f.operators));
    EXPECT_EQ(std::get<DoubleGradient>(f.viscous_term).viscosity, 3.0);
    EXPECT_EQ(std::get<ManufacturedSource>(f.source).flow.speed, 0.3);
    EXPECT_EQ(std::get<ManufacturedSource>(f.source).flow.divergence, 0.1);
    const double rate = std::pow(7.0 / 3.0 * 2.0 / pi, 2), time = 0.075 * 0.075 / 3e-3;
    EXPECT_NEAR(seconds_of(bench.simulation.timing.limits, "viscous"), 0.6 / rate * time, 1e-5 * time);
}

// Gravity counted with "dynamic" pressure too, or the body force forgotten.
TEST(SphScene, BodyForces) {
    Bench full(scene_text(2, {{"body_force", "[1.0, 0.5]"}}));
    EXPECT_EQ(full.fluid().body_force, Vec3(1.0, 0.5 - 9.81, 0.0));
    Bench dynamic(scene_text(3, {{"pressure", "\"dynamic\""}, {"body_force", "[1.0, 0.5, 0.25]"}}));
    EXPECT_EQ(dynamic.fluid().body_force, Vec3(1.0, 0.5, 0.25));
    Bench none(scene_text(3, {{"pressure", "\"dynamic\""}}));
    EXPECT_EQ(none.fluid().body_force, Vec3(Vec3::Zero()));
}

// Jitter in metres in place of spacings, or the same for every seed.
TEST(SphScene, JitterIsAShareOfTheSpacing) {
    Bench lattice(scene_text(3));
    const auto jittered = [](int seed) {
        return scene_text(3, {{"arrange", "{law = \"jittered\", jitter = 0.2, seed = " + std::to_string(seed) + "}"}});
    };
    Bench one(jittered(1)), again(jittered(1)), other(jittered(2));
    Vec3 most = Vec3::Zero(), mean = Vec3::Zero();
    for (std::int32_t id = 0; id < 3840; ++id) {
        const Vec3 moved = position(one.fluid(), id) - position(lattice.fluid(), id);
        most = most.cwiseMax(moved.cwiseAbs()), mean += moved / 3840.0;
    }
    EXPECT_LE(most.maxCoeff(), 0.01 + 1e-15);
    EXPECT_GT(most.minCoeff(), 0.0098);
    EXPECT_LT(mean.norm(), 5e-4); // 3 x 0.01/sqrt(3 x 3840), and a third more
    expect_same_bits(one.fluid(), again.fluid());
    EXPECT_NE(position(one.fluid(), 7), position(other.fluid(), 7));
}

// The rule of the automatic speed of sound: one of its three parts missing or off by a power of a number.
TEST(SphScene, AutomaticSoundSpeed) {
    const auto speed = [](const Keys& more) {
        Keys keys{{"sound_speed", "\"auto\""}, {"reference_velocity", "0.5"}};
        keys.insert(more.begin(), more.end());
        if (keys.count("pressure") == 0) keys["pressure"] = "\"dynamic\"";
        Bench bench(scene_text(2, keys));
        return bench.fluid().sound_speed;
    };
    EXPECT_NEAR(speed({}), 5.0, 1e-13);
    EXPECT_NEAR(speed({{"pressure", "\"full\""}}), 10.0 * std::sqrt(2.0 * 9.81 * 0.8), 1e-12); // a fall through the box
    EXPECT_NEAR(speed({{"pressure_drop", "4000.0"}}), 20.0, 1e-13);                            // 10 sqrt(4)
    EXPECT_NEAR(speed({{"viscosity", "30.0"}}), 8.0, 1e-13); // 20 nu/h = 20 x 0.03/0.075
    EXPECT_NEAR(speed({{"viscosity", "30.0"}, {"pressure_drop", "4000.0"}}), 20.0, 1e-13);
}

// Step limits off by a factor: 0.25 h/c, 0.6 over the greatest viscous rate and 0.25 sqrt(h/f), infinite without
// viscosity and force. The integral of -W'/r is 7/2 over h^2 for this kernel (by Euler's beta function, in the plane
// and in space), and Morris' rate is twice that.
TEST(SphScene, StepLimits) {
    const double time = 0.075 * 0.075 / 3e-3; // h^2/nu
    for (const int d : {2, 3}) {
        Bench bench(scene_text(d, {{"viscosity", "3.0"}}));
        const std::vector<StepLimit>& limits = bench.simulation.timing.limits;
        const double sound = 0.25 * 0.075 / 20.0;
        EXPECT_NEAR(seconds_of(limits, "acoustic"), std::cbrt(100.0 / 500.0) * sound, 1e-12); // h c/nu = 500, undamped
        Bench damped(scene_text(d, {{"viscosity", "3.0"}, {"density_diffusion", "0.1"}}));
        EXPECT_NEAR(seconds_of(damped.simulation.timing.limits, "acoustic"), sound, 1e-15);
        // density diffusion is Morris' sum with delta h c for nu
        EXPECT_TRUE(std::isinf(seconds_of(limits, "diffusion")));
        EXPECT_NEAR(seconds_of(damped.simulation.timing.limits, "diffusion"), 0.6 / 7.0 * 0.075 / (0.1 * 20.0), 1e-7);
        // artificial viscosity of all pairs alike: a central form of 2 (d + 2) nu = alpha h c
        const double nu = 0.1 * 0.075 * 20.0 / (2.0 * (d + 2));
        Bench braked(
            scene_text(d, {{"viscosity", "0.0"}, {"viscous_term", "\"none\""}, {"artificial_viscosity", "0.1"}}));
        Bench central(
            scene_text(d, {{"viscosity", std::to_string(1000.0 * nu)}, {"viscous_term", "\"monaghan_gingold\""}}));
        EXPECT_NEAR(seconds_of(braked.simulation.timing.limits, "viscous") /
                        seconds_of(central.simulation.timing.limits, "viscous"),
                    1.0, 1e-5);
        EXPECT_NEAR(seconds_of(limits, "viscous"), 0.6 / 7.0 * time, 1e-5 * time);
        EXPECT_NEAR(seconds_of(limits, "force"), 0.25 * std::sqrt(0.075 / 9.81), 1e-12);
        EXPECT_TRUE(std::isinf(seconds_of(limits, "shifting")));
    }
    Bench ideal(scene_text(2, {{"viscosity", "0.0"}, {"viscous_term", "\"none\""}, {"pressure", "\"dynamic\""}}));
    const std::vector<StepLimit> others = fluid_limits(ideal.fluid());
    EXPECT_NEAR(seconds_of(others, "acoustic"), 0.1 * 0.25 * 0.075 / 20.0, 1e-15);
    EXPECT_TRUE(std::isinf(seconds_of(others, "viscous")));
    EXPECT_TRUE(std::isinf(seconds_of(others, "force")));
}

// Bad numbers and names of the fluid's table: one line with the key.
TEST(SphScene, BadFluidIsAnInputError) {
    const auto refused = [](const Keys& keys, std::initializer_list<std::string_view> parts) {
        SCOPED_TRACE(keys.begin()->first + " = " + keys.begin()->second);
        for (const int d : {2, 3}) expect_refused(scene_text(d, keys), parts);
    };
    refused({{"spacing", "0.03"}}, {"fluid.spacing", "along x", "a whole number is needed"});
    refused({{"spacing", "1.7"}}, {"fluid.spacing"});
    refused({{"spacing", "0.0"}}, {"fluid.spacing", "0"});
    refused({{"density", "-1000.0"}}, {"scene.toml: fluid.density", "-1000"});
    refused({{"density", ""}}, {"fluid.density: missing"});
    refused({{"smoothing", "0.4"}}, {"fluid.smoothing", "0.4"});
    refused({{"kernel", "\"gauss\""}}, {"fluid.kernel", "gauss", "wendland_c2", "quintic_spline"});
    refused({{"equation_of_state", "\"ideal\""}}, {"fluid.equation_of_state", "ideal", "tait"});
    refused({{"viscous_term", "\"none\""}}, {"fluid.viscous_term", "none", "0.1"});
    refused({{"viscosity", "0.0"}}, {"fluid.viscous_term", "morris"});
    refused({{"viscosity", "-0.1"}}, {"fluid.viscosity", "-0.1"});
    refused({{"sound_speed", "\"automatic\""}}, {"fluid.sound_speed", "automatic", "auto"});
    refused({{"sound_speed", "\"auto\""}}, {"fluid.reference_velocity: missing"});
    refused({{"sound_speed", "-3.0"}}, {"fluid.sound_speed", "-3"});
    refused({{"reference_velocity", "1.0"}}, {"fluid.reference_velocity", "unknown key"}); // nothing reads it
    refused({{"density_diffusion", "-0.1"}}, {"fluid.density_diffusion", "-0.1"});
    refused({{"artificial_viscosity", "-0.1"}}, {"fluid.artificial_viscosity", "-0.1"});
    refused({{"shifting", "4.0"}}, {"fluid.reference_velocity: missing"});
    refused({{"sound_speed", "2.0"}, {"initial", "{law = \"uniform_pressure\", pressure = -600.0}"}},
            {"fluid.sound_speed", "too few", "-600"}); // Tait's law ends at -rho c^2/7 = -571
    refused({{"free_surface", "true"}, {"pressure", "\"dynamic\""}}, {"fluid.pressure", "free surface"});
    for (const int d : {2, 3}) // nothing holds the fluid along y
        expect_refused(scene_text(d, {}, {{"periodic", d == 2 ? "[true, false]" : "[true, false, true]"}}),
                       {"fluid.free_surface", "the fluid ends at"});
    refused({{"shifting", "-1.0"}, {"reference_velocity", "0.5"}}, {"fluid.shifting", "-1"});
    refused({{"pressure", "\"total\""}}, {"fluid.pressure", "total", "dynamic"});
    refused({{"body_force", "[1.0]"}}, {"fluid.body_force"});
    refused({{"arrange", "\"heap\""}}, {"fluid.arrange", "heap", "lattice"});
    for (const char* jitter : {"0.51", "1.5", "0.0", "-0.1"})
        refused({{"arrange", std::string("{law = \"jittered\", seed = 1, jitter = ") + jitter + "}"}},
                {"scene.toml: fluid.arrange.jitter", "outside the allowed range"});
    refused({{"arrange", "{law = \"jittered\", jitter = 0.1}"}}, {"fluid.arrange.seed: missing"});
    refused({{"arrange", "{law = \"lattice\", jitter = 0.1}"}}, {"fluid.arrange.jitter", "unknown key"});
    refused({{"initial", "\"storm\""}}, {"fluid.initial", "storm", "shear_wave"});
    refused({{"initial", "{law = \"sound_wave\", speed = 0.1, waves = 1, kind = \"plane\"}"}},
            {"fluid.initial.kind", "plane", "standing"});
    refused({{"operators", ""}}, {"fluid.operators: missing"});
    refused({{"operators", "\"exact\""}}, {"fluid.operators", "exact", "plain", "corrected"});
    refused({{"viscous_term", "\"double_gradient\""}}, {"fluid.viscous_term", "corrected"});
    refused({{"source", "\"rain\""}}, {"fluid.source", "rain", "manufactured"});
    refused({{"source", "{law = \"manufactured\", speed = 1.0}"}}, {"fluid.source.divergence: missing"});
    for (const char* key : {"source", "initial"})
        refused({{key, "{law = \"manufactured\", speed = 1.0, divergence = 0.0}"}}, {key, "square", "0.8"});
    refused({{"method", "\"lattice\""}}, {"fluid.method", "grid", "sph"});
    refused({{"walls", "3"}}, {"fluid.walls", "unknown key"});
}

// Boxes that cannot be meant, and tables that do not go with the fluid.
TEST(SphScene, BadBoxIsAnInputError) {
    expect_refused(scene_text(3, {}, {{"size", "[1.0, 0.8, 0.6, 0.4]"}}), {"domain.size"});
    expect_refused(scene_text(2, {}, {{"size", "[1.0]"}}), {"domain.size"});
    expect_refused(scene_text(2, {}, {{"gravity", "[0.0, 0.0, -9.81]"}}), {"domain.gravity"});
    expect_refused(scene_text(2, {}, {{"periodic", "[true, true, true]"}}), {"domain.periodic"});
    expect_refused(scene_text(2, {}, {{"size", "[1.0, 0.3]"}}), {"domain.size", "along periodic y"});
    expect_refused(scene_text(3, {}, {{"size", "[1.0, 0.8, 0.25]"}}), {"domain.size", "along periodic z"});
    const std::string grains = "[[grains]]\nname = \"sand\"\n";
    expect_refused(scene_text(2, {}, {}, grains), {"scene.toml: domain", "three dimensions"});
    expect_refused(scene_text(2, {}, {}, "[coupling]\ndirection = \"two_way\"\n"), {"coupling", "no [grains]"});
    expect_refused(scene_text(3, {}, {}, "[[wall]]\nname = \"floor\"\n"), {"wall[0].shape: missing"});
    std::string verlet = scene_text(2);
    verlet.replace(verlet.find("midpoint"), 8, "velocity_verlet");
    expect_refused(verlet, {"time.integrator", "midpoint"});
}

// A number of particles that wraps around to a small one or to none: n^d beyond 64 bits, ids beyond 32 bits.
TEST(SphScene, TooManyParticlesAreRefused) {
    for (const int d : {2, 3})
        for (const char* spacing : {"1e-9", "1e-12", "1e-300"})
            expect_refused(scene_text(d, {{"spacing", spacing}}), {"fluid.spacing", "2e9 are possible"});
}

// Initial states at other places than the particles', or a pressure that is not turned into density.
TEST(SphScene, InitialFieldsByFormula) {
    Bench wave(scene_text(2, {{"initial", "{law = \"shear_wave\", speed = 0.3, waves = 2}"}}));
    Bench sound(scene_text(3, {{"initial", "{law = \"sound_wave\", speed = 0.3, waves = 1, kind = \"travelling\"}"}}));
    Bench vortex(scene_text(2, {{"initial", "{law = \"taylor_green\", speed = 0.3}"}}));
    for (std::size_t k = 0; k < wave.fluid().slots(); ++k) {
        const double y = wave.fluid().x[1][k];
        EXPECT_NEAR(wave.fluid().v[0][k], 0.3 * std::sin(2.0 * pi * 2.0 * y / 0.8), 1e-13);
        EXPECT_EQ(wave.fluid().rho[k], 1000.0);
        const SphFluid& f = vortex.fluid();
        const double a = 2.0 * pi * f.x[0][k], b = 2.0 * pi * f.x[1][k] / 0.8;
        EXPECT_NEAR(f.v[0][k], -0.3 * std::cos(a) * std::sin(b), 1e-13);
        EXPECT_NEAR(f.v[1][k], 0.3 * std::sin(a) * std::cos(b), 1e-13);
        EXPECT_NEAR(pressure(f, f.rho[k]), -0.25 * 1000.0 * 0.09 * (std::cos(2.0 * a) + std::cos(2.0 * b)), 1e-8);
    }
    Bench tension(scene_text(2, {{"initial", "{law = \"uniform_pressure\", pressure = -500.0}"}}));
    for (std::size_t k = 0; k < tension.fluid().slots(); ++k) {
        EXPECT_EQ(tension.fluid().v[0][k], 0.0);
        EXPECT_NEAR(pressure(tension.fluid(), tension.fluid().rho[k]), -500.0, 1e-8);
    }
    const SphFluid& f = sound.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const double u = 0.3 * std::cos(2.0 * pi * f.x[0][k]);
        EXPECT_NEAR(f.v[0][k], u, 1e-13);
        EXPECT_NEAR(pressure(f, f.rho[k]), 1000.0 * 20.0 * u, 1e-8);
    }
}

// A pulse whose pressure does not go with its direction splits into two.
TEST(SphScene, PulseByFormula) {
    for (const double sign : {1.0, -1.0}) {
        Bench pulse(scene_text(2, {{"initial", fmt::format("{{law = \"pulse\", speed = 0.2, centre = 0.4, width = 0.1, "
                                                           "towards = \"{}x\", flow = 0.5}}",
                                                           sign > 0.0 ? "+" : "-")}}));
        const SphFluid& f = pulse.fluid();
        for (std::size_t k = 0; k < f.slots(); ++k) {
            const double u = 0.2 * std::exp(-50.0 * std::pow(f.x[0][k] - 0.4, 2));
            EXPECT_NEAR(f.v[0][k], 0.5 + sign * u, 1e-13);
            EXPECT_EQ(f.v[1][k], 0.0);
            EXPECT_NEAR(pressure(f, f.rho[k]), 1000.0 * 20.0 * u, 1e-8);
        }
    }
}
