#include "sph/clusters.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

constexpr std::size_t columns_per_task = 16;

/// The particles and the passive ones behind them, numbered through: entry e < slots is a slot, the others are passive.
class Entries {
public:
    explicit Entries(const ParticlePlaces& places) : places_(places), slots_(places.id.size()) {}
    std::size_t count() const { return slots_ + places_.passive[0].size(); }
    bool exists(std::size_t e) const { return e >= slots_ || places_.id[e] >= 0; }
    bool passive(std::int32_t e) const { return static_cast<std::size_t>(e) >= slots_; }
    std::int32_t passive_number(std::int32_t e) const { return e - static_cast<std::int32_t>(slots_); }
    double x(std::size_t axis, std::size_t e) const {
        return e < slots_ ? places_.x[axis][e] : places_.passive[axis][e - slots_];
    }
    /// A number that does not change when particles are sorted anew.
    std::int64_t id(std::size_t e) const {
        return e < slots_ ? places_.id[e] : static_cast<std::int64_t>(e - slots_) - (std::int64_t{1} << 32U);
    }

private:
    const ParticlePlaces& places_;
    std::size_t slots_;
};

/// Entries column by column, ascending along the column and then by id; new slots of the particles among them.
struct Sorted {
    std::vector<std::int32_t> entry, begin;     // begin: [columns + 1]
    std::vector<std::int32_t> slot, first_slot; // slot: [entries] -1 for passive; first_slot: [columns + 1]
};

template <class Body> void for_each_column(std::int32_t columns, Body&& body) {
    parallel_chunks(
        static_cast<std::size_t>(columns),
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = begin; c < end; ++c) body(c);
        },
        columns_per_task);
}

void sort_by_column(Sorted& sorted, const Columns& columns, const Entries& entries) {
    std::vector<std::int32_t> column(entries.count(), -1);
    parallel_for(entries.count(), [&](std::size_t e) {
        if (entries.exists(e)) column[e] = columns.real(entries.x(0, e), columns.across == 2 ? entries.x(1, e) : 0.0);
    });
    sorted.begin.assign(static_cast<std::size_t>(columns.real_count()) + 1, 0);
    for (const std::int32_t c : column)
        if (c >= 0) ++sorted.begin[static_cast<std::size_t>(c) + 1];
    for (std::size_t c = 1; c < sorted.begin.size(); ++c) sorted.begin[c] += sorted.begin[c - 1];
    sorted.entry.resize(static_cast<std::size_t>(sorted.begin.back()));
    std::vector<std::int32_t> next(sorted.begin.begin(), sorted.begin.end() - 1);
    for (std::size_t e = 0; e < column.size(); ++e)
        if (column[e] >= 0)
            sorted.entry[static_cast<std::size_t>(next[static_cast<std::size_t>(column[e])]++)] =
                static_cast<std::int32_t>(e);
    const auto along = static_cast<std::size_t>(columns.along);
    const auto before = [&](std::int32_t a, std::int32_t b) {
        const auto ea = static_cast<std::size_t>(a), eb = static_cast<std::size_t>(b);
        const double xa = entries.x(along, ea), xb = entries.x(along, eb);
        return xa != xb ? xa < xb : entries.id(ea) < entries.id(eb);
    };
    for_each_column(columns.real_count(), [&](std::size_t c) {
        const auto first = sorted.entry.begin() + sorted.begin[c], last = sorted.entry.begin() + sorted.begin[c + 1];
        if (!std::is_sorted(first, last, before)) std::sort(first, last, before);
    });
}

/// Cuts the particles of every column into clusters of eight, the last one filled up with copies.
ClusterOrder cut(Sorted& sorted, const Entries& entries) {
    const auto columns = static_cast<std::int32_t>(sorted.begin.size()) - 1;
    sorted.slot.resize(sorted.entry.size());
    sorted.first_slot.assign(sorted.begin.size(), 0);
    for_each_column(columns, [&](std::size_t c) {
        const auto first = sorted.entry.begin() + sorted.begin[c], last = sorted.entry.begin() + sorted.begin[c + 1];
        const auto particles =
            std::count_if(first, last, [&](std::int32_t e) { return !entries.passive(e); }) + pack_width - 1;
        sorted.first_slot[c + 1] = static_cast<std::int32_t>(particles / pack_width * pack_width);
    });
    for (std::size_t c = 1; c < sorted.first_slot.size(); ++c) sorted.first_slot[c] += sorted.first_slot[c - 1];
    ClusterOrder order;
    order.from.resize(static_cast<std::size_t>(sorted.first_slot.back()));
    order.copy.assign(order.from.size(), 0);
    for_each_column(columns, [&](std::size_t c) {
        auto slot = static_cast<std::size_t>(sorted.first_slot[c]);
        for (auto k = static_cast<std::size_t>(sorted.begin[c]); k < static_cast<std::size_t>(sorted.begin[c + 1]);
             ++k) {
            const bool passive = entries.passive(sorted.entry[k]);
            sorted.slot[k] = passive ? -1 : static_cast<std::int32_t>(slot);
            if (!passive) order.from[slot++] = sorted.entry[k];
        }
        for (; slot < static_cast<std::size_t>(sorted.first_slot[c + 1]); ++slot) {
            order.from[slot] = order.from[slot - 1];
            order.copy[slot] = 1;
        }
    });
    return order;
}

