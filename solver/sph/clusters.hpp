// Particles in groups of eight and the neighbours of each group.
//
// Particles are sorted into columns about two spacings wide (strips in the plane) and along each column, then cut into
// clusters of eight, one per lane. A column's last cluster is filled up with copies of its last particle: copies have
// the same state, get the same sums and move alike, so nothing has to know about them. A record holds what a pair reads
// of one particle in one cache line; the images behind periodic sides have records of their own, hence no wrapping in
// the sweep. Particles of walls and open sides are passive: they have records but no lane, since nobody needs their
// sums. Records are laid out column by column along the column, images included, so that the neighbours of a cluster
// are few runs of records.
#pragma once

#include "core/domain.hpp"
#include "core/field.hpp"
#include "core/parallel.hpp"
#include "core/simd.hpp"
#include "sph/record_grid.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace plumb {

using VectorField = std::array<Field<double>, 3>; // components x, y, z; z unused in the plane

/// What a pair reads of one particle. `pressure` is p/rho^2, or p/m^2 where operators weigh by volume: pressure_of and
/// pressure_entry (fluid.hpp).
struct alignas(64) FluidRecord {
    double x, y, z, pressure, u, v, w, volume;
};

/// Places in groups of eight and where their records are laid out; the records themselves are the owner's.
struct Clusters {
    double reach = 0.0;  // of the kernel [m]
    double images = 0.0; // how far beyond periodic sides there have to be images, if further than the reach [m]
    double skin = 0.0;   // [m]; the lists hold until a particle has moved skin / 2

    std::size_t count = 0; // of clusters
    NeighbourLists lists;
    RecordGrid grid;
    std::vector<std::int32_t> record_of;         // [slots] of the particle itself
    std::vector<std::int32_t> record_of_passive; // [passive particles]
    std::vector<std::uint8_t> passive;           // [records] 1 for passive ones; empty when there are none
    std::vector<std::int32_t> image_of;   // [records] the record of the particle it is an image of, or its own number
    std::vector<std::int8_t> image_shift; // [records] periodic shift: 9 a + 3 b + c with a, b, c = 0, 1, 2 for -1, 0, 1

    /// Records near a cluster, ascending.
    std::span<const std::int32_t> near(std::size_t cluster) const { return lists.near(cluster); }
};

struct FluidClusters : Clusters {
    Field<FluidRecord> records;
};

/// Positions of the particles to be clustered, by slot (`id` is -1 in copies), and of the passive ones.
struct ParticlePlaces {
    const VectorField& x;
    const std::vector<std::int32_t>& id;
    const VectorField& passive;
};

/// New order of the slots: slot k holds what was in slot from[k]; copy[k] is 1 where it is a copy that fills a cluster.
struct ClusterOrder {
    std::vector<std::int32_t> from;
    std::vector<std::uint8_t> copy;
};

/// Sorts the particles into clusters and lays out their records, which are the caller's to make. The result depends on
/// positions and ids only. InputError when a periodic side is shorter than two reaches.
ClusterOrder arrange(Clusters& clusters, const ParticlePlaces& places, const Domain& domain, double spacing);

/// Where the records of the clusters' lanes are, by axis [m].
std::array<std::vector<double>, 3> lane_places(const Clusters& clusters, int dimensions);

/// arrange, and the lists of the records near each cluster.
ClusterOrder rebuild(FluidClusters& clusters, const ParticlePlaces& places, const Domain& domain, double spacing);

/// Copies the records of particles to their images, shifted by whole sides. A record has its place in x, y, z.
template <class Record> void update_images(const Clusters& clusters, Field<Record>& records, const Domain& domain) {
    parallel_for(records.size(), [&](std::size_t r) {
        const auto source = static_cast<std::size_t>(clusters.image_of[r]);
        if (source == r) return;
        Record image = records[source];
        const int shift = clusters.image_shift[r];
        image.x += domain.size[0] * (shift / 9 - 1);
        image.y += domain.size[1] * (shift / 3 % 3 - 1);
        image.z += domain.size[2] * (shift % 3 - 1);
        records[r] = image;
    });
}
inline void update_images(FluidClusters& clusters, const Domain& domain) {
    update_images(clusters, clusters.records, domain);
}

/// Loads the records of a cluster, of eight numbers each, as eight lanes of every number.
template <class Record>
inline void load_cluster(const Clusters& clusters, const Field<Record>& records, std::size_t cluster,
                         Pack (&lanes)[8]) {
    static_assert(sizeof(Record) == sizeof(Pack));
    for (std::size_t lane = 0; lane < pack_width; ++lane)
        std::memcpy(&lanes[lane], &records[static_cast<std::size_t>(clusters.record_of[pack_width * cluster + lane])],
                    sizeof(Pack));
    transpose(lanes);
}
/// x y z p/rho^2 u v w V.
inline void load_cluster(const FluidClusters& clusters, std::size_t cluster, Pack (&lanes)[8]) {
    load_cluster(clusters, clusters.records, cluster, lanes);
}

/// InputError, naming `file`, when a periodic side is shorter than two reaches of the kernel with its skin.
void check_periodic_sides(const Domain& domain, double reach_and_skin, const std::string& file);

} // namespace plumb
