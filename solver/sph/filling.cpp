#include "sph/filling.hpp"

#include "sph/sweep.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// C of all slots, and |grad C| h.
struct Filling {
    Field<double> full, slope;
};
template <class KernelLaw, int d> Filling filling(const SphFluid& f) {
    const Pack over_h = broadcast<Pack>(1.0 / f.h), sigma = broadcast<Pack>(KernelLaw::sigma(d) / std::pow(f.h, d));
    Filling c{Field<double>(f.slots()), Field<double>(f.slots())};
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cluster = begin; cluster < end; ++cluster) {
            Pack lanes[8];
            load_cluster(f.clusters, cluster, lanes);
            Pack sum = broadcast<Pack>(0.0);
            auto gradient = fluid_sweep::components<d>(sum, sum, sum);
            for (const std::int32_t record : f.clusters.near(cluster)) {
                const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
                const auto dx = fluid_sweep::components<d>(lanes[0] - b.x, lanes[1] - b.y, lanes[2] - b.z);
                const Pack q = square_root(dot(dx, dx)) * over_h, volume = broadcast<Pack>(b.volume);
                sum += volume * KernelLaw::w(q);
                if (f.free_surface) add(gradient, volume * KernelLaw::f(q) * over_h, dx);
            }
            store(c.full, cluster, sigma * sum);
            store(c.slope, cluster, sigma * square_root(dot(gradient, gradient)));
        }
    });
    return c;
}

} // namespace

void follow_filling(SphFluid& f) {
    if (f.filling_time == 0.0) return;
    const Filling c = std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            return f.dimensions == 2 ? filling<KernelLaw, 2>(f) : filling<KernelLaw, 3>(f);
        },
        f.kernel);
    if (f.free_surface) {
        parallel_for(f.slots(), [&](std::size_t k) {
            const double inside = std::clamp((0.4 - c.slope[k] / c.full[k]) / 0.2, 0.0, 1.0);
            f.drho[k] += f.rho[k] * inside * (c.full[k] - 1.0) / f.filling_time;
        });
        return;
    }
    const std::vector<std::int32_t> slots = ordered_slots(f);
    const double mean =
        ordered_sum(slots.size(), 0.0, [&](std::size_t q) { return c.full[static_cast<std::size_t>(slots[q])]; }) /
        static_cast<double>(slots.size());
    parallel_for(f.slots(), [&](std::size_t k) { f.drho[k] += f.rho[k] * (c.full[k] - mean) / f.filling_time; });
}

} // namespace plumb
