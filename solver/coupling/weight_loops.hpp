// The two loops over who is near whom: one for all sums at particles of the fluid, one for all sums at grains.
#pragma once

#include "core/packed_field.hpp"
#include "core/parallel.hpp"
#include "coupling/weights.hpp"

namespace plumb {

/// Calls body for every group of eight.
template <class Body> void for_each_group(std::size_t groups, Body&& body) {
    constexpr std::size_t groups_per_task = 16;
    parallel_chunks(
        groups,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t g = begin; g < end; ++g) body(g);
        },
        groups_per_task);
}

/// Calls body with the type of the kernel.
template <class Body> void with_kernel(const Kernel& kernel, Body&& body) {
    std::visit([&](const auto& law) { body(law); }, kernel);
}

/// From a record to eight places.
struct Apart {
    std::array<Pack, 3> dx; // [m]
    Pack r;                 // [m]
};
template <class Record>
[[gnu::always_inline]] inline Apart apart(const Pack& x, const Pack& y, const Pack& z, const Record& b) {
    const std::array<Pack, 3> dx{x - b.x, y - b.y, z - b.z};
    return {dx, square_root(dx[0] * dx[0] + dx[1] * dx[1] + dx[2] * dx[2])};
}

/// Calls body(apart, record, its number) for the grains that `lists` name near a cluster of the fluid.
template <class Body>
[[gnu::always_inline]] inline void for_grains_near(const Weights& w, const NeighbourLists& lists, const SphFluid& f,
                                                   std::size_t cluster, Body&& body) {
    const Pack x = load(f.x[0], cluster), y = load(f.x[1], cluster), z = load(f.x[2], cluster);
    for (const std::int32_t record : lists.near(cluster)) {
        const auto r = static_cast<std::size_t>(record);
        body(apart(x, y, z, w.records[r]), w.records[r], r);
    }
}

/// Calls body(apart, record, slot) for the particles of the fluid near a group of grains.
template <class Body>
[[gnu::always_inline]] inline void for_particles_near(const Weights& w, const SphFluid& f, std::size_t group,
                                                      Body&& body) {
    Pack lanes[8];
    load_cluster(w.grains, w.records, group, lanes);
    for (const std::int32_t record : w.fluid_near.near(group)) {
        const auto r = static_cast<std::size_t>(record);
        const FluidRecord& b = f.clusters.records[r];
        body(apart(lanes[0], lanes[1], lanes[2], b), b, static_cast<std::size_t>(w.slot_of_record[r]));
    }
}

/// Calls put(id, lane) for the lanes of a group that are a grain's.
template <class Put> void for_each_grain_of(const Weights& w, std::size_t group, Put&& put) {
    for (std::size_t lane = 0; lane < pack_width; ++lane) {
        const std::int32_t id = w.id[pack_width * group + lane];
        if (id >= 0) put(static_cast<std::size_t>(id), static_cast<int>(lane));
    }
}

} // namespace plumb
