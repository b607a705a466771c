// Smoothing kernels W(r, h) = sigma_d/h^d w(q), q = r/h, in two and three dimensions.
//
// A kernel gives w(q) and f(q) = w'(q)/q, so that grad_a W = sigma_d/h^(d+2) f(q) (x_a - x_b) without a division by r
// where the formula allows it. Both are zero from q = support on. Each is written once for a number or a pack of eight.
// To add a kernel: write the struct, name it in Kernel at the end, and its row in the README; the tests find it.
#pragma once

#include "core/laws.hpp"
#include "core/simd.hpp"

#include <array>
#include <numbers>
#include <variant>

namespace plumb {

namespace detail {
template <class T> inline T number(double x) { return broadcast<T>(x); }
template <class T> inline T positive_part(T x) { return larger(x, broadcast<T>(0.0)); }
template <class T> inline T square(T x) { return x * x; }
} // namespace detail

/// Wendland C2: w = (1 - q/2)^4 (2 q + 1), q < 2.
struct WendlandC2 {
    static constexpr std::string_view name = "wendland_c2";
    static constexpr LawInfo info{"w = (1 - q/2)^4 (2 q + 1), q < 2", "any",
                                  "Wendland 1995, Adv. Comput. Math. 4, 389"};
    static constexpr double support = 2.0;
    static constexpr double sigma(int dimensions) {
        return (dimensions == 2 ? 7.0 / 4.0 : 21.0 / 16.0) / std::numbers::pi;
    }
    template <class T> [[gnu::always_inline]] static T w(T q) {
        const T k = detail::positive_part(detail::number<T>(1.0) - detail::number<T>(0.5) * q);
        return detail::square(detail::square(k)) * (detail::number<T>(2.0) * q + detail::number<T>(1.0));
    }
    template <class T> [[gnu::always_inline]] static T f(T q) {
        const T k = detail::positive_part(detail::number<T>(1.0) - detail::number<T>(0.5) * q);
        return detail::number<T>(-5.0) * (k * k * k);
    }
};

/// Wendland C4: w = (1 - q/2)^6 (35/12 q^2 + 3 q + 1), q < 2.
struct WendlandC4 {
    static constexpr std::string_view name = "wendland_c4";
    static constexpr LawInfo info{"w = (1 - q/2)^6 (35/12 q^2 + 3 q + 1), q < 2", "any",
                                  "Wendland 1995, Adv. Comput. Math. 4, 389"};
    static constexpr double support = 2.0;
    static constexpr double sigma(int dimensions) {
        return (dimensions == 2 ? 9.0 / 4.0 : 495.0 / 256.0) / std::numbers::pi;
    }
    template <class T> [[gnu::always_inline]] static T w(T q) {
        const T k = detail::positive_part(detail::number<T>(1.0) - detail::number<T>(0.5) * q);
        return detail::square(k * k * k) *
               (q * (detail::number<T>(35.0 / 12.0) * q + detail::number<T>(3.0)) + detail::number<T>(1.0));
    }
    template <class T> [[gnu::always_inline]] static T f(T q) {
        const T k = detail::positive_part(detail::number<T>(1.0) - detail::number<T>(0.5) * q);
        return (detail::square(detail::square(k)) * k) *
               (detail::number<T>(-14.0 / 3.0) - detail::number<T>(35.0 / 3.0) * q);
    }
};

/// Cubic spline M4 with support 2 h.
struct CubicSpline {
    static constexpr std::string_view name = "cubic_spline";
    static constexpr LawInfo info{"w = 1/4 (2 - q)+^3 - (1 - q)+^3, q < 2", "pairs with h/spacing above about 1.5",
                                  "Monaghan & Lattanzio 1985, Astron. Astrophys. 149, 135"};
    static constexpr double support = 2.0;
    static constexpr double sigma(int dimensions) { return (dimensions == 2 ? 10.0 / 7.0 : 1.0) / std::numbers::pi; }
    template <class T> [[gnu::always_inline]] static T w(T q) {
        const T outer = detail::positive_part(detail::number<T>(2.0) - q);
        const T inner = detail::positive_part(detail::number<T>(1.0) - q);
        return detail::number<T>(0.25) * (outer * outer * outer) - inner * inner * inner;
    }
    template <class T> [[gnu::always_inline]] static T f(T q) {
        const T one = detail::number<T>(1.0), outer = detail::positive_part(detail::number<T>(2.0) - q);
        const T near = detail::number<T>(2.25) * q - detail::number<T>(3.0); // q < 1
        return select(q < one, near, detail::number<T>(-0.75) * (outer * outer) / larger(q, one));
    }
};

/// Quintic spline M6 with support 3 h.
struct QuinticSpline {
    static constexpr std::string_view name = "quintic_spline";
    static constexpr LawInfo info{"w = (3 - q)+^5 - 6 (2 - q)+^5 + 15 (1 - q)+^5, q < 3", "any",
                                  "Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214"};
    static constexpr double support = 3.0;
    static constexpr double sigma(int dimensions) {
        return (dimensions == 2 ? 7.0 / 478.0 : 1.0 / 120.0) / std::numbers::pi;
    }
    template <class T> [[gnu::always_inline]] static T power4(double centre, T q) {
        return detail::square(detail::square(detail::positive_part(detail::number<T>(centre) - q)));
    }
    template <class T> [[gnu::always_inline]] static T w(T q) {
        const auto power5 = [&](double centre) {
            return power4(centre, q) * detail::positive_part(detail::number<T>(centre) - q);
        };
        return power5(3.0) - detail::number<T>(6.0) * power5(2.0) + detail::number<T>(15.0) * power5(1.0);
    }
    template <class T> [[gnu::always_inline]] static T f(T q) {
        const T one = detail::number<T>(1.0);
        // q < 1: the polynomial divided by q, w'/q = -120 + 120 q^2 - 50 q^3
        const T near =
            detail::square(q) * (detail::number<T>(120.0) - detail::number<T>(50.0) * q) - detail::number<T>(120.0);
        const T far = detail::number<T>(-5.0) * (power4(3.0, q) - detail::number<T>(6.0) * power4(2.0, q));
        return select(q < one, near, far / larger(q, one));
    }
};

using Kernel = std::variant<WendlandC2, WendlandC4, CubicSpline, QuinticSpline>;

/// Integral of g(q) over the kernel's ball in units of h, by the midpoint rule.
template <class KernelLaw, class G> double ball_integral(int dimensions, G&& g) {
    constexpr int n = 2000;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) {
        const double q = KernelLaw::support * (k + 0.5) / n;
        sum += g(q) * (dimensions == 2 ? q : q * q) * KernelLaw::support / n;
    }
    return (dimensions == 2 ? 2.0 : 4.0) * std::numbers::pi * sum;
}

/// Integral of W x^2/h^2 over the ball: the variance of the kernel along one axis, in units of h.
template <class KernelLaw> double second_moment(int dimensions) {
    static const std::array<double, 2> moment = [] {
        std::array<double, 2> values{};
        for (const int d : {2, 3})
            values[static_cast<std::size_t>(d - 2)] =
                KernelLaw::sigma(d) * ball_integral<KernelLaw>(d, [](double q) { return KernelLaw::w(q) * q * q; }) / d;
        return values;
    }();
    return moment[static_cast<std::size_t>(dimensions - 2)];
}

/// Reach of a kernel in units of h.
inline double support(const Kernel& kernel) {
    return std::visit([](const auto& k) { return k.support; }, kernel);
}

} // namespace plumb
