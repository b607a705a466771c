// The sweep over pairs against plain formulas for one pair after the other, for every law.
#include "dem/contact_sweep.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

/// The parameters of one material pair, in words.
struct Numbers {
    double stiffness = 1e4, restitution = 0.7, friction = 0.4, tangential_stiffness = 4e3, tangential_damping = 0.03;
    double young = 2e8, poisson = 0.3;
    double rolling_friction = 0.2, rolling_stiffness = 1e-2, rolling_damping = 0.3;
};

constexpr std::array contacts{"linear_spring", "linear_spring_coulomb", "hertz_mindlin"};
constexpr std::array rollings{"none", "constant_torque", "elastic_plastic"};

std::string text_of(const std::string& contact, const std::string& rolling, const Numbers& n) {
    std::string text =
        fmt::format("law = \"{}\"\nrestitution = {}\nfriction = {}\n", contact, n.restitution, n.friction);
    if (contact == "hertz_mindlin")
        text += fmt::format("young = {}\npoisson = {}\n", n.young, n.poisson);
    else
        text += fmt::format("stiffness = {}\n", n.stiffness);
    if (contact == "linear_spring")
        text += fmt::format("tangential_stiffness = {}\ntangential_damping = {}\n", n.tangential_stiffness,
                            n.tangential_damping);
    text += fmt::format("rolling = {{law = \"{}\"", rolling);
    if (rolling != "none") text += fmt::format(", friction = {}", n.rolling_friction);
    if (rolling == "elastic_plastic")
        text += fmt::format(", stiffness = {}, damping = {}", n.rolling_stiffness, n.rolling_damping);
    return text + "}\n";
}

Vec3 without(const Vec3& a, const Vec3& n) { return a - a.dot(n) * n; }

struct PairResult {
    Vec3 force = Vec3::Zero(), torque_i = Vec3::Zero(), torque_j = Vec3::Zero(), stretch = Vec3::Zero(),
         bend = Vec3::Zero();
};

/// Tangential force against `trial`, at most `limit`.
Vec3 limited(const Vec3& trial, double limit) {
    return trial.norm() > limit ? Vec3(-limit * trial.normalized()) : Vec3(-trial);
}

/// A memory of the old contact plane in the new one, right to second order in the angle `turn`.
Vec3 turned_by_hand(const Vec3& old, const Vec3& n, const Vec3& turn) {
    return without(old, n) + 0.5 * old.dot(n) * turn;
}

