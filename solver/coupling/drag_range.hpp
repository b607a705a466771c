// What every drag law has in common: the convention of its result, and the range in which its source says it holds.
//
// A drag law returns the drag ratio
//     F = f_d / (3 pi mu d u_s),    u_s = eps |u - v|  (superficial slip),    Re = rho d u_s / mu  (re_superficial)
// of the drag f_d [N] on ONE grain, in the formulation in which the grain receives V (-grad p + div tau) separately.
//
// Papers differ in what they call drag. In a steady homogeneous bed the pressure drop carries the whole force,
// -grad p = n f_total with n V = 1 - eps, so the share of the mean pressure gradient in f_total is V n f_total
// = (1 - eps) f_total, and
//     f_d = eps f_total                                                                                   (1)
// Forces per volume of an exchange coefficient beta, n f_d = beta |u - v| (momentum equation eps grad p, "model A"),
// give
//     F = beta d^2 / (18 mu (1 - eps) eps)                                                                (2)
// Each law below says which of the two its source uses and how it was converted.
#pragma once

#include <variant>

namespace plumb {

/// Which Reynolds number the limits of a range are written in.
enum class ReynoldsKind {
    superficial,  // rho d eps |u - v| / mu
    interstitial, // rho d |u - v| / mu
};

/// Range of validity given by the source of a law; ends included.
struct DragRange {
    double re_min, re_max;
    double eps_min, eps_max;
    ReynoldsKind kind = ReynoldsKind::superficial;
};

/// Whether a state lies in the range of a law; `re_superficial` is converted when the range is interstitial.
inline bool within(const DragRange& range, double re_superficial, double eps) {
    const double re = range.kind == ReynoldsKind::superficial ? re_superficial : re_superficial / eps;
    return re >= range.re_min && re <= range.re_max && eps >= range.eps_min && eps <= range.eps_max;
}

namespace detail {
template <class... Families> struct Joined;
template <class... A> struct Joined<std::variant<A...>> { using type = std::variant<A...>; };
template <class... A, class... B, class... Rest>
struct Joined<std::variant<A...>, std::variant<B...>, Rest...> : Joined<std::variant<A..., B...>, Rest...> {};
} // namespace detail

/// One variant of the members of several.
template <class... Families> using JoinedFamilies = typename detail::Joined<Families...>::type;

} // namespace plumb
