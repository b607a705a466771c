#include "dem/injectors.hpp"

#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

namespace plumb {
namespace {

const std::vector<GrainGroup> groups{{"glass", 2500.0, true, Motion::free}, {"wall", 1.0, true, Motion::fixed}};

Domain unit_box(bool periodic) {
    Domain domain;
    domain.size = Vec3(1.0, 1.0, 1.0);
    domain.periodic = {periodic, periodic, periodic};
    return domain;
}

Injector injector_of(const std::string& text, const Domain& domain, const std::vector<WallBody>& walls = {}) {
    Table table(toml::parse(text), "injector[0]", ::testing::TempDir() + "scene.toml");
    Injector injector = make_injector(table, groups, domain, walls);
    table.finish();
    return injector;
}

const std::string timing = "group = 'glass'\ninterval = 0.1\nvelocity = [0, 0, -1]\nstart = 0.0\nend = 0.3\n";
const std::string two_points = "diameter = 0.1\npoints = [[0.2, 0.2, 0.8], [0.7, 0.7, 0.8]]\n";

TEST(Injector, EventsLieInAHalfOpenTimeWithoutDrift) {
    Injector injector = injector_of(timing + two_points, unit_box(false));
    EXPECT_EQ(injector.events_due(-1.0), 0);
    EXPECT_EQ(injector.events_due(0.0), 1);
    EXPECT_EQ(injector.events_due(0.0999), 1);
    EXPECT_EQ(injector.events_due(0.1), 2);
    EXPECT_EQ(injector.events_due(5.0), 3); // 0.3 = 3 * 0.1 itself is out: duration over interval
    injector.start = 0.7;
    injector.end = 1e9;
    EXPECT_EQ(injector.events_due(0.6), 0);
    // The step 0.1/7 is rounded; event k is due at step 7 k all the same, for a million events.
    const double dt = injector.interval / 7.0;
    for (std::int64_t k = 0; k < 1'000'000; k += 37) {
        const double steps = 49.0 + 7.0 * static_cast<double>(k);
        EXPECT_EQ(injector.events_due(steps * dt), k + 1);
        EXPECT_EQ(injector.events_due((steps - 1.0) * dt), k);
        EXPECT_EQ(injector.event_time(k), 0.7 + static_cast<double>(k) * 0.1);
    }
}

TEST(Injector, AddsOneGrainPerPointAndEvent) {
    const Domain domain = unit_box(false);
    const Injector injector = injector_of(timing + two_points, domain);
    Injected done = nothing_injected(injector);
    Grains grains;
    EXPECT_EQ(inject(grains, done, injector, groups, domain, 0.0), 2U);
    EXPECT_EQ(inject(grains, done, injector, groups, domain, 0.05), 0U);
    ASSERT_EQ(grains.size(), 2U);
    EXPECT_EQ(grains.x[1], Vec3(0.7, 0.7, 0.8));
    EXPECT_EQ(grains.v[1], Vec3(0, 0, -1));
    EXPECT_EQ(grains.radius[1], 0.05);
    EXPECT_EQ(grains.group[1], 0);
    EXPECT_EQ(grains.id[1], 1);
    for (Vec3& x : grains.x) x.z() -= 0.101;
    EXPECT_EQ(inject(grains, done, injector, groups, domain, 0.1), 2U);
    EXPECT_EQ(done.total(), 4);
}

TEST(Injector, WaitsForAFreePointAndLosesNoGrain) {
    const Domain domain = unit_box(true);
    const Injector injector =
        injector_of(timing + "diameter = 0.1\npoints = [[0.01, 0.5, 0.5], [0.5, 0.5, 0.5]]", domain);
    Injected done = nothing_injected(injector);
    Grains grains;
    add_grain(grains, groups, 0, 0.05, Vec3(0.95, 0.5, 0.5), Vec3::Zero(),
              Vec3::Zero()); // reaches over the periodic side
    EXPECT_EQ(inject(grains, done, injector, groups, domain, 0.0), 1U);
    EXPECT_EQ(waiting(injector, done, 0.0), 1);
    EXPECT_EQ(waiting(injector, done, 0.25), 5); // of six in all, one has entered
    grains.x[0].x() = 0.905;                     // free by 0.005
    grains.x[1].z() = 0.7;
    EXPECT_EQ(inject(grains, done, injector, groups, domain, 9.0), 2U); // one per point and call, though more are due
    EXPECT_EQ(inject(grains, done, injector, groups, domain, 9.0), 0U); // both points taken again
    std::size_t total = grains.size();
    for (int k = 0; k < 10; ++k) {
        for (std::size_t i = 0; i < grains.size(); ++i) grains.x[i] = Vec3(0.25, 0.0, 0.0); // out of the way
        total += inject(grains, done, injector, groups, domain, 9.0);
    }
    EXPECT_EQ(done.total(), 6);
    EXPECT_EQ(total, 7U);
    EXPECT_EQ(waiting(injector, done, 9.0), 0);
}

TEST(Injector, ResumesExactly) {
    const Domain domain = unit_box(false);
    const Injector injector =
        injector_of("group = 'glass'\ninterval = 0.1\nvelocity = [0, 0, -1]\nstart = 0.0\nend = 5.0\n"
                    "diameter = {law = 'uniform', minimum = 0.01, maximum = 0.02, seed = 4}\n"
                    "points = [[0.2, 0.2, 0.8], [0.7, 0.7, 0.8]]",
                    domain);
    const auto run = [&](Grains& grains, Injected& done, int from, int to) {
        for (int k = from; k < to; ++k) {
            inject(grains, done, injector, groups, domain, 0.05 * k);
            for (Vec3& x : grains.x) x.z() -= 0.003; // slow enough that some have to wait
        }
    };
    Grains unbroken, broken;
    Injected all = nothing_injected(injector), part = all;
    run(unbroken, all, 0, 90);
    run(broken, part, 0, 37);
    const Injected saved{part.count}; // what a checkpoint holds
    Injected resumed = saved;
    run(broken, resumed, 37, 90);
    ASSERT_EQ(unbroken.size(), broken.size());
    EXPECT_GT(unbroken.size(), 20U);
    EXPECT_EQ(all.count, resumed.count);
    for (std::size_t i = 0; i < unbroken.size(); ++i) {
        EXPECT_EQ(unbroken.radius[i], broken.radius[i]);
        EXPECT_EQ(unbroken.x[i], broken.x[i]);
        EXPECT_GE(unbroken.radius[i], 0.005);
        EXPECT_LE(unbroken.radius[i], 0.01);
    }
    EXPECT_NE(unbroken.radius[0], unbroken.radius[1]);
    EXPECT_NE(injector.drawn_diameter(0, 0), injector.drawn_diameter(0, 1));
}

TEST(Injector, ReadsPointsFromAFile) {
    std::ofstream(::testing::TempDir() + "plumb_injector.csv")
        << "x [m],y [m],z [m],diameter [m]\n0.2,0.2,0.8,0.1\n0.7,0.7,0.8,0.2\n";
    const Domain domain = unit_box(false);
    const Injector injector = injector_of(timing + "path = 'plumb_injector.csv'\ndiameter = {law = 'file'}", domain);
    Injected done = nothing_injected(injector);
    Grains grains;
    inject(grains, done, injector, groups, domain, 0.0);
    ASSERT_EQ(grains.size(), 2U);
    EXPECT_EQ(grains.radius[0], 0.05);
    EXPECT_EQ(grains.radius[1], 0.1);
    EXPECT_THROW(injector_of(timing + "path = 'plumb_injector.csv'\ndiameter = 0.1", domain),
                 InputError); // unused column
}

TEST(Injector, RefusesNonsense) {
    const Domain domain = unit_box(false);
    const auto fails = [&](const std::string& text, const std::string& part, const std::vector<WallBody>& walls = {}) {
        try {
            injector_of(text, domain, walls);
            FAIL() << text;
        } catch (const InputError& e) {
            EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
        }
    };
    fails(timing + "diameter = 0.1\npoints = []", "has no point");
    fails(timing + "diameter = 0.1", "either points or path");
    fails(timing + two_points + "path = 'a.csv'", "either points or path");
    fails(timing + "diameter = 0.1\npoints = [[0.5, 0.5, 1.5]]", "outside the domain");
    fails(timing + "diameter = 0.1\npoints = [[0.5, 0.5, 0.5], [0.5, 0.5, 0.59]]", "nearer to point 0");
    fails(timing + "diameter = 'file'\npoints = [[0.5, 0.5, 0.5]]", "needs path");
    fails(timing + two_points + "colour = 1", "unknown key");
    const std::string rest = "velocity = [0, 0, 0]\nstart = 0.5\n" + two_points;
    fails("group = 'sand'\ninterval = 0.1\nend = 1.0\n" + rest, "no group \"sand\"");
    fails("group = 'wall'\ninterval = 0.1\nend = 1.0\n" + rest, "do not move freely");
    fails("group = 'glass'\ninterval = 0.0\nend = 1.0\n" + rest, "interval");
    fails("group = 'glass'\ninterval = 0.1\nend = 0.5\n" + rest, "end");
    fails("group = 'glass'\ninterval = 1e-12\nend = 1.0\n" + rest, "events");
    Table plane(toml::parse("point = [0, 0, 0.9]\nnormal = [0, 0, -1]"), "wall", "scene.toml");
    const std::vector<WallBody> near{{"lid", Plane(plane)}}; // 0.1 above the points
    EXPECT_NO_THROW(injector_of(timing + two_points, domain, near));
    fails(timing + "diameter = 0.22\npoints = [[0.2, 0.2, 0.8]]", "wall \"lid\"", near);
}

} // namespace
} // namespace plumb
