// The step functions of drag: limits, fixed points, orders, stability.
#include "coupling/exchange.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

/// (1/n! - ...) by its series in long double for small z, by the definition otherwise.
long double exact_phi(int n, long double z) {
    if (z < 1.0L) {
        long double term = 1.0L, sum = 0.0L;
        for (int k = 1; k <= n; ++k) term /= k;
        for (int k = n + 1; k < n + 40; ++k) {
            sum += term;
            term *= -z / k;
        }
        return sum;
    }
    const long double phi0 = std::exp(-z), phi1 = -std::expm1(-z) / z;
    return n == 0 ? phi0 : n == 1 ? phi1 : (1.0L - phi1) / z;
}

template <class F> void for_each_exchange(F&& f) {
    f(ExponentialExchange{});
    f(ImplicitExchange{});
    f(ExplicitExchange{});
}

/// Velocity of a grain under dv/dt = g - c |v| v from v0 after time t in steps of dt.
template <class E> double newton_velocity(const E& exchange, double g, double c, double v0, double t, double dt) {
    Vec3 v(v0, 0.0, 0.0);
    const auto rate = [&](double slip) { return c * slip; };
    for (long long k = std::llround(t / dt); k > 0; --k) {
        const StepWeights w = exchange(mid_step_rate(exchange, rate, v, Vec3(g, 0.0, 0.0), dt) * dt);
        v = w.phi0 * v + w.phi1 * dt * Vec3(g, 0.0, 0.0);
    }
    return v.x();
}

} // namespace

// A wrong coefficient of the series, cancellation above it, a jump where they meet: against long double.
TEST(Exchange, ExponentialFunctions) {
    for (const double z : {1e-12, 1e-6, 1e-3, 1e-2, 0.049999, 0.05, 0.050001, 0.1, 1.0, 10.0, 100.0, 1e5}) {
        const StepWeights w = ExponentialExchange{}(z);
        EXPECT_NEAR(w.phi0, static_cast<double>(exact_phi(0, z)), 4e-16 * std::max(w.phi0, 1e-300)) << z;
        EXPECT_NEAR(w.phi1, static_cast<double>(exact_phi(1, z)), 1e-15 * w.phi1) << z;
        EXPECT_NEAR(w.phi2, static_cast<double>(exact_phi(2, z)), 1e-14 * w.phi2) << z;
    }
}

// z = 0 must be velocity Verlet, without 0/0.
TEST(Exchange, NoDragIsVelocityVerlet) {
    for_each_exchange([](const auto& exchange) {
        const StepWeights w = exchange(0.0);
        EXPECT_EQ(w.phi0, 1.0);
        EXPECT_EQ(w.phi1, 1.0);
        EXPECT_EQ(w.phi2, 0.5);
    });
}

// phi1 and phi2 that do not belong to phi0 would move a grain at its terminal velocity.
TEST(Exchange, TheThreeFunctionsBelongTogether) {
    for_each_exchange([](const auto& exchange) {
        for (const double z : {1e-8, 1e-3, 0.05, 0.3, 1.0, 1.9, 30.0, 1e5}) {
            const StepWeights w = exchange(z);
            EXPECT_NEAR(w.phi0 + z * w.phi1, 1.0, 1e-15 * (1.0 + z * z)) << z;
            EXPECT_NEAR(w.phi1 + z * w.phi2, 1.0, 1e-15 * (1.0 + z * z)) << z;
        }
    });
    for (const double z : {1e5, 1e10, 1e100}) { // long steps: the fluid's velocity, and the way with it
        EXPECT_NEAR(ExponentialExchange{}(z).phi1 * z, 1.0, 1e-14);
        EXPECT_NEAR(ImplicitExchange{}(z).phi1 * z, 1.0, 3.0 / z + 1e-14);
        EXPECT_NEAR(ExponentialExchange{}(z).phi2 * z, 1.0, 2.0 / z + 1e-14);
        EXPECT_NEAR(ImplicitExchange{}(z).phi2 * z, 1.0, 2.0 / z + 1e-14);
    }
}

// A grain at its terminal velocity stays there and moves with it, for any step.
TEST(Exchange, TheTerminalStateIsAFixedPoint) {
    for_each_exchange([](const auto& exchange) {
        for (const double z : {1e-3, 0.05, 1.0, 1.9, 1e3, 1e10}) {
            if (z > 1e4 && exchange(z).phi0 < -1.0) continue;
            const double beta = 40.0, dt = z / beta, u = 0.7, g = -9.81, v = u + g / beta;
            const StepWeights w = exchange(z);
            EXPECT_NEAR(w.phi0 * v + w.phi1 * dt * g + (1.0 - w.phi0) * u, v, 1e-13 * (1.0 + z * z * 1e-2)) << z;
            EXPECT_NEAR(w.phi1 * dt * v + w.phi2 * dt * dt * (g + beta * u), dt * v, 1e-13 * dt * (1.0 + z * z * 1e-2))
                << z;
        }
    });
}

