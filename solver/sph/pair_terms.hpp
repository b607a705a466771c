// The terms of the equations of motion as sums over neighbours. A term is a pure function of one pair: eight particles
// a, one per lane, against one particle b. The sweep adds up all terms of a scene in one loop; no term has a loop.
//
// Fixed: dx = x_a - x_b, dv = v_a - v_b, grad_a W = F dx with F = sigma/h^(d+2) f(q) <= 0, V = m/rho. All masses are m.
// A term adds to Sums without the common factor m sigma/h^(d+2), which the sweep applies once at the end.
#pragma once

#include "core/laws.hpp"
#include "core/simd.hpp"

#include <variant>

namespace plumb {

/// A vector of d components. Named members, not an array: an array that is indexed in a loop stays in memory, and the
/// sums of the sweep have to stay in registers.
template <class T, int d> struct Components;
template <class T> struct Components<T, 2> { T x, y; };
template <class T> struct Components<T, 3> { T x, y, z; };

/// Calls body(component of a, ...) for every component.
template <int d, class Body, class... Vectors>
[[gnu::always_inline]] inline void for_components(Body&& body, Vectors&&... v) {
    body(v.x...);
    body(v.y...);
    if constexpr (d == 3) body(v.z...);
}
template <class T, int d> [[gnu::always_inline]] inline T dot(const Components<T, d>& a, const Components<T, d>& b) {
    T sum = a.x * b.x + a.y * b.y;
    if constexpr (d == 3) sum += a.z * b.z;
    return sum;
}
/// sum += factor * a
template <class T, int d>
[[gnu::always_inline]] inline void add(Components<T, d>& sum, T factor, const Components<T, d>& a) {
    for_components<d>(
        [&](T & s, const T& c) __attribute__((always_inline)) { s += factor * c; }, sum, a);
}
/// sum -= factor * a
template <class T, int d>
[[gnu::always_inline]] inline void subtract(Components<T, d>& sum, T factor, const Components<T, d>& a) {
    for_components<d>(
        [&](T & s, const T& c) __attribute__((always_inline)) { s -= factor * c; }, sum, a);
}

/// A symmetric matrix of d x d.
template <class T, int d> struct Symmetric;
template <class T> struct Symmetric<T, 2> { T xx, yy, xy; };
template <class T> struct Symmetric<T, 3> { T xx, yy, xy, zz, xz, yz; };

/// One pair, eight times.
template <int d> struct PairState {
    Components<Pack, d> dx, dv; // [m], [m/s]
    Pack r_sq;                  // |dx|^2 [m2]
    Pack f;                     // w'(q)/q [-]
    Pack dv_dx;                 // dv . dx [m2/s]
};

/// What a pair needs to know of one particle besides position and velocity.
struct Side {
    Pack pressure; // p/rho^2 [m5/(kg s2)]; p/m^2 for the terms of volumes [Pa/kg2]
    Pack volume;   // m/rho [m3], [m2] in the plane
};

template <int d> struct Sums {
    Components<Pack, d> acceleration; // dv/dt
    Pack density_rate;                // d rho/dt
    // for shifting; without the factor m
    Components<Pack, d> spread;   // -grad C, towards where particles are missing
    Pack completeness;            // sum V_b (x_b - x_a) . grad W, the divergence of the position
    Components<Pack, d> dv_along; // derivatives of v and rho along the spread; without two such factors
    Pack drho_along;              // [1/m], times m
    // for corrected operators, likewise
    Components<Components<Pack, d>, d> grad_v; // of each component of the velocity
    Components<Pack, d> grad_rho, grad_p;
    Symmetric<Pack, d> moment; // sum V (x_b - x_a) (x) grad W
};

/// What the coefficients of the terms are made from.
struct TermScales {
    double mass;        // [kg], [kg/m] in the plane
    double viscosity;   // dynamic [Pa s]
    double h;           // smoothing length [m]
    double sound_speed; // [m/s]
    int dimensions;
};

/// d rho_a/dt = sum m dv . grad W
struct Continuity {
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& /*a*/, const Side& /*b*/,
                                           Sums<d>& sums) const {
        sums.density_rate += p.f * p.dv_dx;
    }
};

/// dv_a/dt = - sum m (p_a/rho_a^2 + p_b/rho_b^2) grad W: conserves momentum.
struct PressureTerm {
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        subtract(sums.acceleration, p.f * (a.pressure + b.pressure), p.dx);
    }
};

