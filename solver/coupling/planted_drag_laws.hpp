// Drag laws that are wrong on purpose, in test builds only (PLUMB_PLANTED): each carries one mistake that has been seen
// in codes or papers, so that the checks can be shown to catch it. They are never part of the program that is
// installed.
#pragma once

#ifndef PLUMB_PLANTED
#error "planted faults belong to test builds only"
#endif

#include "core/laws.hpp"
#include "coupling/drag_laws_dense.hpp"
#include "coupling/drag_laws_sphere.hpp"

#include <cmath>
#include <variant>

namespace plumb {

namespace detail {
inline constexpr LawInfo planted(std::string_view mistake) { return {mistake, "none", "planted fault"}; }
} // namespace detail

// --- exponents

/// Di Felice's eps^(2-chi), which belongs to the interstitial slip, on the superficial one.
struct PlantedDiFeliceExponent : DiFelice {
    static constexpr std::string_view name = "di_felice_wrong_exponent";
    static constexpr LawInfo info = detail::planted("eps^(2-chi) on the superficial slip");
    double operator()(double re, double eps) const { return DiFelice::operator()(re, eps) * eps * eps; }
};

/// Digits of the exponent swapped.
struct PlantedSchillerNaumannExponent : SchillerNaumann {
    static constexpr std::string_view name = "schiller_naumann_wrong_exponent";
    static constexpr LawInfo info = detail::planted("Re^0.678 for Re^0.687");
    double operator()(double re, double eps) const { return (1.0 + 0.15 * std::pow(re / eps, 0.678)) / eps; }
};

/// The exponent's sign lost.
struct PlantedWenYuSign : WenYu {
    static constexpr std::string_view name = "wen_yu_wrong_sign";
    static constexpr LawInfo info = detail::planted("eps^+3.65 for eps^-3.65");
    double operator()(double re, double eps) const { return SchillerNaumann::sphere(re) * std::pow(eps, 3.65); }
};

/// Digits of the exponent swapped.
struct PlantedTangExponent : Tang {
    static constexpr std::string_view name = "tang_wrong_exponent";
    static constexpr LawInfo info = detail::planted("Re^-0.434 for Re^-0.343");
    double operator()(double re, double eps) const {
        const double eps4 = (eps * eps) * (eps * eps);
        const double factor = 0.169 * eps + 0.0644 / eps4;
        return Tang::operator()(re, eps) + factor * (std::pow(re, 0.566) - std::pow(re, 0.657));
    }
};

// --- missing eps

/// No voidage function at all.
struct PlantedDiFeliceNoEps : DiFelice {
    static constexpr std::string_view name = "di_felice_missing_eps";
    static constexpr LawInfo info = detail::planted("factor eps^-chi left out");
    double operator()(double re, double /*eps*/) const { return detail::dallavalle(re); }
};

/// The factor 1/eps^2 of the inertial term left out.
struct PlantedBeetstraNoEps : Beetstra {
    static constexpr std::string_view name = "beetstra_missing_eps";
    static constexpr LawInfo info = detail::planted("1/eps^2 of the inertial term left out");
    double operator()(double re, double eps) const { return detail::creeping_array(eps) + inertial(re, eps); }
};

/// The whole force taken for the drag without the mean pressure gradient.
struct PlantedTennetiNoEps : Tenneti {
    static constexpr std::string_view name = "tenneti_missing_eps";
    static constexpr LawInfo info = detail::planted("factor eps of f_d = eps f_total left out");
    double operator()(double re, double eps) const { return whole_force(re, eps); }
};

/// The same mistake in Koch and Hill's law.
struct PlantedKochHillNoEps : KochHill {
    static constexpr std::string_view name = "koch_hill_missing_eps";
    static constexpr LawInfo info = detail::planted("factor eps of f_d = eps f_total left out");
    double operator()(double re, double eps) const { return KochHill::operator()(re, eps) / eps; }
};

/// Ergun's beta divided by eps once instead of twice.
struct PlantedErgunNoEps : Ergun {
    static constexpr std::string_view name = "ergun_missing_eps";
    static constexpr LawInfo info = detail::planted("1/eps for 1/eps^2");
    double operator()(double re, double eps) const { return Ergun::operator()(re, eps) * eps; }
};

/// Reynolds number on the interstitial slip.
struct PlantedGidaspowNoEps : Gidaspow {
    static constexpr std::string_view name = "gidaspow_missing_eps";
    static constexpr LawInfo info = detail::planted("Re without eps");
    double operator()(double re, double eps) const { return Gidaspow::operator()(re / eps, eps); }
};

// --- natural for decimal logarithm

namespace detail {
inline double natural_bump(double re) {
    if (!(re > 0.0)) return 0.0;
    const double x = 1.5 - std::log(re);
    return std::exp(-0.5 * x * x);
}
} // namespace detail

struct PlantedDiFeliceLn : DiFelice {
    static constexpr std::string_view name = "di_felice_ln";
    static constexpr LawInfo info = detail::planted("ln Re for log10 Re");
    double operator()(double re, double eps) const {
        return detail::dallavalle(re) * std::pow(eps, -3.7 + 0.65 * detail::natural_bump(re));
    }
};

struct PlantedRongLn : Rong {
    static constexpr std::string_view name = "rong_ln";
    static constexpr LawInfo info = detail::planted("ln Re for log10 Re");
    double operator()(double re, double eps) const {
        const double beta = 2.65 * (eps + 1.0) - (5.3 - 3.5 * eps) * eps * eps * detail::natural_bump(re);
        return detail::dallavalle(re) * std::pow(eps, -beta);
    }
};

// --- misprinted constants

struct PlantedSchillerNaumann115 : SchillerNaumann {
    static constexpr std::string_view name = "schiller_naumann_115";
    static constexpr LawInfo info = detail::planted("1.15 for 0.15");
    double operator()(double re, double eps) const { return (1.0 + 1.15 * std::pow(re / eps, 0.687)) / eps; }
};

/// The sign of a3 lost between Re = 1 and 1000, as in copies of the table.
struct PlantedMorsiAlexanderSign : MorsiAlexander {
    static constexpr std::string_view name = "morsi_alexander_wrong_sign";
    static constexpr LawInfo info = detail::planted("+a3/Re^2 for 1 <= Re < 1000");
    double operator()(double re, double eps) const {
        const double re_i = re / eps;
        const double a3 = re_i < 1.0      ? 0.0
                          : re_i < 10.0   ? 3.8889
                          : re_i < 100.0  ? 116.67
                          : re_i < 1000.0 ? 2778.0
                                          : 0.0;
        return MorsiAlexander::operator()(re, eps) + (a3 > 0.0 ? 2.0 * a3 / (24.0 * re_i) / eps : 0.0);
    }
};

using PlantedDragLaws =
    std::variant<PlantedDiFeliceExponent, PlantedSchillerNaumannExponent, PlantedWenYuSign, PlantedTangExponent,
                 PlantedDiFeliceNoEps, PlantedBeetstraNoEps, PlantedTennetiNoEps, PlantedKochHillNoEps,
                 PlantedErgunNoEps, PlantedGidaspowNoEps, PlantedDiFeliceLn, PlantedRongLn, PlantedSchillerNaumann115,
                 PlantedMorsiAlexanderSign>;

} // namespace plumb
