// The matrix P between smoothed particles and grains: porosity, gathering and spreading against all pairs.
#include "weights_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

// A neighbour missed or met twice across a side, the wrong kernel's width, a copy that counts.
TEST(Weights, PorosityIsThatOfAllPairs) {
    for (const auto& periodic : {std::array{true, true, true}, std::array{false, true, false}}) {
        const Setting s = setting(periodic, different);
        for_each_particle(s.fluid, [&](std::size_t k, const Vec3& x, double /*volume*/) {
            double eps = 1.0;
            for (std::size_t j = 0; j < s.grains.size(); ++j)
                eps -= s.grains.volume[j] * kernel(s, x, s.grains.x[j], 0.12);
            ASSERT_NEAR(s.fluid.eps[k], eps, 1e-13);
        });
    }
}

TEST(Weights, GatheredFieldsAreThoseOfAllPairs) {
    for (const CouplingWidths& widths : {different, CouplingWidths{0.18, 0.18, 0.18}}) {
        const Setting s = setting({true, true, true}, widths);
        const SphFluid& f = s.fluid;
        std::vector<double> load(f.slots(), 0.0);
        for (std::size_t j = 0; j < s.grains.size(); ++j) {
            double total = 0.0;
            for_each_particle(f, [&](std::size_t, const Vec3& x, double volume) {
                total += volume * kernel(s, x, s.grains.x[j], widths.spread);
            });
            for_each_particle(f, [&](std::size_t k, const Vec3& x, double volume) {
                load[k] +=
                    s.mass[j] * volume * kernel(s, x, s.grains.x[j], widths.spread) / total / (f.mass * f.share[k]);
            });
        }
        for (std::size_t j = 0; j < s.grains.size(); ++j) {
            double total = 0.0, eps = 0.0, of_load = 0.0;
            Vec3 u = Vec3::Zero(), a = u, stress = u;
            for_each_particle(f, [&](std::size_t k, const Vec3& x, double volume) {
                const double weight = volume * kernel(s, x, s.grains.x[j], widths.gather);
                const Vec3 own(f.a[0][k], f.a[1][k], f.a[2][k]);
                total += weight, eps += weight * f.eps[k], of_load += weight * load[k];
                u += weight * Vec3(f.v[0][k], f.v[1][k], f.v[2][k]);
                a += weight * own;
                stress += weight * f.share[k] * f.rho[k] * (own - f.body_force);
            });
            ASSERT_LT((s.at.u[j] - u / total).norm(), 1e-13);
            ASSERT_LT((s.at.a[j] - a / total).norm(), 1e-13);
            ASSERT_LT((s.at.stress[j] - stress / total).norm(), 1e-10);
            ASSERT_NEAR(s.at.eps[j], eps / total, 1e-13);
            ASSERT_NEAR(s.at.load[j], of_load / total, 1e-12 * (1.0 + of_load / total));
        }
    }
}

// A transposed or half gradient, its scale, the wrong kernel's width: it is that of the gathered velocity as a function
// of the place, by differences. Their error is delta^2/6 times a third derivative of 15/h^3 and rounding over delta.
TEST(Weights, GradientIsThatOfTheGatheredVelocity) {
    const Setting s = setting({true, true, true}, different);
    const auto velocity_at = [&](const Vec3& x) {
        double total = 0.0;
        Vec3 u = Vec3::Zero();
        for_each_particle(s.fluid, [&](std::size_t k, const Vec3& at, double volume) {
            const double weight = volume * kernel(s, at, x, different.gather);
            total += weight;
            u += weight * Vec3(s.fluid.v[0][k], s.fluid.v[1][k], s.fluid.v[2][k]);
        });
        return Vec3(u / total);
    };
    const double delta = 1e-5;
    for (std::size_t j = 0; j < s.grains.size(); ++j)
        for (Eigen::Index c = 0; c < 3; ++c) {
            const Vec3 step = delta * Vec3::Unit(c);
            const Vec3 slope = (velocity_at(s.grains.x[j] + step) - velocity_at(s.grains.x[j] - step)) / (2.0 * delta);
            ASSERT_LT((s.at.gradient[j].col(c) - slope).norm(), 1e-6);
        }
}

