#include "coupling/history_force.hpp"

#include "core/errors.hpp"

#include <cassert>
#include <utility>

namespace plumb {

namespace {

using std::numbers::pi;

/// The x in [low, high] at which the rising function f crosses zero, by bisection to the last bit that matters.
template <class F> double root_of_rising(const F& f, double low, double high) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (f(middle) > 0.0 ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

/// Spacing in y whose aliasing error 2/sqrt(cosh(2 pi^2/h)) is `error`; the further aliases are of order error^2.
double spacing(double error) { return 2.0 * pi * pi / std::acosh(4.0 / (error * error)); }

/// s_max t_min at which erfc(sqrt(s_max t_min)) is `error`.
double top(double error) {
    const double root = root_of_rising([=](double x) { return error - std::erfc(x); }, 0.0, 10.0);
    return root * root;
}

/// s_0 t_max at which the error of the merged slow end is `error`.
double bottom(double h, double error) {
    const double q = std::exp(-0.5 * h), q3 = q * q * q, q5 = q3 * q * q;
    const double zeroth = q / (1.0 - q), first = q3 / (1.0 - q3), second = q5 / (1.0 - q5);
    return std::pow(error * 2.0 * std::sqrt(pi) / (h * (second - first * first / zeroth)), 0.4);
}

} // namespace

double ExponentialSum::operator()(double t) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < rate.size(); ++k) sum += weight[k] * std::exp(-rate[k] * t);
    return sum;
}

ExponentialSum inverse_square_root(int count, double t_min, double t_max) {
    assert(count >= 4 && t_min > 0.0 && t_max > t_min);
    // count - 1 nodes span the decades from s_0 to s_max, one exponential is the slow end. Larger errors need fewer
    // decades and allow a wider spacing, so the nodes suffice from some error on.
    const auto spare = [=](double log_error) {
        const double error = std::exp(log_error) / 3.0, h = spacing(error);
        return (count - 2) * h - std::log(t_max / t_min * top(error) / bottom(h, error));
    };
    const double error = std::exp(root_of_rising(spare, std::log(1e-15), 0.0));
    const double h = spacing(error / 3.0), s0 = bottom(h, error / 3.0) / t_max;

    ExponentialSum sum;
    sum.relative_error = error;
    const double q = std::exp(-0.5 * h), q3 = q * q * q;
    const double zeroth = q / (1.0 - q), first = q3 / (1.0 - q3);
    sum.rate.push_back(s0 * first / zeroth);
    sum.weight.push_back(h * std::sqrt(s0 / pi) * zeroth);
    for (int k = 0; k < count - 1; ++k) {
        const double s = s0 * std::exp(k * h);
        sum.rate.push_back(s);
        sum.weight.push_back(h * std::sqrt(s / pi));
    }
    return sum;
}

BassetKernel::BassetKernel(ExponentialSum sum, double step) : sum_(std::move(sum)), step_(step) {
    for (std::size_t k = 0; k < sum_.rate.size(); ++k) {
        const double x = sum_.rate[k] * step;
        decay_.push_back(std::exp(-x));
        gain_.push_back(-std::expm1(-x) / x);
        past_weight_.push_back(sum_.weight[k] * std::exp(-x));
    }
}

Vec3 BassetKernel::force_from_past(std::span<const double> state, double coefficient) const {
    assert(state.size() == state_size());
    double x = 0.0, y = 0.0, z = 0.0;
    for (std::size_t k = 0; k < past_weight_.size(); ++k) {
        x += past_weight_[k] * state[3 * k];
        y += past_weight_[k] * state[3 * k + 1];
        z += past_weight_[k] * state[3 * k + 2];
    }
    return coefficient * Vec3(x, y, z);
}

void BassetKernel::advance(std::span<double> state, const Vec3& slip_change) const {
    assert(state.size() == state_size());
    for (std::size_t k = 0; k < decay_.size(); ++k) {
        state[3 * k] = decay_[k] * state[3 * k] + gain_[k] * slip_change.x();
        state[3 * k + 1] = decay_[k] * state[3 * k + 1] + gain_[k] * slip_change.y();
        state[3 * k + 2] = decay_[k] * state[3 * k + 2] + gain_[k] * slip_change.z();
    }
}

void BassetKernel::add_jump(std::span<double> state, const Vec3& jump) {
    for (std::size_t i = 0; i < state.size(); ++i) state[i] += jump[static_cast<Eigen::Index>(i % 3)];
}

BassetKernel BassetHistory::operator()(double step) const {
    if (!(window > step))
        throw InputError(fmt::format("coupling.basset.window: {} s is not longer than the step of {} s", window, step));
    ExponentialSum sum = inverse_square_root(count, step, window);
    const double largest = 0.1; // beyond this the history is not the one asked for
    if (sum.relative_error > largest)
        throw InputError(
            fmt::format("coupling.basset.count: {} exponentials miss the kernel by {:.0f} % between the step of "
                        "{} s and the window of {} s; allowed is 10 %",
                        count, 100.0 * sum.relative_error, step, window));
    return BassetKernel(std::move(sum), step);
}

} // namespace plumb
