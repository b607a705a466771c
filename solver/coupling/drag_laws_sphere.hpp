// Drag of a single sphere in unbounded fluid.
//
// These laws know nothing of neighbours: the drag depends on the interstitial slip |u - v| alone, with
// Re_i = rho d |u - v| / mu = re_superficial / eps and C_d defined by f_d = (pi/8) C_d rho d^2 |u - v|^2. Written as
// the drag ratio of drag_range.hpp that is F = (C_d(Re_i) Re_i / 24) / eps, so that 3 pi mu d u_s F does not contain
// eps: no hindrance. `sphere(re)` is C_d Re / 24, finite at Re = 0; at eps = 1 it is the drag ratio. To add a law:
// write the struct, name it in SphereDragLaws at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"
#include "coupling/drag_range.hpp"

#include <array>
#include <cmath>
#include <variant>

namespace plumb {

/// No drag at all: F = 0.
struct NoDrag {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"F = 0", "any", "absence of drag"};
    static constexpr DragRange range{0.0, 1e300, 0.0, 1.0};
    double operator()(double /*re_superficial*/, double /*eps*/) const { return 0.0; }
};

/// C_d = 24/Re: creeping flow. Stokes 1851. The first neglected term, Oseen's 3 Re/16, is 2 % at Re = 0.1.
struct Stokes {
    static constexpr std::string_view name = "stokes";
    static constexpr LawInfo info{"C_d = 24/Re_i, F = 1/eps", "Re_i <= 0.1 (error 3 Re_i/16), one sphere",
                                  "Stokes 1851, Trans. Camb. Phil. Soc. 9"};
    static constexpr DragRange range{0.0, 0.1, 0.0, 1.0, ReynoldsKind::interstitial};
    static double sphere(double /*re*/) { return 1.0; }
    double operator()(double /*re_superficial*/, double eps) const { return 1.0 / eps; }
};

/// C_d = 24/Re (1 + 0.15 Re^0.687), and 0.44 for Re > 1000. Limit Re -> 0: Stokes.
/// The fit is Schiller and Naumann's (Re <= 800, usually trusted to 1000); the constant above it is Newton's regime,
/// added by later users and outside `range`. C_d steps up by 0.4 % there.
struct SchillerNaumann {
    static constexpr std::string_view name = "schiller_naumann";
    static constexpr LawInfo info{"C_d = 24/Re_i (1 + 0.15 Re_i^0.687), 0.44 above Re_i = 1000; F = C_d Re_i/(24 eps)",
                                  "Re_i <= 1000, one sphere", "Schiller & Naumann 1933, Z. VDI 77, 318-320"};
    static constexpr DragRange range{0.0, 1000.0, 0.0, 1.0, ReynoldsKind::interstitial};
    static double sphere(double re) {
        if (re > 1000.0) return 0.44 / 24.0 * re; // Newton's regime, e.g. Clift, Grace & Weber 1978, ch. 5
        return 1.0 + 0.15 * std::pow(re, 0.687);  // Schiller & Naumann 1933
    }
    double operator()(double re_superficial, double eps) const { return sphere(re_superficial / eps) / eps; }
};

/// C_d = a1 + a2/Re + a3/Re^2 in eight intervals; Stokes below Re = 0.1.
/// Morsi & Alexander 1972, table 1. Neighbouring pieces meet within 0.01 % up to Re = 100, 0.02 % at 100, 0.4 % at
/// 1000, 0.1 % at 5000 and 2.4 % at 10 000, where the drag steps down: that jump is the source's own. The sign of a3
/// between Re = 1 and 1000 (minus) and the digits of the last two rows are often copied wrong.
struct MorsiAlexander {
    static constexpr std::string_view name = "morsi_alexander";
    static constexpr LawInfo info{"C_d = a1 + a2/Re_i + a3/Re_i^2 in 8 intervals; F = C_d Re_i/(24 eps)",
                                  "Re_i <= 50 000, one sphere",
                                  "Morsi & Alexander 1972, J. Fluid Mech. 55, 193-208, table 1"};
    static constexpr DragRange range{0.0, 5e4, 0.0, 1.0, ReynoldsKind::interstitial};

