// Which grains may touch: a Verlet list over grains sorted by cell.
#pragma once

#include "core/field.hpp"
#include "core/simd.hpp"
#include "dem/grains.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

/// What a contact gives to its two grains, one cache line: force on i (fx fy fz), torque per radius (tx ty tz), 0, 0.
using PairForce = Pack;

/// One cache line of a grain as the sweep over pairs reads it; the velocity is the one predicted for the end of the
/// step.
struct alignas(64) GrainRecord {
    double x, y, z, radius, vx, vy, vz, inverse_mass;
};
/// Surface velocity radius * omega [m/s] and the material's number.
struct alignas(32) SpinRecord {
    double x, y, z, material;
};

/// Where the forces of a grain's first pairs stand, padded with a line that is always zero. Most grains have no more,
/// and a loop of fixed length is never mispredicted: in a random bed that is worth a third of the whole step.
struct alignas(64) ForceSlots {
    static constexpr std::int32_t width = 8;
    std::array<std::int32_t, width> own, incoming;
};

/// Couple of rolling resistance on i (its opposite acts on j), padded to four numbers.
using PairCouple [[gnu::vector_size(32)]] = double;

/// Candidate pairs (i < j in the order of the grains) nearer than the sum of their radii, reach and skin, in ascending
/// order of i, padded with (n, n) to whole blocks of eight; place n holds a record that touches nothing. The list is a
/// pure function of the positions it was built for (Grains::x_listed) and of the ids, so it is never saved: a resumed
/// run builds the same one again.
struct Neighbours {
    double skin = 0.0;                        // [m]; the list holds until a grain has moved skin / 2
    double reach = 0.0;                       // [m] separation at which the last liquid bridge breaks; 0 without any
    std::size_t count = 0;                    // candidate pairs without padding
    Field<std::int32_t> i, j;                 // [padded]
    std::vector<std::int32_t> own;            // [n + 1] pairs own[k] .. own[k+1]-1 have i = k
    std::vector<std::int32_t> incoming_begin; // [n + 1] range in `incoming` of the pairs with j = k
    std::vector<std::int32_t> incoming;       // pair indices
    Field<ForceSlots> slots;                  // [n]
    std::vector<std::uint8_t> crosses;        // [blocks] 1 if a pair of the block is nearest across a periodic side
    Field<GrainRecord> records;               // [n + 1] what the sweep reads of a grain
    Field<SpinRecord> spins;                  // [n + 1]
    bool rolls = false;                       // a rolling law is in use: couples are kept
    bool bridges = false;                     // grains are wet: volumes of bridges are kept
    int history = 0;                          // numbers remembered per pair: tangential, then rolling stretch
    Field<double> stretch;                    // [blocks][history][8]
    Field<double> bridge;                     // [padded] liquid between the two [m3], 0 without a bridge; empty if dry
    Field<PairForce> force;                   // [padded + 1] last forces; the last line stays zero
    Field<PairCouple> couple;                 // [padded] last couples; empty without rolling resistance

    std::size_t padded() const { return i.size(); }
    double& remembered(std::size_t pair, int what) {
        return stretch[(pair / 8 * static_cast<std::size_t>(history) + static_cast<std::size_t>(what)) * 8 + pair % 8];
    }
    double remembered(std::size_t pair, int what) const {
        return const_cast<Neighbours*>(this)->remembered(pair, what);
    }
};

/// What the pair of grains with these ids remembers. A stretch is as seen from `first` (it changes sign with the
/// order).
struct RememberedContact {
    std::int32_t first, second;
    std::array<double, 6> stretch;
    double bridge = 0.0; // liquid between the two [m3]
};

/// All non-zero memories of the list: for rebuilding it and for checkpoints.
std::vector<RememberedContact> remembered_contacts(const Neighbours& list, const Grains& grains);

/// Sorts the grains by (cell, id) and lists all candidate pairs, with the memory given for those that have one. Two
/// fixed grains, or two of the same block, are never paired. Returns the new order: place k holds what was at order[k].
std::vector<std::int32_t> rebuild(Neighbours& list, Grains& grains, const std::vector<GrainGroup>& groups,
                                  const Domain& domain, const std::vector<RememberedContact>& memory);

} // namespace plumb
