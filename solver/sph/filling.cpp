#include "sph/filling.hpp"

#include "sph/sweep.hpp"

#include <cmath>

namespace plumb {

namespace {

template <class KernelLaw, int d> void follow(SphFluid& f) {
    const Pack over_h = broadcast<Pack>(1.0 / f.h), one = broadcast<Pack>(1.0),
               sigma = broadcast<Pack>(KernelLaw::sigma(d) / std::pow(f.h, d)),
               rate = broadcast<Pack>(f.mass / f.filling_time);
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            Pack lanes[8];
            load_cluster(f.clusters, c, lanes);
            Pack sum = broadcast<Pack>(0.0);
            for (const std::int32_t record : f.clusters.near(c)) {
                const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
                const auto dx = fluid_sweep::components<d>(lanes[0] - b.x, lanes[1] - b.y, lanes[2] - b.z);
                sum += broadcast<Pack>(b.volume) * KernelLaw::w(square_root(dot(dx, dx)) * over_h);
            }
            add(f.drho, c, rate / lanes[7] * (sigma * sum - one));
        }
    });
}

} // namespace

void follow_filling(SphFluid& f) {
    if (f.filling_time == 0.0) return;
    std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            f.dimensions == 2 ? follow<KernelLaw, 2>(f) : follow<KernelLaw, 3>(f);
        },
        f.kernel);
}

} // namespace plumb
