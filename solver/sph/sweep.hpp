// The hot loop: all terms of the equations of motion for eight particles at a time, in one pass over their neighbours.
#pragma once

#include "core/packed_field.hpp"
#include "core/parallel.hpp"
#include "sph/fluid.hpp"

#include <cassert>

namespace plumb {

namespace fluid_sweep {

template <int d, class T> inline Components<T, d> components(const T& x, const T& y, const T& z) {
    if constexpr (d == 3)
        return {x, y, z};
    else
        return {x, y};
}

/// Written out: with {} the compiler clears memory before every cluster.
template <int d> inline Sums<d> no_sums() {
    const Pack zero = broadcast<Pack>(0.0);
    const auto none = components<d>(zero, zero, zero);
    const auto matrix = components<d>(none, none, none);
    if constexpr (d == 3)
        return {none, zero, none, zero, none, zero, matrix, none, none, {zero, zero, zero, zero, zero, zero}};
    else
        return {none, zero, none, zero, none, zero, matrix, none, none, {zero, zero, zero}};
}

/// f(q) of the e-th neighbour, computed; of KeepSlope also written down, for KeptSlope to be read in another pass.
template <class KernelLaw> struct Slope {
    Pack inverse_h;
    explicit Slope(double h) : inverse_h(broadcast<Pack>(1.0 / h)) {}
    [[gnu::always_inline]] Pack operator()(std::size_t /*e*/, const Pack& r_sq) const {
        return KernelLaw::f(square_root(r_sq) * inverse_h);
    }
};
template <class KernelLaw> struct KeepSlope {
    Slope<KernelLaw> slope;
    Pack* kept;
    [[gnu::always_inline]] Pack operator()(std::size_t e, const Pack& r_sq) const { return kept[e] = slope(e, r_sq); }
};
struct KeptSlope {
    const Pack* kept;
    [[gnu::always_inline]] Pack operator()(std::size_t e, const Pack& /*r_sq*/) const { return kept[e]; }
};

constexpr std::size_t lookahead = 24; // neighbours whose record is asked for in advance
static_assert(lookahead <= NeighbourLists::padding);

/// Adds the terms over the neighbours of a cluster to its sums.
template <int d, class SlopeOf, class... Terms>
[[gnu::always_inline]] inline void add_over_neighbours(const FluidClusters& clusters, std::size_t cluster,
                                                       const SlopeOf& slope, Sums<d>& sums, const Terms&... terms) {
    Sums<d> own = sums; // nobody else has its address, so it stays in registers
    Pack lanes[8];
    load_cluster(clusters, cluster, lanes);
    const auto x = components<d>(lanes[0], lanes[1], lanes[2]), v = components<d>(lanes[4], lanes[5], lanes[6]);
    const Side a{lanes[3], lanes[7]};
    const std::span<const std::int32_t> near = clusters.near(cluster);
    const std::int32_t* const list = near.data();
    for (std::size_t e = 0; e < near.size(); ++e) {
        const FluidRecord& b = clusters.records[static_cast<std::size_t>(list[e])];
        __builtin_prefetch(&clusters.records[static_cast<std::size_t>(list[e + lookahead])]);
        PairState<d> p;
        p.dx = components<d>(x.x - b.x, x.y - b.y, lanes[2] - b.z);
        p.dv = components<d>(v.x - b.u, v.y - b.v, lanes[6] - b.w);
        p.r_sq = dot(p.dx, p.dx);
        p.f = slope(e, p.r_sq);
        p.dv_dx = dot(p.dv, p.dx);
        const Side other{broadcast<Pack>(b.pressure), broadcast<Pack>(b.volume)};
        (terms(p, a, other, own), ...);
    }
    sums = own;
}

/// The optional terms and, with shifting, the derivatives along the spread, which is summed up already: one more pass,
/// with the slopes that the first one kept. In one pass the sums would outnumber the registers, and these terms would
/// have to be compiled for every kernel and viscous term.
template <int d> void add_extras(const SphFluid& f, std::size_t cluster, const Field<Pack>& slopes, Sums<d>& sums);

/// Room for the slopes of a cluster.
inline Pack* room_for_slopes(Field<Pack>& slopes, const FluidClusters& clusters, std::size_t cluster) {
    const std::size_t needed = clusters.near(cluster).size();
    if (slopes.size() < needed) slopes.resize(2 * needed);
    return slopes.data();
}

/// Accelerations and density rates of a cluster: its sums times `factor`, and the body force.
template <int d> void store_rates(SphFluid& f, std::size_t cluster, double factor, const Sums<d>& sums) {
    const Pack scale = broadcast<Pack>(factor);
    const Pack inertia = f.among_grains() ? scale / load(f.share, cluster) : scale;
    std::size_t axis = 0;
    for_components<d>(
        [&](const Pack& sum) {
            store(f.a[axis], cluster, inertia * sum + broadcast<Pack>(f.body_force[static_cast<Eigen::Index>(axis)]));
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
        [&](const Pack& spread, const Pack& dv) {
            store(f.spread[axis], cluster, scale * spread);
            store(f.dv_spread[axis++], cluster, squared * dv);
        },
        sums.spread, sums.dv_along);
    store(f.drho_spread, cluster, squared * broadcast<Pack>(f.mass) * sums.drho_along);
    store(f.completeness, cluster, scale * sums.completeness * broadcast<Pack>(1.0 / d));
}

/// body(first, last) for the clusters, in parts that are evaluated side by side.
template <class Body> void for_cluster_parts(const SphFluid& f, const Body& body) {
    parallel_chunks(f.clusters.count, body, 16);
}

/// The equations of motion alone: one pass over all clusters.
template <class KernelLaw, int d, class Viscous> void evaluate(SphFluid& f, const Viscous& viscous) {
    const double gradient = KernelLaw::sigma(d) / std::pow(f.h, d + 2);
    for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            Sums<d> sums = no_sums<d>();
            add_over_neighbours<d>(f.clusters, c, Slope<KernelLaw>(f.h), sums, Continuity{}, PressureTerm{}, viscous);
            store_rates<d>(f, c, f.mass * gradient, sums);
        }
    });
}

