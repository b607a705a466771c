// The hot loop: all terms of the equations of motion for eight particles at a time, in one pass over their neighbours.
#pragma once

#include "core/parallel.hpp"
#include "sph/fluid.hpp"

#include <cassert>
#include <cstring>

namespace plumb {

namespace fluid_sweep {

/// Loads eight records as eight lanes of every number: x y z p/rho^2 u v w V.
inline void load_cluster(const FluidClusters& clusters, std::size_t cluster, Pack (&lanes)[8]) {
    for (std::size_t lane = 0; lane < pack_width; ++lane)
        std::memcpy(&lanes[lane],
                    &clusters.records[static_cast<std::size_t>(clusters.record_of[pack_width * cluster + lane])],
                    sizeof(Pack));
    transpose(lanes);
}

template <int d, class T> inline Components<T, d> components(const T& x, const T& y, const T& z) {
    if constexpr (d == 3)
        return {x, y, z};
    else
        return {x, y};
}

/// Written out: with {} the compiler clears memory before every cluster.
template <int d> inline Symmetric<Pack, d> all_zero(const Pack& zero) {
    if constexpr (d == 3)
        return {zero, zero, zero, zero, zero, zero};
    else
        return {zero, zero, zero};
}

constexpr std::size_t lookahead = 24; // neighbours whose record is asked for in advance
static_assert(lookahead <= NeighbourLists::padding);

template <class KernelLaw, int d, class... Terms>
[[gnu::always_inline]] inline Sums<d> sum_over_neighbours(const FluidClusters& clusters, std::size_t cluster,
                                                          double inverse_h, const Terms&... terms) {
    Pack lanes[8];
    load_cluster(clusters, cluster, lanes);
    const auto x = components<d>(lanes[0], lanes[1], lanes[2]), v = components<d>(lanes[4], lanes[5], lanes[6]);
    const Side a{lanes[3], lanes[7]};
    const Pack scale = broadcast<Pack>(inverse_h);
    const Pack zero = broadcast<Pack>(0.0);
    const auto nothing = components<d>(zero, zero, zero);
    Sums<d> sums{nothing, zero, nothing,           components<d>(nothing, nothing, nothing),
                 nothing, zero, all_zero<d>(zero), nothing};
    const std::span<const std::int32_t> near = clusters.near(cluster);
    const std::int32_t* const list = near.data();
    for (std::size_t e = 0; e < near.size(); ++e) {
        const FluidRecord& b = clusters.records[static_cast<std::size_t>(list[e])];
        __builtin_prefetch(&clusters.records[static_cast<std::size_t>(list[e + lookahead])]);
        PairState<d> p;
        p.dx = components<d>(x.x - b.x, x.y - b.y, lanes[2] - b.z);
        p.dv = components<d>(v.x - b.u, v.y - b.v, lanes[6] - b.w);
        p.r_sq = dot(p.dx, p.dx);
        p.f = KernelLaw::f(square_root(p.r_sq) * scale);
        p.dv_dx = dot(p.dv, p.dx);
        const Side other{broadcast<Pack>(b.p_over_rho_sq), broadcast<Pack>(b.volume)};
        (terms(p, a, other, sums), ...);
    }
    return sums;
}

inline void store(Field<double>& field, std::size_t cluster, Pack value) {
    std::memcpy(&field[pack_width * cluster], &value, sizeof value);
}

/// Accelerations and density rates of a cluster: its sums times `factor`, and the body force.
template <int d> void store_rates(SphFluid& f, std::size_t cluster, double factor, const Sums<d>& sums) {
    const Pack scale = broadcast<Pack>(factor);
    std::size_t axis = 0;
    for_components<d>(
        [&](const Pack& sum) {
            store(f.a[axis], cluster, scale * sum + broadcast<Pack>(f.body_force[static_cast<Eigen::Index>(axis)]));
            ++axis;
        },
        sums.acceleration);
    store(f.drho, cluster, scale * sums.density_rate);
}

/// -grad C, and the derivatives of v and rho along it.
template <int d> void store_spread(SphFluid& f, std::size_t cluster, double gradient, const Sums<d>& sums) {
    const Pack scale = broadcast<Pack>(gradient), squared = scale * scale;
    std::size_t axis = 0;
    for_components<d>(
        [&](const Pack& spread, const Components<Pack, d>& grad) {
            store(f.spread[axis], cluster, scale * spread);
            store(f.dv_spread[axis++], cluster, squared * dot(grad, sums.spread));
        },
        sums.spread, sums.grad_v);
    store(f.drho_spread, cluster, squared * dot(sums.grad_rho, sums.spread));
    store(f.completeness, cluster, scale * sums.completeness * broadcast<Pack>(1.0 / d));
}

/// One pass over all clusters.
template <class KernelLaw, int d, class Viscous, class Others>
void evaluate(SphFluid& f, const Viscous& viscous, const Others& others) {
    const double gradient = KernelLaw::sigma(d) / std::pow(f.h, d + 2);
    parallel_chunks(
        f.clusters.count,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const Sums<d> sums = sum_over_neighbours<KernelLaw, d>(f.clusters, c, 1.0 / f.h, Continuity{},
                                                                       PressureTerm{}, viscous, others);
                store_rates<d>(f, c, f.mass * gradient, sums);
                if (f.extras.shifting) store_spread<d>(f, c, gradient, sums);
            }
        },
        16);
}

} // namespace fluid_sweep

/// The sweep of one kernel, for the viscous term, the extras and the dimensions of the scene.
template <class KernelLaw> void evaluate_with(SphFluid& f) {
    std::visit(
        [&](const auto& viscous) {
            if constexpr (std::is_same_v<std::decay_t<decltype(viscous)>, DoubleGradient>)
                assert(!"double_gradient needs corrected operators; the scene's reader refuses it");
            else if (f.extras.idle())
                f.dimensions == 2 ? fluid_sweep::evaluate<KernelLaw, 2>(f, viscous, NoExtras{})
                                  : fluid_sweep::evaluate<KernelLaw, 3>(f, viscous, NoExtras{});
            else
                f.dimensions == 2 ? fluid_sweep::evaluate<KernelLaw, 2>(f, viscous, f.extras)
                                  : fluid_sweep::evaluate<KernelLaw, 3>(f, viscous, f.extras);
        },
        f.viscous_term);
}

// One translation unit each, so that they compile side by side.
extern template void evaluate_with<WendlandC2>(SphFluid&);
extern template void evaluate_with<WendlandC4>(SphFluid&);
extern template void evaluate_with<CubicSpline>(SphFluid&);
extern template void evaluate_with<QuinticSpline>(SphFluid&);

} // namespace plumb
