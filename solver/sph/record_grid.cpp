#include "sph/record_grid.hpp"

#include "core/field.hpp"
#include "core/parallel.hpp"

#include <bit>
#include <cstring>
#include <limits>

namespace plumb {

Columns make_columns(const Domain& domain, double spacing, double reach) {
    Columns columns;
    columns.across = domain.dimensions - 1;
    columns.along = domain.dimensions - 1;
    // eight particles fill a cube, or a square
    columns.bin_width = domain.dimensions == 3 ? 2.0 * spacing : std::sqrt(8.0) * spacing;
    for (int axis = 0; axis < columns.across; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const double size = domain.size[axis];
        columns.n[k] = std::max(1, static_cast<std::int32_t>(size / columns.bin_width));
        columns.inverse_width[k] = columns.n[k] / size;
        if (domain.periodic[k])
            columns.halo[k] = static_cast<std::int32_t>(std::ceil(reach * columns.inverse_width[k]));
    }
    return columns;
}

void make_bins(RecordGrid& grid) {
    const auto& along = grid.x[static_cast<std::size_t>(grid.columns.along)];
    double low = 0.0, high = 0.0;
    for (std::size_t r = 0; r < grid.records(); ++r) low = std::min(low, along[r]), high = std::max(high, along[r]);
    grid.bin_origin = low;
    // A few particles far out must not cost memory: the outermost bins reach to infinity.
    const double most =
        4.0 * static_cast<double>(grid.records()) / static_cast<double>(grid.columns.extended_count()) + 64.0;
    grid.bins = static_cast<std::int32_t>(std::clamp((high - low) / grid.columns.bin_width + 1.0, 1.0, most));
    const auto stride = static_cast<std::size_t>(grid.bins) + 1;
    renew_size(grid.bin_begin, static_cast<std::size_t>(grid.columns.extended_count()) * stride);
    parallel_chunks(
        grid.begin.size() - 1,
        [&](std::size_t first, std::size_t last) {
            for (std::size_t c = first; c < last; ++c) {
                std::int32_t* begin = &grid.bin_begin[c * stride];
                std::size_t next = 0;
                for (std::int32_t r = grid.begin[c]; r < grid.begin[c + 1]; ++r)
                    for (const std::size_t bin = grid.bin(along[static_cast<std::size_t>(r)]); next <= bin;)
                        begin[next++] = r;
                while (next < stride) begin[next++] = grid.begin[c + 1];
            }
        },
        64);
}

namespace {

template <int d> PlaceGroup group_of(const std::array<std::vector<double>, 3>& place, std::size_t group) {
    PlaceGroup box{};
    for (std::size_t axis = 0; axis < d; ++axis) {
        std::memcpy(&box.x[axis], &place[axis][pack_width * group], sizeof(Pack));
        box.low[axis] = std::numeric_limits<double>::infinity(), box.high[axis] = -box.low[axis];
        for (int lane = 0; lane < pack_width; ++lane) {
            box.low[axis] = std::min(box.low[axis], box.x[axis][lane]);
            box.high[axis] = std::max(box.high[axis], box.x[axis][lane]);
        }
    }
    return box;
}

/// A list that grows by many at once and is written without asking each time whether there is room.
struct OpenList {
    std::vector<std::int32_t> entries; // more than `size`, for what comes
    std::size_t size = 0;

