// Basset's history force: the kernel, exact integrals, the direct sum over the past, and a sphere released from rest.
// Each test says which mistake it would catch.
#include "coupling/history_force.hpp"

#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <vector>

using namespace plumb;
using std::numbers::pi;

namespace {

/// Simpson's rule with 2 n intervals.
double integral(const std::function<double(double)>& f, double a, double b, int n) {
    double sum = f(a) + f(b);
    const double h = (b - a) / (2 * n);
    for (int i = 1; i < 2 * n; ++i) sum += (i % 2 ? 4.0 : 2.0) * f(a + i * h);
    return sum * h / 3.0;
}

/// The history force (K = 1) at the end of `steps` steps of a slip w(t) along x, by the recurrence.
double history(const std::function<double(double)>& w, double end, int steps, int count) {
    const double dt = end / steps;
    const BassetKernel kernel = BassetHistory(count, 2.0 * end)(dt);
    std::vector<double> state(kernel.state_size(), 0.0);
    for (int i = 0; i + 1 < steps; ++i) kernel.advance(state, Vec3(w((i + 1) * dt) - w(i * dt), 0.0, 0.0));
    const double last = w(end) - w(end - dt);
    return kernel.force_from_past(state, 1.0).x() + kernel.implicit_coefficient(1.0) * last;
}

/// The same with the exact kernel and a stored past: the slow obvious twin.
double stored_history(const std::function<double(double)>& w, double end, int steps) {
    const double dt = end / steps;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double slope = (w((i + 1) * dt) - w(i * dt)) / dt;
        sum += slope * 2.0 * (std::sqrt((steps - i) * dt) - std::sqrt((steps - i - 1) * dt));
    }
    return sum;
}

/// Sphere released from rest: (m + m_f/2) v' = weight - D v - K Int v'/sqrt.
struct Release {
    double inertia, weight, drag, basset; // [kg], [N], [kg/s], [kg/sqrt(s)]
    explicit Release(double density_ratio) {
        const double d = 1e-3, rho = 1000.0, mu = 0.1, mf = rho * pi / 6 * d * d * d;
        inertia = mf * (density_ratio + 0.5);
        weight = mf * (density_ratio - 1.0) * 9.81;
        drag = 3.0 * pi * mu * d;
        basset = basset_coefficient(rho, mu, d);
    }
    double a() const { return drag / inertia; }
    double b() const { return basset / inertia * std::sqrt(pi); }

    /// From v(s) = (weight/inertia)/(s (s + a + b sqrt(s))): the integral along the cut of the root, with x = y^2.
    double velocity(double t) const {
        const auto f = [this, t](double y) {
            const double p = a() - y * y, q = b() * y;
            return std::exp(-y * y * t) / (p * p + q * q);
        };
        const double scale = std::sqrt(a()), far = std::sqrt(40.0 / t);
        const double tail = integral(f, 0.0, scale, 20000) + (far > scale ? integral(f, scale, far, 200000) : 0.0);
        return weight / inertia * (1.0 / a() - 2.0 * b() / pi * tail);
    }
    /// Boggio 1907: with real roots a1, a2 of z^2 - b z + a (density ratio below 5/8).
    double velocity_boggio(double t) const {
        const double root = std::sqrt(b() * b() - 4.0 * a()), a1 = 0.5 * (b() - root), a2 = 0.5 * (b() + root);
        const auto part = [t](double z) { return (1.0 - std::exp(z * z * t) * std::erfc(z * std::sqrt(t))) / z; };
        return weight / inertia / (a2 - a1) * (part(a1) - part(a2));
    }
    /// Trapezoidal steps with the newest part of the history implicit. w = -v.
    double velocity_in_steps(double t, int steps) const {
        const double dt = t / steps;
        const BassetKernel kernel = BassetHistory(40, 2.0 * t)(dt);
        std::vector<double> state(kernel.state_size(), 0.0);
        const double c = kernel.implicit_coefficient(basset);
        double v = 0.0, force = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double past = kernel.force_from_past(state, basset).z();
            const double dv = dt * (weight - drag * v + 0.5 * (force + past)) / (inertia + 0.5 * dt * (drag + c));
            kernel.advance(state, Vec3(0.0, 0.0, -dv));
            force = past - c * dv;
            v += dv;
        }
        return v;
    }
};

} // namespace

