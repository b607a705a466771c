// Liquid bridges of moving grains: when they form and break, what they pull, and the same bits however a run is cut.
#include "core/parallel.hpp"
#include "grain_fixtures.hpp"
#include "run/touching.hpp"

#include <map>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr std::string_view bridge =
    "cohesion = {law = \"liquid_bridge\", surface_tension = 0.07, contact_angle = 0.5, volume = 1e-13}\n";
const std::string elastic =
    "law = \"linear_spring\"\nstiffness = 1e3\nrestitution = 1.0\nfriction = 0.0\n" + std::string(bridge);
const std::string rough =
    "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 0.8\nfriction = 0.5\ntangential_stiffness = 4e3\n"
    "tangential_damping = 0.01\n"
    "rolling = {law = \"elastic_plastic\", friction = 0.1, stiffness = 1e-2, damping = 0.2}\n" +
    std::string(bridge);
constexpr double radius = 5e-4, dt = 2e-6, volume = 1e-13;
const double reach = 1.25 * std::cbrt(volume); // 58 um

/// As in the papers, by hand.
double pull(double s, double r) {
    const double scaled = s * std::sqrt(r / volume);
    return 2.0 * std::numbers::pi * r * 0.07 * std::cos(0.5) / (1.0 + 1.05 * scaled + 2.5 * scaled * scaled);
}

/// Grains of many sizes on a floor, periodic sideways, in motion: contacts, bridges, walls, springs, rebuilds.
GrainSystem busy() {
    GrainSystem s = system_of(box(Vec3(6e-3, 6e-3, 6e-3), {true, true, false}, Vec3(0, 0, -9.81)), rough,
                              {group_of("a"), group_of("b", 4000.0)},
                              {plane("floor", Vec3(0, 0, 0), Vec3(0, 0, 1)),
                               plane("lid", Vec3(0, 0, 6e-3), Vec3(0, 0, -1), Vec3(0.1, 0.0, -0.3))});
    add_jittered_lattice(s, 6, 4e-4, 5e-4, 0.05, 0.3, 200.0, 11);
    return s;
}

std::size_t bridges(const GrainSystem& s) {
    std::size_t count = 0;
    for (std::size_t p = 0; p < s.neighbours.count; ++p) count += s.neighbours.bridge[p] > 0.0 ? 1U : 0U;
    return count;
}
std::size_t wall_bridges(const GrainSystem& s) {
    std::size_t count = 0;
    for (const WallContact& c : all_wall_contacts(s.wall_contacts)) count += c.bridge > 0.0 ? 1U : 0U;
    return count;
}

/// Two grains a nanometre within each other that part at `speed`, the first of `first` radii.
GrainSystem parting_pair(double speed, double first = 1.0) {
    GrainSystem s = system_of(box(Vec3::Constant(2e-2)), elastic);
    const double apart = radius * (1.0 + first) - 1e-9;
    add(s, first * radius, Vec3(5e-3, 8e-3, 7e-3), Vec3(-0.5 * speed, 0.0, 0.0));
    add(s, radius, Vec3(5e-3 + apart, 8e-3, 7e-3), Vec3(0.5 * speed, 0.0, 0.0));
    return s;
}
double separation(const GrainSystem& s) {
    const Grains& g = s.grains;
    return s.domain.minimum_image(g.x[0] - g.x[1]).norm() - g.radius[0] - g.radius[1];
}
void turn_round(GrainSystem& s) {
    for (Vec3& v : s.grains.v) v = -v;
}

} // namespace

// The force on the way out, past the rupture, back without a bridge, and again after the grains have touched. Equal and
// unequal grains.
TEST(LiquidBridges, FormAtContactAndLiveUntilTheyBreak) {
    for (const double first : {1.0, 3.0}) {
        GrainSystem s = parting_pair(0.6, first);
        const double r = 2.0 * radius * first / (1.0 + first);
        start(s);
        EXPECT_EQ(bridges(s), 1U);
        EXPECT_NEAR(contact_forces(s)[place(s.grains, 0)].x(), pull(0.0, r) - 1e3 * 1e-9, 1e-12);
        int held = 0;
        while (separation(s) < 1.5 * reach) {
            advance_grains(s, 1, dt);
            const double expected = separation(s) < reach ? pull(separation(s), r) : 0.0;
            EXPECT_NEAR(contact_forces(s)[place(s.grains, 0)].x(), expected, 1e-12);
            EXPECT_NEAR(contact_forces(s)[place(s.grains, 1)].x(), -expected, 1e-12);
            EXPECT_EQ(bridges(s), expected > 0.0 ? 1U : 0U);
            held += expected > 0.0 ? 1 : 0;
        }
        EXPECT_GT(held, 30);
        turn_round(s);
        while (separation(s) > 0.0) {
            EXPECT_EQ(contact_forces(s)[0].norm(), 0.0); // dry until they touch
            advance_grains(s, 1, dt);
        }
        EXPECT_EQ(bridges(s), 1U);
    }
}

