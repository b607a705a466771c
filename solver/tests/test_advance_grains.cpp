// The motion of grains: exact solutions, conservation, orders, and the same bits however a run is cut.
#include "dem/advance_grains.hpp"

#include "core/parallel.hpp"
#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr std::string_view elastic = "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 1.0\nfriction = 0.0\n";
constexpr std::string_view rough =
    "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 0.8\nfriction = 0.5\ntangential_stiffness = 4e3\n"
    "tangential_damping = 0.01\n"
    "rolling = {law = \"elastic_plastic\", friction = 0.1, stiffness = 1e-2, damping = 0.2}\n";
constexpr double radius = 5e-4, dt = 2e-6; // a contact of two glass spheres of 1 mm lasts 25 us

/// Grains of many sizes on a floor, periodic sideways, in motion: contacts, walls, springs, rebuilds.
GrainSystem busy() {
    GrainSystem s = system_of(box(Vec3(6e-3, 6e-3, 6e-3), {true, true, false}, Vec3(0, 0, -9.81)), rough,
                              {group_of("a"), group_of("b", 4000.0)},
                              {plane("floor", Vec3(0, 0, 0), Vec3(0, 0, 1)),
                               plane("lid", Vec3(0, 0, 6e-3), Vec3(0, 0, -1), Vec3(0.1, 0.0, -0.3))});
    add_jittered_lattice(s, 6, 4e-4, 5e-4, 0.05, 0.3, 200.0, 11);
    return s;
}

/// A fresh system with the state of `s`, as a checkpoint would bring it.
GrainSystem resumed(const GrainSystem& s) {
    GrainSystem fresh = busy();
    fresh.grains = s.grains;
    fresh.step = s.step, fresh.time = s.time, fresh.listed_time = s.listed_time;
    restore_lists(fresh, remembered_contacts(s.neighbours, s.grains), all_wall_contacts(s.wall_contacts));
    return fresh;
}

/// Largest error of the energy of two elastic grains during their impact, in parts of it.
double energy_error(Integrator integrator, int steps_per_contact) {
    GrainSystem s = system_of(box(Vec3::Constant(1e-2)), elastic);
    s.integrator = integrator;
    add(s, radius, Vec3(4e-3, 5e-3, 5e-3), Vec3(0.1, 0.0, 0.0));
    add(s, radius, Vec3(5e-3, 5e-3, 5e-3));
    const double step = std::numbers::pi * std::sqrt(0.5 * s.grains.mass[0] / 1e4) / steps_per_contact;
    const double before = kinetic_energy(s.grains);
    double worst = 0.0;
    for (int k = 0; k < steps_per_contact; ++k) {
        advance_grains(s, 1, step);
        const double overlap = 2.0 * radius - (s.grains.x[0] - s.grains.x[1]).norm();
        const double energy = kinetic_energy(s.grains) + 0.5 * 1e4 * std::pow(std::max(0.0, overlap), 2.0);
        worst = std::max(worst, std::abs(energy / before - 1.0));
    }
    return worst;
}

void expect_every_contact_listed(const GrainSystem& s) {
    const Grains& g = s.grains;
    std::vector<std::vector<std::int32_t>> partners(g.size());
    for (std::size_t p = 0; p < s.neighbours.count; ++p)
        partners[static_cast<std::size_t>(s.neighbours.i[p])].push_back(s.neighbours.j[p]);
    for (std::size_t a = 0; a < g.size(); ++a)
        for (std::size_t b = a + 1; b < g.size(); ++b)
            if (s.domain.minimum_image(g.x[a] - g.x[b]).norm() < g.radius[a] + g.radius[b]) {
                ASSERT_TRUE(std::count(partners[a].begin(), partners[a].end(), static_cast<std::int32_t>(b)) == 1)
                    << "grains " << g.id[a] << " and " << g.id[b] << " overlap unseen in step " << s.step;
            }
}

} // namespace

