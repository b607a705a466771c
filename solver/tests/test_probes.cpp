// Probe quantities by hand, contact energies, the part of a sphere in a box, and the reader of [[probe]].
#include "core/errors.hpp"
#include "core/random.hpp"
#include "dem/advance_grains.hpp"
#include "run/probes.hpp"
#include "run/sphere_overlap.hpp"
#include "scene_bench.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb {

using fixture::Bench;
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
constexpr double pi = std::numbers::pi;
const double infinity = std::numeric_limits<double>::infinity();

/// Two grains of 2 m and 4 m diameter in a box of 20 m; density 3/(4 pi), so that a mass is R^3.
std::string scene_text(const std::string& extra, const std::string& periodic = "[false, false, false]") {
    return "[domain]\nsize = [20.0, 20.0, 20.0]\nperiodic = " + periodic +
           "\ngravity = [0.0, 0.0, -10.0]\n"
           "[[grains]]\nname = \"small\"\ndensity = 0.238732414637843\ndiameter = 2.0\nrotation = true\nmotion = "
           "\"free\"\n"
           "arrange = {law = \"single\", position = [5.0, 5.0, 5.0]}\nvelocity = [1.0, 2.0, 3.0]\n"
           "angular_velocity = [0.0, 0.0, 5.0]\ncontact = {law = \"linear_spring\", stiffness = 100.0, damping = 0.0, "
           "friction = 0.0}\n"
           "[[grains]]\nname = \"large\"\ndensity = 0.238732414637843\ndiameter = 4.0\nrotation = true\nmotion = "
           "\"free\"\n"
           "arrange = {law = \"single\", position = [8.5, 5.0, 5.0]}\nvelocity = [-1.0, 0.0, 0.0]\n"
           "angular_velocity = [0.0, 0.0, 0.0]\ncontact = {law = \"linear_spring\", stiffness = 100.0, damping = 0.0, "
           "friction = 0.0}\n"
           "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n"
           "contact = \"as_grains\"\n"
           "[time]\nend = 1e-2\noutput_interval = 1e-3\nintegrator = \"velocity_verlet\"\nstep = 1e-4\n" +
           extra;
}

double probed(const std::string& keys) {
    Bench bench(scene_text("[[probe]]\nname = \"p\"\n" + keys));
    // move the grains together by hand: overlap 0.5 along x
    auto& grains = bench.simulation.grains.grains;
    const auto place = positions_of_ids(grains);
    grains.x[static_cast<std::size_t>(place[1])][0] = 7.5;
    bench.simulation.grains.started = false; // they were no neighbours where the scene put them
    start(bench.simulation.grains, bench.simulation.timing.dt);
    record(bench.probes, bench.simulation);
    return bench.probes.front().value.front();
}

TEST(Probes, SingleGrain) {
    EXPECT_EQ(probed("quantity = \"grain_position\"\ngrain = 1\naxis = \"x\""), 7.5);
    EXPECT_EQ(probed("quantity = \"grain_velocity\"\ngrain = 0\naxis = \"y\""), 2.0);
    EXPECT_EQ(probed("quantity = \"grain_angular_velocity\"\ngrain = 0\naxis = \"z\""), 5.0);
}

TEST(Probes, Sums) { // masses 1 and 8, inertias 2/5 and 2/5 8 4
    EXPECT_NEAR(probed("quantity = \"grain_mean_velocity\"\naxis = \"x\""), 0.0, 1e-15);
    EXPECT_NEAR(probed("quantity = \"grain_mean_velocity\"\naxis = \"x\"\ngroup = \"large\""), -1.0, 1e-15);
    EXPECT_NEAR(probed("quantity = \"grain_mean_position\"\naxis = \"x\""), 6.25, 1e-14);
    EXPECT_NEAR(probed("quantity = \"grain_momentum\"\naxis = \"x\""), 1.0 - 8.0, 1e-12);
    EXPECT_NEAR(probed("quantity = \"grain_kinetic_energy\""), 7.0 + 0.2 * 25.0 + 4.0, 1e-12);
    EXPECT_NEAR(probed("quantity = \"grain_potential_energy\""), 9.0 * 10.0 * 5.0, 1e-10);
    EXPECT_NEAR(probed("quantity = \"grain_contact_energy\""), 0.5 * 100.0 * 0.25, 1e-12);
    EXPECT_NEAR(probed("quantity = \"grain_total_energy\""), 16.0 + 450.0 + 12.5, 1e-9);
    // z of x cross m v + I omega: small (5*2 - 5*1) + 0.4*5, large (7.5*0 - 5*(-8))
    EXPECT_NEAR(probed("quantity = \"grain_angular_momentum\"\naxis = \"z\""), 5.0 + 2.0 + 40.0, 1e-11);
    // V = (-7, 2, 3)/9; sum m v^2 = 14 + 8; sum m |v - V|^2 = 22 - 9 V^2
    EXPECT_NEAR(probed("quantity = \"granular_temperature\""), (22.0 - 62.0 / 9.0) / 27.0, 1e-12);
    EXPECT_EQ(probed("quantity = \"grain_count\""), 2.0);
    EXPECT_EQ(probed("quantity = \"grain_count\"\ngroup = \"small\""), 1.0);
}

