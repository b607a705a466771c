// Drag of a sphere among others: laws that depend on the fluid fraction eps. phi = 1 - eps.
//
// Every law returns F of drag_range.hpp; equation numbers (1), (2) refer to that page. A frequent cross-check is the
// Carman-Kozeny law, -grad p = 180 mu phi^2 U / (d^2 eps^3) with U the superficial velocity: with n = 6 phi/(pi d^3) it
// is f_total/(3 pi mu d U) = 10 phi/eps^3, hence by (1) F = 10 phi/eps^2 (Ergun's 150 in place of 180: 8.33 phi/eps^2).
// To add a law: write the struct, name it in DenseDragLaws at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"
#include "coupling/drag_laws_sphere.hpp"
#include "coupling/drag_range.hpp"

#include <cmath>
#include <variant>

namespace plumb {

namespace detail {
/// C_d Re/24 of Dallavalle's C_d = (0.63 + 4.8/sqrt(Re))^2, finite at Re = 0, where it is 0.96.
inline double dallavalle(double re) {
    const double root = 0.63 * std::sqrt(re) + 4.8; // Dallavalle 1948, Micromeritics
    return root * root / 24.0;
}

/// exp(-(1.5 - log10 Re)^2/2), the bump of Di Felice's exponent; its limit at Re = 0 is 0.
inline double intermediate_bump(double re) {
    if (!(re > 0.0)) return 0.0;
    const double x = 1.5 - std::log10(re); // Di Felice 1994: decimal logarithm
    return std::exp(-0.5 * x * x);
}
} // namespace detail

/// F = C_d Re/24 eps^-chi, C_d = (0.63 + 4.8/sqrt(Re))^2, chi = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2/2), Re superficial.
/// Source: Di Felice 1994, where f_d = (pi/8) C_d rho d^2 u_s^2 eps^-chi is what balances the weight in the
/// bulk density, eps V (rho_p - rho) g: by (1) that is this page's f_d, no conversion. The same law is written
/// eps^(2-chi) on the interstitial slip; eps^-chi on the interstitial slip is wrong.
/// Limits: eps = 1: Dallavalle (0.96 of Stokes at Re = 0); Re -> 0: 0.96 eps^-3.7.
struct DiFelice {
    static constexpr std::string_view name = "di_felice";
    static constexpr LawInfo info{
        "F = (0.63 sqrt(Re) + 4.8)^2/24 eps^-chi, chi = 3.7 - 0.65 exp(-(1.5 - log10 Re)^2/2), Re superficial",
        "0.01 <= Re <= 1e4, 0.4 <= eps <= 1", "Di Felice 1994, Int. J. Multiphase Flow 20, 153-159"};
    static constexpr DragRange range{0.01, 1e4, 0.4, 1.0};
    double operator()(double re_superficial, double eps) const {
        const double chi = 3.7 - 0.65 * detail::intermediate_bump(re_superficial); // Di Felice 1994
        return detail::dallavalle(re_superficial) * std::pow(eps, -chi);
    }
};

/// F = C_d Re/24 eps^-3.65 with Schiller-Naumann's C_d (0.44 above Re = 1000), Re superficial.
/// Source: Wen & Yu 1966 in the form of Gidaspow 1994, beta = (3/4) C_d eps phi rho |u-v|/d eps^-2.65; by (2)
/// eps^-3.65. Wen and Yu's own eps^-4.7 multiplies the whole force; by (1) it is eps^-3.7 here, and the customary
/// rounding is 3.65. Limits: eps = 1: Schiller-Naumann; Re -> 0: eps^-3.65.
struct WenYu {
    static constexpr std::string_view name = "wen_yu";
    static constexpr LawInfo info{"F = (1 + 0.15 Re^0.687) eps^-3.65, C_d = 0.44 above Re = 1000, Re superficial",
                                  "Re <= 1000, 0.4 <= eps <= 1 (Gidaspow uses it above 0.8)",
                                  "Wen & Yu 1966, Chem. Eng. Prog. Symp. Ser. 62, 100-111"};
    static constexpr DragRange range{0.0, 1000.0, 0.4, 1.0};
    double operator()(double re_superficial, double eps) const {
        return SchillerNaumann::sphere(re_superficial) * std::pow(eps, -3.65); // Wen & Yu 1966, Gidaspow 1994
    }
};

/// F = (150 (1-eps) + 1.75 Re) / (18 eps^2), Re superficial: packed beds.
/// Source: Ergun 1952, -grad p = 150 mu phi^2 U/(d^2 eps^3) + 1.75 rho phi U^2/(d eps^3). By -grad p = n f_total and
/// (1), or from beta = 150 phi^2 mu/(eps d^2) + 1.75 phi rho |u-v|/d by (2). Limits: Re -> 0: 8.33 phi/eps^2
/// (Carman-Kozeny with 150); eps = 1: 0.0972 Re, i.e. C_d = 7/3 without any viscous part: no single-sphere law; do not
/// use it in dilute suspensions.
struct Ergun {
    static constexpr std::string_view name = "ergun";
    static constexpr LawInfo info{"F = (150 (1-eps) + 1.75 Re)/(18 eps^2), Re superficial",
                                  "Re <= 1000, 0.36 <= eps <= 0.65 (packed beds)",
                                  "Ergun 1952, Chem. Eng. Prog. 48, 89-94"};
    static constexpr DragRange range{0.0, 1000.0, 0.36, 0.65};
    double operator()(double re_superficial, double eps) const {
        return (150.0 * (1.0 - eps) + 1.75 * re_superficial) / (18.0 * eps * eps); // 150, 1.75: Ergun 1952
    }
};

/// Ergun for eps <= 0.8, Wen-Yu above. Source: Gidaspow 1994. The two do not meet: at eps = 0.8 F steps by a factor
/// 0.867 at Re = 0 (Ergun 2.604, Wen-Yu 2.258); the step is the source's own.
/// Limits: eps = 1: Schiller-Naumann; Re -> 0: 8.33 phi/eps^2 or eps^-3.65.
struct Gidaspow {
    static constexpr std::string_view name = "gidaspow";
    static constexpr LawInfo info{"Ergun for eps <= 0.8, Wen-Yu above", "Re <= 1000, 0.36 <= eps <= 1",
                                  "Gidaspow 1994, Multiphase Flow and Fluidization"};
    static constexpr DragRange range{0.0, 1000.0, 0.36, 1.0};
    double operator()(double re_superficial, double eps) const {
        if (eps > 0.8) return WenYu{}(re_superficial, eps); // 0.8: Gidaspow 1994
        return Ergun{}(re_superficial, eps);
    }
};

namespace detail {
/// 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi)): creeping flow through random arrays. van der Hoef, Beetstra & Kuipers
/// 2005, J. Fluid Mech. 528, 233-254: drag without the share of the mean pressure gradient, superficial velocity.
inline double creeping_array(double eps) {
    const double phi = 1.0 - eps, eps2 = eps * eps;
    return 10.0 * phi / eps2 + eps2 * (1.0 + 1.5 * std::sqrt(phi)); // van der Hoef et al. 2005
}
} // namespace detail

/// F = 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi))
///     + 0.413 Re/(24 eps^2) [1/eps + 3 eps phi + 8.4 Re^-0.343] / [1 + 10^(3 phi) Re^-(1+4 phi)/2], Re superficial.
/// Source: Beetstra, van der Hoef & Kuipers 2007, whose F is the drag without the mean pressure gradient over
/// 3 pi mu d U: no conversion (its creeping limit is Carman-Kozeny's F, above). The fraction is multiplied through by
/// Re^((1+4 phi)/2) to hold at Re = 0.
/// Limits: Re -> 0: creeping_array(eps); eps = 1, Re = 0: Stokes. At eps = 1 and finite Re it is no single-sphere law:
/// 16 % above Schiller-Naumann at Re = 100 and 69 % at 1000; the fit starts at phi = 0.1.
struct Beetstra {
    static constexpr std::string_view name = "beetstra";
    static constexpr LawInfo info{
        "F = 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi)) + 0.413 Re/(24 eps^2) [1/eps + 3 eps phi + "
        "8.4 Re^-0.343]/[1 + 10^(3 phi) Re^-(1+4 phi)/2], Re superficial",
        "Re <= 1000, 0.4 <= eps <= 0.9", "Beetstra et al. 2007, AIChE J. 53, 489-501"};
    static constexpr DragRange range{0.0, 1000.0, 0.4, 0.9};
    double operator()(double re_superficial, double eps) const {
        return detail::creeping_array(eps) + inertial(re_superficial, eps) / (eps * eps);
    }
    /// The term of Re, times eps^2. Constants: Beetstra et al. 2007.
    static double inertial(double re, double eps) {
        if (!(re > 0.0)) return 0.0;
        const double phi = 1.0 - eps, log_re = std::log(re);
        const double power = std::exp((0.5 + 2.0 * phi) * log_re); // Re^((1+4 phi)/2)
        const double damping = power / (power + std::pow(10.0, 3.0 * phi));
        const double bracket = (1.0 / eps + 3.0 * eps * phi) * re + 8.4 * std::exp(0.657 * log_re); // 1 - 0.343
        return 0.413 / 24.0 * bracket * damping;
    }
};

/// F = 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi))
///     + [0.11 phi (1+phi) - 0.00456/eps^4 + (0.169 eps + 0.0644/eps^4) Re^-0.343] Re, Re superficial.
/// Source: Tang, Peters, Kuipers, Kriebitzsch & van der Hoef 2015 (static arrays), same F as Beetstra: no conversion.
/// The minus of 0.00456 belongs there: with a plus F at eps = 1, Re = 1000 would be 50 % above Schiller-Naumann instead
/// of 0.2 % (test). Limits: Re -> 0: creeping_array(eps); eps = 1: Stokes at Re = 0, 0 to 20 % above Schiller-Naumann
/// up to Re = 1000.
struct Tang {
    static constexpr std::string_view name = "tang";
    static constexpr LawInfo info{
        "F = 10 phi/eps^2 + eps^2 (1 + 1.5 sqrt(phi)) + [0.11 phi (1+phi) - 0.00456/eps^4 + (0.169 "
        "eps + 0.0644/eps^4) Re^-0.343] Re, Re superficial",
        "Re <= 1000, 0.4 <= eps <= 1", "Tang et al. 2015, AIChE J. 61, 688-698"};
    static constexpr DragRange range{0.0, 1000.0, 0.4, 1.0};
    double operator()(double re_superficial, double eps) const { // constants: Tang et al. 2015
        const double phi = 1.0 - eps, eps4 = (eps * eps) * (eps * eps);
        return detail::creeping_array(eps) + (0.11 * phi * (1.0 + phi) - 0.00456 / eps4) * re_superficial +
               (0.169 * eps + 0.0644 / eps4) * std::pow(re_superficial, 0.657); // Re^(1 - 0.343)
    }
};

/// F = eps F_T, F_T = F_SN(Re)/eps^3 + 5.81 phi/eps^3 + 0.48 phi^(1/3)/eps^4 + phi^3 Re (0.95 + 0.61 phi^3/eps^2), Re
/// superficial, F_SN = 1 + 0.15 Re^0.687 (Schiller-Naumann, continued by C_d = 0.44 above Re = 1000).
/// Source: Tenneti, Garg & Subramaniam 2011, whose F_T is the whole mean force, mean pressure gradient included, over
/// 3 pi mu d eps |u-v|: hence the factor eps of (1). Check at phi = 0.4, Re = 0: F_T = 18.1 against 19.7 of van der
/// Hoef et al. over eps. In a widely used code the isolated-sphere term lacks one power of 1/eps; the form here agrees
/// with the one used by Osnes et al. 2023 (Int. J. Multiphase Flow 165, 104485) after conversion. Limits: eps = 1:
/// Schiller-Naumann; Re -> 0: (1 + 5.81 phi)/eps^2 + 0.48 phi^(1/3)/eps^3.
struct Tenneti {
    static constexpr std::string_view name = "tenneti";
    static constexpr LawInfo info{
        "F = eps [(1 + 0.15 Re^0.687)/eps^3 + 5.81 phi/eps^3 + 0.48 phi^(1/3)/eps^4 + phi^3 Re "
        "(0.95 + 0.61 phi^3/eps^2)], Re superficial",
        "0.01 <= Re <= 300, 0.5 <= eps <= 0.9", "Tenneti et al. 2011, Int. J. Multiphase Flow 37, 1072-1092"};
    static constexpr DragRange range{0.01, 300.0, 0.5, 0.9};
    double operator()(double re_superficial, double eps) const { return eps * whole_force(re_superficial, eps); }
    /// F_T, with the share of the mean pressure gradient. Constants: Tenneti et al. 2011.
    static double whole_force(double re, double eps) {
        const double phi = 1.0 - eps, phi3 = phi * phi * phi, eps2 = eps * eps, eps3 = eps2 * eps;
        return (SchillerNaumann::sphere(re) + 5.81 * phi + 0.48 * std::cbrt(phi) / eps) / eps3 +
               phi3 * re * (0.95 + 0.61 * phi3 / eps2);
    }
};

/// F = C_d Re/24 eps^-beta, C_d = (0.63 + 4.8/sqrt(Re))^2,
/// beta = 2.65 (eps + 1) - (5.3 - 3.5 eps) eps^2 exp(-(1.5 - log10 Re)^2/2), Re superficial.
/// Source: Rong, Dong & Yu 2013, f_d = (pi/8) C_d rho d^2 |u-v|^2 eps^(2-beta) without the pressure gradient: on u_s it
/// is eps^-beta, no conversion. Check at eps = 0.4, Re = 0: F = 28.7 against 31.3 (Ergun) and 37.5 (Carman-Kozeny); the
/// whole force would be 2.5 times that. At eps = 0.4 beta equals Di Felice's chi within 0.04 for every Re. Limits: eps
/// = 1: Dallavalle; Re -> 0: 0.96 eps^-(2.65 (eps + 1)).
struct Rong {
    static constexpr std::string_view name = "rong";
    static constexpr LawInfo info{
        "F = (0.63 sqrt(Re) + 4.8)^2/24 eps^-beta, beta = 2.65 (eps+1) - (5.3 - 3.5 eps) eps^2 "
        "exp(-(1.5 - log10 Re)^2/2), Re superficial",
        "Re <= 3000, 0.37 <= eps <= 1", "Rong, Dong & Yu 2013, Chem. Eng. Sci. 99, 44-58"};
    static constexpr DragRange range{0.0, 3000.0, 0.37, 1.0};
    double operator()(double re_superficial, double eps) const { // constants: Rong et al. 2013
        const double bump = detail::intermediate_bump(re_superficial);
        const double beta = 2.65 * (eps + 1.0) - (5.3 - 3.5 * eps) * eps * eps * bump;
        return detail::dallavalle(re_superficial) * std::pow(eps, -beta);
    }
};

/// F = eps (F0 + F3 Re/2), Re superficial on the diameter (the source's Re uses the radius, hence the half);
/// F0 = [1 + 3 sqrt(phi/2) + (135/64) phi ln(phi) + 16.14 phi]/[1 + 0.681 phi - 8.48 phi^2 + 8.16 phi^3] for phi < 0.4,
/// F0 = 10 phi/eps^3 from there on; F3 = 0.0673 + 0.212 phi + 0.0232/eps^5.
/// Source: Koch & Hill 2001 after Hill, Koch & Ladd 2001, whose F is the whole force over 6 pi mu a U (10 phi/eps^3 is
/// Carman-Kozeny with the pressure gradient): hence eps of (1). Equals beta = 18 mu eps^2 phi/d^2 (F0 + F3 Re/2) by
/// (2). The low-Re branch F1 Re_a^2 of the source is left out, as customary. 8.14 for 8.16 is a misprint in
/// circulation. Limits: eps = 1: 1 + 0.04525 Re, Stokes at Re = 0 but no single-sphere law beyond (linear in Re); Re ->
/// 0: eps F0. F0 steps up by 1.0 % at phi = 0.4.
struct KochHill {
    static constexpr std::string_view name = "koch_hill";
    static constexpr LawInfo info{
        "F = eps (F0 + F3 Re/2); F0 = [1 + 3 sqrt(phi/2) + 135/64 phi ln(phi) + 16.14 phi]/[1 + 0.681 phi - 8.48 phi^2 "
        "+ "
        "8.16 phi^3] below phi = 0.4, else 10 phi/eps^3; F3 = 0.0673 + 0.212 phi + 0.0232/eps^5; Re superficial",
        "Re <= 240, 0.36 <= eps <= 0.99", "Koch & Hill 2001, Annu. Rev. Fluid Mech. 33, 619-647"};
    static constexpr DragRange range{0.0, 240.0, 0.36, 0.99};
    double operator()(double re_superficial, double eps) const {
        return eps * (creeping(eps) + 0.5 * inertial_slope(eps) * re_superficial);
    }
    /// F0. Constants: Hill, Koch & Ladd 2001, J. Fluid Mech. 448, 213-241.
    static double creeping(double eps) {
        const double phi = 1.0 - eps;
        if (phi >= 0.4) return 10.0 * phi / (eps * eps * eps);
        const double logarithm = phi > 0.0 ? phi * std::log(phi) : 0.0;
        return (1.0 + 3.0 * std::sqrt(0.5 * phi) + 135.0 / 64.0 * logarithm + 16.14 * phi) /
               (1.0 + phi * (0.681 + phi * (-8.48 + phi * 8.16)));
    }
    /// F3, per Reynolds number on the radius. Constants: Hill, Koch & Ladd 2001, J. Fluid Mech. 448, 243-278.
    static double inertial_slope(double eps) {
        const double eps2 = eps * eps;
        return 0.0673 + 0.212 * (1.0 - eps) + 0.0232 / (eps2 * eps2 * eps);
    }
};

using DenseDragLaws = std::variant<DiFelice, WenYu, Ergun, Gidaspow, Beetstra, Tang, Tenneti, Rong, KochHill>;

} // namespace plumb