// A wrong weight, a missing pi, or an error bound that does not hold (or says nothing).
TEST(BassetKernel, ErrorStaysWithinItsBound) {
    for (const int count : {8, 12, 16, 24, 40})
        for (const double ratio : {10.0, 1e3, 1e6}) {
            const double t_min = 1e-4;
            const ExponentialSum sum = inverse_square_root(count, t_min, t_min * ratio);
            EXPECT_EQ(sum.rate.size(), static_cast<std::size_t>(count));
            double worst = 0.0;
            for (double s = 0.0; s <= 1.0; s += 1.0 / 2000) {
                const double t = t_min * std::pow(ratio, s);
                worst = std::max(worst, std::abs(sum(t) * std::sqrt(t) - 1.0));
            }
            EXPECT_LE(worst, sum.relative_error + 1e-13) << count << " " << ratio;
            EXPECT_GE(worst, 0.1 * sum.relative_error) << count << " " << ratio;
        }
}

// A wrong spacing: far from both ends only the spacing errs, by a wave in log t whose height is a third of the bound.
TEST(BassetKernel, SpacingTakesAThirdOfTheBound) {
    for (const int count : {16, 24, 32}) {
        const ExponentialSum sum = inverse_square_root(count, 1e-6, 1.0);
        double worst = 0.0;
        for (double t = 3e-4; t < 3e-3; t *= 1.002) worst = std::max(worst, std::abs(sum(t) * std::sqrt(t) - 1.0));
        EXPECT_NEAR(worst / (sum.relative_error / 3.0), 1.0, 0.02) << count;
    }
}

// The accuracy promised in the doc comment.
TEST(BassetKernel, AccuracyOverFourDecades) {
    EXPECT_LT(inverse_square_root(16, 1e-4, 1.0).relative_error, 3e-4);
    EXPECT_LT(inverse_square_root(20, 1e-4, 1.0).relative_error, 4e-5);
    EXPECT_LT(inverse_square_root(28, 1e-4, 1.0).relative_error, 2e-6);
    double previous = 1.0;
    for (int count = 6; count < 50; ++count) {
        const double error = inverse_square_root(count, 1e-4, 1.0).relative_error;
        EXPECT_LT(error, previous) << count;
        previous = error;
    }
}

// K: 1.5 x 1e-6 x sqrt(pi x 1000 x 1e-3) = 2.65868e-6; radius for diameter would be a quarter.
TEST(BassetHistory, CoefficientByHand) { EXPECT_NEAR(basset_coefficient(1000.0, 1e-3, 1e-3), 2.65868e-6, 1e-11); }

// A wrong implicit coefficient or gain: a slip that grows linearly is exact for any step, F = 2 sqrt(t).
TEST(BassetHistory, LinearSlipIsExact) {
    for (const int steps : {2, 7, 100})
        EXPECT_NEAR(history([](double t) { return t; }, 2.0, steps, 40), 2.0 * std::sqrt(2.0), 1e-8) << steps;
}

// A kernel used where it is not accurate, or a wrong recurrence: equal to the direct sum over the stored past, within
// the kernel's bound, for a rough slip.
TEST(BassetHistory, EqualsTheStoredPast) {
    const auto w = [](double t) { return std::sin(7.0 * t) + (t > 0.6 ? 1.0 : 0.0) + 0.2 * std::cos(40.0 * t); };
    for (const int count : {12, 20, 40}) {
        const double bound = inverse_square_root(count, 1.0 / 200, 2.0).relative_error;
        EXPECT_NEAR(history(w, 1.0, 200, count), stored_history(w, 1.0, 200), 10.0 * bound) << count;
    }
}