TEST(Probes, Contacts) {
    EXPECT_EQ(probed("quantity = \"contact_count\""), 1.0);
    EXPECT_EQ(probed("quantity = \"coordination_number\""), 1.0);
    EXPECT_NEAR(probed("quantity = \"max_overlap\""), 0.5, 1e-14);
    EXPECT_EQ(probed("quantity = \"wall_force\"\nwall = \"floor\"\naxis = \"z\""), 0.0);
}

TEST(Probes, PerGrain) {
    Bench bench(scene_text("[[probe]]\nname = \"v\"\nquantity = \"grain_velocities\"\naxis = \"x\"\n"
                           "[[probe]]\nname = \"w\"\nquantity = \"grain_angular_velocities\"\naxis = \"z\"\n"));
    record(bench.probes, bench.simulation);
    EXPECT_EQ(bench.probes[0].value, (std::vector<double>{1.0, -1.0}));
    EXPECT_EQ(bench.probes[1].value, (std::vector<double>{5.0, 0.0}));
    EXPECT_EQ(bench.probes[0].width, 2U);
    EXPECT_TRUE(bench.probes[0].per_grain());
}

TEST(Probes, PackingFraction) {
    // the lower half of the small grain, in a slab that also cuts the large one: both centres at z = 5
    const double half = 0.5 * 4.0 / 3.0 * pi * 9.0;
    EXPECT_NEAR(probed("quantity = \"packing_fraction\"\nlower = [0.0, 0.0, 0.0]\nupper = [20.0, 20.0, 5.0]"),
                half / 2000.0, 1e-15);
    EXPECT_NEAR(probed("quantity = \"packing_fraction\"\nlower = [5.0, 5.0, 5.0]\nupper = [5.5, 20.0, 20.0]"),
                0.25 * pi * (0.5 - 0.125 / 3.0) / (0.5 * 225.0), 1e-8);
}

TEST(Probes, Intervals) {
    Bench bench(scene_text("[[probe]]\nname = \"p\"\nquantity = \"grain_count\"\ninterval = 3e-4\n"
                           "[[probe]]\nname = \"q\"\nquantity = \"grain_count\"\n"));
    EXPECT_EQ(bench.probes[0].steps, 3);
    EXPECT_EQ(bench.probes[1].steps, 10);
    EXPECT_EQ(next_record(bench.probes, 0, 100), 3);
    EXPECT_EQ(next_record(bench.probes, 9, 100), 10);
    EXPECT_EQ(next_record(bench.probes, 98, 99), 99);
}

std::string complaint(const std::string& probe, const std::string& periodic = "[false, false, false]") {
    try {
        Bench bench(scene_text("[[probe]]\n" + probe, periodic));
    } catch (const InputError& e) {
        return e.what();
    }
    return "no complaint";
}

