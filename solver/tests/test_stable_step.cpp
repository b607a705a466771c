// The step: limits by hand, how one is chosen, and what a scene may ask for.
#include "schemes/stable_step.hpp"

#include "grain_fixtures.hpp"

#include <numbers>

using namespace plumb;
using namespace plumb::fixture;

namespace {

using std::numbers::pi;

Timing timing_of(std::string_view text, std::vector<StepLimit> limits = {}) {
    Table table = table_of(text, "time");
    const Timing t = timing(table, std::move(limits));
    table.finish();
    return t;
}
StepLimit limit(std::string name, double seconds) { return {std::move(name), seconds, "by hand"}; }

std::string spring(double stiffness) {
    return fmt::format("law = \"linear_spring\"\nstiffness = {}\nrestitution = 1.0\nfriction = 0.0\n", stiffness);
}
double contact_limit(const GrainSystem& s) {
    const std::vector<StepLimit> limits = grain_limits(s);
    EXPECT_EQ(limits.size(), 1U);
    EXPECT_EQ(limits.front().name, "contact");
    return limits.front().seconds;
}
constexpr std::string_view hertz =
    "law = \"hertz_mindlin\"\nyoung = 1e8\npoisson = 0.25\nrestitution = 1.0\nfriction = 0.0\n";

} // namespace

// The automatic step must divide the output interval and be no longer than the least limit, and no shorter than needed.
TEST(StableStep, AutomaticStepDividesTheInterval) {
    const Timing t =
        timing_of("end = 3.0\noutput_interval = 1.0\nstep = \"auto\"", {limit("drag", 0.7), limit("contact", 0.3)});
    EXPECT_EQ(t.steps_per_output, 4);
    EXPECT_EQ(t.dt, 0.25);
    EXPECT_EQ(t.outputs, 3);
    EXPECT_EQ(t.ruling, "contact");
    Random random(4);
    for (int k = 0; k < 1000; ++k) {
        const double bound = std::pow(10.0, random.uniform(-7.0, 1.0));
        const Timing u = timing_of("end = 0.02\noutput_interval = 0.01\nstep = \"auto\"", {limit("contact", bound)});
        ASSERT_LE(u.dt, bound * (1.0 + 1e-11));
        ASSERT_NEAR(static_cast<double>(u.steps_per_output) * u.dt, 0.01, 1e-16);
        if (u.steps_per_output > 1) {
            ASSERT_GT(0.01 / static_cast<double>(u.steps_per_output - 1), bound);
        }
    }
}

// Probes may have intervals of their own: the automatic step divides them too, and is no shorter than that needs.
TEST(StableStep, AutomaticStepDividesTheProbesIntervals) {
    const auto timed = [](double output, const std::vector<double>& intervals, double bound) {
        Table time = table_of(fmt::format("end = {}\noutput_interval = {}\nstep = \"auto\"", output, output), "time");
        return timing(time, {limit("contact", bound)}, intervals);
    };
    EXPECT_EQ(timed(0.1, {0.03}, 0.007).steps_per_output, 20);       // common interval 0.01, two steps of it
    EXPECT_EQ(timed(0.1, {0.03, 0.0025}, 1.0).steps_per_output, 40); // common interval 0.0025
    EXPECT_EQ(timed(0.1, {0.03, 0.0025}, 1.0).ruling, "probe_interval");
    EXPECT_EQ(timed(0.1, {0.2, 0.5}, 1.0).steps_per_output, 1); // longer ones
    EXPECT_EQ(timed(1.0, {1.0 / 3.0, 1.0 / 7.0}, 1.0).steps_per_output, 21);
    Random random(3);
    for (int k = 0; k < 1000; ++k) {
        const double unit = random.uniform(1e-4, 1e-3), bound = std::pow(10.0, random.uniform(-6.0, -3.0));
        const double output = unit * std::floor(random.uniform(1.0, 50.0)),
                     probe = unit * std::floor(random.uniform(1.0, 50.0));
        const Timing t = timed(output, {probe}, bound);
        ASSERT_LE(t.dt, bound * (1.0 + 1e-9));
        ASSERT_NEAR(probe / t.dt, std::nearbyint(probe / t.dt), 1e-9 * probe / t.dt);
    }
    expect_error([&] { timed(0.1, {0.1 / std::numbers::sqrt2}, 1e-3); }, {"time.step", "0.1 s", "probe interval"});
}

// A limit that divides the interval exactly must not cost one step more through rounding.
TEST(StableStep, ALimitThatDividesIsTaken) {
    for (const int n : {1, 3, 7, 10, 1000, 12345}) {
        const Timing t = timing_of("end = 0.1\noutput_interval = 0.1\nstep = \"auto\"", {limit("contact", 0.1 / n)});
        EXPECT_EQ(t.steps_per_output, n);
    }
}

