#include "coupling/suspension_viscosity.hpp"

#include "coupling/weight_loops.hpp"

#include <atomic>

namespace plumb {

namespace {

/// mu_eff/mu - 1 of every slot; counts those at the limit.
template <class Law> std::int64_t set_excess(const SphFluid& f, const Law& law, Field<double>& excess) {
    std::atomic<std::int64_t> at_limit{0};
    excess.resize(f.slots());
    parallel_for(f.slots(), [&](std::size_t k) {
        const double ratio = law(f.eps[k]);
        if (f.id[k] >= 0 && ratio >= law.greatest()) ++at_limit;
        excess[k] = ratio - 1.0;
    });
    return at_limit;
}

template <class KernelLaw> void add_friction(SphFluid& f, const Weights& w, const Field<double>& excess) {
    const Pack inverse_h = broadcast<Pack>(1.0 / f.h);
    const double factor = KernelLaw::sigma(3) / std::pow(f.h, 5) * f.viscosity / f.mass;
    for_each_group(f.clusters.count, [&](std::size_t cluster) {
        Pack own[8];
        load_cluster(f.clusters, cluster, own);
        const Pack ours = load(excess, cluster);
        std::array<Pack, 3> sum{};
        for (const std::int32_t record : f.clusters.near(cluster)) {
            const auto r = static_cast<std::size_t>(record);
            const FluidRecord& b = f.clusters.records[r];
            const std::int32_t slot = w.slot_of_record[r];
            const Pack theirs = slot < 0 ? ours : broadcast<Pack>(excess[static_cast<std::size_t>(slot)]);
            const Pack q = apart(own[0], own[1], own[2], b).r * inverse_h;
            const Pack weight = KernelLaw::f(q) * broadcast<Pack>(b.volume) * (ours + theirs);
            sum[0] += weight * (own[4] - b.u);
            sum[1] += weight * (own[5] - b.v);
            sum[2] += weight * (own[6] - b.w);
        }
        const Pack scale = broadcast<Pack>(factor) * own[7] / load(f.share, cluster);
        for (std::size_t c = 0; c < 3; ++c) add(f.a[c], cluster, scale * sum[c]);
    });
}

} // namespace

std::int64_t add_suspension_viscosity(SphFluid& f, const Weights& w, const SuspensionViscosity& law) {
    if (std::holds_alternative<PureFluidViscosity>(law)) return 0;
    Field<double> excess;
    const std::int64_t at_limit = std::visit([&](const auto& one) { return set_excess(f, one, excess); }, law);
    with_kernel(f.kernel, [&](const auto& kernel) { add_friction<std::decay_t<decltype(kernel)>>(f, w, excess); });
    return at_limit;
}

} // namespace plumb
