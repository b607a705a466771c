#include "sph/variable_sweep.hpp"

#include "sph/sweep.hpp"

#include <atomic>

namespace plumb {

namespace fluid_sweep {

namespace {

/// Smoothing length of a particle of volume V [m], as if nothing limited it.
double free_length(const SphFluid& f, double volume) {
    return f.h / f.spacing * (f.dimensions == 2 ? std::sqrt(volume) : std::cbrt(volume));
}

/// What a pair needs to know of each record's smoothing length; boundary particles have Omega = 1.
template <class KernelLaw> void fill_lengths(SphFluid& f) {
    const FluidClusters& clusters = f.clusters;
    renew_size(f.lengths.of_record, clusters.records.size());
    if (f.lengths.omega.size() != f.slots()) f.lengths.omega.assign(f.slots(), 1.0);
    const double longest = greatest_growth(f.operators) * f.h;
    std::atomic<std::int64_t> capped{0};
    const auto length_of = [&](std::int32_t record, double omega) {
        const auto r = static_cast<std::size_t>(record);
        const double wanted = free_length(f, clusters.records[r].volume), h = std::min(wanted, longest);
        if (wanted > longest) ++capped;
        const double factor = KernelLaw::sigma(f.dimensions) / std::pow(h, f.dimensions + 2);
        f.lengths.of_record[r] = {1.0 / h, factor, factor / omega};
    };
    parallel_for(f.slots(), [&](std::size_t k) {
        if (f.id[k] >= 0) length_of(clusters.record_of[k], f.lengths.omega[k]);
    });
    parallel_for(clusters.record_of_passive.size(),
                 [&](std::size_t k) { length_of(clusters.record_of_passive[k], 1.0); });
    f.lengths.capped += capped;
    parallel_for(clusters.records.size(), [&](std::size_t r) {
        const auto source = static_cast<std::size_t>(clusters.image_of[r]);
        if (source != r) f.lengths.of_record[r] = f.lengths.of_record[source];
    });
}

template <class KernelLaw, int d, class Viscous>
void evaluate_cluster(SphFluid& f, std::size_t cluster, const Viscous& viscous, Field<Pack>& slopes) {
    Pack lanes[8];
    load_cluster(f.clusters, cluster, lanes);
    Pack inverse_h, factor, factor_over_omega;
    for (std::size_t lane = 0; lane < pack_width; ++lane) {
        const int l = static_cast<int>(lane);
        const RecordLength& own =
            f.lengths.of_record[static_cast<std::size_t>(f.clusters.record_of[pack_width * cluster + lane])];
        inverse_h[l] = own.inverse_h, factor[l] = own.factor, factor_over_omega[l] = own.factor_over_omega;
    }
    const auto x = components<d>(lanes[0], lanes[1], lanes[2]), v = components<d>(lanes[4], lanes[5], lanes[6]);
    const Side a{lanes[3], lanes[7]};
    const Pack zero = broadcast<Pack>(0.0), half = broadcast<Pack>(0.5), reach = broadcast<Pack>(KernelLaw::support);
    Sums<d> sums = no_sums<d>();
    Pack growth = zero; // sum of d w + q w', which is -h^(d+1)/sigma dW/dh
    slopes.clear();
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
        const RecordLength& length = f.lengths.of_record[static_cast<std::size_t>(record)];
        PairState<d> p;
        p.dx = components<d>(x.x - b.x, x.y - b.y, lanes[2] - b.z);
        p.dv = components<d>(v.x - b.u, v.y - b.v, lanes[6] - b.w);
        p.r_sq = dot(p.dx, p.dx);
        p.dv_dx = dot(p.dv, p.dx);
        const Pack r = square_root(p.r_sq), q = r * inverse_h;
        const Pack shape = KernelLaw::f(q), other_shape = KernelLaw::f(r * broadcast<Pack>(length.inverse_h));
        const Side other{broadcast<Pack>(b.pressure), broadcast<Pack>(b.volume)};
        sums.density_rate += factor_over_omega * shape * p.dv_dx;
        subtract(sums.acceleration,
                 a.pressure * factor_over_omega * shape +
                     other.pressure * broadcast<Pack>(length.factor_over_omega) * other_shape,
                 p.dx);
        const Pack inside = select(q < reach, broadcast<Pack>(1.0), zero);
        growth += inside * (broadcast<Pack>(d) * KernelLaw::w(q) + q * q * shape);
        p.f = half * (factor * shape + broadcast<Pack>(length.factor) * other_shape);
        viscous(p, a, other, sums);
        if (f.shifting > 0.0) ConcentrationGradient{}(p, a, other, sums);
        slopes.push_back(p.f);
    }
    add_extras<d>(f, cluster, slopes, sums);
    store_rates<d>(f, cluster, f.mass, sums);
    if (f.shifting > 0.0) store_spread<d>(f, cluster, 1.0, sums);
    // m/rho is the volume; factor h^2 = sigma/h^d
    store(f.lengths.omega, cluster,
          broadcast<Pack>(1.0) - a.volume * factor / (inverse_h * inverse_h) * growth * broadcast<Pack>(1.0 / d));
}

template <class KernelLaw, int d> void evaluate_all(SphFluid& f) {
    fill_lengths<KernelLaw>(f);
    std::visit(
        [&](const auto& viscous) {
            if constexpr (!std::is_same_v<std::decay_t<decltype(viscous)>, DoubleGradient>)
                parallel_chunks(
                    f.clusters.count,
                    [&](std::size_t begin, std::size_t end) {
                        Field<Pack> slopes;
                        for (std::size_t c = begin; c < end; ++c) evaluate_cluster<KernelLaw, d>(f, c, viscous, slopes);
                    },
                    16);
        },
        f.viscous_term);
}

} // namespace

} // namespace fluid_sweep

void evaluate_variable(SphFluid& f) {
    std::visit(
        [&](const auto& kernel) {
            using Law = std::decay_t<decltype(kernel)>;
            f.dimensions == 2 ? fluid_sweep::evaluate_all<Law, 2>(f) : fluid_sweep::evaluate_all<Law, 3>(f);
        },
        f.kernel);
}

} // namespace plumb
