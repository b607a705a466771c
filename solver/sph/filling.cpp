#include "sph/filling.hpp"

#include "sph/sweep.hpp"

#include <cmath>

namespace plumb {

namespace {

/// C of all slots.
template <class KernelLaw, int d> Field<double> fill(const SphFluid& f) {
    const Pack over_h = broadcast<Pack>(1.0 / f.h), sigma = broadcast<Pack>(KernelLaw::sigma(d) / std::pow(f.h, d));
    Field<double> c(f.slots());
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cluster = begin; cluster < end; ++cluster) {
            Pack lanes[8];
            load_cluster(f.clusters, cluster, lanes);
            Pack sum = broadcast<Pack>(0.0);
            for (const std::int32_t record : f.clusters.near(cluster)) {
                const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
                const auto dx = fluid_sweep::components<d>(lanes[0] - b.x, lanes[1] - b.y, lanes[2] - b.z);
                sum += broadcast<Pack>(b.volume) * KernelLaw::w(square_root(dot(dx, dx)) * over_h);
            }
            store(c, cluster, sigma * sum);
        }
    });
    return c;
}

} // namespace

void follow_filling(SphFluid& f) {
    if (f.filling_time == 0.0) return;
    const Field<double> c = std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            return f.dimensions == 2 ? fill<KernelLaw, 2>(f) : fill<KernelLaw, 3>(f);
        },
        f.kernel);
    const std::vector<std::int32_t> slots = ordered_slots(f);
    const double mean =
        ordered_sum(slots.size(), 0.0, [&](std::size_t q) { return c[static_cast<std::size_t>(slots[q])]; }) /
        static_cast<double>(slots.size());
    parallel_for(f.slots(), [&](std::size_t k) { f.drho[k] += f.rho[k] * (c[k] - mean) / f.filling_time; });
}

} // namespace plumb
