// Rolling resistance: direction, limit, rest.
#include "dem/rolling_laws.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double radius = 5e-4, normal_force = 0.2, inertia = 4e-13;
constexpr double stiffness = 1e-2, limit = 0.1 * radius * normal_force; // of the laws below

Rolling<double> rolling(const Space<double>& rotation, double dt) {
    return {{0, 0, 1}, rotation, normal_force, radius, 1.0 / inertia, dt, {0, 0, 0}};
}
double norm(const Space<double>& a) { return std::sqrt(dot(a, a)); }

const ConstantTorque constant() { return rolling_of<ConstantTorque>("friction = 0.1"); }
const ElasticPlastic elastic_plastic() {
    return rolling_of<ElasticPlastic>("friction = 0.1\nstiffness = 1e-2\ndamping = 0.3");
}

/// Turns one body of `inertia` against a fixed one under `driving` [N m] for `time`; returns the angle at the end and
/// the last angular velocity.
std::pair<double, double> turned(const ElasticPlastic& law, double driving, double omega, double dt, int steps) {
    Space<double> bend{0, 0, 0};
    double angle = 0.0;
    for (int k = 0; k < steps; ++k) {
        const double m = ElasticPlastic::torque(rolling({omega, 0, 0}, dt), law.parameters, bend).x;
        omega += dt * (m + driving) / inertia;
        angle += dt * omega;
    }
    return {angle, omega};
}

} // namespace

// A couple along the rotation, or of another size than mu_r R f_n.
TEST(RollingLaws, ConstantTorqueOpposesTheRotationWithItsLimit) {
    Space<double> none{0, 0, 0};
    const auto m = ConstantTorque::torque(rolling({3.0, -4.0, 0.0}, 1e-9), constant().parameters, none);
    EXPECT_NEAR(m.x, -0.6 * 0.1 * radius * normal_force, 1e-18);
    EXPECT_NEAR(m.y, 0.8 * 0.1 * radius * normal_force, 1e-18);
    EXPECT_EQ(m.z, 0.0);
}

// A couple that turns the rotation round in a long step and makes grains at rest shiver.
TEST(RollingLaws, ConstantTorqueStopsRatherThanReverses) {
    Space<double> none{0, 0, 0};
    for (const double dt : {1e-6, 1e-4, 1.0}) {
        const double omega = 2.0;
        const auto m = ConstantTorque::torque(rolling({omega, 0, 0}, dt), constant().parameters, none);
        EXPECT_GE(omega + dt * m.x / inertia, -1e-15);
        EXPECT_LT(omega + dt * m.x / inertia, omega);
    }
    const auto rest = ConstantTorque::torque(rolling({0, 0, 0}, 1e-6), constant().parameters, none);
    EXPECT_EQ(norm(rest), 0.0);
    const auto no_step = ConstantTorque::torque(rolling({0, 0, 0}, 0.0), constant().parameters, none);
    EXPECT_EQ(norm(no_step), 0.0); // 0/0
}

// Small rotations: -(k_r s + c_r w) with c_r = 2 zeta sqrt(k_r I*), s at the middle of the step.
TEST(RollingLaws, ElasticPlasticByHand) {
    Space<double> bend{0, 1e-6, 0};
    const double dt = 1e-7, w = 1e-3;
    const auto m = ElasticPlastic::torque(rolling({w, 0, 0}, dt), elastic_plastic().parameters, bend);
    EXPECT_NEAR(m.x, -stiffness * 0.5 * dt * w - 2.0 * 0.3 * std::sqrt(stiffness * inertia) * w, 1e-22);
    EXPECT_NEAR(m.y, -stiffness * 1e-6, 1e-20);
    EXPECT_NEAR(bend.x, dt * w, 1e-24);
    EXPECT_NEAR(bend.y, 1e-6, 1e-18);
}

// A spring that keeps winding beyond the yield couple, and a couple larger than it.
TEST(RollingLaws, ElasticPlasticYieldsAtItsLimit) {
    const ElasticPlastic law = elastic_plastic();
    Space<double> bend{0, 0, 0};
    for (int k = 0; k < 20000; ++k) {
        const auto m = ElasticPlastic::torque(rolling({5.0, 0, 0}, 1e-5), law.parameters, bend);
        if (k > 10000) {
            ASSERT_NEAR(m.x, -limit, 1e-12 * limit);
        }
    }
    EXPECT_NEAR(bend.x, limit / stiffness + 0.5e-5 * 5.0, 1e-12); // unloads at once when the rotation turns
}