// Velocity Verlet follows a parabola exactly; semi-implicit Euler is ahead by g t dt/2. Lost half kicks show here.
TEST(AdvanceGrains, FreeFlight) {
    for (const Integrator integrator : {Integrator::velocity_verlet, Integrator::semi_implicit_euler}) {
        GrainSystem s = system_of(box(Vec3::Constant(1.0), {false, false, true}, Vec3(0.5, 0.0, -9.81)), elastic);
        s.integrator = integrator;
        const Vec3 x0(0.5, 0.5, 0.02), v0(0.1, -0.2, 0.3), omega(3.0, 4.0, 5.0);
        add(s, radius, x0, v0, omega);
        const double step = 1e-4, t = 2000 * step;
        advance_grains(s, 2000, step);
        const double ahead = integrator == Integrator::velocity_verlet ? 0.0 : step;
        const Vec3 x = x0 + t * v0 + 0.5 * t * (t + ahead) * s.domain.gravity;
        EXPECT_LT((unwrapped(s.grains, s.domain, 0) - x).norm(), 1e-12);
        EXPECT_LT((s.grains.v[0] - v0 - t * s.domain.gravity).norm(), 1e-12);
        EXPECT_EQ(s.grains.omega[0], omega);
        EXPECT_EQ(s.step, 2000);
        EXPECT_NEAR(s.time, t, 1e-15);
        EXPECT_NE(s.grains.turns[0].z(), 0.0); // it did leave through the bottom
    }
}

// A grain that enters later must fly as exactly as one that was there from the start (no acceleration for its first
// step).
TEST(AdvanceGrains, AGrainAddedLaterFliesExactly) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0), {}, Vec3(0.0, 0.0, -9.81)), elastic);
    add(s, radius, Vec3(0.2, 0.2, 0.9));
    advance_grains(s, 100, 1e-4);
    add(s, radius, Vec3(0.7, 0.7, 0.9), Vec3(0.0, 0.0, -0.1));
    advance_grains(s, 100, 1e-4);
    const std::size_t late = place(s.grains, 1);
    EXPECT_NEAR(s.grains.v[late].z(), -0.1 - 9.81 * 1e-2, 1e-12);
    EXPECT_NEAR(s.grains.v[place(s.grains, 0)].z(), -9.81 * 2e-2, 1e-12);
    EXPECT_NEAR(s.grains.x[late].z(), 0.9 - 0.1 * 1e-2 - 0.5 * 9.81 * 1e-4, 1e-12);
}

// Orders: a force taken at the wrong time costs one. The energy of an elastic impact is kept to second order by
// velocity Verlet and to first by semi-implicit Euler.
TEST(AdvanceGrains, EnergyOfAnElasticImpact) {
    const auto verlet = [](int n) { return energy_error(Integrator::velocity_verlet, n); };
    const auto euler = [](int n) { return energy_error(Integrator::semi_implicit_euler, n); };
    EXPECT_LT(verlet(50), 2e-3);
    EXPECT_NEAR(order_of(verlet(50), verlet(200), 4.0), 2.0, 0.1);
    EXPECT_NEAR(order_of(euler(50), euler(200), 4.0), 1.0, 0.1);
}

// Equal grains exchange their velocities in an elastic head-on impact, across a periodic side too.
TEST(AdvanceGrains, ElasticImpactExchangesVelocities) {
    for (const double at : {2e-3, 9.7e-3}) {
        GrainSystem s = system_of(box(Vec3::Constant(1e-2), {true, true, true}), elastic);
        add(s, radius, Vec3(at, 5e-3, 5e-3), Vec3(0.2, 0.05, 0.0));
        add(s, radius, s.domain.wrapped(Vec3(at + 1.2e-3, 5e-3, 5e-3)), Vec3(-0.1, 0.05, 0.0));
        advance_grains(s, 20000, 1e-7);
        EXPECT_LT((s.grains.v[place(s.grains, 0)] - Vec3(-0.1, 0.05, 0.0)).norm(), 1e-5) << at;
        EXPECT_LT((s.grains.v[place(s.grains, 1)] - Vec3(0.2, 0.05, 0.0)).norm(), 1e-5) << at;
    }
}