/// d rho_a/dt = rho_a sum V_b dv . grad W
struct VolumeContinuity {
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        sums.density_rate += p.f * p.dv_dx * (b.volume * (broadcast<Pack>(1.0) / a.volume));
    }
};

/// m_a dv_a/dt = - sum V_a V_b (p_a + p_b) grad W: conserves momentum.
struct VolumePressureTerm {
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        subtract(sums.acceleration, p.f * (a.volume * b.volume) * (a.pressure + b.pressure), p.dx);
    }
};

/// No viscosity.
struct Inviscid {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"dv/dt = 0", "inviscid flow", "-"};
    Inviscid() = default;
    explicit Inviscid(const TermScales& /*scales*/) {}
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& /*p*/, const Side& /*a*/, const Side& /*b*/,
                                           Sums<d>& /*sums*/) const {}
};

/// dv_a/dt = sum m 2 mu/(rho_a rho_b) (dx . grad W)/r^2 dv: dissipates shear and compression alike; does not conserve
/// angular momentum.
struct Morris {
    static constexpr std::string_view name = "morris";
    static constexpr LawInfo info{"dv/dt = sum m 2 mu/(rho_a rho_b) (dx . grad W)/r^2 dv", "any",
                                  "Morris, Fox & Zhu 1997, J. Comput. Phys. 136, 214, eq. 22"};
    double coefficient = 0.0; // 2 mu/m^2, for volumes in place of 1/rho
    Morris() = default;
    explicit Morris(const TermScales& s) : coefficient(2.0 * s.viscosity / (s.mass * s.mass)) {}
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        add(sums.acceleration, (p.f * b.volume) * (broadcast<Pack>(coefficient) * a.volume), p.dv);
    }
};

/// dv_a/dt = sum m K mu/(rho_a rho_b) (dv . dx)/(r^2 + 0.01 h^2) grad W: a force along the line of centres, so angular
/// momentum is conserved.
struct CentralViscosity {
    double coefficient = 0.0, softening_sq = 0.0;
    CentralViscosity() = default;
    CentralViscosity(const TermScales& s, double factor)
        : coefficient(factor * s.viscosity / (s.mass * s.mass)), softening_sq(0.01 * s.h * s.h) {}
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        const Pack rate = p.dv_dx / (p.r_sq + broadcast<Pack>(softening_sq));
        add(sums.acceleration, (p.f * b.volume) * (broadcast<Pack>(coefficient) * a.volume) * rate, p.dx);
    }
};

/// K = 2 (d + 2), with which the sum tends to the viscous term of an incompressible flow.
struct MonaghanGingold : CentralViscosity {
    static constexpr std::string_view name = "monaghan_gingold";
    static constexpr LawInfo info{
        "dv/dt = sum m 2 (d + 2) mu/(rho_a rho_b) (dv . dx)/(r^2 + 0.01 h^2) grad W", "any",
        "Monaghan & Gingold 1983, J. Comput. Phys. 52, 374; Monaghan 2005, Rep. Prog. Phys. 68, 1703"};
    MonaghanGingold() = default;
    explicit MonaghanGingold(const TermScales& s) : CentralViscosity(s, 2.0 * (s.dimensions + 2)) {}
};

/// K = 2 x 4.96333, calibrated on a flow in three dimensions (theory: 10); in the plane theory asks for 8.
struct Cleary : CentralViscosity {
    static constexpr std::string_view name = "cleary";
    static constexpr LawInfo info{"dv/dt = sum m 9.92666 mu/(rho_a rho_b) (dv . dx)/(r^2 + 0.01 h^2) grad W",
                                  "three dimensions; 24 % too viscous in the plane",
                                  "Cleary 1998, Appl. Math. Model. 22, 981 (xi = 4.96333)"};
    Cleary() = default;
    explicit Cleary(const TermScales& s) : CentralViscosity(s, 2.0 * 4.96333) {}
};

/// dv_a/dt = mu/rho_a sum V_b (grad v_b - grad v_a) . B_a grad W, grad v with the corrected gradient: the divergence of
/// the velocity's gradient, which needs a second pass over the neighbours (corrected_sweep.hpp) and is no sum over
/// pairs.
struct DoubleGradient {
    static constexpr std::string_view name = "double_gradient";
    static constexpr LawInfo info{"dv/dt = mu/rho sum V (grad v_b - grad v_a) . B grad W",
                                  "fluid.operators = \"corrected\"",
                                  "Negi & Ramachandran 2022, arXiv 2107.11859 (the coupled form)"};
    double viscosity = 0.0; // dynamic [Pa s]
    DoubleGradient() = default;
    explicit DoubleGradient(const TermScales& s) : viscosity(s.viscosity) {}
};

