#include "sph/clusters.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace plumb {

namespace {

/// Columns along the last axis of the space, on a grid across it. Along a periodic axis the grid goes on beyond both
/// sides by `halo` columns of images; along an open one the outermost columns reach to infinity.
struct Columns {
    int across = 2;     // axes of the grid: 1 in the plane
    Eigen::Index along; // the axis of the columns
    std::array<std::int32_t, 2> n{1, 1}, halo{0, 0};
    std::array<double, 2> inverse_width{0.0, 0.0};
    double bin_width = 0.0;

    std::int32_t real_count() const { return n[0] * n[1]; }
    std::int32_t extended(int axis) const { return n[axis_(axis)] + 2 * halo[axis_(axis)]; }
    std::int32_t extended_count() const { return extended(0) * extended(1); }
    /// Column number along an axis of the grid; between -halo and n - 1 + halo.
    std::int32_t at(int axis, double x) const {
        const auto k = axis_(axis);
        const double c = std::floor(x * inverse_width[k]);
        return static_cast<std::int32_t>(
            std::clamp(c, static_cast<double>(-halo[k]), static_cast<double>(n[k] - 1 + halo[k])));
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

Columns make_columns(const Domain& domain, int dimensions, double spacing, double reach) {
    Columns columns;
    columns.across = dimensions - 1;
    columns.along = dimensions - 1;
    const double width = dimensions == 3 ? 2.0 * spacing : std::sqrt(8.0) * spacing; // eight particles fill a cube
    columns.bin_width = width;
    for (int axis = 0; axis < columns.across; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const double size = domain.size[axis];
        columns.n[k] = std::max(1, static_cast<std::int32_t>(size / width));
        columns.inverse_width[k] = columns.n[k] / size;
        if (domain.periodic[k])
            columns.halo[k] = static_cast<std::int32_t>(std::ceil(reach * columns.inverse_width[k]));
    }
    return columns;
}

void check_sides(const Domain& domain, int dimensions, double reach) {
    for (int c = 0; c < dimensions; ++c)
        if (domain.periodic[static_cast<std::size_t>(c)] && domain.size[c] < 2.0 * reach)
            throw InputError(
                fmt::format("domain.size: {} m along periodic {} is shorter than twice the reach of the kernel "
                            "with its skin, {:.6g} m: particles would meet two images of each other",
                            domain.size[c], axis_names[static_cast<std::size_t>(c)], reach));
}

/// Slots of the particles, column by column, ascending along the column and then by id.
struct Sorted {
    std::vector<std::int32_t> slot, begin; // begin: [columns + 1]
};

Sorted sorted_by_column(const Columns& columns, const ParticlePlaces& places) {
    const std::size_t slots = places.id.size();
    const auto& along = places.x[static_cast<std::size_t>(columns.along)];
    std::vector<std::int32_t> column(slots, -1);
    parallel_for(slots, [&](std::size_t k) {
        if (places.id[k] >= 0) column[k] = columns.real(places.x[0][k], places.x[1][k]);
    });
    Sorted sorted;
    sorted.begin.assign(static_cast<std::size_t>(columns.real_count()) + 1, 0);
    for (const std::int32_t c : column)
        if (c >= 0) ++sorted.begin[static_cast<std::size_t>(c) + 1];
    for (std::size_t c = 1; c < sorted.begin.size(); ++c) sorted.begin[c] += sorted.begin[c - 1];
    sorted.slot.resize(static_cast<std::size_t>(sorted.begin.back()));
    std::vector<std::int32_t> next(sorted.begin.begin(), sorted.begin.end() - 1);
    for (std::size_t k = 0; k < slots; ++k)
        if (column[k] >= 0)
            sorted.slot[static_cast<std::size_t>(next[static_cast<std::size_t>(column[k])]++)] =
                static_cast<std::int32_t>(k);
    const auto before = [&](std::int32_t a, std::int32_t b) {
        const double xa = along[static_cast<std::size_t>(a)], xb = along[static_cast<std::size_t>(b)];
        return xa != xb ? xa < xb : places.id[static_cast<std::size_t>(a)] < places.id[static_cast<std::size_t>(b)];
    };
    parallel_chunks(
        static_cast<std::size_t>(columns.real_count()),
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) {
                const auto first = sorted.slot.begin() + sorted.begin[c],
                           last = sorted.slot.begin() + sorted.begin[c + 1];
                if (!std::is_sorted(first, last, before)) std::sort(first, last, before);
            }
        },
        16);
    return sorted;
}

/// Cuts every column into clusters of eight, the last one filled up with copies.
ClusterOrder cut(const Sorted& sorted, std::vector<std::int32_t>& first_slot) {
    ClusterOrder order;
    first_slot.assign(sorted.begin.size(), 0);
    for (std::size_t c = 0; c + 1 < sorted.begin.size(); ++c) {
        first_slot[c] = static_cast<std::int32_t>(order.from.size());
        for (std::int32_t k = sorted.begin[c]; k < sorted.begin[c + 1]; ++k) {
            order.from.push_back(sorted.slot[static_cast<std::size_t>(k)]);
            order.copy.push_back(0);
        }
        while (order.from.size() % pack_width != 0) {
            order.from.push_back(order.from.back());
            order.copy.push_back(1);
        }
    }
    first_slot.back() = static_cast<std::int32_t>(order.from.size());
    return order;
}

/// Records of the extended columns: where each begins, and in each the images below, the particles, the images above.
struct RecordLayout {
    std::vector<std::int32_t> begin;     // [extended columns + 1]
    std::vector<std::int32_t> bin_begin; // [extended columns][bins + 1] runs of bin_width along the column
    std::int32_t bins = 0;
    double bin_origin = 0.0;