// Order of the step: t^2 has F = (8/3) t^(3/2), sin has a Fresnel integral (here by x = sqrt(t - s)); the piecewise
// linear slip converges with dt^(3/2).
TEST(BassetHistory, OrderThreeHalvesForASmoothSlip) {
    const double end = 2.0;
    const double square = 8.0 / 3.0 * std::pow(end, 1.5);
    const double fresnel =
        integral([=](double x) { return 6.0 * std::cos(3.0 * (end - x * x)); }, 0.0, std::sqrt(end), 2000);
    const std::function<double(double)> slips[] = {[](double t) { return t * t; },
                                                   [](double t) { return std::sin(3.0 * t); }};
    const double exact[] = {square, fresnel};
    for (int i = 0; i < 2; ++i) {
        const double coarse = std::abs(history(slips[i], end, 200, 60) - exact[i]);
        const double fine = std::abs(history(slips[i], end, 800, 60) - exact[i]);
        EXPECT_NEAR(std::log(coarse / fine) / std::log(4.0), 1.5, 0.1);
        EXPECT_LT(fine / std::abs(exact[i]), 2e-4);
    }
}

// A jump lost or felt with the wrong weight: F = K jump/sqrt(t), in every component.
TEST(BassetHistory, SuddenSlip) {
    const BassetKernel kernel = BassetHistory(40, 2.0)(0.01);
    std::vector<double> state(kernel.state_size(), 0.0);
    BassetKernel::add_jump(state, Vec3(1.0, -2.0, 3.0));
    for (int i = 0; i < 99; ++i) kernel.advance(state, Vec3::Zero());
    EXPECT_NEAR((kernel.force_from_past(state, 0.5) - Vec3(0.5, -1.0, 1.5)).norm(), 0.0, 1e-8); // t = 1
}

// The two forms of the reference agree (real roots), so neither hides a mistake of the other.
TEST(BassetHistory, ReferencesOfTheReleaseAgree) {
    const Release light(0.2);
    for (const double t : {1e-4, 1e-3, 1e-2}) EXPECT_NEAR(light.velocity(t) / light.velocity_boggio(t), 1.0, 1e-6) << t;
}

// Sign of the force, the implicit share, or the factor between history and inertia: a sphere released from rest in
// creeping flow, light and heavy.
TEST(BassetHistory, SphereReleasedFromRest) {
    for (const double ratio : {0.2, 2.5, 7.8}) {
        const Release sphere(ratio);
        const double t = 1.0 / sphere.a(), exact = sphere.velocity(t);
        // The error changes sign near a hundred steps, so its order (3/2) shows only well beyond.
        const double coarse = std::abs(sphere.velocity_in_steps(t, 1600) / exact - 1.0);
        const double fine = std::abs(sphere.velocity_in_steps(t, 6400) / exact - 1.0);
        EXPECT_LT(coarse, 1e-6) << ratio;
        EXPECT_NEAR(std::log(coarse / fine) / std::log(4.0), 1.5, 0.2) << ratio;
        const double without = sphere.weight / sphere.drag * (1.0 - std::exp(-1.0));
        EXPECT_GT(std::abs(exact / without - 1.0), 0.1) << ratio; // the history matters here
    }
}

// Keys of the scene and impossible demands.
TEST(BassetHistory, Scene) {
    const auto made = [](std::string_view text) {
        return make_family<HistoryForce>(Table(toml::parse(text), "coupling.basset", "scene.toml"));
    };
    const HistoryForce law = made("law = 'exponentials'\ncount = 16\nwindow = 1.0");
    EXPECT_EQ(history_kernel(law, 1e-4).state_size(), 48U);
    EXPECT_EQ(history_kernel(law, 1e-4).step(), 1e-4);
    EXPECT_THROW(history_kernel(law, 1.0), InputError); // window = step
    EXPECT_THROW(history_kernel(made("law = 'exponentials'\ncount = 4\nwindow = 1.0"), 1e-6), InputError); // too few
    EXPECT_THROW(made("law = 'exponentials'\ncount = 3\nwindow = 1.0"), InputError);
    EXPECT_THROW(made("law = 'exponentials'\ncount = 16"), InputError);
}