/// Viscous terms that are sums over pairs.
using PairViscousTerm = std::variant<Inviscid, Morris, MonaghanGingold, Cleary>;
using ViscousTerm = std::variant<Inviscid, Morris, MonaghanGingold, Cleary, DoubleGradient>;

/// Coefficients of the terms that few scenes use; without a coefficient a term is not evaluated.
struct Extras {
    double diffusion = 0.0;                              // 2 delta h c [m2/s]
    double artificial = 0.0;                             // alpha c h/m [m2/(s kg)], for volumes in place of 1/rho
    double softening_sq = 0.0;                           // 0.01 h^2 [m2]
    bool stratified = false;                             // gravity compresses the fluid at rest
    Components<double, 3> stratification{0.0, 0.0, 0.0}; // rho_0 g/(m c^2) [1/m4], [1/m3] in the plane

    bool idle() const { return diffusion == 0.0 && artificial == 0.0; }
};

/// The absence of an optional term.
struct NoTerm {
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& /*p*/, const Side& /*a*/, const Side& /*b*/,
                                           Sums<d>& /*sums*/) const {}
};

/// d rho_a/dt = 2 delta h c sum (rho_b - rho_a) (x_b - x_a) . grad W/r^2 V_b (Molteni & Colagrossi 2009, Comput. Phys.
/// Commun. 180, 861); (rho_b - rho_a) V_b = m (1 - V_b/V_a) and (x_b - x_a) . grad W/r^2 = -F. The density that belongs
/// to hydrostatic pressure is left alone (Fourtakas et al. 2019, Comput. Fluids 190, 346).
template <bool stratified> struct DensityDiffusion {
    double coefficient;
    Components<double, 3> stratification;
    explicit DensityDiffusion(const Extras& e) : coefficient(e.diffusion), stratification(e.stratification) {}
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        Pack difference = broadcast<Pack>(1.0) - b.volume * (broadcast<Pack>(1.0) / a.volume);
        if constexpr (stratified) {
            Pack head = broadcast<Pack>(stratification.x) * p.dx.x + broadcast<Pack>(stratification.y) * p.dx.y;
            if constexpr (d == 3) head += broadcast<Pack>(stratification.z) * p.dx.z;
            difference += b.volume * head;
        }
        sums.density_rate -= (broadcast<Pack>(coefficient) * p.f) * difference;
    }
};

/// dv_a/dt = sum m alpha c h/rho (dv . dx)/(r^2 + 0.01 h^2) grad W while approaching (Monaghan 1992, Annu. Rev. Astron.
/// Astrophys. 30, 543), with the mean of 1/rho.
struct ArtificialViscosity {
    double half, softening_sq;
    explicit ArtificialViscosity(const Extras& e) : half(0.5 * e.artificial), softening_sq(e.softening_sq) {}
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        const Pack approach = smaller(p.dv_dx, broadcast<Pack>(0.0)) / (p.r_sq + broadcast<Pack>(softening_sq));
        add(sums.acceleration, (p.f * approach) * (broadcast<Pack>(half) * (a.volume + b.volume)), p.dx);
    }
};

/// grad C = sum V_b grad W, along which shifting moves particles (Lind et al. 2012, J. Comput. Phys. 231, 1499).
struct ConcentrationGradient {
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& /*a*/, const Side& b,
                                           Sums<d>& sums) const {
        const Pack weight = p.f * b.volume;
        subtract(sums.spread, weight, p.dx);
        sums.completeness -= weight * p.r_sq;
    }
};

/// s . grad v and s . grad rho, of differences, for s = -grad C: sums that need the sum of ConcentrationGradient.
template <int d> struct AlongSpread {
    Components<Pack, d> spread;
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        const Pack along = p.f * dot(p.dx, spread), one = broadcast<Pack>(1.0);
        subtract(sums.dv_along, along * b.volume, p.dv);
        sums.drho_along += along * (one - b.volume * (one / a.volume));
    }
};

/// grad v and grad rho, of differences.
struct FieldGradients {
    double mass = 0.0; // [kg]
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        const Pack weight = p.f * b.volume, one = broadcast<Pack>(1.0);
        for_components<d>(
            [&](Components<Pack, d> & grad, const Pack& dv)
                __attribute__((always_inline)) { subtract(grad, weight * dv, p.dx); },
            sums.grad_v, p.dv);
        add(sums.grad_rho, p.f * (broadcast<Pack>(mass) * (one - b.volume * (one / a.volume))), p.dx);
    }
};

} // namespace plumb
