// Contact laws as functions of one contact: impacts integrated by an independent Runge-Kutta scheme, limits, signs.
#include "dem/contact_laws.hpp"

#include "grain_fixtures.hpp"

#include <functional>
#include <numbers>

using namespace plumb;
using namespace plumb::fixture;

namespace {

using std::numbers::pi;

constexpr std::string_view linear = "law = \"linear_spring\"\nstiffness = 1e4\nfriction = 0.0\n";
constexpr std::string_view frictional = "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 0.8\nfriction = 0.4\n"
                                        "tangential_stiffness = 3e3\ntangential_damping = 0.02\n"
                                        "rolling = \"none\"\n";
constexpr std::string_view coulomb = "law = \"linear_spring_coulomb\"\nstiffness = 1e4\nrestitution = 0.8\n"
                                     "friction = 0.4\nrolling = \"none\"\n";
constexpr std::string_view hertz = "law = \"hertz_mindlin\"\nyoung = 1e8\npoisson = 0.25\nfriction = 0.4\n"
                                   "rolling = \"none\"\n";

std::string with(std::string_view text, std::string_view key, double value) {
    return fmt::format("{}{} = {:.17e}\n", text, key, value);
}

Contact<double> contact_at(double overlap, const Space<double>& velocity, double dt = 0.0) {
    return {overlap, {1.0, 0.0, 0.0}, velocity, 1.0 / 1e-5, 1.0 / 5e-4, dt, {0.0, 0.0, 0.0}};
}

struct Impact {
    double speed; // when the overlap is back at zero [m/s]
    double time;  // of contact [s]
};

/// Head-on impact of reduced mass m at speed v0 by the classical Runge-Kutta scheme with about `steps` steps.
template <class Law>
Impact impact(const Law& law, double m, double inverse_radius, double v0, double guess, int steps) {
    const auto force = [&](double overlap, double v) {
        Space<double> none{0, 0, 0};
        const Contact<double> c{overlap, {1, 0, 0}, {v, 0, 0}, 1.0 / m, inverse_radius, 0.0, {0, 0, 0}};
        return Law::force(c, law.parameters, none).normal;
    };
    double overlap = 0.0, v = -v0, t = 0.0;
    const auto stepped = [&](double dt) {
        const double k1 = -v, l1 = force(overlap, v) / m;
        const double k2 = -(v + 0.5 * dt * l1), l2 = force(overlap + 0.5 * dt * k1, v + 0.5 * dt * l1) / m;
        const double k3 = -(v + 0.5 * dt * l2), l3 = force(overlap + 0.5 * dt * k2, v + 0.5 * dt * l2) / m;
        const double k4 = -(v + dt * l3), l4 = force(overlap + dt * k3, v + dt * l3) / m;
        return std::pair{overlap + dt / 6.0 * (k1 + 2 * k2 + 2 * k3 + k4), v + dt / 6.0 * (l1 + 2 * l2 + 2 * l3 + l4)};
    };
    const double dt = guess / steps;
    for (int k = 0; k < 20 * steps; ++k) {
        const auto [next, next_v] = stepped(dt);
        if (next <= 0.0) { // bisection for the end of the contact
            double low = 0.0, high = dt;
            for (int b = 0; b < 60; ++b) (stepped(0.5 * (low + high)).first > 0.0 ? low : high) = 0.5 * (low + high);
            return {stepped(low).second, t + low};
        }
        overlap = next, v = next_v, t += dt;
    }
    ADD_FAILURE() << "the contact does not end";
    return {0.0, 0.0};
}

/// A contact with random overlap, direction and velocity.
Contact<double> random_contact(Random& random) {
    const Vec3 n = random_vector(random, -1.0, 1.0).normalized(), v = random_vector(random, -0.1, 0.1);
    return {random.uniform(-1e-6, 1e-5),
            {n.x(), n.y(), n.z()},
            {v.x(), v.y(), v.z()},
            random.uniform(1e4, 1e6),
            random.uniform(1e3, 1e4),
            1e-7,
            {1e-4 * v.x(), 1e-4 * v.y(), 1e-4 * v.z()}};
}
Space<double> random_stretch(Random& random) {
    const Vec3 s = random_vector(random, -1e-6, 1e-6);
    return {s.x(), s.y(), s.z()};
}
double norm(const Space<double>& a) { return std::sqrt(dot(a, a)); }

template <class Law, class T> typename Law::template Parameters<T> spread(const Law& law) {
    constexpr std::size_t n = sizeof(law.parameters) / sizeof(double);
    double one[n];
    std::memcpy(one, &law.parameters, sizeof one);
    T all[n];
    for (std::size_t q = 0; q < n; ++q) all[q] = broadcast<T>(one[q]);
    typename Law::template Parameters<T> packed;
    std::memcpy(&packed, all, sizeof packed);
    return packed;
}

/// Equal bits; where the compiler may contract products and sums into one rounding it need not do so in the same places
/// of both forms, which leaves a few roundings.
bool agree(const double* a, const double* b, std::size_t n) {
#ifdef __FMA__
    const double largest =
        std::abs(*std::max_element(a, a + n, [](double p, double q) { return std::abs(p) < std::abs(q); }));
    for (std::size_t q = 0; q < n; ++q)
        if (std::abs(a[q] - b[q]) > 1e-14 * largest) return false;
    return true;
#else
    return same_bits(a, b, n);
#endif
}

/// Eight random contacts by the pack and by the scalar form.
template <class Law> void expect_lanes_are_scalars(const Law& law) {
    Random random(17);
    const auto parameters = spread<Law, Pack>(law);
    std::size_t different = 0;
    for (int repeat = 0; repeat < 500; ++repeat) {
        Contact<Pack> packed{};
        Space<Pack> stretch{};
        Contact<double> one[8];
        Space<double> own[8];
        for (int k = 0; k < 8; ++k) {
            one[k] = random_contact(random);
            own[k] = random_stretch(random);
            packed.overlap[k] = one[k].overlap, packed.inverse_mass[k] = one[k].inverse_mass;
            packed.inverse_radius[k] = one[k].inverse_radius, packed.time_step[k] = one[k].time_step;
            packed.normal.x[k] = one[k].normal.x, packed.normal.y[k] = one[k].normal.y;
            packed.normal.z[k] = one[k].normal.z, packed.velocity.x[k] = one[k].velocity.x;
            packed.velocity.y[k] = one[k].velocity.y, packed.velocity.z[k] = one[k].velocity.z;
            packed.turn.x[k] = one[k].turn.x, packed.turn.y[k] = one[k].turn.y, packed.turn.z[k] = one[k].turn.z;
            stretch.x[k] = own[k].x, stretch.y[k] = own[k].y, stretch.z[k] = own[k].z;
        }
        const ContactForce<Pack> f = Law::force(packed, parameters, stretch);
        for (int k = 0; k < 8; ++k) {
            const ContactForce<double> g = Law::force(one[k], law.parameters, own[k]);
            const double lane[7] = {f.normal[k],  f.tangential.x[k], f.tangential.y[k], f.tangential.z[k],
                                    stretch.x[k], stretch.y[k],      stretch.z[k]};
            const double scalar[7] = {g.normal, g.tangential.x, g.tangential.y, g.tangential.z,
                                      own[k].x, own[k].y,       own[k].z};
            different += agree(lane, scalar, 7) ? 0U : 1U;
        }
    }
    EXPECT_EQ(different, 0U) << Law::name << ": of 4000 contacts";
}

} // namespace