// The spring of a contact that exists at the start has its first half step too: the claimed midpoint rule is second
// order from the first step on. Slip under a sticking contact, error against half the step.
TEST(AdvanceGrains, TangentialSpringOfAnInitialContactIsSecondOrder) {
    const auto spin_after = [](double step) {
        GrainSystem s = system_of(box(Vec3::Constant(1e-2)),
                                  "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 1.0\nfriction = 100.0\n"
                                  "tangential_stiffness = 1e3\ntangential_damping = 0.0\nrolling = \"none\"\n");
        add(s, radius, Vec3(4e-3, 5e-3, 5e-3), Vec3(0.0, 1e-3, 0.0));
        add(s, radius, Vec3(4.98e-3, 5e-3, 5e-3));
        advance_grains(s, std::llround(6.4e-6 / step), step);
        return s.grains.omega[0].z();
    };
    const double coarse = spin_after(4e-7), middle = spin_after(2e-7), fine = spin_after(1e-7);
    EXPECT_NEAR(order_of(std::abs(coarse - middle), std::abs(middle - fine), 2.0), 2.0, 0.3);
}

// The same while a Hertzian contact is being loaded, where the tangential stiffness grows: the force carried over from
// the step before must see the overlap of that time to second order.
TEST(AdvanceGrains, TangentialForceOfALoadingHertzianContactIsSecondOrder) {
    const auto spin_after = [](double step) {
        GrainSystem s =
            system_of(box(Vec3::Constant(1e-2)), "law = \"hertz_mindlin\"\nyoung = 2e7\npoisson = 0.25\n"
                                                 "restitution = 1.0\nfriction = 100.0\nrolling = \"none\"\n");
        add(s, radius, Vec3(4e-3, 5e-3, 5e-3), Vec3(0.2, 1e-1, 0.0));
        add(s, radius, Vec3(4.995e-3, 5e-3, 5e-3));
        advance_grains(s, std::llround(1.28e-5 / step), step);
        EXPECT_LT(s.grains.v[0].x() - s.grains.v[1].x(), 0.19); // being loaded, and felt
        EXPECT_GT(s.grains.v[0].x() - s.grains.v[1].x(), 0.02);
        return s.grains.omega[0].z();
    };
    const double coarse = spin_after(4e-7), middle = spin_after(2e-7), fine = spin_after(1e-7);
    EXPECT_NEAR(order_of(std::abs(coarse - middle), std::abs(middle - fine), 2.0), 2.0, 0.3);
}

// Forces without memory that alternate in sign every step for ever once a grain rests or rolls.
TEST(AdvanceGrains, HistoryFreeFrictionAndRollingComeToRest) {
    const std::string contact = "law = \"linear_spring_coulomb\"\nstiffness = 1e4\nrestitution = 0.5\nfriction = 0.5\n";
    for (const std::string rolling : {"\"none\"", "{law = \"constant_torque\", friction = 0.05}"})
        for (const bool rotation : {true, false}) {
            GrainSystem s =
                system_of(box(Vec3::Constant(1e-2), {}, Vec3(0, 0, -9.81)), contact + "rolling = " + rolling + "\n",
                          {group_of("a", 2500.0, rotation)}, {plane("floor", Vec3(0, 0, 0), Vec3(0, 0, 1))});
            add(s, radius, Vec3(2e-3, 5e-3, radius), Vec3(1e-3, 0.0, 0.0));
            advance_grains(s, 10000, dt); // slides for 0.2 ms (rolls after two thirds of it), rolls for 2 ms at most
            const double weight = s.grains.mass[0] * 9.81;
            for (int k = 0; k < 20; ++k) {
                EXPECT_LT(std::abs(contact_forces(s)[0].x()), 1e-6 * weight) << rolling << rotation << k;
                EXPECT_LT(s.grains.alpha[0].norm() * radius, 1e-6 * 9.81) << rolling << rotation << k;
                advance_grains(s, 1, dt);
            }
        }
}