    std::int32_t bin(double x_along, double width) const {
        return static_cast<std::int32_t>(
            std::clamp(std::floor((x_along - bin_origin) / width), 0.0, static_cast<double>(bins - 1)));
    }
};

/// Index of the real column behind an extended one and the shift that moves it there.
std::pair<std::int32_t, std::int8_t> unwrapped(std::int32_t c, std::int32_t n) {
    if (c < 0) return {c + n, std::int8_t{0}};
    if (c >= n) return {c - n, std::int8_t{2}};
    return {c, std::int8_t{1}};
}

RecordLayout lay_out(FluidClusters& clusters, const Columns& columns, const Sorted& sorted,
                     const std::vector<std::int32_t>& first_slot, const ParticlePlaces& places, const Domain& domain,
                     int dimensions) {
    const double reach = clusters.reach + clusters.skin;
    const auto along = static_cast<std::size_t>(columns.along);
    const bool wraps = domain.periodic[along];
    const double length = domain.size[columns.along];
    RecordLayout layout;
    clusters.image_of.clear();
    clusters.image_shift.clear();
    clusters.record_of.assign(static_cast<std::size_t>(first_slot.back()), -1);
    std::vector<std::int32_t> slot_of_record; // the slot whose position it has, before the shift
    const auto place = [&](std::int32_t slot) { return places.x[along][static_cast<std::size_t>(slot)]; };
    std::vector<std::int32_t> new_slot; // by record: the slot after sorting
    for (std::int32_t a = -columns.halo[0]; a < columns.n[0] + columns.halo[0]; ++a)
        for (std::int32_t b = -columns.halo[1]; b < columns.n[1] + columns.halo[1]; ++b) {
            layout.begin.push_back(static_cast<std::int32_t>(slot_of_record.size()));
            const auto [ra, sa] = unwrapped(a, columns.n[0]);
            const auto [rb, sb] = columns.across == 2 ? unwrapped(b, columns.n[1]) : std::pair{0, std::int8_t{1}};
            const auto c = static_cast<std::size_t>(ra * columns.n[1] + rb);
            const std::int32_t first = sorted.begin[c], last = sorted.begin[c + 1];
            const auto shift = [&, shift_a = sa, shift_b = sb](int s) { // columns run along z, or along y in the plane
                return static_cast<std::int8_t>(columns.across == 2 ? 9 * shift_a + 3 * shift_b + s
                                                                    : 9 * shift_a + 3 * s + 1);
            };
            const auto put = [&](std::int32_t k, int s) {
                slot_of_record.push_back(sorted.slot[static_cast<std::size_t>(k)]);
                new_slot.push_back(first_slot[c] + (k - first));
                clusters.image_shift.push_back(shift(s));
            };
            if (wraps)
                for (std::int32_t k = first; k < last; ++k)
                    if (place(sorted.slot[static_cast<std::size_t>(k)]) >= length - reach) put(k, 0);
            for (std::int32_t k = first; k < last; ++k) put(k, 1);
            if (wraps)
                for (std::int32_t k = first; k < last; ++k)
                    if (place(sorted.slot[static_cast<std::size_t>(k)]) <= reach) put(k, 2);
        }
    const std::size_t records = slot_of_record.size();
    layout.begin.push_back(static_cast<std::int32_t>(records));
    constexpr std::int8_t unshifted = 9 + 3 + 1;
    for (std::size_t r = 0; r < records; ++r)
        if (clusters.image_shift[r] == unshifted)
            clusters.record_of[static_cast<std::size_t>(new_slot[r])] = static_cast<std::int32_t>(r);
    for (std::size_t s = 1; s < clusters.record_of.size(); ++s) // copies read the record of the one they copy
        if (clusters.record_of[s] < 0) clusters.record_of[s] = clusters.record_of[s - 1];
    clusters.image_of.resize(records);
    for (std::size_t r = 0; r < records; ++r)
        clusters.image_of[r] = clusters.record_of[static_cast<std::size_t>(new_slot[r])];
    for (int axis = 0; axis < 3; ++axis) {
        auto& x = clusters.x[static_cast<std::size_t>(axis)];
        x.assign(records + pack_width, 0.0);
        if (axis >= dimensions) continue;
        const int divisor = axis == 0 ? 9 : axis == 1 ? 3 : 1;
        const double side = domain.size[axis];
        for (std::size_t r = 0; r < records; ++r)
            x[r] = places.x[static_cast<std::size_t>(axis)][static_cast<std::size_t>(slot_of_record[r])] +
                   side * (clusters.image_shift[r] / divisor % 3 - 1);
    }
    return layout;
}

/// Runs of each extended column by position along it.
void bin_columns(RecordLayout& layout, const FluidClusters& clusters, const Columns& columns) {
    const auto& along = clusters.x[static_cast<std::size_t>(columns.along)];
    const std::size_t records = static_cast<std::size_t>(layout.begin.back());
    double low = 0.0, high = 0.0;
    for (std::size_t r = 0; r < records; ++r) low = std::min(low, along[r]), high = std::max(high, along[r]);
    layout.bin_origin = low;
    // A few particles far out must not cost memory: the outermost bins reach to infinity.
    const double most = 4.0 * static_cast<double>(records) / static_cast<double>(columns.extended_count()) + 64.0;
    layout.bins = static_cast<std::int32_t>(std::clamp((high - low) / columns.bin_width + 1.0, 1.0, most));
    const auto stride = static_cast<std::size_t>(layout.bins) + 1;
    layout.bin_begin.assign(static_cast<std::size_t>(columns.extended_count()) * stride, 0);
    for (std::size_t c = 0; c + 1 < layout.begin.size(); ++c) {
        std::int32_t* begin = &layout.bin_begin[c * stride];
        std::int32_t next = 0;
        for (std::int32_t r = layout.begin[c]; r < layout.begin[c + 1]; ++r)
            for (const std::int32_t bin = layout.bin(along[static_cast<std::size_t>(r)], columns.bin_width);
                 next <= bin;)
                begin[next++] = r;
        while (next <= layout.bins) begin[next++] = layout.begin[c + 1];
    }
}

/// Positions of eight particles and the box around them.
template <int d> struct ClusterBox {
    std::array<Pack, d> x;
    std::array<double, d> low, high;
};

template <int d> ClusterBox<d> box_of(const FluidClusters& clusters, std::size_t cluster) {
    ClusterBox<d> box;
    for (std::size_t axis = 0; axis < d; ++axis) {
        box.low[axis] = std::numeric_limits<double>::infinity(), box.high[axis] = -box.low[axis];
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const double x =
                clusters.x[axis][static_cast<std::size_t>(clusters.record_of[pack_width * cluster + lane])];
            box.x[axis][static_cast<int>(lane)] = x;
            box.low[axis] = std::min(box.low[axis], x), box.high[axis] = std::max(box.high[axis], x);
        }
    }
    return box;
}

