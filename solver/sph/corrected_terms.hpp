// What the corrected operators add to the terms of pair_terms.hpp.
#pragma once

#include "sph/pair_terms.hpp"

namespace plumb {

/// sum += factor * a (x) a
template <int d>
[[gnu::always_inline]] inline void add_square(Symmetric<Pack, d>& sum, Pack factor, const Components<Pack, d>& a) {
    const Pack x = factor * a.x, y = factor * a.y;
    sum.xx += x * a.x, sum.xy += x * a.y, sum.yy += y * a.y;
    if constexpr (d == 3) sum.xz += x * a.z, sum.yz += y * a.z, sum.zz += factor * a.z * a.z;
}

template <int d>
[[gnu::always_inline]] inline Components<Pack, d> product(const Symmetric<Pack, d>& m, const Components<Pack, d>& a) {
    if constexpr (d == 2)
        return {m.xx * a.x + m.xy * a.y, m.xy * a.x + m.yy * a.y};
    else
        return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
                m.xz * a.x + m.yz * a.y + m.zz * a.z};
}

/// Adjugate of a symmetric matrix: its inverse times its determinant.
inline Symmetric<Pack, 2> adjugate(const Symmetric<Pack, 2>& m) { return {m.yy, m.xx, -m.xy}; }
inline Symmetric<Pack, 3> adjugate(const Symmetric<Pack, 3>& m) {
    return {m.yy * m.zz - m.yz * m.yz, m.xx * m.zz - m.xz * m.xz, m.xz * m.yz - m.xy * m.zz,
            m.xx * m.yy - m.xy * m.xy, m.xy * m.yz - m.xz * m.yy, m.xy * m.xz - m.xx * m.yz};
}
inline Pack determinant(const Symmetric<Pack, 2>& m, const Symmetric<Pack, 2>& adjugate) {
    return m.xx * adjugate.xx + m.xy * adjugate.xy;
}
inline Pack determinant(const Symmetric<Pack, 3>& m, const Symmetric<Pack, 3>& adjugate) {
    return m.xx * adjugate.xx + m.xy * adjugate.xy + m.xz * adjugate.xz;
}

// A moment whose eigenvalues differ by a factor of about 400 comes from particles in a row (a plane): there is no
// gradient across it to be found, and the correction would only multiply noise by that factor.
inline constexpr double least_isotropy = 0.01; // determinant over that of the sphere of the same trace

/// Inverse of a moment; `plain` times the unit matrix, which leaves the gradient uncorrected, where there is none.
template <int d> inline Symmetric<Pack, d> inverse_or_plain(const Symmetric<Pack, d>& m, Pack plain) {
    const Symmetric<Pack, d> adjugate_m = adjugate(m);
    const Pack det = determinant(m, adjugate_m);
    Pack mean = m.xx + m.yy;
    if constexpr (d == 3) mean += m.zz;
    mean *= broadcast<Pack>(1.0 / d);
    const Pack sphere = d == 2 ? mean * mean : mean * mean * mean;
    const PackMask good = det > broadcast<Pack>(least_isotropy) * sphere;
    const Pack over = broadcast<Pack>(1.0) / select(good, det, broadcast<Pack>(1.0)), none = broadcast<Pack>(0.0);
    const auto diagonal = [&](Pack a) { return select(good, over * a, plain); };
    const auto other = [&](Pack a) { return select(good, over * a, none); };
    Symmetric<Pack, d> b;
    b.xx = diagonal(adjugate_m.xx), b.yy = diagonal(adjugate_m.yy), b.xy = other(adjugate_m.xy);
    if constexpr (d == 3) b.zz = diagonal(adjugate_m.zz), b.xz = other(adjugate_m.xz), b.yz = other(adjugate_m.yz);
    return b;
}

/// sum V (x_b - x_a) (x) grad W and sum V (p_b - p_a) grad W; the latter's correction is linear, hence made afterwards.
struct MomentAndPressure {
    double mass = 0.0; // [kg], [kg/m] in the plane
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        add_square<d>(sums.moment, -(p.f * b.volume), p.dx);
        // V_b (p_b - p_a) with p = (p/rho^2) (m/V)^2
        const Pack m = broadcast<Pack>(mass), rho_a = m / a.volume;
        const Pack difference = b.pressure * m * (m / b.volume) - b.volume * (a.pressure * (rho_a * rho_a));
        add(sums.grad_p, p.f * difference, p.dx);
    }
};

/// The viscous term of the scene where it is a sum over pairs, by a branch that is always predicted: corrected
/// operators with such a term are there to be compared, not to be fast.
struct AnyPairViscosity {
    Morris morris;
    CentralViscosity central;

    explicit AnyPairViscosity(const ViscousTerm& term) {
        if (const auto* m = std::get_if<Morris>(&term)) morris = *m;
        if (const auto* m = std::get_if<MonaghanGingold>(&term)) central = *m;
        if (const auto* m = std::get_if<Cleary>(&term)) central = *m;
    }
    template <int d>
    [[gnu::always_inline]] void operator()(const PairState<d>& p, const Side& a, const Side& b, Sums<d>& sums) const {
        if (morris.coefficient != 0.0) morris(p, a, b, sums);
        if (central.coefficient != 0.0) central(p, a, b, sums);
    }
};

} // namespace plumb