// Creep: below the limit the body comes to rest at driving/k_r and stays; above it, it goes on turning.
TEST(RollingLaws, ElasticPlasticHoldsBelowItsLimit) {
    const double dt = 2e-7; // the period 2 pi sqrt(I/k_r) is 40 us
    const auto [half, slow] = turned(elastic_plastic(), 0.5 * limit, 0.0, dt, 100000);
    const auto [later, slower] = turned(elastic_plastic(), 0.5 * limit, 0.0, dt, 200000);
    EXPECT_NEAR(half, 0.5 * limit / stiffness, 1e-6 * limit / stiffness);
    EXPECT_NEAR(later, half, 1e-9 * half);
    EXPECT_NEAR(slow, 0.0, 1e-9);
    EXPECT_NEAR(slower, 0.0, 1e-9);
    const auto [angle, fast] = turned(elastic_plastic(), 1.5 * limit, 0.0, dt, 10000);
    EXPECT_GT(angle, 10.0 * limit / stiffness);
    EXPECT_NEAR(fast, 0.5 * limit / inertia * 10000 * dt, 0.1 * fast);
}

// Twist must not bend the rolling spring: the part along the normal is dropped when the normal turns.
TEST(RollingLaws, ElasticPlasticForgetsTheTwist) {
    Space<double> bend{1e-6, 0, 5e-6};
    const auto m = ElasticPlastic::torque(rolling({0, 0, 0}, 1e-6), elastic_plastic().parameters, bend);
    EXPECT_EQ(m.z, 0.0);
    EXPECT_EQ(bend.z, 0.0);
    EXPECT_EQ(bend.x, 1e-6);
}

// Without a normal force there is no resistance (0/0 included).
TEST(RollingLaws, NoNormalForceNoCouple) {
    Rolling<double> r = rolling({2.0, 1.0, 0.0}, 1e-6);
    r.normal_force = 0.0;
    Space<double> bend{1e-6, 0, 0}, straight{0, 0, 0};
    EXPECT_EQ(norm(ConstantTorque::torque(r, constant().parameters, bend)), 0.0);
    EXPECT_EQ(norm(ElasticPlastic::torque(r, elastic_plastic().parameters, bend)), 0.0);
    r.rotation = {0, 0, 0};
    EXPECT_EQ(norm(ElasticPlastic::torque(r, elastic_plastic().parameters, straight)), 0.0);
}

// A pack must give what the scalar law gives.
TEST(RollingLaws, LanesAgreeWithTheScalarLaw) {
    Random random(2);
    const ElasticPlastic law = elastic_plastic();
    const auto p = [](double x) { return broadcast<Pack>(x); };
    for (int repeat = 0; repeat < 200; ++repeat) {
        Rolling<Pack> packed{{p(0), p(0), p(1)}, {},      p(normal_force),   p(radius),
                             p(1.0 / inertia),   p(1e-6), {p(0), p(0), p(0)}};
        Space<Pack> bend{};
        Rolling<double> one[8];
        Space<double> own[8];
        for (int k = 0; k < 8; ++k) {
            one[k] = rolling({random.normal(), random.normal(), 0.0}, 1e-6);
            own[k] = {2e-3 * random.normal(), 2e-3 * random.normal(), 0.0};
            packed.rotation.x[k] = one[k].rotation.x, packed.rotation.y[k] = one[k].rotation.y,
            packed.rotation.z[k] = 0;
            bend.x[k] = own[k].x, bend.y[k] = own[k].y, bend.z[k] = 0;
        }
        const auto m = ElasticPlastic::torque(packed, {p(0.1), p(stiffness), p(0.3)}, bend);
        for (int k = 0; k < 8; ++k) {
            const auto n = ElasticPlastic::torque(one[k], law.parameters, own[k]);
            ASSERT_NEAR(m.x[k], n.x, 1e-14 * norm(n));
            ASSERT_NEAR(m.y[k], n.y, 1e-14 * norm(n));
            ASSERT_NEAR(bend.x[k], own[k].x, 1e-14 * norm(own[k]));
        }
    }
}

// Keys that are missing, negative or left over.
TEST(RollingLaws, ParameterErrors) {
    const auto made = [](std::string_view text) {
        Table t = table_of(text);
        make_family<RollingLaw>(t.law("rolling"));
        t.finish();
    };
    expect_error([&] { made("rolling = \"constant_torque\""); }, {"rolling.friction", "missing"});
    expect_error([&] { made("rolling = {law = \"constant_torque\", friction = -0.1}"); }, {"rolling.friction", "-0.1"});
    expect_error([&] { made("rolling = {law = \"constant_torque\", friction = 0.1, stiffness = 1.0}"); },
                 {"rolling.stiffness", "unknown"});
    expect_error([&] { made("rolling = {law = \"elastic_plastic\", friction = 0.1, stiffness = 0.0, damping = 0.0}"); },
                 {"rolling.stiffness", "0"});
    expect_error(
        [&] { made("rolling = {law = \"elastic_plastic\", friction = 0.1, stiffness = 1.0, damping = -1.0}"); },
        {"rolling.damping", "-1"});
    expect_error([&] { made("rolling = \"sticky\""); }, {"sticky", "constant_torque", "elastic_plastic"});
    EXPECT_NO_THROW(made("rolling = \"none\""));
}