// Fixed grains that recoil, fall or stop: they keep their velocity whatever hits them.
TEST(AdvanceGrains, FixedGrainsKeepTheirVelocity) {
    GrainSystem s = system_of(box(Vec3::Constant(1e-2), {}, Vec3(0, 0, -9.81)), rough,
                              {group_of("free"), group_of("fixed", 2500.0, true, Motion::fixed)});
    const Vec3 start_at(5e-3, 5e-3, 2e-3), other(8e-3, 2e-3, 2e-3), moving(0.05, 0.0, 0.02);
    add(s, radius, start_at, Vec3::Zero(), Vec3::Zero(), 1);
    add(s, radius, other, moving, Vec3::Zero(), 1);
    add(s, radius, Vec3(5.1e-3, 5e-3, 3.0e-3), Vec3(0.0, 0.0, -0.2));
    advance_grains(s, 500, dt);
    EXPECT_EQ(s.grains.x[place(s.grains, 0)], start_at);
    EXPECT_EQ(s.grains.v[place(s.grains, 1)], moving);
    EXPECT_LT((s.grains.x[place(s.grains, 1)] - other - 500 * dt * moving).norm(), 1e-15);
    EXPECT_GT(s.grains.v[place(s.grains, 2)].z(), 0.0); // it did bounce
    EXPECT_EQ(s.grains.omega[place(s.grains, 0)], Vec3(0.0, 0.0, 0.0));
}

// A block whose grains follow their own forces, or that moves with the force of one grain only: it is one body.
TEST(AdvanceGrains, BlocksMoveAsOneBody) {
    GrainSystem s =
        system_of(box(Vec3::Constant(2e-2)), rough, {group_of("free"), group_of("block", 1500.0, true, Motion::block)});
    const std::vector<Vec3> shape{{8e-3, 8e-3, 5e-3}, {9e-3, 8e-3, 5e-3}, {8e-3, 9e-3, 5e-3}, {8.5e-3, 8.5e-3, 5.6e-3}};
    for (std::size_t k = 0; k < shape.size(); ++k)
        add(s, 4e-4 + 5e-5 * static_cast<double>(k), shape[k], Vec3::Zero(), Vec3::Zero(), 1);
    add(s, radius, Vec3(6.9e-3, 7.9e-3, 5e-3), Vec3(0.3, 0.0, 0.0));
    const Vec3 before = momentum(s.grains);
    advance_grains(s, 400, dt);
    const Vec3 v = s.grains.v[place(s.grains, 0)];
    EXPECT_GT(v.x(), 0.0);
    for (std::int32_t id = 0; id < 4; ++id) {
        const std::size_t k = place(s.grains, id);
        EXPECT_TRUE(same_bits(s.grains.v[k], v));
        EXPECT_EQ(s.grains.omega[k], Vec3(0.0, 0.0, 0.0));
        const Vec3 moved = s.grains.x[k] - shape[static_cast<std::size_t>(id)];
        EXPECT_LT((moved - (s.grains.x[place(s.grains, 0)] - shape[0])).norm(), 1e-15);
    }
    EXPECT_LT((momentum(s.grains) - before).norm(), 1e-13 * before.norm());
}

