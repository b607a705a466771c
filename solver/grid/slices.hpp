// Matrices of neighbours on a grid, for speed: of every sixteen rows, the diagonals that occur in them. A product then
// needs no number of a column, and sixteen rows are one row of vector instructions; what a diagonal lacks is filled
// with zeros. Single precision.
#pragma once

#include "core/parallel.hpp"
#include "grid/aggregation.hpp"

#include <cstring>

namespace plumb {

inline constexpr std::size_t lanes = 16;
using FloatPack [[gnu::vector_size(64)]] = float;

/// Numbers by row, with `lanes` zeros before the first and as many or more after the last: row k is at k + lanes.
using Numbers = Field<float>;
inline std::size_t padded_size(std::size_t rows) { return (rows + lanes - 1) / lanes * lanes + 2 * lanes; }

inline FloatPack pack_at(const Numbers& x, std::size_t k) {
    FloatPack p;
    std::memcpy(&p, x.data() + k, sizeof p);
    return p;
}
inline void put_pack(Numbers& x, std::size_t k, FloatPack p) { std::memcpy(x.data() + k, &p, sizeof p); }

struct Slices {
    std::vector<int> begin; // of each slice among all diagonals, and the end
    std::vector<int> first; // by diagonal: place of the number that the slice's first row takes
    Numbers value;          // `lanes` by diagonal
};
Slices slices(const Equations& equations);

/// Calls use(place of the first row, (a x) of sixteen rows) for all of a matrix; `use` may write to those rows only,
/// and not to x.
template <class Use> void for_each_product(const Slices& a, const Numbers& x, Use&& use) {
    constexpr std::size_t share = 256; // slices
    const auto run = [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            FloatPack sum{};
            const auto last = static_cast<std::size_t>(a.begin[s + 1]);
            for (auto e = static_cast<std::size_t>(a.begin[s]); e < last; ++e)
                sum += pack_at(a.value, lanes * e) * pack_at(x, static_cast<std::size_t>(a.first[e]));
            use((s + 1) * lanes, sum);
        }
    };
    parallel_chunks(a.begin.size() - 1, run, share);
}

} // namespace plumb
