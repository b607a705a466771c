// Smoothing kernels against their definition: normalisation, slope, support, moments.
#include "sph/kernels.hpp"

#include "fluid_fixtures.hpp"

#include <map>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double pi = std::numbers::pi;
constexpr int panels = 240; // per integral: a multiple of both supports, so that no panel holds a knot of a spline

template <class Law> class SphKernel : public testing::Test {};
using Kernels = TypesOf<Kernel>::type;
TYPED_TEST_SUITE(SphKernel, Kernels);

/// Integral of W r^power over the space, in units of h.
template <class Law> double moment(int dimensions, int power) {
    const double shell = dimensions == 2 ? 2.0 * pi : 4.0 * pi;
    return shell * Law::sigma(dimensions) *
           integral([&](double q) { return Law::w(q) * std::pow(q, dimensions - 1 + power); }, 0.0, Law::support,
                    panels);
}

/// Largest |w| and |f|, for tolerances.
template <class Law> double top() { return std::abs(Law::w(0.0)); }
template <class Law> double steepest() { return std::abs(Law::f(0.0)); }

} // namespace

// A sigma of the wrong dimension or for another support: densities would be off by a constant factor.
TYPED_TEST(SphKernel, IntegratesToOne) {
    for (const int d : {2, 3}) EXPECT_NEAR(moment<TypeParam>(d, 0), 1.0, 1e-10) << d << " dimensions";
}

// f not the derivative of w: forces that belong to another kernel than the density does.
TYPED_TEST(SphKernel, SlopeIsThatOfTheKernel) {
    constexpr double step = 1e-5;
    for (double q = 0.01; q < TypeParam::support + 0.5; q += 0.0173) {
        const double slope = (TypeParam::w(q + step) - TypeParam::w(q - step)) / (2.0 * step);
        EXPECT_NEAR(TypeParam::f(q) * q, slope, 1e-8 * steepest<TypeParam>()) << "q = " << q;
    }
}

// A division by q = 0, or a branch near the origin with another limit: w = w(0) + f(0) q^2/2 + O(q^3).
TYPED_TEST(SphKernel, SlopeHasItsLimitAtTheOrigin) {
    ASSERT_TRUE(std::isfinite(TypeParam::f(0.0)));
    EXPECT_LT(TypeParam::f(0.0), 0.0);
    EXPECT_NEAR(TypeParam::f(1e-9), TypeParam::f(0.0), 1e-7 * steepest<TypeParam>());
    constexpr double q = 1e-4;
    EXPECT_NEAR(2.0 * (TypeParam::w(q) - TypeParam::w(0.0)) / (q * q), TypeParam::f(0.0), 1e-3 * steepest<TypeParam>());
}

// A step at a knot or at the support, or a tail beyond it: neighbours that enter or leave would kick.
TYPED_TEST(SphKernel, IsContinuousAndEndsAtItsSupport) {
    constexpr double tiny = 1e-9;
    for (double knot = 1.0; knot <= TypeParam::support; knot += 1.0) {
        EXPECT_NEAR(TypeParam::w(knot - tiny), TypeParam::w(knot + tiny), 1e-8 * top<TypeParam>()) << knot;
        EXPECT_NEAR(TypeParam::f(knot - tiny), TypeParam::f(knot + tiny), 1e-8 * steepest<TypeParam>()) << knot;
    }
    for (const double beyond : {0.0, 1e-12, 1e-3, 0.5, 1.0, 10.0, 1e6}) {
        EXPECT_EQ(TypeParam::w(TypeParam::support + beyond), 0.0) << beyond;
        EXPECT_EQ(TypeParam::f(TypeParam::support + beyond), 0.0) << beyond;
    }
}

// A sign that makes neighbours attract, or a part where weight is negative.
TYPED_TEST(SphKernel, FallsFromTheOriginOn) {
    for (double q = 0.0; q < TypeParam::support + 0.5; q += 0.0097) {
        EXPECT_GE(TypeParam::w(q), 0.0) << "q = " << q;
        EXPECT_LE(TypeParam::f(q), 0.0) << "q = " << q;
    }
    EXPECT_GT(TypeParam::w(TypeParam::support - 0.01), 0.0);
    EXPECT_LT(TypeParam::f(TypeParam::support - 0.01), 0.0);
}

// A branch taken for a whole pack instead of lane by lane: lanes lie on all sides of every knot.
TYPED_TEST(SphKernel, LanesAreScalars) {
    Random random(5);
    for (int repeat = 0; repeat < 500; ++repeat) {
        Pack q{};
        for (int lane = 0; lane < pack_width; ++lane) q[lane] = random.uniform(0.0, 1.2 * TypeParam::support);
        q[repeat % pack_width] = repeat % 4; // 0 and the knots themselves
        const Pack w = TypeParam::w(q), f = TypeParam::f(q);
        for (int lane = 0; lane < pack_width; ++lane) {
            const double scalar_w = TypeParam::w(double{q[lane]}), scalar_f = TypeParam::f(double{q[lane]});
            EXPECT_NEAR(w[lane], scalar_w, 1e-14 * std::abs(scalar_w) + 1e-16 * top<TypeParam>()) << q[lane];
            EXPECT_NEAR(f[lane], scalar_f, 1e-14 * std::abs(scalar_f) + 1e-16 * steepest<TypeParam>()) << q[lane];
        }
    }
}

// Another kernel of the same support and norm under this name. Second moments by hand, from Euler's beta function:
// in units of s = q/2 the Wendland kernels give sums of B(i, j), the splines integrals of (a - q)^n q^m over [0, a].
TYPED_TEST(SphKernel, SecondMomentsAreThoseOfTheFormula) {
    const std::map<std::string_view, std::array<double, 2>> by_hand{
        {"wendland_c2", {5.0 / 9.0, 4.0 / 5.0}},
        {"wendland_c4", {14.0 / 33.0, 8.0 / 13.0}},
        {"cubic_spline", {31.0 / 49.0, 9.0 / 10.0}},
        {"quintic_spline", {2771.0 / 2868.0, 7.0 / 5.0}},
    };
    const auto known = by_hand.find(TypeParam::name);
    if (known == by_hand.end()) GTEST_SKIP() << "no moments by hand for " << TypeParam::name;
    EXPECT_NEAR(moment<TypeParam>(2, 2), known->second[0], 1e-10);
    EXPECT_NEAR(moment<TypeParam>(3, 2), known->second[1], 1e-10);
}

// The reach handed to the neighbour lists is not that of the kernel.
TEST(SphKernels, SupportOfTheVariantIsThatOfTheLaw) {
    for_each_law<Kernel>([](auto law) { EXPECT_EQ(support(Kernel(law)), decltype(law)::support); });
}