// Rotation that is switched off but still turns, or couples that then change the motion of the partner's spin.
TEST(AdvanceGrains, RotationOff) {
    GrainSystem s =
        system_of(box(Vec3::Constant(1e-2)), rough, {group_of("plain", 2500.0, false), group_of("turning")});
    add(s, radius, Vec3(4e-3, 5e-3, 5e-3), Vec3(0.1, 0.1, 0.0));
    add(s, radius, Vec3(4.99e-3, 5e-3, 5e-3), Vec3::Zero(), Vec3::Zero(), 1);
    advance_grains(s, 10, dt);
    EXPECT_EQ(s.grains.omega[place(s.grains, 0)], Vec3(0.0, 0.0, 0.0));
    EXPECT_NE(s.grains.omega[place(s.grains, 1)].z(), 0.0);
}

// Anything that is not action and reaction at one point: a cloud of colliding, spinning grains of many sizes.
TEST(AdvanceGrains, ACollidingCloudKeepsItsMomenta) {
    GrainSystem s = system_of(box(Vec3::Constant(6e-3)), rough);
    add_jittered_lattice(s, 6, 4e-4, 4.7e-4, 0.02, 0.3, 200.0, 5); // no overlaps yet, hence no elastic energy
    const Vec3 p = momentum(s.grains), l = angular_momentum(s.grains);
    double speeds = 0.0;
    for (std::size_t k = 0; k < s.grains.size(); ++k) speeds += s.grains.mass[k] * s.grains.v[k].norm();
    const double energy = kinetic_energy(s.grains);
    advance_grains(s, 400, dt);
    EXPECT_LT((momentum(s.grains) - p).norm(), 1e-13 * speeds);
    EXPECT_LT((angular_momentum(s.grains) - l).norm(), 1e-13 * speeds * 6e-3);
    EXPECT_LT(kinetic_energy(s.grains), 0.9 * energy); // they did collide
}

// A run that depends on how it is cut into calls.
TEST(AdvanceGrains, SplittingARunChangesNoBit) {
    GrainSystem whole = busy(), parts = busy();
    advance_grains(whole, 300, dt);
    for (const int steps : {1, 0, 99, 150, 50}) advance_grains(parts, steps, dt);
    expect_same_bits(whole.grains, parts.grains);
    EXPECT_EQ(whole.step, parts.step);
    EXPECT_EQ(whole.time, parts.time);
}

// A resumed run that has lost a spring, a list or an order of summation: same bits from several moments on.
TEST(AdvanceGrains, AResumedRunHasTheSameBits) {
    GrainSystem unbroken = busy();
    for (const int steps : {1, 36, 63, 100}) {
        advance_grains(unbroken, steps, dt);
        GrainSystem again = resumed(unbroken);
        expect_same_bits(unbroken.grains, again.grains);
        EXPECT_EQ(unbroken.neighbours.i, again.neighbours.i);
        EXPECT_EQ(unbroken.neighbours.j, again.neighbours.j);
        EXPECT_EQ(unbroken.wall_contacts.near, again.wall_contacts.near);
        GrainSystem ahead = unbroken;
        advance_grains(ahead, 150, dt);
        advance_grains(again, 150, dt);
        expect_same_bits(ahead.grains, again.grains);
        EXPECT_EQ(ahead.listed_time, again.listed_time);
        EXPECT_GT(ahead.listed_time, unbroken.listed_time); // lists were renewed on the way
    }
}