// beta = -ln e/sqrt(pi^2 + ln^2 e): a log10, a lost pi. e = exp(-pi) gives 1/sqrt(2), e = 1 nothing.
TEST(ContactLaws, DampingRatioByHand) {
    EXPECT_NEAR(damping_ratio(std::exp(-pi)), std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(damping_ratio(std::exp(-pi / std::sqrt(3.0))), 0.5, 1e-15);
    EXPECT_EQ(damping_ratio(1.0), 0.0);
}

// The damping of a restitution: c = 2 beta sqrt(k m*), here sqrt(2 k m*), for every mass.
TEST(ContactLaws, RestitutionIsADampingOfEveryMass) {
    const auto law = law_of<LinearSpring>(with(linear, "restitution", std::exp(-pi)));
    for (const double m : {1e-9, 1e-5, 2.0}) {
        const auto given = law_of<LinearSpring>(with(linear, "damping", std::sqrt(2.0 * 1e4 * m)));
        Space<double> none{0, 0, 0};
        Contact<double> c = contact_at(1e-6, {-0.3, 0.0, 0.0});
        c.inverse_mass = 1.0 / m;
        const double by_root = LinearSpring::force(c, law.parameters, none).normal;
        EXPECT_NEAR(by_root, 1e4 * 1e-6 + 0.3 * std::sqrt(2.0 * 1e4 * m), 1e-13 * by_root);
        EXPECT_NEAR(LinearSpring::force(c, given.parameters, none).normal, by_root, 1e-13 * by_root);
    }
}

// A wrong damping, mass or sign: the ratio of the speeds of a head-on impact is the number in the scene, for every
// mass. Both linear laws share their normal part.
TEST(ContactLaws, LinearImpactHasItsRestitutionAndContactTime) {
    for (const double e : {0.1, 0.5, 0.9, 1.0})
        for (const double m : {1e-6, 3e-5}) {
            const auto law = law_of<LinearSpring>(with(linear, "restitution", e));
            const double time = law.contact_time(1.0 / m, 1e3, 0.2);
            const Impact i = impact(law, m, 1e3, 0.2, time, 4000);
            EXPECT_NEAR(i.speed, e * 0.2, 1e-9);
            EXPECT_NEAR(i.time, time, 1e-9 * time);
        }
    const auto law = law_of<LinearSpring>(with(linear, "restitution", 1.0));
    EXPECT_NEAR(law.contact_time(1.0 / 1e-6, 1e3, 1.0), pi * 1e-5, 1e-18); // pi sqrt(m/k)
}

// A Hertzian damping whose restitution depends on speed, mass, size or modulus (it must not), or a wrong prefactor.
TEST(ContactLaws, HertzImpactHasItsRestitutionAtEverySpeed) {
    for (const double e : {0.2, 0.6, 0.95, 1.0})
        for (const auto& [m, v0] : {std::pair{1e-6, 1.0}, std::pair{1e-6, 0.01}, std::pair{4e-4, 1.0}}) {
            const auto law = law_of<HertzMindlin>(with(hertz, "restitution", e));
            const Impact i = impact(law, m, 2e3, v0, law.contact_time(1.0 / m, 2e3, v0), 20000);
            EXPECT_NEAR(i.speed / v0, e, 2e-4) << m << " " << v0;
        }
}

// Contact time of an elastic Hertzian impact: the factor 2.94 and the power 1/5 of the speed.
TEST(ContactLaws, HertzContactTime) {
    const auto law = law_of<HertzMindlin>(with(hertz, "restitution", 1.0));
    for (const double v0 : {0.01, 1.0}) {
        const double time = law.contact_time(1e5, 2e3, v0);
        EXPECT_NEAR(impact(law, 1e-5, 2e3, v0, time, 20000).time, time, 1e-4 * time);
    }
    const double ratio = law.contact_time(1e5, 2e3, 0.01) / law.contact_time(1e5, 2e3, 1.0);
    EXPECT_NEAR(ratio, std::pow(100.0, 0.2), 1e-12);
    // At rest: the contact of an overlap of 1e-3 R*, which the speed sqrt(4/5 k_h o^2.5 / m*) reaches.
    const double k_h = 4.0 / 3.0 * law.parameters.modulus / std::sqrt(2e3), o = 1e-3 / 2e3;
    const double slow = std::sqrt(0.8 * k_h * std::pow(o, 2.5) * 1e5);
    EXPECT_NEAR(law.contact_time(1e5, 2e3, 0.0), law.contact_time(1e5, 2e3, slow),
                1e-9 * law.contact_time(1e5, 2e3, slow));
    EXPECT_NEAR(law.contact_time(1e5, 2e3, 0.0), 2.9432 * o / slow, 1e-9 * o / slow);
    EXPECT_EQ(contact_time(ContactLaw(law), 1e5, 2e3, 1.0), law.contact_time(1e5, 2e3, 1.0));
}

// Hertz and Mindlin by hand for two spheres of 1 mm radius: factors 4/3 and 8, E* of two bodies, G* = G/(2 (2 - nu)).
TEST(ContactLaws, HertzMindlinByHand) {
    const auto law = law_of<HertzMindlin>(with(hertz, "restitution", 1.0));
    const double r = 5e-4, o = 2e-6, e_star = 1e8 / (2.0 * (1.0 - 0.0625)), g = 1e8 / 2.5, g_star = g / 3.5;
    Space<double> stretch{0, 0, 0};
    const double dt = 1e-8, slip = 0.5;
    const auto f = HertzMindlin::force(contact_at(o, {0.0, slip, 0.0}, dt), law.parameters, stretch);
    EXPECT_NEAR(f.normal, 4.0 / 3.0 * e_star * std::sqrt(r) * std::pow(o, 1.5), 1e-12 * f.normal);
    EXPECT_NEAR(f.tangential.y, -8.0 * g_star * std::sqrt(r * o) * 0.5 * dt * slip, 1e-12 * std::abs(f.tangential.y));
    EXPECT_NEAR(stretch.y, dt * slip, 1e-12 * dt * slip);
}

// Loading turned into unloading: the old tangential force must stay when the overlap grows, and shrink with the
// stiffness when it shrinks. Overlap 1 -> 4 doubles the stiffness.
TEST(ContactLaws, MindlinForceStaysOnLoadingAndShrinksOnUnloading) {
    const auto law = law_of<HertzMindlin>(with("law = \"hertz_mindlin\"\nyoung = 1e8\npoisson = 0.25\nfriction = 9\n"
                                               "rolling = \"none\"\n",
                                               "restitution", 1.0));
    const double dt = 1e-6;
    const auto tangential = [&](double overlap, double before) {
        Space<double> stretch{0, 1e-8, 0}, none{0, 0, 0};
        // before = overlap + v_n dt - f_n dt^2/(2 m*); without damping f_n does not depend on v_n
        Contact<double> c = contact_at(overlap, {0.0, 0.0, 0.0}, dt);
        const double fn = HertzMindlin::force(c, law.parameters, none).normal;
        const double vn = (before - overlap) / dt + 0.5 * dt * fn * c.inverse_mass;
        return HertzMindlin::force(contact_at(overlap, {vn, 0.0, 0.0}, dt), law.parameters, stretch).tangential.y;
    };
    const double at_1 = tangential(1e-6, 1e-6), at_4 = tangential(4e-6, 4e-6);
    EXPECT_NEAR(at_4, 2.0 * at_1, 1e-9 * std::abs(at_1));
    EXPECT_NEAR(tangential(4e-6, 1e-6), at_1, 1e-9 * std::abs(at_1)); // loaded: same force as before
    EXPECT_NEAR(tangential(1e-6, 4e-6), at_1, 1e-9 * std::abs(at_1)); // unloaded: same stretch, softer spring
}

// Attraction, dashpots with the wrong sign, friction along the slip.
TEST(ContactLaws, Signs) {
    const auto check = [](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        Space<double> stretch{0, 0, 0};
        const double at_rest = Law::force(contact_at(1e-6, {0, 0, 0}), law.parameters, stretch).normal;
        const double approaching = Law::force(contact_at(1e-6, {-0.01, 0, 0}), law.parameters, stretch).normal;
        const double leaving = Law::force(contact_at(1e-6, {0.01, 0, 0}), law.parameters, stretch).normal;
        EXPECT_GT(at_rest, 0.0) << Law::name;
        EXPECT_GT(approaching, at_rest) << Law::name;
        EXPECT_LT(leaving, at_rest) << Law::name;
        stretch = {0, 0, 0};
        const auto f = Law::force(contact_at(1e-6, {0.0, 0.3, -0.4}, 1e-7), law.parameters, stretch).tangential;
        EXPECT_EQ(f.x, 0.0) << Law::name;
        EXPECT_LT(f.y, 0.0) << Law::name;
        EXPECT_NEAR(f.z / f.y, -4.0 / 3.0, 1e-12) << Law::name;
    };
    check(law_of<LinearSpring>(frictional));
    check(law_of<LinearSpringCoulomb>(coulomb));
    check(law_of<HertzMindlin>(with(hertz, "restitution", 0.8)));
}

// A tangential force beyond mu f_n, one that pulls while the normal force does, one out of the contact plane.
TEST(ContactLaws, CoulombsLimitHolds) {
    const auto check = [](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        Random random(5);
        int sliding = 0;
        for (int repeat = 0; repeat < 5000; ++repeat) {
            const Contact<double> c = random_contact(random);
            Space<double> stretch = random_stretch(random);
            const auto f = Law::force(c, law.parameters, stretch);
            const double limit = 0.4 * std::max(f.normal, 0.0);
            ASSERT_LE(norm(f.tangential), limit * (1.0 + 1e-14)) << Law::name;
            ASSERT_LE(std::abs(dot(f.tangential, c.normal)), 1e-13 * limit) << Law::name;
            if (limit > 0.0 && norm(f.tangential) > 0.999999 * limit) ++sliding;
        }
        EXPECT_GT(sliding, 100) << Law::name; // the limit was really met
        EXPECT_LT(sliding, 4900) << Law::name;
    };
    check(law_of<LinearSpring>(frictional));
    check(law_of<LinearSpringCoulomb>(coulomb));
    check(law_of<HertzMindlin>(with(hertz, "restitution", 0.8)));
}

// A sliding contact that winds up its spring: when the slip turns round the force must turn at once, not after the
// distance slid. In steady sliding the spring holds exactly the limit less the dashpot's share.
TEST(ContactLaws, SlidingDoesNotWindUpTheSpring) {
    const auto law = law_of<LinearSpring>(frictional);
    Space<double> stretch{0, 0, 0};
    const double dt = 1e-6;
    for (int k = 0; k < 10000; ++k) LinearSpring::force(contact_at(1e-5, {0.0, 0.1, 0.0}, dt), law.parameters, stretch);
    const double limit = 0.4 * 1e4 * 1e-5;
    EXPECT_NEAR(stretch.y, (limit - 0.02 * 0.1) / 3e3 + 0.5 * dt * 0.1, 1e-9 * limit);
    const double turn = 2.0 * limit / 3e3; // slip that takes the spring from +limit to -limit
    int steps = 0;
    for (double f = -limit; f < 0.99 * limit && steps < 100000; ++steps)
        f = LinearSpring::force(contact_at(1e-5, {0.0, -0.1, 0.0}, dt), law.parameters, stretch).tangential.y;
    EXPECT_LT(steps * 0.1 * dt, 1.05 * turn);
}

// Friction that overshoots: whatever the step, the slip of two free spheres after it points as before or is zero.
TEST(ContactLaws, HistoryFreeFrictionNeverReversesTheSlip) {
    const auto law = law_of<LinearSpringCoulomb>(coulomb);
    Random random(9);
    int stopped = 0;
    for (int repeat = 0; repeat < 5000; ++repeat) {
        Contact<double> c = random_contact(random);
        c.time_step = std::pow(10.0, random.uniform(-9.0, 1.0));
        Space<double> none{0, 0, 0};
        const auto f = LinearSpringCoulomb::force(c, law.parameters, none);
        const Space<double> slip = c.velocity - dot(c.velocity, c.normal) * c.normal;
        // surface of a solid sphere: 1/m + R^2/I = 3.5/m
        const Space<double> after = slip + (3.5 * c.inverse_mass * c.time_step) * f.tangential;
        ASSERT_GE(dot(after, slip), -1e-12 * dot(slip, slip));
        ASSERT_LE(dot(after, after), dot(slip, slip) * (1.0 + 1e-12));
        if (dot(after, slip) < 0.67 * dot(slip, slip)) ++stopped; // 1 - stopping_share
    }
    EXPECT_GT(stopped, 100);
    Space<double> none{0, 0, 0};
    const auto still = LinearSpringCoulomb::force(contact_at(1e-6, {0, 0, 0}, 0.0), law.parameters, none);
    EXPECT_EQ(still.tangential.y, 0.0); // 0/0 at rest in a step of no length
}

// A stretch that shortens when its contact turns: rigid rotation of a pair by one radian in the plane of the stretch
// must turn it and keep its length, to second order in the step; across that plane nothing may change at all.
TEST(ContactLaws, AStretchTurnsWithItsContact) {
    const auto error = [](int steps) {
        const double angle = 1.0 / steps;
        Space<double> stretch{0.0, 1.0, 0.5};
        for (int k = 1; k <= steps; ++k) {
            const double c = std::cos(k * angle), s = std::sin(k * angle);
            stretch = turned(stretch, Space<double>{c, s, 0.0}, Space<double>{-s * angle, c * angle, 0.0});
        }
        EXPECT_NEAR(stretch.z, 0.5, 1e-15);
        return norm(stretch - Space<double>{-std::sin(1.0), std::cos(1.0), 0.5});
    };
    EXPECT_LT(error(100), 1e-5);
    EXPECT_GT(order_of(error(50), error(100), 2.0), 1.9);
}

// The packed form must be the scalar one: walls use the one, pairs the other.
TEST(ContactLaws, LanesHaveTheBitsOfTheScalarLaw) {
    expect_lanes_are_scalars(law_of<LinearSpring>(frictional));
    expect_lanes_are_scalars(law_of<LinearSpringCoulomb>(coulomb));
    expect_lanes_are_scalars(law_of<HertzMindlin>(with(hertz, "restitution", 0.8)));
}

// A cycle that makes energy: random closed paths in overlap and slip, gone through slowly, may cost work but never
// give any (Hertz-Mindlin without the rule for unloading gives some).
TEST(ContactLaws, NoClosedCycleOfHertzMindlinGivesEnergy) {
    const auto law = law_of<HertzMindlin>(with(hertz, "restitution", 1.0));
    Random random(21);
    const int steps = 2000;
    const double dt = 1e-6, overlap0 = 1e-6;
    for (int repeat = 0; repeat < 200; ++repeat) {
        std::vector<std::array<double, 3>> corners{{overlap0, 0.0, 0.0}}; // overlap and two slips
        for (int k = 0; k < 5; ++k) {
            const double overlap = random.uniform(2e-7, 4e-6), slip = random.uniform(-4e-7, 4e-7);
            corners.push_back({overlap, slip, repeat % 2 == 0 ? 0.0 : random.uniform(-4e-7, 4e-7)});
        }
        corners.push_back(corners.front());
        Space<double> stretch{0, 0, 0};
        double gained = 0.0, moved = 0.0; // work done by the force, and the sum of its parts
        ContactForce<double> last = HertzMindlin::force(contact_at(overlap0, {0, 0, 0}, 0.0), law.parameters, stretch);
        for (std::size_t leg = 1; leg < corners.size(); ++leg)
            for (int k = 1; k <= steps; ++k) {
                std::array<double, 3> step{};
                for (std::size_t c = 0; c < 3; ++c) step[c] = (corners[leg][c] - corners[leg - 1][c]) / steps;
                const double overlap = corners[leg - 1][0] + k * step[0];
                const auto now = HertzMindlin::force(
                    contact_at(overlap, {-step[0] / dt, step[1] / dt, step[2] / dt}, dt), law.parameters, stretch);
                const double work = -0.5 * (now.normal + last.normal) * step[0] +
                                    0.5 * (now.tangential.y + last.tangential.y) * step[1] +
                                    0.5 * (now.tangential.z + last.tangential.z) * step[2];
                gained += work;
                moved += std::abs(work);
                last = now;
            }
        ASSERT_LT(gained, 1e-4 * moved) << repeat;
    }
}