/// The same with more terms, by mass or by volume.
template <class KernelLaw, int d, class Density, class Pressure, class Viscous, class Spread>
void evaluate_with_extras(SphFluid& f, const Viscous& viscous, const Spread& spread) {
    const double gradient = KernelLaw::sigma(d) / std::pow(f.h, d + 2);
    for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        Field<Pack> slopes;
        for (std::size_t c = begin; c < end; ++c) {
            const KeepSlope<KernelLaw> slope{Slope<KernelLaw>(f.h), room_for_slopes(slopes, f.clusters, c)};
            Sums<d> sums = no_sums<d>();
            add_over_neighbours<d>(f.clusters, c, slope, sums, Density{}, Pressure{}, viscous, spread);
            add_extras<d>(f, c, slopes, sums);
            store_rates<d>(f, c, f.mass * gradient, sums);
            if (f.shifting > 0.0) store_spread<d>(f, c, gradient, sums);
        }
    });
}

template <class KernelLaw, int d, class Viscous> void evaluate_any(SphFluid& f, const Viscous& viscous) {
    if (std::holds_alternative<VolumeWeightedOperators>(f.operators))
        f.shifting > 0.0
            ? evaluate_with_extras<KernelLaw, d, VolumeContinuity, VolumePressureTerm>(f, viscous,
                                                                                       ConcentrationGradient{})
            : evaluate_with_extras<KernelLaw, d, VolumeContinuity, VolumePressureTerm>(f, viscous, NoTerm{});
    else if (f.shifting > 0.0)
        evaluate_with_extras<KernelLaw, d, Continuity, PressureTerm>(f, viscous, ConcentrationGradient{});
    else if (f.extras.idle())
        evaluate<KernelLaw, d>(f, viscous);
    else
        evaluate_with_extras<KernelLaw, d, Continuity, PressureTerm>(f, viscous, NoTerm{});
}

} // namespace fluid_sweep

/// The sweep of one kernel, for the viscous term, the extras and the dimensions of the scene.
template <class KernelLaw> void evaluate_with(SphFluid& f) {
    std::visit(
        [&](const auto& viscous) {
            if constexpr (std::is_same_v<std::decay_t<decltype(viscous)>, DoubleGradient>)
                assert(!"double_gradient needs corrected operators; the scene's reader refuses it");
            else
                f.dimensions == 2 ? fluid_sweep::evaluate_any<KernelLaw, 2>(f, viscous)
                                  : fluid_sweep::evaluate_any<KernelLaw, 3>(f, viscous);
        },
        f.viscous_term);
}

// One translation unit each, so that they compile side by side.
extern template void evaluate_with<WendlandC2>(SphFluid&);
extern template void evaluate_with<WendlandC4>(SphFluid&);
extern template void evaluate_with<CubicSpline>(SphFluid&);
extern template void evaluate_with<QuinticSpline>(SphFluid&);

} // namespace plumb