/// Appends the records [begin, end) that are nearer than `reach` to a particle of the cluster.
template <int d>
void append_near(const ClusterBox<d>& box, const FluidClusters& clusters, std::int32_t begin, std::int32_t end,
                 double reach_sq, std::vector<std::int32_t>& list) {
    for (std::int32_t r = begin; r < end; r += pack_width) {
        Pack outside_sq{}; // squared distance to the box
        for (std::size_t axis = 0; axis < d; ++axis) {
            Pack x;
            std::memcpy(&x, &clusters.x[axis][static_cast<std::size_t>(r)], sizeof x);
            const Pack below = broadcast<Pack>(box.low[axis]) - x, above = x - broadcast<Pack>(box.high[axis]);
            const Pack outside = larger(larger(below, above), broadcast<Pack>(0.0));
            outside_sq += outside * outside;
        }
        const PackMask candidates = outside_sq < broadcast<Pack>(reach_sq);
        if (!any(candidates)) continue;
        for (std::int32_t lane = 0; lane < std::min(end - r, pack_width); ++lane) {
            if (candidates[lane] == 0) continue;
            const auto record = static_cast<std::size_t>(r + lane);
            Pack distance_sq{};
            for (std::size_t axis = 0; axis < d; ++axis) {
                const Pack dx = box.x[axis] - broadcast<Pack>(clusters.x[axis][record]);
                distance_sq += dx * dx;
            }
            if (any(distance_sq < broadcast<Pack>(reach_sq))) list.push_back(r + lane);
        }
    }
}