// A slow pair turns round before its bridge breaks; one across a periodic side does the same.
TEST(LiquidBridges, HoldSlowGrainsAlsoAcrossAPeriodicSide) {
    GrainSystem s = parting_pair(0.05);
    GrainSystem across = parting_pair(0.05);
    across.domain.periodic = {true, false, false};
    for (Vec3& x : across.grains.x) x.x() += 1.45e-2; // the second is at x = 0.5 mm beyond the side
    across.grains.x[1] = across.domain.wrapped(across.grains.x[1]);
    double farthest = 0.0;
    for (int k = 0; k < 3000; ++k) {
        advance_grains(s, 1, dt);
        advance_grains(across, 1, dt);
        farthest = std::max(farthest, separation(s));
        EXPECT_EQ(bridges(s), 1U);
        EXPECT_NEAR(separation(across), separation(s), 1e-9 * radius);
    }
    EXPECT_GT(farthest, 5e-6);
    EXPECT_LT(farthest, reach);
}

// Total energy, bridge included, along such an oscillation: second order in the step.
TEST(LiquidBridges, KeepTheEnergyOfAHeldPair) {
    const auto worst = [](double step) {
        GrainSystem s = parting_pair(0.06);
        const auto energy = [&] { return kinetic_energy(s.grains) + touching_pairs(s, step)[0].energy; };
        start(s);
        const double before = energy(), kinetic = kinetic_energy(s.grains);
        EXPECT_LT(before, 0.0); // bound
        double error = 0.0;
        for (double t = 0.0; t < 3e-3; t += step) {
            advance_grains(s, 1, step);
            error = std::max(error, std::abs(energy() - before) / kinetic);
        }
        return error;
    };
    const double coarse = worst(2e-6), fine = worst(5e-7);
    EXPECT_LT(coarse, 2e-3);
    EXPECT_NEAR(order_of(coarse, fine, 4.0), 2.0, 0.4);
}

// 4 pi R gamma cos(theta) on a wall, moving with it; gone after the rupture, back after a touch. A fixed grain has
// none.
TEST(LiquidBridges, OnAWall) {
    GrainSystem s = system_of(box(Vec3::Constant(0.02)), elastic, {group_of("glass")},
                              {plane("floor", Vec3(0, 0, 1e-3), Vec3(0, 0, 1), Vec3(0.0, 0.0, -0.3))});
    add(s, radius, Vec3(5e-3, 5e-3, 1e-3 + radius - 1e-9), Vec3(0.0, 0.0, 0.3));
    start(s);
    EXPECT_NEAR(contact_forces(s)[0].z(), 1e3 * 1e-9 - pull(0.0, 2.0 * radius), 1e-12);
    const auto gap = [&] { return s.grains.x[0].z() - (1e-3 - 0.3 * s.time) - radius; };
    while (gap() < 1.5 * reach) {
        advance_grains(s, 1, dt);
        const double expected = gap() < reach ? pull(gap(), 2.0 * radius) : 0.0;
        EXPECT_NEAR(contact_forces(s)[0].z(), -expected, 1e-12);
        EXPECT_EQ(wall_bridges(s), expected > 0.0 ? 1U : 0U);
    }
    s.grains.v[0].z() = -0.9; // after the wall
    while (gap() > 0.0) {
        EXPECT_EQ(contact_forces(s)[0].norm(), 0.0);
        advance_grains(s, 1, dt);
    }
    EXPECT_EQ(wall_bridges(s), 1U);
}