    struct Piece {
        double below; // the row holds for Re below this
        double a1, a2, a3;
    };
    static constexpr std::array<Piece, 8> pieces{{
        {0.1, 0.0, 24.0, 0.0}, // Morsi & Alexander 1972, table 1, as are all rows
        {1.0, 3.690, 22.73, 0.0903},
        {10.0, 1.222, 29.1667, -3.8889},
        {100.0, 0.6167, 46.50, -116.67},
        {1000.0, 0.3644, 98.33, -2778.0},
        {5000.0, 0.357, 148.62, -4.75e4},
        {10000.0, 0.46, -490.546, 57.87e4},
        {1e300, 0.5191, -1662.5, 5.4167e6},
    }};
    static double sphere(double re) {
        if (re < pieces[0].below) return 1.0;
        std::size_t i = 1;
        while (re >= pieces[i].below && i + 1 < pieces.size()) ++i;
        return (pieces[i].a1 * re + pieces[i].a2 + pieces[i].a3 / re) / 24.0;
    }
    double operator()(double re_superficial, double eps) const { return sphere(re_superficial / eps) / eps; }
};

/// C_d = 24/Re (1 + 0.150 Re^0.681) + 0.407/(1 + 8710/Re). Limits: Stokes at Re -> 0, 0.407 at Re -> infinity.
/// The last term times Re/24 is written 0.407/24 Re^2/(Re + 8710) to hold at Re = 0.
struct BrownLawler {
    static constexpr std::string_view name = "brown_lawler";
    static constexpr LawInfo info{"C_d = 24/Re_i (1 + 0.150 Re_i^0.681) + 0.407/(1 + 8710/Re_i); F = C_d Re_i/(24 eps)",
                                  "Re_i <= 2e5, one sphere", "Brown & Lawler 2003, J. Environ. Eng. 129, 222-231"};
    static constexpr DragRange range{0.0, 2e5, 0.0, 1.0, ReynoldsKind::interstitial};
    static double sphere(double re) { // constants: Brown & Lawler 2003
        return 1.0 + 0.150 * std::pow(re, 0.681) + 0.407 / 24.0 * re * re / (re + 8710.0);
    }
    double operator()(double re_superficial, double eps) const { return sphere(re_superficial / eps) / eps; }
};

/// C_d = 24/Re (1 + 0.1806 Re^0.6459) + 0.4251/(1 + 6880.95/Re): the spheres' case (sphericity 1) of the paper's fit.
/// Limits: Stokes at Re -> 0, 0.4251 at Re -> infinity.
struct HaiderLevenspiel {
    static constexpr std::string_view name = "haider_levenspiel";
    static constexpr LawInfo info{
        "C_d = 24/Re_i (1 + 0.1806 Re_i^0.6459) + 0.4251/(1 + 6880.95/Re_i); F = C_d Re_i/(24 eps)",
        "Re_i <= 2.6e5, one sphere", "Haider & Levenspiel 1989, Powder Technol. 58, 63-70"};
    static constexpr DragRange range{0.0, 2.6e5, 0.0, 1.0, ReynoldsKind::interstitial};
    static double sphere(double re) { // constants: Haider & Levenspiel 1989
        return 1.0 + 0.1806 * std::pow(re, 0.6459) + 0.4251 / 24.0 * re * re / (re + 6880.95);
    }
    double operator()(double re_superficial, double eps) const { return sphere(re_superficial / eps) / eps; }
};

using SphereDragLaws = std::variant<NoDrag, Stokes, SchillerNaumann, MorsiAlexander, BrownLawler, HaiderLevenspiel>;

} // namespace plumb