// A gradient that is not that of a linear flow. By Poisson's summation the sum over a cubic lattice differs from the
// integral by the kernel's transform What(K) at the lattice's waves: of What and K What' with K h = 4 pi (h = 2
// spacings) 6.0e-5 and 1.8e-4 at the six nearest waves, 1.1e-5 and 1.5e-4 at the twelve next and less beyond; 4.1e-3 in
// all if every wave were in phase and along every axis.
TEST(Weights, GradientOfAShearOnALattice) {
    Eigen::Matrix3d shear;
    shear << 1.0, -2.0, 3.0, 0.5, -1.5, 2.5, -0.7, 4.0, 0.3;
    const Setting s = setting({true, true, true}, {0.2, 0.2, 0.2}, 60, [&](SphFluid& f) {
        for (std::size_t k = 0; k < f.slots(); ++k) {
            const Vec3 v = shear * Vec3(f.x[0][k], f.x[1][k], f.x[2][k]);
            for (std::size_t c = 0; c < 3; ++c) f.v[c][k] = v[static_cast<Eigen::Index>(c)];
        }
    });
    int inside = 0;
    for (std::size_t j = 0; j < s.grains.size(); ++j) {
        const Vec3 x = s.fluid.domain.wrapped(s.grains.x[j]), beyond = s.fluid.domain.size - x;
        if (x.minCoeff() < 0.4 || beyond.minCoeff() < 0.4) continue; // the shear jumps at the sides
        ++inside;
        EXPECT_LT((s.at.gradient[j] - shear).norm(), 4.1e-3 * shear.norm());
    }
    EXPECT_GT(inside, 2);
}

// Forces that are lost at a side, or spread with weights that do not sum to one.
TEST(Weights, TheFluidReceivesWhatIsSpread) {
    for (const auto& periodic : {std::array{true, true, true}, std::array{false, true, false}}) {
        Setting s = setting(periodic, different);
        std::vector<Vec3> force(s.grains.size());
        Random random(9);
        Vec3 sum = Vec3::Zero();
        for (Vec3& f : force) {
            f = Vec3(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
            sum += f;
        }
        const VectorField before = s.fluid.a;
        spread(s.fluid, s.weights, force);
        Vec3 received = Vec3::Zero();
        for_each_particle(s.fluid, [&](std::size_t k, const Vec3& /*x*/, double /*volume*/) {
            for (std::size_t c = 0; c < 3; ++c)
                received[static_cast<Eigen::Index>(c)] +=
                    s.fluid.mass * s.fluid.share[k] * (s.fluid.a[c][k] - before[c][k]);
        });
        EXPECT_LT((received - sum).norm(), 1e-12);
    }
}

// Lists that are used after a grain has left them.
TEST(Weights, ListsKnowWhenTheyAreOutdated) {
    Setting s = setting({true, true, true}, different);
    EXPECT_FALSE(outdated(s.weights, s.fluid.domain, s.grains));
    s.grains.x[3] += Vec3(1.2, 0.0, 0.0); // a whole side: the same place
    EXPECT_FALSE(outdated(s.weights, s.fluid.domain, s.grains));
    s.grains.x[3] += Vec3(0.0, 0.02, 0.0);
    EXPECT_TRUE(outdated(s.weights, s.fluid.domain, s.grains));
}

// A porosity below the densest packing passes unnoticed.
TEST(Weights, ClampedPorositiesAreCounted) {
    Setting s = setting({true, true, true}, different, 1);
    EXPECT_EQ(set_porosity(s.fluid, s.weights), 0);
    s.grains.volume[0] = 0.02;
    place_grains(s.weights, s.fluid.domain, s.grains);
    const std::int64_t clamped = set_porosity(s.fluid, s.weights);
    std::int64_t low = 0;
    for_each_particle(s.fluid, [&](std::size_t k, const Vec3& x, double /*volume*/) {
        low += 1.0 - 0.02 * kernel(s, x, s.grains.x[0], 0.12) < 0.2595 ? 1 : 0;
        EXPECT_GE(s.fluid.eps[k], 0.2595);
    });
    EXPECT_GT(clamped, 0);
    EXPECT_EQ(clamped, low);
}