/// Force on i of two touching grains, as in the papers named at the laws.
PairResult pair_result(const GrainSystem& s, std::size_t i, std::size_t j, const std::string& contact,
                       const std::string& rolling, const Numbers& p, Vec3 stretch, Vec3 bend, double dt) {
    const Grains& g = s.grains;
    PairResult out;
    const Vec3 dx = s.domain.minimum_image(g.x[i] - g.x[j]);
    const double distance = dx.norm(), overlap = g.radius[i] + g.radius[j] - distance;
    if (overlap <= 0.0) return out;
    const Vec3 n = dx / distance;
    const double arm_i = g.radius[i] * distance / (g.radius[i] + g.radius[j]), arm_j = distance - arm_i;
    const Vec3 v = (g.v[i] + g.omega[i].cross(-arm_i * n)) - (g.v[j] + g.omega[j].cross(arm_j * n));
    const double vn = v.dot(n), m = 1.0 / (1.0 / g.mass[i] + 1.0 / g.mass[j]);
    const double r = 1.0 / (1.0 / g.radius[i] + 1.0 / g.radius[j]);
    const Vec3 vt = v - vn * n, turn = dt / distance * without(g.v[i] - g.v[j], n);
    const double log_e = std::log(p.restitution), beta = -log_e / std::hypot(std::numbers::pi, log_e);
    double fn = 0.0;
    Vec3 ft;
    if (contact == "hertz_mindlin") {
        const double e_star = p.young / (2.0 * (1.0 - p.poisson * p.poisson));
        const double g_star = p.young / (2.0 * (1.0 + p.poisson)) / (2.0 * (2.0 - p.poisson));
        const double sn = 2.0 * e_star * std::sqrt(r * overlap), st = 8.0 * g_star * std::sqrt(r * overlap);
        const double damping = 2.0 * std::sqrt(5.0 / 6.0) * beta; // Tsuji's form of the same damping
        fn = 2.0 / 3.0 * sn * overlap - damping * std::sqrt(sn * m) * vn;
        const double before = std::max(0.0, overlap + vn * dt - 0.5 * dt * dt * fn / m);
        if (before < overlap) stretch *= std::sqrt(before / overlap);
        const Vec3 now = turned_by_hand(stretch, n, turn) + 0.5 * dt * vt;
        const double ct = damping * std::sqrt(st * m);
        ft = limited(st * now + ct * vt, p.friction * std::max(0.0, fn));
        out.stretch = (-ft - ct * vt) / st + 0.5 * dt * vt;
    } else {
        fn = p.stiffness * overlap - 2.0 * beta * std::sqrt(p.stiffness * m) * vn;
        const double limit = p.friction * std::max(0.0, fn);
        if (contact == "linear_spring") {
            const Vec3 now = turned_by_hand(stretch, n, turn) + 0.5 * dt * vt;
            ft = limited(p.tangential_stiffness * now + p.tangential_damping * vt, limit);
            out.stretch = (-ft - p.tangential_damping * vt) / p.tangential_stiffness + 0.5 * dt * vt;
        } else {
            ft = -std::min(limit, 1.0 / 3.0 * 2.0 / 7.0 * m * vt.norm() / dt) * vt.normalized();
        }
    }
    out.force = fn * n + ft;
    out.torque_i = (-arm_i * n).cross(ft);
    out.torque_j = (arm_j * n).cross(-ft);
    const Vec3 w = without(g.omega[i] - g.omega[j], n);
    const double yield = p.rolling_friction * r * std::max(0.0, fn);
    const double inertia =
        1.0 / (2.5 / (g.mass[i] * g.radius[i] * g.radius[i]) + 2.5 / (g.mass[j] * g.radius[j] * g.radius[j]));
    Vec3 couple = Vec3::Zero();
    if (rolling == "constant_torque") couple = -std::min(yield, 1.0 / 3.0 * w.norm() * inertia / dt) * w.normalized();
    if (rolling == "elastic_plastic") {
        Vec3 now = turned_by_hand(bend, n, turn) + 0.5 * dt * w;
        const bool yields = p.rolling_stiffness * now.norm() > yield;
        if (yields) now = yield / p.rolling_stiffness * now.normalized();
        couple = -p.rolling_stiffness * now;
        if (!yields) couple -= 2.0 * p.rolling_damping * std::sqrt(p.rolling_stiffness * inertia) * w;
        out.bend = now + 0.5 * dt * w;
    }
    out.torque_i += couple;
    out.torque_j -= couple;
    return out;
}

/// Two materials and the pair of them; one material when they are alike.
GrainSystem packed_box(const std::string& contact, const std::string& rolling, const std::array<Numbers, 3>& numbers,
                       bool polydisperse, std::array<bool, 3> periodic) {
    GrainSystem s;
    s.domain = box(Vec3::Constant(7e-3), periodic);
    s.groups = {group_of("glass", 2500.0), group_of("steel", 7800.0)};
    s.contact = contact_model(
        {"glass", "steel"},
        {contact_of(text_of(contact, rolling, numbers[0])), contact_of(text_of(contact, rolling, numbers[1]))}, 2,
        {{"glass", "steel", contact_of(text_of(contact, rolling, numbers[2]))}}, "scene.toml");
    add_jittered_lattice(s, 7, polydisperse ? 4e-4 : 5e-4, polydisperse ? 6e-4 : 5e-4, 0.05, 0.05, 100.0, 4);
    start(s);
    return s;
}