// Stability: |phi0| <= 1 for every step, going to zero (L-stable), but for the explicit one, which grows beyond z = 2.
TEST(Exchange, Stability) {
    for (double z = 1e-6; z < 1e12; z *= 1.7) {
        for (const double phi0 : {ExponentialExchange{}(z).phi0, ImplicitExchange{}(z).phi0}) {
            EXPECT_GE(phi0, 0.0);
            EXPECT_LE(phi0, 1.0);
        }
    }
    EXPECT_LT(ImplicitExchange{}(1e10).phi0, 1e-19);
    EXPECT_LT(std::abs(ExplicitExchange{}(1.999).phi0), 1.0);
    EXPECT_GT(std::abs(ExplicitExchange{}(2.001).phi0), 1.0);
}

// The rate in the middle of the step: the iteration must end at the solution, for Stokes to Newton drag and for steps
// ten decades longer than the relaxation time, where plain iteration jumps to and fro.
TEST(Exchange, MidStepRateConverges) {
    for (const double power : {0.0, 0.5, 0.687, 1.0})
        for (const double dt : {1e-6, 1e-2, 1.0, 1e3, 1e10})
            for (const double slip : {1e-8, 0.3, 50.0}) {
                int calls = 0;
                const auto rate = [&](double s) {
                    ++calls;
                    return 3.0 * std::pow(s, power);
                };
                const auto check = [&](const auto& exchange) {
                    calls = 0;
                    const Vec3 w(slip, 0.0, 0.0), g(0.0, 0.0, -9.81);
                    const double beta = mid_step_rate(exchange, rate, w, g, dt);
                    EXPECT_LE(calls, 101);
                    const StepWeights half = exchange(0.5 * beta * dt);
                    const double found = rate((half.phi0 * w + 0.5 * dt * half.phi1 * g).norm());
                    EXPECT_NEAR(found, beta, 1e-11 * beta) << power << " " << dt << " " << slip;
                };
                check(ExponentialExchange{});
                check(ImplicitExchange{});
            }
}

// In a step of the relaxation time's order a few drag laws must do: they are most of a coupled step's cost.
TEST(Exchange, MidStepRateIsCheap) {
    for (const double power : {0.0, 0.2, 0.687, 1.0}) {
        int calls = 0;
        const auto rate = [&](double s) {
            ++calls;
            return 30.0 * std::pow(s, power);
        };
        mid_step_rate(ExponentialExchange{}, rate, Vec3(0.3, 0.0, 0.0), Vec3(0.0, 0.0, -9.81), 0.03);
        EXPECT_LE(calls, 9) << power;
    }
}

// From rest, Newton drag has the rate 0 at the start of the step; the rate in its middle is not 0. With 0 a grain in a
// long step would fall as if there were no fluid.
TEST(Exchange, MidStepRateFromRestWithNewtonDrag) {
    const auto rate = [](double slip) { return 3.0 * slip; };
    for (const double dt : {1e-3, 1.0, 1e6}) {
        const Vec3 g(0.0, 0.0, -9.81);
        const double beta = mid_step_rate(ExponentialExchange{}, rate, Vec3::Zero(), g, dt);
        const StepWeights half = ExponentialExchange{}(0.5 * beta * dt);
        EXPECT_GT(beta, 0.0) << dt;
        EXPECT_NEAR(rate((0.5 * dt * half.phi1 * g).norm()), beta, 1e-10) << dt;
    }
    EXPECT_EQ(mid_step_rate(
                  ExponentialExchange{}, [](double) { return 0.0; }, Vec3(1, 0, 0), Vec3(0, 0, 1), 1.0),
              0.0);
}

// Second order for nonlinear drag (a rate taken at the start of the step costs one): v = v_t tanh(g t/v_t + c0).
TEST(Exchange, SecondOrderForNonlinearDrag) {
    const double g = 9.81, c = 25.0, vt = std::sqrt(g / c), v0 = 0.2 * vt, t = 0.1;
    const double exact = vt * std::tanh(g * t / vt + std::atanh(0.2));
    for_each_exchange([&](const auto& exchange) {
        const double coarse = newton_velocity(exchange, g, c, v0, t, t / 20) - exact;
        const double fine = newton_velocity(exchange, g, c, v0, t, t / 80) - exact;
        EXPECT_NEAR(order_of(std::abs(coarse), std::abs(fine), 4.0), 2.0, 0.2)
            << std::decay_t<decltype(exchange)>::name;
    });
    EXPECT_NEAR(newton_velocity(ExponentialExchange{}, g, c, v0, 1e4, 1e3), vt, 1e-12);
}

// Names in a scene.
TEST(Exchange, Names) {
    Table t = table_of("a = \"exponential\"\nb = \"implicit\"\nc = \"explicit\"\nd = \"euler\"");
    EXPECT_EQ(law_name(make_family<Exchange>(t.law("a"))), "exponential");
    EXPECT_EQ(law_name(make_family<Exchange>(t.law("b"))), "implicit");
    EXPECT_EQ(law_name(make_family<Exchange>(t.law("c"))), "explicit");
    expect_error([&] { make_family<Exchange>(t.law("d")); }, {"euler", "implicit"});
}