template <int d>
void list_cluster(const FluidClusters& clusters, const Columns& columns, const RecordLayout& layout,
                  std::size_t cluster, std::vector<std::int32_t>& list) {
    const double reach = clusters.reach + clusters.skin;
    const ClusterBox<d> box = box_of<d>(clusters, cluster);
    constexpr std::size_t along = d - 1;
    const auto stride = static_cast<std::size_t>(layout.bins) + 1;
    const auto low_bin = static_cast<std::size_t>(layout.bin(box.low[along] - reach, columns.bin_width));
    const auto high_bin = static_cast<std::size_t>(layout.bin(box.high[along] + reach, columns.bin_width));
    const std::int32_t b_low = d == 3 ? columns.at(1, box.low[1] - reach) : 0;
    const std::int32_t b_high = d == 3 ? columns.at(1, box.high[1] + reach) : 0;
    for (std::int32_t a = columns.at(0, box.low[0] - reach); a <= columns.at(0, box.high[0] + reach); ++a)
        for (std::int32_t b = b_low; b <= b_high; ++b) {
            const std::int32_t* bins =
                &layout.bin_begin[static_cast<std::size_t>(columns.extended_index(a, b)) * stride];
            append_near<d>(box, clusters, bins[low_bin], bins[high_bin + 1], reach * reach, list);
        }
}

template <int d> void list_neighbours(FluidClusters& clusters, const Columns& columns, const RecordLayout& layout) {
    clusters.parts.resize((clusters.count + clusters_per_part - 1) / clusters_per_part);
    clusters.part_end.resize(clusters.count);
    parallel_chunks(
        clusters.count,
        [&](std::size_t first, std::size_t last) {
            std::vector<std::int32_t> part;
            part.reserve(256 * clusters_per_part);
            for (std::size_t c = first; c < last; ++c) {
                list_cluster<d>(clusters, columns, layout, c, part);
                clusters.part_end[c] = static_cast<std::int32_t>(part.size());
            }
            part.insert(part.end(), list_padding, 0);
            clusters.parts[first / clusters_per_part].assign(part.begin(), part.end()); // holds no more than it needs
        },
        clusters_per_part);
}

} // namespace

ClusterOrder rebuild(FluidClusters& clusters, const ParticlePlaces& places, const Domain& domain, int dimensions,
                     double spacing) {
    const double reach = clusters.reach + clusters.skin;
    check_sides(domain, dimensions, reach);
    const Columns columns = make_columns(domain, dimensions, spacing, reach);
    const Sorted sorted = sorted_by_column(columns, places);
    std::vector<std::int32_t> first_slot;
    ClusterOrder order = cut(sorted, first_slot);
    clusters.count = order.from.size() / pack_width;
    RecordLayout layout = lay_out(clusters, columns, sorted, first_slot, places, domain, dimensions);
    bin_columns(layout, clusters, columns);
    if (dimensions == 3)
        list_neighbours<3>(clusters, columns, layout);
    else
        list_neighbours<2>(clusters, columns, layout);
    clusters.records.resize(static_cast<std::size_t>(layout.begin.back()));
    return order;
}

void update_images(FluidClusters& clusters, const Domain& domain) {
    parallel_for(clusters.records.size(), [&](std::size_t r) {
        const auto source = static_cast<std::size_t>(clusters.image_of[r]);
        if (source == r) return;
        FluidRecord image = clusters.records[source];
        const int shift = clusters.image_shift[r];
        image.x += domain.size[0] * (shift / 9 - 1);
        image.y += domain.size[1] * (shift / 3 % 3 - 1);
        image.z += domain.size[2] * (shift % 3 - 1);
        clusters.records[r] = image;
    });
}

} // namespace plumb