void expect_plain_formulas(GrainSystem& s, const std::string& contact, const std::string& rolling,
                           const std::array<Numbers, 3>& numbers) {
    Neighbours& list = s.neighbours;
    Random random(8);
    const bool spring = contact != "linear_spring_coulomb", bends = rolling == "elastic_plastic";
    ASSERT_EQ(list.history, (spring ? 3 : 0) + (bends ? 3 : 0));
    for (std::size_t p = 0; p < list.count; ++p)
        for (int h = 0; h < list.history; ++h)
            list.remembered(p, h) = random.normal() * (spring && h < 3 ? 1e-6 : 1e-4);
    const double dt = 1e-6;
    std::vector<PairResult> want;
    std::vector<Vec3> force(s.grains.size(), Vec3::Zero());
    int touching = 0;
    for (std::size_t p = 0; p < list.count; ++p) {
        const auto i = static_cast<std::size_t>(list.i[p]), j = static_cast<std::size_t>(list.j[p]);
        const auto remembered = [&](int h) {
            return Vec3(list.remembered(p, h), list.remembered(p, h + 1), list.remembered(p, h + 2));
        };
        const Numbers& n =
            numbers[s.grains.group[i] != s.grains.group[j] ? 2U : static_cast<std::size_t>(s.grains.group[i])];
        want.push_back(pair_result(s, i, j, contact, rolling, n, spring ? remembered(0) : Vec3::Zero(),
                                   bends ? remembered(list.history - 3) : Vec3::Zero(), dt));
        force[i] += want.back().force;
        force[j] -= want.back().force;
        touching += want.back().force.norm() > 0.0 ? 1 : 0;
    }
    ASSERT_GT(touching, 200);
    evaluate_pairs(list, s.contact, s.domain, dt);
    const double small = 1e-11, f0 = 0.1, t0 = 1e-4; // scales of force [N] and torque [N m]
    for (std::size_t p = 0; p < list.count; ++p) {
        const auto i = static_cast<std::size_t>(list.i[p]), j = static_cast<std::size_t>(list.j[p]);
        const PairForce& f = list.force[p];
        ASSERT_LT((Vec3(f[0], f[1], f[2]) - want[p].force).norm(), small * f0) << p;
        Vec3 ti = s.grains.radius[i] * Vec3(f[3], f[4], f[5]), tj = s.grains.radius[j] * Vec3(f[3], f[4], f[5]);
        if (rolling != "none") {
            const Vec3 couple(list.couple[p][0], list.couple[p][1], list.couple[p][2]);
            ti += couple, tj -= couple;
        }
        ASSERT_LT((ti - want[p].torque_i).norm(), small * t0) << p;
        ASSERT_LT((tj - want[p].torque_j).norm(), small * t0) << p;
        for (int c = 0; c < 3; ++c) {
            if (spring) {
                ASSERT_NEAR(list.remembered(p, c), want[p].stretch[c], small * 1e-5) << p;
            }
            if (bends) {
                ASSERT_NEAR(list.remembered(p, list.history - 3 + c), want[p].bend[c], small * 1e-2) << p;
            }
        }
    }
    const std::vector<Vec3> sum = contact_forces(s);
    for (std::size_t k = 0; k < sum.size(); ++k) ASSERT_LT((sum[k] - force[k]).norm(), 12 * small * f0);
}

std::array<Numbers, 3> unlike() {
    std::array<Numbers, 3> n{};
    n[1] = {3e4, 0.9, 0.1, 1e4, 0.01, 5e8, 0.2, 0.05, 3e-2, 0.1};
    n[2] = {2e4, 0.5, 0.7, 9e3, 0.06, 3e8, 0.1, 0.4, 2e-2, 0.7};
    return n;
}

} // namespace

