// Where records are: columns across the box, each sorted along itself and cut into bins, and the search in them.
#pragma once

#include "core/domain.hpp"
#include "core/simd.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb {

/// Columns along the last axis of the space, on a grid across it. Along a periodic axis the grid goes on beyond both
/// sides by `halo` columns of images; along an open one the outermost columns reach to infinity.
struct Columns {
    int across = 2;     // axes of the grid: 1 in the plane
    Eigen::Index along; // the axis of the columns
    std::array<std::int32_t, 2> n{1, 1}, halo{0, 0};
    std::array<double, 2> inverse_width{0.0, 0.0};
    double bin_width = 0.0; // [m]

    std::int32_t real_count() const { return n[0] * n[1]; }
    std::int32_t extended(int axis) const { return n[axis_(axis)] + 2 * halo[axis_(axis)]; }
    std::int32_t extended_count() const { return extended(0) * extended(1); }
    /// Column number along an axis of the grid; between -halo and n - 1 + halo.
    std::int32_t at(int axis, double x) const {
        const auto k = axis_(axis);
        const double c = std::floor(x * inverse_width[k]);
        if (!(c > static_cast<double>(-halo[k]))) return -halo[k]; // NaN too
        return static_cast<std::int32_t>(std::min(c, static_cast<double>(n[k] - 1 + halo[k])));
    }
    std::int32_t real(double x, double y) const {
        const std::int32_t a = std::clamp(at(0, x), 0, n[0] - 1);
        return across == 1 ? a : a * n[1] + std::clamp(at(1, y), 0, n[1] - 1);
    }
    std::int32_t extended_index(std::int32_t a, std::int32_t b) const {
        return (a + halo[0]) * extended(1) + (b + halo[1]);
    }

private:
    static std::size_t axis_(int axis) { return static_cast<std::size_t>(axis); }
};

Columns make_columns(const Domain& domain, double spacing, double reach);

/// Records of the extended columns and runs of them by position along the column.
struct RecordGrid {
    Columns columns;
    std::vector<std::int32_t> begin;      // [extended columns + 1] the first record of each
    std::vector<std::int32_t> bin_begin;  // [extended columns][bins + 1] runs of bin_width along the column
    std::array<std::vector<double>, 3> x; // [records + 8] where the records were when the grid was made [m]
    std::int32_t bins = 0;
    double bin_origin = 0.0; // [m]

    std::size_t records() const { return static_cast<std::size_t>(begin.back()); }
    std::size_t bin(double x_along) const {
        const double b = std::floor((x_along - bin_origin) / columns.bin_width);
        if (!(b > 0.0)) return 0; // a NaN is nobody's neighbour, but must not be an index
        return static_cast<std::size_t>(std::min(b, static_cast<double>(bins - 1)));
    }
};

/// Cuts the columns into bins; `begin` and `x` are there, ascending along each column.
void make_bins(RecordGrid& grid);

/// Eight places, one per lane, and the box around them.
struct PlaceGroup {
    std::array<Pack, 3> x;
    std::array<double, 3> low, high;
};

/// Groups of places and the records near each, in parts that are built at the same time and keep their memory.
struct NeighbourLists {
    static constexpr std::size_t groups_per_part = 64, padding = 32;
    std::vector<std::vector<std::int32_t>> parts;
    std::vector<std::int32_t> part_end; // [groups] where the list of a group ends in its part

    /// Records near a group, ascending. `padding` more entries can be read behind them.
    std::span<const std::int32_t> near(std::size_t group) const {
        const std::vector<std::int32_t>& part = parts[group / groups_per_part];
        const auto begin = group % groups_per_part == 0 ? 0 : static_cast<std::size_t>(part_end[group - 1]);
        return {part.data() + begin, static_cast<std::size_t>(part_end[group]) - begin};
    }
};

/// Lists of the records nearer than `reach` to any of eight places; group g has those of lanes 8 g to 8 g + 7. `place`
/// holds the places by lane. Records with a 1 in `left_out` (may be empty) are not listed.
void list_records(NeighbourLists& lists, const RecordGrid& grid, const std::array<std::vector<double>, 3>& place,
                  int dimensions, double reach, const std::vector<std::uint8_t>& left_out);

} // namespace plumb