// Without a limit, or with a long one, the interval itself rules.
TEST(StableStep, TheOutputIntervalRulesWhenNothingElseDoes) {
    for (const double bound : {2.0, std::numeric_limits<double>::infinity()}) {
        const Timing t = timing_of("end = 1.0\noutput_interval = 0.5\nstep = \"auto\"", {limit("contact", bound)});
        EXPECT_EQ(t.steps_per_output, 1);
        EXPECT_EQ(t.dt, 0.5);
        EXPECT_EQ(t.ruling, "output_interval");
    }
    EXPECT_EQ(timing_of("end = 1.0\noutput_interval = 0.5\nstep = \"auto\"").steps_per_output, 1);
}

// Safety factors multiply their own limit and can change which one rules.
TEST(StableStep, SafetyFactors) {
    const std::string_view text =
        "end = 1.0\noutput_interval = 1.0\nstep = \"auto\"\nsafety = {contact = 2.0, drag = 0.5}";
    const Timing t = timing_of(text, {limit("contact", 0.2), limit("drag", 0.5)});
    EXPECT_EQ(t.ruling, "drag");
    EXPECT_EQ(t.steps_per_output, 4);
    EXPECT_EQ(t.limits[0].seconds, 0.4);
    EXPECT_EQ(t.limits[1].seconds, 0.25);
    expect_error(
        [] {
            timing_of("end = 1.0\noutput_interval = 1.0\nstep = \"auto\"\nsafety = {contact = 0.0}",
                      {limit("contact", 1.0)});
        },
        {"time.safety.contact", "0", "(0, inf)"});
    expect_error(
        [] {
            timing_of("end = 1.0\noutput_interval = 1.0\nstep = \"auto\"\nsafety = {acoustic = 1.0}",
                      {limit("contact", 1.0)});
        },
        {"time.safety.acoustic", "unknown"});
}

// An explicit step is taken as it is, limits or not, but it must divide the output interval, and that the end.
TEST(StableStep, ExplicitSteps) {
    const Timing t =
        timing_of("end = 0.3\noutput_interval = 0.1\nstep = 0.001\nsnapshots = true", {limit("contact", 1e-9)});
    EXPECT_EQ(t.dt, 0.001);
    EXPECT_EQ(t.steps_per_output, 100);
    EXPECT_EQ(t.outputs, 3);
    EXPECT_EQ(t.ruling, "given");
    EXPECT_TRUE(t.snapshots);
    expect_error([] { timing_of("end = 0.3\noutput_interval = 0.1\nstep = 0.003"); },
                 {"time.", "0.003", "whole number"});
    expect_error([] { timing_of("end = 0.3\noutput_interval = 0.1\nstep = 0.2"); }, {"time.", "0.2", "whole number"});
    expect_error([] { timing_of("end = 0.25\noutput_interval = 0.1\nstep = 0.1"); }, {"time.end", "0.25", "0.1"});
    expect_error([] { timing_of("end = 0.05\noutput_interval = 0.1\nstep = 0.1"); }, {"time.end", "0.05"});
}

// Every other slip in the table.
TEST(StableStep, BadTables) {
    expect_error([] { timing_of("output_interval = 0.1\nstep = 0.1"); }, {"time.end", "missing"});
    expect_error([] { timing_of("end = 1.0\nstep = 0.1"); }, {"time.output_interval", "missing"});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 0.1"); }, {"time.step", "missing"});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 0.1\nstep = \"fast\""); }, {"time.step", "fast", "auto"});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 0.1\nstep = 0.0"); }, {"time.step", "0"});
    expect_error([] { timing_of("end = -1.0\noutput_interval = 0.1\nstep = 0.1"); }, {"time.end", "-1"});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 0.0\nstep = 0.1"); }, {"time.output_interval", "0"});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 0.1\nstep = nan"); }, {"time.step", "not finite"});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 0.1\nstep = 0.1\nsnapshots = 1"); }, {"time.snapshots"});
}

// Numbers of steps beyond any integer: a tiny limit must not turn into the longest step, nor a tiny step into garbage.
TEST(StableStep, AbsurdlyManySteps) {
    for (const double bound : {1e-20, 1e-30, 1e-300}) {
        try {
            const Timing t = timing_of("end = 1.0\noutput_interval = 1.0\nstep = \"auto\"", {limit("contact", bound)});
            EXPECT_LE(t.dt, bound * 1.001);
        } catch (const InputError&) { // a refusal is as good
        }
        expect_error([&] { timing_of(fmt::format("end = 1.0\noutput_interval = 1.0\nstep = {}", bound)); }, {"time."});
    }
    expect_error([] { timing_of("end = 1.0\noutput_interval = 1.0\nstep = 5e-324"); }, {"time."});
    expect_error([] { timing_of("end = 1.0\noutput_interval = 1e-300\nstep = 1e-300"); }, {"time.end"});
}