// Sums or lists that depend on the number of threads.
TEST(AdvanceGrains, ThreadsChangeNoBit) {
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

// A list that holds too long: a fast grain (0.9 radii a step) shot through a packing, and all others in motion. After
// every step all overlapping pairs must be in the list.
TEST(AdvanceGrains, NoContactIsMissedByTheList) {
    GrainSystem s = system_of(box(Vec3(8e-3, 6e-3, 6e-3), {true, true, false}), elastic);
    add_jittered_lattice(s, 6, 3e-4, 5e-4, 0.1, 1.0, 0.0, 6);
    add(s, 1e-4, Vec3(4e-3, 3e-3, 6.2e-3), Vec3(0.5, 0.0, -40.0)); // outside the open top
    for (int k = 0; k < 200; ++k) {
        advance_grains(s, 1, dt);
        expect_every_contact_listed(s);
        if (HasFatalFailure()) return;
    }
}

// A step that is much too long ends with the step, time, grain, field and limit named.
TEST(AdvanceGrains, ATooLargeStepIsReported) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), elastic);
    add(s, radius, Vec3(0.2, 0.2, 0.2));
    add(s, radius, Vec3(0.9, 0.9, 0.9), Vec3(1.0, 0.0, 0.0));
    advance_grains(s, 3, 1e-4);
    s.grains.v[place(s.grains, 1)] = Vec3(0.0, -20.0, 0.0);
    try {
        advance_grains(s, 5, 1e-4);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const Diverged& d) {
        EXPECT_EQ(d.step, 4);
        EXPECT_NEAR(d.time, 4e-4, 1e-15);
        EXPECT_EQ(d.index, 1);
        EXPECT_NEAR(d.value, 2e-3, 1e-12);
        EXPECT_FALSE(d.field.empty());
        EXPECT_FALSE(d.likely_limit.empty());
    }
}

// NaN slips through comparisons: it must be caught as a velocity, as a force (two grains at one point) and as a spin.
TEST(AdvanceGrains, NotANumberIsReported) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const bool contacts : {true, false}) {
        GrainSystem s = system_of(box(Vec3::Constant(1.0)), contacts ? elastic : "law = \"none\"");
        for (int k = 0; k < 5; ++k) add(s, radius, Vec3(0.1 * k + 0.2, 0.5, 0.5));
        s.grains.v[3].y() = nan;
        s.grains.v[4].z() = nan;
        try {
            advance_grains(s, 1, 1e-5);
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Diverged& d) {
            EXPECT_EQ(d.step, 1);
            EXPECT_EQ(d.index, 3);
            EXPECT_TRUE(std::isnan(d.value));
        }
    }
    GrainSystem same = system_of(box(Vec3::Constant(1.0)), elastic);
    add(same, radius, Vec3(0.5, 0.5, 0.5));
    add(same, radius, Vec3(0.5, 0.5, 0.5));
    EXPECT_THROW(advance_grains(same, 2, 1e-6), Diverged);
}
// One made by the forces of the last step of all: no later drift sees it.
TEST(AdvanceGrains, NotANumberInTheLastKickIsReported) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), elastic);
    add(s, radius, Vec3(0.5, 0.5, 0.5));
    add(s, radius, Vec3(0.5, 0.5, 0.5 + 3.0 * radius), Vec3(0.0, 0.0, -0.5 * radius / 1e-3));
    add(s, radius, Vec3(0.5, 0.5, 0.5 + 6.0 * radius));
    start(s, 1e-3);
    s.domain.gravity.x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(advance_grains(s, 1, 1e-3), Diverged);
}
TEST(AdvanceGrains, ASpinThatIsNotANumberIsReported) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0)), rough);
    add(s, radius, Vec3(0.5, 0.5, 0.5), Vec3::Zero(), Vec3(std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0));
    EXPECT_THROW(advance_grains(s, 2, 1e-6), Diverged);
}

// Independent grains may move as far as they like in a step; those that can touch two images of one another may not.
TEST(AdvanceGrains, ContactlessGrainsAndShortBoxes) {
    GrainSystem s = system_of(box(Vec3::Constant(1.0), {true, true, true}), "law = \"none\"");
    add(s, radius, Vec3(0.5, 0.5, 0.5), Vec3(7.0, 0.0, 0.0));
    EXPECT_NO_THROW(advance_grains(s, 3, 1.0));
    EXPECT_NEAR(unwrapped(s.grains, s.domain, 0).x(), 21.5, 1e-12);
    GrainSystem narrow = system_of(box(Vec3(1.9e-3, 1e-2, 1e-2), {true, false, false}), elastic);
    add(narrow, radius, Vec3(1e-3, 5e-3, 5e-3));
    expect_error([&] { start(narrow); }, {"domain.size", "0.0019", "x"});
}