TEST(Probes, BadTablesAreInputErrors) {
    const std::string count = "quantity = \"grain_count\"\n";
    EXPECT_THAT(complaint(count), HasSubstr("probe[0].name: missing"));
    EXPECT_THAT(complaint("name = \"\"\n" + count), HasSubstr("must be made of"));
    EXPECT_THAT(complaint("name = \"a/b\"\n" + count), HasSubstr("must be made of"));
    EXPECT_THAT(complaint("name = \"..\"\n" + count), HasSubstr("must be made of"));
    EXPECT_THAT(complaint("name = \"a\"\n" + count + "[[probe]]\nname = \"a\"\n" + count), HasSubstr("another probe"));
    EXPECT_THAT(complaint("name = \"a\"\nquantity = \"speed\""),
                HasSubstr("\"speed\" is not one of \"grain_position\""));
    EXPECT_THAT(complaint("name = \"a\"\ninterval = 1.5e-4\n" + count), HasSubstr("a whole number is needed"));
    EXPECT_THAT(complaint("name = \"a\"\ninterval = 1e-6\n" + count), HasSubstr("a whole number is needed"));
    EXPECT_THAT(complaint("name = \"a\"\nintervall = 1e-4\n" + count), HasSubstr("intervall: unknown key"));
    EXPECT_THAT(complaint("name = \"a\"\ngroup = \"sand\"\n" + count), HasSubstr("no [[grains]] named \"sand\""));
    EXPECT_THAT(complaint("name = \"a\"\naxis = \"x\"\n" + count), HasSubstr("axis: unknown key"));
    const std::string position = "name = \"a\"\nquantity = \"grain_position\"\n";
    EXPECT_THAT(complaint(position + "axis = \"x\""), HasSubstr("grain: missing"));
    EXPECT_THAT(complaint(position + "grain = 2\naxis = \"x\""), HasSubstr("2 is not a grain"));
    EXPECT_THAT(complaint(position + "grain = 0\naxis = \"w\""), HasSubstr("\"w\" is not one of"));
    EXPECT_THAT(complaint("name = \"a\"\nquantity = \"wall_force\"\nwall = \"lid\"\naxis = \"x\""),
                HasSubstr("no [[wall]] named \"lid\""));
    EXPECT_THAT(complaint("name = \"a\"\nquantity = \"grain_fluid_force\"\naxis = \"x\""),
                HasSubstr("needs a [fluid]"));
    EXPECT_THAT(
        complaint("name = \"a\"\nquantity = \"packing_fraction\"\nlower = [0.0,0.0,0.0]\nupper = [0.0,1.0,1.0]"),
        HasSubstr("must exceed lower"));
    EXPECT_THAT(
        complaint("name = \"a\"\nquantity = \"packing_fraction\"\nlower = [0.0,0.0,0.0]\nupper = [21.0,1.0,1.0]"),
        HasSubstr("must lie in the domain"));
    EXPECT_THAT(complaint("name = \"a\"\nquantity = \"grain_angular_momentum\"\naxis = \"z\"", "[true, false, false]"),
                HasSubstr("periodic along x"));
}

TEST(ContactEnergy, IsTheIntegralOfTheForce) {
    const auto law = [](const std::string& text) {
        const toml::table data = toml::parse(text);
        return make_family<ContactLaw>(Table(data, "contact", "test"));
    };
    const std::vector<ContactLaw> laws{
        law("law = \"linear_spring\"\nstiffness = 1e3\ndamping = 0.0\nfriction = 0.0"),
        law("law = \"linear_spring_coulomb\"\nstiffness = 2e3\ndamping = 0.0\nfriction = 0.0"),
        law("law = \"hertz_mindlin\"\nyoung = 1e7\npoisson = 0.3\nrestitution = 1.0\nfriction = 0.0")};
    for (const ContactLaw& one : laws)
        std::visit(
            [&](const auto& l) {
                using Law = std::decay_t<decltype(l)>;
                if constexpr (!std::is_same_v<Law, NoContact>) {
                    const double depth = 1e-4, inverse_radius = 200.0;
                    const int n = 2000;
                    double work = 0.0; // midpoint rule
                    for (int k = 0; k < n; ++k) {
                        Space<double> stretch{0, 0, 0};
                        const Contact<double> c{depth * (k + 0.5) / n, {1, 0, 0}, {0, 0, 0}, 1.0,
                                                inverse_radius,        0.0,       {0, 0, 0}};
                        work += Law::force(c, l.parameters, stretch).normal * depth / n;
                    }
                    EXPECT_NEAR(elastic_energy(one, depth, inverse_radius, 0.0) / work, 1.0, 1e-5) << Law::name;
                }
            },
            one);
}

TEST(ContactEnergy, TangentialSpring) {
    const toml::table data = toml::parse("law = \"linear_spring\"\nstiffness = 1e3\ndamping = 0.0\nfriction = 0.5\n"
                                         "tangential_stiffness = 300.0\ntangential_damping = 0.0");
    const auto law = make_family<ContactLaw>(Table(data, "contact", "test"));
    const double normal = 0.5 * 1e3 * 0.2 * 0.2;
    EXPECT_NEAR(elastic_energy(law, 0.2, 1.0, 0.04), normal + 0.5 * 300.0 * 0.04, 1e-12); // 60 N of at most 100 N
    EXPECT_NEAR(elastic_energy(law, 0.2, 1.0, 4.0), normal + 0.5 * 100.0 * 100.0 / 300.0, 1e-12); // friction's limit
}