    /// Room for `more` behind the entries that are there.
    std::int32_t* room(std::size_t more) {
        if (entries.size() < size + more) entries.resize(2 * (size + more));
        return &entries[size];
    }
};

/// Appends the records [begin, end) that are nearer than `reach` to a place of the group.
template <int d>
void append_near(const PlaceGroup& box, const RecordGrid& grid, std::int32_t begin, std::int32_t end, double reach_sq,
                 const std::vector<std::uint8_t>& left_out, OpenList& list) {
    if (begin >= end) return;
    const Pack limit = broadcast<Pack>(reach_sq);
    std::int32_t* out = list.room(static_cast<std::size_t>(end - begin) + 1);
    const std::int32_t* const first = out;
    for (std::int32_t r = begin; r < end; r += pack_width) {
        Pack outside_sq{}; // squared distance to the box
        for (std::size_t axis = 0; axis < d; ++axis) {
            Pack x;
            std::memcpy(&x, &grid.x[axis][static_cast<std::size_t>(r)], sizeof x);
            const Pack below = broadcast<Pack>(box.low[axis]) - x, above = x - broadcast<Pack>(box.high[axis]);
            const Pack outside = larger(larger(below, above), broadcast<Pack>(0.0));
            outside_sq += outside * outside;
        }
        unsigned candidates = lanes_below(outside_sq, limit);
        if (end - r < pack_width) candidates &= (1U << static_cast<unsigned>(end - r)) - 1U;
        for (; candidates != 0; candidates &= candidates - 1) {
            const std::int32_t at = r + std::countr_zero(candidates);
            const auto record = static_cast<std::size_t>(at);
            if (!left_out.empty() && left_out[record] != 0) continue;
            Pack distance_sq{};
            for (std::size_t axis = 0; axis < d; ++axis) {
                const Pack dx = box.x[axis] - broadcast<Pack>(grid.x[axis][record]);
                distance_sq += dx * dx;
            }
            *out = at;
            out += lanes_below(distance_sq, limit) != 0 ? 1 : 0;
        }
    }
    list.size += static_cast<std::size_t>(out - first);
}

template <int d>
void list_group(const PlaceGroup& box, const RecordGrid& grid, double reach, const std::vector<std::uint8_t>& left_out,
                OpenList& list) {
    constexpr std::size_t along = d - 1;
    const Columns& columns = grid.columns;
    const auto stride = static_cast<std::size_t>(grid.bins) + 1;
    const std::size_t low_bin = grid.bin(box.low[along] - reach), high_bin = grid.bin(box.high[along] + reach);
    const std::int32_t b_low = d == 3 ? columns.at(1, box.low[1] - reach) : 0;
    const std::int32_t b_high = d == 3 ? columns.at(1, box.high[1] + reach) : 0;
    for (std::int32_t a = columns.at(0, box.low[0] - reach); a <= columns.at(0, box.high[0] + reach); ++a)
        for (std::int32_t b = b_low; b <= b_high; ++b) {
            const std::int32_t* bins = &grid.bin_begin[static_cast<std::size_t>(columns.extended_index(a, b)) * stride];
            append_near<d>(box, grid, bins[low_bin], bins[high_bin + 1], reach * reach, left_out, list);
        }
}

template <int d>
void list_all(NeighbourLists& lists, const RecordGrid& grid, const std::array<std::vector<double>, 3>& place,
              double reach, const std::vector<std::uint8_t>& left_out) {
    constexpr std::size_t per_part = NeighbourLists::groups_per_part;
    const std::size_t groups = place[0].size() / pack_width;
    lists.parts.resize((groups + per_part - 1) / per_part);
    renew_size(lists.part_end, groups);
    parallel_chunks(
        groups,
        [&](std::size_t first, std::size_t last) {
            OpenList part;
            part.entries.resize(256 * per_part);
            for (std::size_t c = first; c < last; ++c) {
                list_group<d>(group_of<d>(place, c), grid, reach, left_out, part);
                lists.part_end[c] = static_cast<std::int32_t>(part.size);
            }
            std::fill_n(part.room(NeighbourLists::padding), NeighbourLists::padding, 0);
            const auto end = part.entries.begin() + static_cast<std::ptrdiff_t>(part.size + NeighbourLists::padding);
            lists.parts[first / per_part].assign(part.entries.begin(), end); // holds no more than it needs
        },
        per_part);
}

} // namespace

void list_records(NeighbourLists& lists, const RecordGrid& grid, const std::array<std::vector<double>, 3>& place,
                  int dimensions, double reach, const std::vector<std::uint8_t>& left_out) {
    if (dimensions == 3)
        list_all<3>(lists, grid, place, reach, left_out);
    else
        list_all<2>(lists, grid, place, reach, left_out);
}

} // namespace plumb
