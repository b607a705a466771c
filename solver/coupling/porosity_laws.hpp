// How the fluid fraction among smoothed particles follows from the grains near a place,
//     eps(x) = 1 - sum_j V_j G(|x - x_j|; d_j),
// with a radial function G [1/m3] of integral one: the room taken from the fluid is that of the grains, wherever it is.
//
// A law gives its reach [m] and G(r) for a kernel and a diameter. G is tabulated once (radial_table.hpp), so it need
// not be fast; `by_diameter` says whether it differs from grain to grain. To add an estimate: write the struct, name it
// in PorosityLaw at the end, and its README row; the tests find it.
#pragma once

#include "core/laws.hpp"
#include "sph/kernels.hpp"

#include <cmath>
#include <functional>
#include <variant>

namespace plumb {

/// W(r) of a kernel in space, normalised [1/m3].
struct SpaceKernel {
    Kernel kernel;
    double h = 0.0; // smoothing length [m]

    double reach() const { return support(kernel) * h; }
    double operator()(double r) const {
        const auto w = [&](const auto& law) { return law.sigma(3) / (h * h * h) * law.w(r / h); };
        return r < reach() ? std::visit(w, kernel) : 0.0;
    }
};

/// Integral of q(|y|) W(|x - y|) over the ball |y| < limit [m], at |x| = r. To round-off where q is a constant or a
/// kernel of the same h: Gauss's rule from knot to knot of what are polynomials between.
double convolution(const SpaceKernel& w, const std::function<double(double)>& q, double limit, double r);

/// G = W: the grain's volume sits in its centre. The kernel itself, evaluated and not tabulated.
struct KernelPorosity {
    static constexpr std::string_view name = "kernel";
    static constexpr LawInfo info{"G = W", "kernels wider than grains",
                                  "Robinson, Ramaioli & Luding 2014, Int. J. Multiphase Flow 59, 121"};
    static constexpr bool by_diameter = false;
    double reach(const SpaceKernel& w, double /*diameter*/) const { return w.reach(); }
    double operator()(const SpaceKernel& w, double r, double /*diameter*/) const { return w(r); }
    double transform(double w, double /*k*/, double /*diameter*/) const { return w; }
};

/// G = 1/V times the integral of W over the grain's sphere: the share of the fluid's filter that is inside of grains,
/// as the averaged equations define it. Wider than W by the sphere's own variance, d^2/20 along each axis.
struct OverlapPorosity {
    static constexpr std::string_view name = "overlap";
    static constexpr LawInfo info{"G = integral of W over the grain's sphere / V", "any kernel width",
                                  "Anderson & Jackson 1967, Ind. Eng. Chem. Fundam. 6, 527"};
    static constexpr bool by_diameter = true;
    double reach(const SpaceKernel& w, double diameter) const { return w.reach() + 0.5 * diameter; }
    double operator()(const SpaceKernel& w, double r, double diameter) const;
    /// Times that of a sphere, 3 (sin x - x cos x)/x^3, x = k d/2.
    double transform(double w, double k, double diameter) const {
        const double x = 0.5 * k * diameter;
        return w * (x < 1e-3 ? 1.0 - 0.1 * x * x : 3.0 * (std::sin(x) - x * std::cos(x)) / (x * x * x));
    }
};

/// G = 2 W - W*W, one step of van Cittert's deconvolution: its transform, 1 - (1 - What)^2, keeps long waves to the
/// fourth order in k h (W: the second) and lies between 0 and 1 where What does, so nothing is amplified. Past the edge
/// of a slab eps overshoots, for any h: by 3.7 % of the jump with wendland_c2, so eps may be a little above 1 in the
/// fluid.
struct DeconvolvedPorosity {
    static constexpr std::string_view name = "deconvolved";
    static constexpr LawInfo info{"G = 2 W - W*W", "overshoots at edges by 4 % of the jump; reaches twice as far as W",
                                  "van Cittert 1931, Z. Phys. 69, 298; Stolz & Adams 1999, Phys. Fluids 11, 1699"};
    static constexpr bool by_diameter = false;
    double reach(const SpaceKernel& w, double /*diameter*/) const { return 2.0 * w.reach(); }
    double operator()(const SpaceKernel& w, double r, double diameter) const;
    double transform(double w, double /*k*/, double /*diameter*/) const { return w * (2.0 - w); }
};

using PorosityLaw = std::variant<KernelPorosity, OverlapPorosity, DeconvolvedPorosity>;

inline double reach(const PorosityLaw& law, const SpaceKernel& w, double diameter) {
    return std::visit([&](const auto& one) { return one.reach(w, diameter); }, law);
}
/// Transform of G where that of W is `w`.
inline double transform(const PorosityLaw& law, double w, double k, double diameter) {
    return std::visit([&](const auto& one) { return one.transform(w, k, diameter); }, law);
}
inline bool by_diameter(const PorosityLaw& law) {
    return std::visit([](const auto& one) { return one.by_diameter; }, law);
}

} // namespace plumb