TEST(SphereOverlap, Disc) {
    EXPECT_NEAR(disc_rectangle_overlap(2.0, -3, 3, -3, 3), 4.0 * pi, 1e-14);
    EXPECT_NEAR(disc_rectangle_overlap(2.0, 0, 3, 0, 3), pi, 1e-14);
    EXPECT_NEAR(disc_rectangle_overlap(2.0, -1, 1, -1, 1), 4.0, 1e-14);
    EXPECT_NEAR(disc_rectangle_overlap(2.0, -3, 3, -3, 0), 2.0 * pi, 1e-14);
    EXPECT_NEAR(disc_rectangle_overlap(2.0, 2, 3, -1, 1), 0.0, 1e-14);
    // segment beyond x = 1 of a disc of radius 2: r^2 acos(d/r) - d sqrt(r^2 - d^2)
    EXPECT_NEAR(disc_rectangle_overlap(2.0, 1, 3, -3, 3), 4.0 * std::acos(0.5) - std::sqrt(3.0), 1e-14);
    EXPECT_NEAR(disc_rectangle_overlap(2.0, -3, 3, -3, -1), 4.0 * std::acos(0.5) - std::sqrt(3.0), 1e-14);
}

TEST(SphereOverlap, KnownVolumes) {
    const double v = 4.0 / 3.0 * pi * 8.0;
    const Vec3 far = Vec3::Constant(infinity);
    EXPECT_NEAR(sphere_box_overlap(2.0, -far, far), v, 1e-13);
    EXPECT_NEAR(sphere_box_overlap(2.0, Vec3::Zero(), far), v / 8, 1e-6 * v);
    EXPECT_NEAR(sphere_box_overlap(2.0, Vec3(0, 0, -5), Vec3(5, 5, 5)), v / 4, 1e-6 * v);
    EXPECT_NEAR(sphere_box_overlap(2.0, Vec3(-5, -5, 1), far), pi * 1.0 * 5.0 / 3.0, 1e-13);    // cap of height 1
    EXPECT_NEAR(sphere_box_overlap(2.0, Vec3::Constant(-1), Vec3::Constant(1)), 8.0, 1e-6 * v); // inside it
    EXPECT_EQ(sphere_box_overlap(2.0, Vec3(2, -5, -5), far), 0.0);
    EXPECT_EQ(sphere_box_overlap(2.0, Vec3(1.5, 1.5, 1.5), far), 0.0); // the corner is 2.6 away
}

TEST(SphereOverlap, PartsAddUpToTheWhole) {
    Random random(5);
    for (int trial = 0; trial < 50; ++trial) {
        const double radius = random.uniform(0.5, 2.0), v = 4.0 / 3.0 * pi * radius * radius * radius;
        const Vec3 cut(random.uniform(-radius, radius), random.uniform(-radius, radius),
                       random.uniform(-radius, radius));
        double sum = 0.0;
        for (int octant = 0; octant < 8; ++octant) {
            Vec3 lower = cut, upper = cut;
            for (int c = 0; c < 3; ++c)
                ((octant >> c & 1) ? upper : lower)[c] = (octant >> c & 1) ? infinity : -infinity;
            sum += sphere_box_overlap(radius, lower, upper);
        }
        EXPECT_NEAR(sum / v, 1.0, 4e-6);
    }
}

TEST(SphereOverlap, AgreesWithCountingPoints) { // slow obvious twin
    Random random(11);
    const Vec3 lower(-0.3, -2.0, 0.2), upper(0.9, 0.4, 5.0);
    const int n = 200000;
    int inside = 0;
    for (int k = 0; k < n; ++k) {
        const Vec3 x(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const bool in_box = (x.array() > lower.array()).all() && (x.array() < upper.array()).all();
        inside += in_box && x.squaredNorm() < 1.0 ? 1 : 0;
    }
    const double counted = 8.0 * inside / n; // standard error 8 sqrt(p (1 - p)/n) = 0.006
    EXPECT_NEAR(sphere_box_overlap(1.0, lower, upper), counted, 0.03);
}

} // namespace
} // namespace plumb