// pi sqrt(m*/k)/20 of the shortest contact, over all pairs of two materials and a wall: here every pair in turn rules.
TEST(StableStep, ContactLimitOfTwoMaterialsByHand) {
    for (int ruling = 0; ruling < 5; ++ruling) {
        GrainSystem s = system_of(box(Vec3::Constant(1.0)), spring(1.0), {group_of("a", 2000.0), group_of("b", 8000.0)},
                                  {plane("floor", Vec3(0, 0, 0), Vec3(0, 0, 1))});
        const auto k = [&](int pair) { return pair == ruling ? 1e6 : 1e3; };
        s.contact =
            contact_model({"a", "b", "floor"}, {contact_of(spring(k(0))), contact_of(spring(k(1))), std::nullopt}, 2,
                          {{"a", "b", contact_of(spring(k(2)))},
                           {"a", "floor", contact_of(spring(k(3)))},
                           {"b", "floor", contact_of(spring(k(4)))}},
                          "scene.toml");
        add(s, 2e-3, Vec3(0.1, 0.1, 0.1));
        add(s, 1e-3, Vec3(0.3, 0.1, 0.1)); // the lightest of a
        add(s, 1e-3, Vec3(0.5, 0.1, 0.1), Vec3::Zero(), Vec3::Zero(), 1);
        const double ma = 2000.0 * 4.0 / 3.0 * pi * 1e-9, mb = 4.0 * ma;
        const double reduced[] = {ma / 2.0, mb / 2.0, ma * mb / (ma + mb), ma, mb};
        EXPECT_NEAR(contact_limit(s), pi * std::sqrt(reduced[ruling] / 1e6) / 20.0, 1e-12 * contact_limit(s)) << ruling;
    }
}

// A tangential spring may be the stiffer one: at the surface of spheres it moves 2/7 of the mass.
TEST(StableStep, TangentialSpringsCanRule) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)),
                              "law = \"linear_spring\"\nstiffness = 1e3\nrestitution = 1.0\nfriction = 0.5\n"
                              "tangential_stiffness = 1e5\ntangential_damping = 0.0\nrolling = \"none\"\n");
    add(s, 1e-3, Vec3(0.5, 0.5, 0.5));
    EXPECT_NEAR(contact_limit(s), pi * std::sqrt(0.5 * s.grains.mass[0] / (3.5 * 1e5)) / 20.0,
                1e-12 * contact_limit(s));
}

// Hertzian contacts are shorter the faster the impact: twice the fastest grain, plus the fall through the box.
TEST(StableStep, HertzianLimitFollowsTheSpeed) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), hertz);
    add(s, 1e-3, Vec3(0.5, 0.5, 0.5), Vec3(0.3, 0.0, 0.4));
    add(s, 1e-3, Vec3(0.2, 0.5, 0.5), Vec3(0.1, 0.0, 0.0));
    const double m = 0.5 * s.grains.mass[0], speed = 2.0 * 0.5;
    const double k = 4.0 / 3.0 * 1e8 / (2.0 * (1.0 - 0.0625)) * std::sqrt(5e-4);
    const double by_hand = 2.9432 * std::pow(1.25 * m * speed * speed / k, 0.4) / speed / 20.0; // Johnson 1985
    EXPECT_NEAR(contact_limit(s), by_hand, 1e-4 * by_hand);
    GrainSystem falling = s;
    falling.domain.gravity = Vec3(0, 0, -9.81);
    EXPECT_NEAR(contact_limit(falling) / contact_limit(s), std::pow(1.0 + std::sqrt(2.0 * 9.81), -0.2), 1e-9);
}

// A fluid can carry grains into each other faster than they fall.
TEST(StableStep, HertzianLimitFollowsTheFluid) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), hertz);
    add(s, 1e-3, Vec3(0.2, 0.5, 0.5));
    const double slow = grain_limits(s, 1.0).front().seconds, fast = grain_limits(s, 32.0).front().seconds;
    EXPECT_NEAR(fast / slow, 0.5, 1e-9); // t_c ~ v^(-1/5)
}

// Grains at rest without gravity still have stiff contacts: overlapping ones, or some that a fluid drives together. No
// limit at all would make the step as long as the output interval.
TEST(StableStep, HertzianContactsAtRestHaveALimit) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), hertz);
    add(s, 1e-3, Vec3(0.5, 0.5, 0.5));
    add(s, 1e-3, Vec3(0.50199, 0.5, 0.5));
    EXPECT_LT(contact_limit(s), 1e-2);
}

// Without contacts there is no contact limit; a group without grains has none either.
TEST(StableStep, NoContactNoLimit) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), "law = \"none\"");
    add(s, 1e-3, Vec3(0.5, 0.5, 0.5));
    EXPECT_EQ(contact_limit(s), std::numeric_limits<double>::infinity());
    const GrainSystem empty = system_of(box(Vec3::Constant(1.0)), spring(1e4));
    EXPECT_EQ(contact_limit(empty), std::numeric_limits<double>::infinity());
}
