// How the drag between a grain and the fluid is integrated over a step.
//
// During a step dv/dt = g - beta (v - u), with everything but the slip in g. With z = beta dt every choice has the form
//     v' = phi0 v + phi1 dt g + (1 - phi0) u,      x' = x + phi1 dt v + phi2 dt^2 (g + beta u),
//     phi1 = (1 - phi0)/z,   phi2 = (1 - phi1)/z,
// so that a grain at its terminal velocity stays there and moves with it for any z, and z -> 0 is velocity Verlet.
// The rate beta of a nonlinear drag law is taken at the middle of the step, which makes all three second order.
#pragma once

#include "core/laws.hpp"
#include "core/vec.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace plumb {

struct StepWeights {
    double phi0, phi1, phi2;
};

/// phi0 = exp(-z): exact for a constant rate; no step is too long.
struct ExponentialExchange {
    static constexpr std::string_view name = "exponential";
    static constexpr LawInfo info{"phi0 = exp(-z)", "any step", "Hochbruck & Ostermann 2010, Acta Numerica 19, 209"};
    static constexpr int most_iterations = 100;
    StepWeights operator()(double z) const {
        // Below z = 0.05 the differences lose digits; four terms of the series are then exact to 1e-9 relative in
        // phi2's correction, that is to rounding after the factor z.
        if (z < 0.05) {
            const double phi2 =
                1.0 / 2 -
                z * (1.0 / 6 -
                     z * (1.0 / 24 -
                          z * (1.0 / 120 - z * (1.0 / 720 - z * (1.0 / 5040 - z * (1.0 / 40320 - z / 362880))))));
            const double phi1 = 1.0 - z * phi2;
            return {1.0 - z * phi1, phi1, phi2};
        }
        const double phi1 = -std::expm1(-z) / z;
        return {std::exp(-z), phi1, (1.0 - phi1) / z};
    }
};

/// phi0 = 1/(1 + z + z^2/2), the (0,2) Pade approximant: implicit, L-stable, second order.
struct ImplicitExchange {
    static constexpr std::string_view name = "implicit";
    static constexpr LawInfo info{"phi0 = 1/(1 + z + z^2/2)", "any step",
                                  "Hairer & Wanner 1996, Solving ODEs II, IV.3"};
    static constexpr int most_iterations = 100;
    StepWeights operator()(double z) const {
        const double d = 1.0 + z * (1.0 + 0.5 * z);
        return {1.0 / d, (1.0 + 0.5 * z) / d, 0.5 * (1.0 + z) / d};
    }
};

/// phi0 = 1 - z + z^2/2: explicit, second order, unstable for z > 2. It is here to show what the other two avoid.
struct ExplicitExchange {
    static constexpr std::string_view name = "explicit";
    static constexpr LawInfo info{"phi0 = 1 - z + z^2/2",
                                  "step < 2 tau_p one way; two ways on a grid < 2 tau_p/(3 load) at great load",
                                  "Hairer, Norsett & Wanner 1993, II.1"};
    static constexpr int most_iterations = 1;
    StepWeights operator()(double z) const { return {1.0 - z + 0.5 * z * z, 1.0 - 0.5 * z, 0.5}; }
};

using Exchange = std::variant<ExponentialExchange, ImplicitExchange, ExplicitExchange>;

/// Drag rate beta [1/s] at the middle of a step of `dt` seconds that starts with `slip` = v - u [m/s] under the
/// acceleration `g` [m/s2] by all other forces. `rate(speed)` is beta at a slip of `speed` [m/s], not decreasing.
///
/// The root of F(x) = ln rate(slip at the middle for beta = e^x) - x by the secant rule. Where the step is long, the
/// slip at its middle is g/beta, so for beta ~ slip^p the slope of F is -(1 + p), between -1 (Stokes) and -2 (Newton)
/// for any step. The first change, and all from the twentieth on (a law with jumps), take the slope -2, with which the
/// error is at least halved.
template <class ExchangeLaw, class Rate>
double mid_step_rate(const ExchangeLaw& exchange, const Rate& rate, const Vec3& slip, const Vec3& g, double dt) {
    const double tolerance = 1e-13;                              // relative; a few rounding errors
    double beta = rate(slip.norm()), before = 0.0, change = 0.0; // F and the change of x in the last pass
    for (int k = 0; k < ExchangeLaw::most_iterations; ++k) {
        const StepWeights half = exchange(0.5 * beta * dt);
        const double found = rate((half.phi0 * slip + (0.5 * dt * half.phi1) * g).norm());
        // A law without a linear part starts from rest with beta = 0, whose logarithm no change would bring up.
        if (ExchangeLaw::most_iterations == 1 || beta == 0.0 || found == 0.0) {
            const bool settled = found == beta;
            beta = found, change = 0.0;
            if (settled) break;
            continue;
        }
        const double f = std::log(found / beta);
        const double steepness = change == 0.0 || k >= 20 ? 2.0 : std::clamp((before - f) / change, 0.9, 2.2);
        before = f, change = f / steepness;
        beta *= std::exp(change);
        if (std::abs(change) <= tolerance) break;
    }
    return beta;
}

} // namespace plumb