/// Index of the real column behind an extended one and the shift that moves it there.
std::pair<std::int32_t, int> unwrapped(std::int32_t c, std::int32_t n) {
    if (c < 0) return {c + n, 0};
    if (c >= n) return {c - n, 2};
    return {c, 1};
}

/// Lays out the records: per extended column the images below, the particles, the images above.
class Layout {
public:
    Layout(Clusters& clusters, const Sorted& sorted, const Entries& entries, const Domain& domain)
        : clusters_(clusters), grid_(clusters.grid), sorted_(sorted), entries_(entries), domain_(domain),
          along_(static_cast<std::size_t>(grid_.columns.along)), wraps_(domain.periodic[along_]),
          reach_(std::max(clusters.reach, clusters.images) + clusters.skin) {}

    void make() {
        const Columns& columns = grid_.columns;
        const auto count = static_cast<std::size_t>(columns.extended_count());
        grid_.begin.assign(count + 1, 0);
        for_each_column(columns.extended_count(), [&](std::size_t c) { grid_.begin[c + 1] = length_of(c); });
        for (std::size_t c = 1; c <= count; ++c) grid_.begin[c] += grid_.begin[c - 1];
        const std::size_t records = grid_.records();
        renew_size(clusters_.image_of, records);
        renew_size(clusters_.image_shift, records);
        clusters_.passive.clear();
        clusters_.record_of_passive.clear();
        const std::size_t slots = static_cast<std::size_t>(sorted_.first_slot.back());
        const std::size_t passives = sorted_.entry.size() - particles();
        if (passives > 0) {
            clusters_.passive.assign(records, 0);
            clusters_.record_of_passive.assign(passives, -1);
        }
        clusters_.record_of.assign(slots, -1);
        for (std::size_t axis = 0; axis < 3; ++axis) grid_.x[axis].assign(records + pack_width, 0.0);
        for_each_column(columns.extended_count(), [&](std::size_t c) { fill(c); });
        for (std::size_t s = 1; s < slots; ++s) // copies read the record of the one they copy
            if (clusters_.record_of[s] < 0) clusters_.record_of[s] = clusters_.record_of[s - 1];
        parallel_for(records, [&](std::size_t r) { clusters_.image_of[r] = record_of(clusters_.image_of[r]); });
    }

private:
    struct Source { // of an extended column
        std::size_t column;
        int shift; // without the part along the column
    };
    Source source(std::size_t extended) const {
        const Columns& columns = grid_.columns;
        const auto c = static_cast<std::int32_t>(extended);
        const auto [a, shift_a] = unwrapped(c / columns.extended(1) - columns.halo[0], columns.n[0]);
        const auto [b, shift_b] =
            columns.across == 2 ? unwrapped(c % columns.extended(1) - columns.halo[1], columns.n[1]) : std::pair{0, 1};
        return {static_cast<std::size_t>(a * columns.n[1] + b), 9 * shift_a + (columns.across == 2 ? 3 * shift_b : 1)};
    }
    std::size_t particles() const {
        return static_cast<std::size_t>(
            std::count_if(sorted_.slot.begin(), sorted_.slot.end(), [](std::int32_t s) { return s >= 0; }));
    }
    double place(std::size_t k) const { return entries_.x(along_, static_cast<std::size_t>(sorted_.entry[k])); }
    /// Calls put(k, s) for the sorted entries of a column in the order of its records; s = 0, 1, 2: image below, the
    /// entry itself, image above.
    template <class Put> void for_each_record(std::size_t column, Put&& put) const {
        const auto first = static_cast<std::size_t>(sorted_.begin[column]),
                   last = static_cast<std::size_t>(sorted_.begin[column + 1]);
        const double length = domain_.size[grid_.columns.along];
        if (wraps_)
            for (std::size_t k = first; k < last; ++k)
                if (place(k) >= length - reach_) put(k, 0);
        for (std::size_t k = first; k < last; ++k) put(k, 1);
        if (wraps_)
            for (std::size_t k = first; k < last; ++k)
                if (place(k) <= reach_) put(k, 2);
    }
    std::int32_t length_of(std::size_t extended) const {
        std::int32_t length = 0;
        for_each_record(source(extended).column, [&](std::size_t /*k*/, int /*s*/) { ++length; });
        return length;
    }
    void fill(std::size_t extended) {
        const Source from = source(extended);
        auto r = static_cast<std::size_t>(grid_.begin[extended]);
        const int per_step = grid_.columns.across == 2 ? 1 : 3; // columns run along z, or along y in the plane
        for_each_record(from.column, [&](std::size_t k, int s) {
            const int shift = from.shift + per_step * s;
            const std::int32_t e = sorted_.entry[k];
            constexpr int unshifted = 9 + 3 + 1;
            clusters_.image_shift[r] = static_cast<std::int8_t>(shift);
            clusters_.image_of[r] = static_cast<std::int32_t>(k); // for the moment
            if (entries_.passive(e)) clusters_.passive[r] = 1;
            if (shift == unshifted) own_record(e, k) = static_cast<std::int32_t>(r);
            for (int axis = 0; axis < domain_.dimensions; ++axis) {
                const int divisor = axis == 0 ? 9 : axis == 1 ? 3 : 1;
                const auto q = static_cast<std::size_t>(axis);
                grid_.x[q][r] =
                    entries_.x(q, static_cast<std::size_t>(e)) + domain_.size[axis] * (shift / divisor % 3 - 1);
            }
            ++r;
        });
    }
    std::int32_t& own_record(std::int32_t e, std::size_t k) {
        return entries_.passive(e) ? clusters_.record_of_passive[static_cast<std::size_t>(entries_.passive_number(e))]
                                   : clusters_.record_of[static_cast<std::size_t>(sorted_.slot[k])];
    }
    std::int32_t record_of(std::int32_t k) const {
        const auto q = static_cast<std::size_t>(k);
        const std::int32_t e = sorted_.entry[q];
        return entries_.passive(e) ? clusters_.record_of_passive[static_cast<std::size_t>(entries_.passive_number(e))]
                                   : clusters_.record_of[static_cast<std::size_t>(sorted_.slot[q])];
    }