// Every law with every rolling law, one material, equal spheres, periodic on all sides: indices, lanes, signs, levers.
TEST(ContactSweep, OneMaterialEqualSpheres) {
    for (const std::string contact : contacts)
        for (const std::string rolling : rollings) {
            SCOPED_TRACE(contact + " " + rolling);
            GrainSystem s = packed_box(contact, rolling, {}, false, {true, true, true});
            expect_plain_formulas(s, contact, rolling, {});
        }
}

// Radii, masses and parameters of each pair: a lane that takes those of its neighbour or of the other material.
TEST(ContactSweep, TwoMaterialsManySizes) {
    for (const std::string contact : contacts)
        for (const std::string rolling : rollings) {
            SCOPED_TRACE(contact + " " + rolling);
            GrainSystem s = packed_box(contact, rolling, unlike(), true, {true, false, true});
            expect_plain_formulas(s, contact, rolling, unlike());
        }
}

// Action that is not reaction, levers that do not meet at the contact point: total force and moment vanish.
TEST(ContactSweep, MomentumAndAngularMomentumAreConserved) {
    for (const std::string contact : contacts)
        for (const std::string rolling : rollings) {
            SCOPED_TRACE(contact + " " + rolling);
            GrainSystem s = packed_box(contact, rolling, unlike(), true, {false, false, false});
            const std::vector<Vec3> f = contact_forces(s);
            Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
            double size = 0.0;
            for (std::size_t k = 0; k < f.size(); ++k) {
                const double inertia = sphere_inertia(s.grains.mass[k], 2.0 * s.grains.radius[k]);
                force += f[k];
                moment += s.grains.x[k].cross(f[k]) + inertia * s.grains.alpha[k];
                size += f[k].norm();
            }
            EXPECT_LT(force.norm(), 1e-14 * size);
            EXPECT_LT(moment.norm(), 1e-14 * size * 7e-3);
        }
}

// Chunks of the sweep that overlap or depend on threads.
TEST(ContactSweep, OneAndTwoThreadsGiveTheSameBits) {
    const int before = thread_count();
    for (const std::string rolling : rollings) {
        GrainSystem one = packed_box("linear_spring", rolling, unlike(), true, {true, true, true}), two = one;
        set_threads(1);
        evaluate_pairs(one.neighbours, one.contact, one.domain, 1e-6);
        set_threads(2);
        evaluate_pairs(two.neighbours, two.contact, two.domain, 1e-6);
        set_threads(before);
        EXPECT_EQ(std::memcmp(one.neighbours.force.data(), two.neighbours.force.data(),
                              one.neighbours.count * sizeof(PairForce)),
                  0);
        EXPECT_EQ(std::memcmp(one.neighbours.stretch.data(), two.neighbours.stretch.data(),
                              one.neighbours.stretch.size() / 8 * 7 * sizeof(double)),
                  0);
    }
}

// The padding of the last block must touch nothing, as the list promises: no force, no memory, no NaN.
TEST(ContactSweep, PaddingTouchesNothing) {
    GrainSystem s = system_of(box(Vec3::Constant(1e-2)), text_of("linear_spring", "elastic_plastic", {}));
    add(s, 5e-4, Vec3(5e-3, 5e-3, 5e-3), Vec3(0.1, 0.0, 0.0));
    add(s, 5e-4, Vec3(5.9e-3, 5e-3, 5e-3));
    advance_grains(s, 2, 1e-7);
    ASSERT_EQ(s.neighbours.count, 1U);
    ASSERT_EQ(s.neighbours.padded(), 8U);
    for (std::size_t p = 1; p < 8; ++p) {
        for (int c = 0; c < 8; ++c) EXPECT_EQ(s.neighbours.force[p][c], 0.0) << p << " " << c;
        for (int h = 0; h < 6; ++h) EXPECT_EQ(s.neighbours.remembered(p, h), 0.0) << p << " " << h;
    }
}
