// Particles in groups of eight and the neighbours of each group.
//
// Particles are sorted into columns about two spacings wide (strips in the plane) and along each column, then cut into
// clusters of eight, one per lane. A column's last cluster is filled up with copies of its last particle: copies have
// the same state, get the same sums and move alike, so nothing has to know about them. A record holds what a pair reads
// of one particle in one cache line; the images behind periodic sides have records of their own, hence no wrapping in
// the sweep. Records are laid out column by column along the column, images included, so that the neighbours of a
// cluster are few runs of records.
#pragma once

#include "core/domain.hpp"
#include "core/field.hpp"
#include "core/simd.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb {

/// What a pair reads of one particle.
struct alignas(64) FluidRecord {
    double x, y, z, p_over_rho_sq, u, v, w, volume;
};

inline constexpr std::size_t clusters_per_part = 64, list_padding = 32;

struct FluidClusters {
    double reach = 0.0; // of the kernel [m]
    double skin = 0.0;  // [m]; the lists hold until a particle has moved skin / 2

    std::size_t count = 0; // of clusters
    // Lists of `clusters_per_part` clusters each: parts are built at the same time and keep their memory.
    std::vector<std::vector<std::int32_t>> parts;
    std::vector<std::int32_t> part_end; // [count] where the list of a cluster ends in its part
    Field<FluidRecord> records;
    std::vector<std::int32_t> record_of;  // [slots] of the particle itself
    std::vector<std::int32_t> image_of;   // [records] the record of the particle it is an image of, or its own number
    std::vector<std::int8_t> image_shift; // [records] periodic shift: 9 a + 3 b + c with a, b, c = 0, 1, 2 for -1, 0, 1
    std::array<std::vector<double>, 3> x; // [records + 8] where they were when the lists were built [m]

    /// Records near a cluster, ascending. `list_padding` more entries can be read behind them.
    std::span<const std::int32_t> near(std::size_t cluster) const {
        const std::vector<std::int32_t>& part = parts[cluster / clusters_per_part];
        const auto begin = cluster % clusters_per_part == 0 ? 0 : static_cast<std::size_t>(part_end[cluster - 1]);
        return {part.data() + begin, static_cast<std::size_t>(part_end[cluster]) - begin};
    }
};

/// Positions of the particles to be clustered, by slot; `id` is -1 in copies.
struct ParticlePlaces {
    const std::array<Field<double>, 3>& x;
    const std::vector<std::int32_t>& id;
};

/// New order of the slots: slot k holds what was in slot from[k]; copy[k] is 1 where it is a copy that fills a cluster.
struct ClusterOrder {
    std::vector<std::int32_t> from;
    std::vector<std::uint8_t> copy;
};

/// Sorts the particles and builds lists and records' places. The result depends on positions and ids only.
/// InputError when a periodic side is shorter than two reaches.
ClusterOrder rebuild(FluidClusters& clusters, const ParticlePlaces& places, const Domain& domain, int dimensions,
                     double spacing);

/// Copies the records of particles to their images, shifted by whole sides.
void update_images(FluidClusters& clusters, const Domain& domain);

} // namespace plumb