    Clusters& clusters_;
    RecordGrid& grid_;
    const Sorted& sorted_;
    const Entries& entries_;
    const Domain& domain_;
    std::size_t along_;
    bool wraps_;
    double reach_;
};

} // namespace

void check_periodic_sides(const Domain& domain, double reach_and_skin, const std::string& file) {
    for (int c = 0; c < domain.dimensions; ++c)
        if (domain.periodic[static_cast<std::size_t>(c)] && domain.size[c] < 2.0 * reach_and_skin)
            throw InputError(
                fmt::format("{}domain.size: {} m along periodic {} is shorter than twice the reach of the "
                            "kernel with its skin, {:.6g} m: particles would meet two images of each other",
                            file.empty() ? "" : file + ": ", domain.size[c], axis_names[static_cast<std::size_t>(c)],
                            reach_and_skin));
}

ClusterOrder arrange(Clusters& clusters, const ParticlePlaces& places, const Domain& domain, double spacing) {
    const double reach = std::max(clusters.reach, clusters.images) + clusters.skin;
    check_periodic_sides(domain, reach, "");
    clusters.grid.columns = make_columns(domain, spacing, reach);
    const Entries entries(places);
    Sorted sorted;
    sort_by_column(sorted, clusters.grid.columns, entries);
    ClusterOrder order = cut(sorted, entries);
    clusters.count = order.from.size() / pack_width;
    Layout(clusters, sorted, entries, domain).make();
    make_bins(clusters.grid);
    return order;
}

std::array<std::vector<double>, 3> lane_places(const Clusters& clusters, int dimensions) {
    std::array<std::vector<double>, 3> place;
    const std::size_t lanes = clusters.record_of.size();
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(dimensions); ++axis) {
        place[axis].resize(lanes);
        parallel_for(lanes, [&](std::size_t s) {
            place[axis][s] = clusters.grid.x[axis][static_cast<std::size_t>(clusters.record_of[s])];
        });
    }
    return place;
}

ClusterOrder rebuild(FluidClusters& clusters, const ParticlePlaces& places, const Domain& domain, double spacing) {
    ClusterOrder order = arrange(clusters, places, domain, spacing);
    renew_size(clusters.records, clusters.grid.records());
    list_records(clusters.lists, clusters.grid, lane_places(clusters, domain.dimensions), domain.dimensions,
                 clusters.reach + clusters.skin, {});
    return order;
}

} // namespace plumb
