// Basset's history force on one grain, by a sum of exponentials: no stored past.
//
//     F(t) = K Int_0^t w'(s) / sqrt(t - s) ds,    K = (3/2) d^2 sqrt(pi rho mu),    w = u - v along the grain's path
//
// The kernel. From 1/sqrt(t) = pi^(-1/2) Int exp(y/2 - e^y t) dy over all y, the trapezoidal rule with spacing h in y
// gives
//     1/sqrt(t) ~ sum_k w_k exp(-s_k t),    s_k = e^(y_k),  w_k = h sqrt(s_k/pi).
// Three errors, relative to 1/sqrt(t):
//   spacing  By Poisson's sum the m-th alias is 2 |Gamma(1/2 + 2 pi i m/h)|/sqrt(pi) = 2/sqrt(cosh(2 pi^2 m/h)), for
//            every t: 1.5e-4 at h = 1, and the square of it at half the spacing.
//   top      Nodes above s_max are dropped: at most erfc(sqrt(s_max t)), largest at t = t_min.
//   bottom   The infinitely many nodes below the lowest kept one, s_0, are one exponential of the same sum and first
//   moment
//            (geometric series of q = exp(-h/2)): at most h/(2 sqrt(pi)) (s_0 t)^(5/2) [q^5/(1-q^5) - (q^3/(1-q^3))^2
//            (1-q)/q], largest at t = t_max.
// A number `count` of exponentials is spent so that the three are equal; three times one of them is `relative_error`.
//
// The step. In a step of length dt the slip changes linearly by dw, each exponential is advanced exactly for that, and
// the newest step is integrated with the exact kernel: 2 sqrt(dt) dw/dt. So the kernel is used for lags of one step and
// more only (t_min = dt), and
//     F(t + dt) = K [ sum_k w_k exp(-s_k dt) E_k(t) + (2/sqrt(dt)) dw ],    E_k(t) = Int_0^t w'(s) exp(-s_k (t-s)) ds.
// Its second part is inertia: with dw = du - dv, an integrator that takes a share theta of F at the end of the step
// solves
//     (m + theta dt implicit_coefficient) dv = dt (other forces) + theta dt (past + implicit_coefficient du) + ...
// The piecewise linear slip makes an error of order dt^(3/2) in F for a smooth slip.
// Source of the force: Basset 1888; Maxey & Riley 1983, Phys. Fluids 26, 883-889. Range: creeping flow around the
// grain.
#pragma once

#include "core/laws.hpp"
#include "core/vec.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <variant>
#include <vector>

namespace plumb {

/// K = (3/2) d^2 sqrt(pi rho mu) [kg/sqrt(s)] of a grain of diameter d [m].
inline double basset_coefficient(double density, double viscosity, double diameter) {
    return 1.5 * diameter * diameter * std::sqrt(std::numbers::pi * density * viscosity); // Basset 1888
}

/// sum_k weight_k exp(-rate_k t), close to 1/sqrt(t) for t_min <= t <= t_max.
struct ExponentialSum {
    std::vector<double> weight;  // [1/sqrt(s)]
    std::vector<double> rate;    // [1/s], rising; the first stands for the whole slow end
    double relative_error = 0.0; // bound on [t_min, t_max]

    double operator()(double t) const;
};

/// The best sum of `count` >= 4 exponentials on [t_min, t_max] [s] by the rule at the top of this page. Its error is at
/// most 1; whether it is small enough is the caller's business.
ExponentialSum inverse_square_root(int count, double t_min, double t_max);

/// The history kernel for steps of one length, and what happens to a grain's state in a step. A grain's state is
/// `state_size()` numbers [m/s], E_k x y z for k = 0, 1, ...; all zero for a grain that has never slipped. It does not
/// depend on the grain's size, so the coefficient K is given when the force is asked for.
class BassetKernel {
public:
    BassetKernel(ExponentialSum sum, double step);

    std::size_t state_size() const { return 3 * sum_.rate.size(); }
    double relative_error() const { return sum_.relative_error; }
    double step() const { return step_; }

    /// Force at the end of the coming step if the slip does not change in it [N]; K from basset_coefficient.
    Vec3 force_from_past(std::span<const double> state, double coefficient) const;
    /// Force at the end of the coming step per change of slip in it, 2 K/sqrt(dt) [kg/s].
    double implicit_coefficient(double coefficient) const { return 2.0 * coefficient / std::sqrt(step_); }
    /// Carries the state over one step in which the slip changed linearly by `slip_change` [m/s].
    void advance(std::span<double> state, const Vec3& slip_change) const;
    /// Adds a sudden change of slip now, e.g. of a grain that enters the fluid with a slip: its force K jump/sqrt(t) is
    /// felt from the end of the coming step on.
    static void add_jump(std::span<double> state, const Vec3& jump);

private:
    ExponentialSum sum_;
    double step_;
    std::vector<double> decay_;       // exp(-s_k dt)
    std::vector<double> gain_;        // (1 - exp(-s_k dt))/(s_k dt)
    std::vector<double> past_weight_; // w_k exp(-s_k dt)
};

/// The history force with `count` exponentials, faithful for lags from one step to `window` [s]; older changes of slip
/// are forgotten faster than 1/sqrt(t). A window as long as the run forgets nothing. 16 exponentials are good to 3e-4
/// over four decades of time, 20 to 4e-5, 28 to 2e-6.
struct BassetHistory {
    static constexpr std::string_view name = "exponentials";
    static constexpr LawInfo info{"(3/2) d^2 sqrt(pi rho mu) Int d(u-v)/ds / sqrt(t-s) ds by `count` exponentials",
                                  "creeping flow; lags between the step and `window`",
                                  "Basset 1888; Maxey & Riley 1983, Phys. Fluids 26, 883-889"};
    static constexpr int least = 4, most = 100; // fewer are never accurate to 10 %, more are beyond double precision
    int count;
    double window; // [s]

    BassetHistory(int exponentials, double longest_lag) : count(exponentials), window(longest_lag) {}
    explicit BassetHistory(Table& table)
        : count(static_cast<int>(table.integer("count", least, most))), window(table.number("window", positive)) {}

    /// The kernel for steps of `step` [s]. InputError if the window is not longer than the step, or if so few
    /// exponentials miss the kernel by more than 10 %.
    BassetKernel operator()(double step) const;
};

using HistoryForce = std::variant<BassetHistory>;

/// The kernel of a history force for steps of `step` [s]; InputError as above.
inline BassetKernel history_kernel(const HistoryForce& law, double step) {
    return std::visit([=](const auto& one) { return one(step); }, law);
}

} // namespace plumb