// A bridge lost or kept too long by the list, its rebuilds or the periodic sides: against every pair of grains, step by
// step, in a colliding cloud.
TEST(LiquidBridges, AreThoseOfTheSlowTwin) {
    GrainSystem s = busy();
    std::map<std::pair<std::int32_t, std::int32_t>, bool> wet; // by ids
    std::size_t formed = 0, broken = 0, apart = 0;
    double listed = -1.0;
    int rebuilds = 0;
    for (int step = 0; step < 400; ++step) {
        step == 0 ? start(s, dt) : advance_grains(s, 1, dt);
        const Grains& g = s.grains;
        std::size_t count = 0;
        for (std::size_t i = 0; i < g.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const double gap = s.domain.minimum_image(g.x[i] - g.x[j]).norm() - g.radius[i] - g.radius[j];
                bool& has = wet[std::minmax(g.id[i], g.id[j])];
                const bool had = has;
                has = gap < 0.0 || (has && gap <= reach);
                count += has ? 1U : 0U, apart += has && gap > 0.0 ? 1U : 0U;
                formed += has && !had ? 1U : 0U, broken += had && !has ? 1U : 0U;
            }
        ASSERT_EQ(bridges(s), count) << "step " << step;
        for (std::size_t p = 0; p < s.neighbours.count; ++p) {
            const auto i = static_cast<std::size_t>(s.neighbours.i[p]), j = static_cast<std::size_t>(s.neighbours.j[p]);
            ASSERT_EQ(s.neighbours.bridge[p] > 0.0, wet[std::minmax(g.id[i], g.id[j])]) << "step " << step;
        }
        rebuilds += s.listed_time != listed ? 1 : 0;
        listed = s.listed_time;
    }
    EXPECT_GT(formed, 100U); // the cloud did what it is here for
    EXPECT_GT(broken, 20U);
    EXPECT_GT(apart, 1000U);
    EXPECT_GT(rebuilds, 10);
}

TEST(LiquidBridges, KeepTheMomentaOfACloud) {
    GrainSystem s = system_of(box(Vec3::Constant(6e-3)), rough);
    add_jittered_lattice(s, 6, 4e-4, 4.7e-4, 0.02, 0.3, 200.0, 5);
    const Vec3 p = momentum(s.grains), l = angular_momentum(s.grains);
    double speeds = 0.0;
    for (std::size_t k = 0; k < s.grains.size(); ++k) speeds += s.grains.mass[k] * s.grains.v[k].norm();
    advance_grains(s, 400, dt);
    EXPECT_GT(bridges(s), 50U);
    EXPECT_LT((momentum(s.grains) - p).norm(), 1e-13 * speeds);
    EXPECT_LT((angular_momentum(s.grains) - l).norm(), 1e-13 * speeds * 6e-3);
}

TEST(LiquidBridges, SplittingARunChangesNoBit) {
    GrainSystem whole = busy(), parts = busy();
    advance_grains(whole, 300, dt);
    for (const int steps : {1, 0, 99, 150, 50}) advance_grains(parts, steps, dt);
    expect_same_bits(whole.grains, parts.grains);
    EXPECT_GT(bridges(whole), 50U);
    EXPECT_GT(wall_bridges(whole), 10U);
}

TEST(LiquidBridges, AResumedRunHasTheSameBits) {
    GrainSystem unbroken = busy();
    for (const int steps : {1, 99, 200}) {
        advance_grains(unbroken, steps, dt);
        GrainSystem again = busy();
        again.grains = unbroken.grains;
        again.step = unbroken.step, again.time = unbroken.time, again.listed_time = unbroken.listed_time;
        restore_lists(again, remembered_contacts(unbroken.neighbours, unbroken.grains),
                      all_wall_contacts(unbroken.wall_contacts));
        EXPECT_EQ(bridges(again), bridges(unbroken));
        EXPECT_EQ(wall_bridges(again), wall_bridges(unbroken));
        GrainSystem ahead = unbroken;
        advance_grains(ahead, 150, dt);
        advance_grains(again, 150, dt);
        expect_same_bits(ahead.grains, again.grains);
    }
}

TEST(LiquidBridges, ThreadsChangeNoBit) {
    const int before = thread_count();
    GrainSystem one = busy();
    set_threads(1);
    advance_grains(one, 200, dt);
    for (const int threads : {2, 3}) {
        GrainSystem many = busy();
        set_threads(threads);
        advance_grains(many, 200, dt);
        set_threads(before);
        expect_same_bits(one.grains, many.grains);
    }
    set_threads(before);
}

// Friction is that of the solid contact: the liquid's pull neither presses nor relieves it.
TEST(LiquidBridges, DoNotRaiseTheFriction) {
    const std::string sliding =
        "law = \"linear_spring_coulomb\"\nstiffness = 1e3\ndamping = 0.0\nfriction = 0.3\nrolling = \"none\"\n";
    for (const std::string& contact : {sliding, sliding + std::string(bridge)}) {
        GrainSystem s = system_of(box(Vec3::Constant(0.02)), contact);
        add(s, radius, Vec3(5e-3, 5e-3, 5e-3), Vec3(0.0, 0.2, 0.0));
        add(s, radius, Vec3(5e-3 + 2.0 * radius - 1e-7, 5e-3, 5e-3), Vec3(0.0, -0.2, 0.0));
        start(s);
        EXPECT_NEAR(contact_forces(s)[place(s.grains, 0)].y(), -0.3 * 1e3 * 1e-7, 1e-12);
    }
}
