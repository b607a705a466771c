#include "dem/neighbours.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// Uniform cells at least `cutoff` wide, x fastest. Along an open axis the outermost cells reach to infinity.
struct Cells {
    std::array<std::int32_t, 3> n{1, 1, 1};
    Vec3 inverse_width = Vec3::Zero();
    std::vector<std::int32_t> begin; // [cells + 1] range of grains in sorted order

    std::int32_t count() const { return n[0] * n[1] * n[2]; }
    std::int32_t along(int axis, double x) const {
        const std::int32_t last = n[static_cast<std::size_t>(axis)] - 1;
        return static_cast<std::int32_t>(
            std::clamp(std::floor(x * inverse_width[axis]), 0.0, static_cast<double>(last)));
    }
    std::int32_t of(const Vec3& x) const { return (along(2, x[2]) * n[1] + along(1, x[1])) * n[0] + along(0, x[0]); }
};

Cells sized_cells(const Domain& domain, double cutoff, std::size_t grains) {
    Cells cells;
    // A nearly empty box gets wider cells, so that they never outnumber the grains by much.
    const double volume = domain.size.prod();
    const double width = std::max(cutoff, std::cbrt(volume / static_cast<double>(2 * grains + 64)));
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        cells.n[k] = std::max(1, static_cast<std::int32_t>(domain.size[c] / width));
        cells.inverse_width[c] = cells.n[k] / domain.size[c];
    }
    return cells;
}

/// Sorts the grains by (cell, id) and fills cells.begin; returns the order.
std::vector<std::int32_t> sort_by_cell(Cells& cells, Grains& grains) {
    const std::size_t n = grains.size();
    std::vector<std::int32_t> cell(n);
    parallel_for(n, [&](std::size_t k) { cell[k] = cells.of(grains.x[k]); });
    cells.begin.assign(static_cast<std::size_t>(cells.count()) + 1, 0);
    for (std::size_t k = 0; k < n; ++k) ++cells.begin[static_cast<std::size_t>(cell[k]) + 1];
    for (std::size_t c = 1; c < cells.begin.size(); ++c) cells.begin[c] += cells.begin[c - 1];
    std::vector<std::int32_t> next(cells.begin.begin(), cells.begin.end() - 1);
    std::vector<std::int32_t> order(n);
    for (const std::int32_t place : positions_of_ids(grains)) // ascending id: the sort is stable in id
        order[static_cast<std::size_t>(next[static_cast<std::size_t>(cell[static_cast<std::size_t>(place)])]++)] =
            place;
    reorder(grains, order);
    return order;
}

/// Contiguous ranges of sorted grains in the cells around one cell, with the periodic shift of each.
struct Stretch {
    std::int32_t begin, end;
    Vec3 shift; // to be added to x_i - x_j [m]
};

struct Around {
    std::array<std::pair<std::int32_t, double>, 3> cell; // index and shift [m]
    int count = 0;
};

/// The up to three different cells next to and at `c` along an axis.
Around around(std::int32_t c, std::int32_t n, bool periodic, double size) {
    Around found;
    for (std::int32_t d = -1; d <= 1; ++d) {
        std::int32_t at = c + d;
        double shift = 0.0;
        if (at < 0 || at >= n) {
            if (!periodic || n < 3) continue; // with fewer than three cells the neighbour is in the list already
            shift = at < 0 ? size : -size;
            at = at < 0 ? at + n : at - n;
        }
        found.cell[static_cast<std::size_t>(found.count++)] = {at, shift};
    }
    return found;
}

void collect(const Cells& cells, const Domain& domain, std::int32_t cell, std::vector<Stretch>& ranges) {
    ranges.clear();
    const std::int32_t cx = cell % cells.n[0], cy = cell / cells.n[0] % cells.n[1],
                       cz = cell / (cells.n[0] * cells.n[1]);
    const Around xs = around(cx, cells.n[0], domain.periodic[0], domain.size[0]);
    const Around ys = around(cy, cells.n[1], domain.periodic[1], domain.size[1]);
    const Around zs = around(cz, cells.n[2], domain.periodic[2], domain.size[2]);
    for (int a = 0; a < zs.count; ++a)
        for (int b = 0; b < ys.count; ++b)
            for (int c = 0; c < xs.count; ++c) {
                const auto& [z, dz] = zs.cell[static_cast<std::size_t>(a)];
                const auto& [y, dy] = ys.cell[static_cast<std::size_t>(b)];
                const auto& [x, dx] = xs.cell[static_cast<std::size_t>(c)];
                const std::int32_t index = (z * cells.n[1] + y) * cells.n[0] + x; // there are few cells per grain
                const auto at = static_cast<std::size_t>(index);
                if (cells.begin[at + 1] > cells.begin[static_cast<std::size_t>(cell)]) // only j > i is wanted
                    ranges.push_back({cells.begin[at], cells.begin[at + 1], Vec3(dx, dy, dz)});
            }
}

bool excluded(const std::vector<GrainGroup>& groups, std::int32_t a, std::int32_t b) {
    const Motion first = groups[static_cast<std::size_t>(a)].motion,
                 second = groups[static_cast<std::size_t>(b)].motion;
    return (first == Motion::fixed && second == Motion::fixed) || (a == b && first == Motion::block);
}

struct Found {
    std::vector<std::int32_t> i, j;
};

/// Pairs owned by the grains [begin, end) that are no farther apart than `margin` [m].
void search(const Cells& cells, const Grains& grains, const std::vector<GrainGroup>& groups, const Domain& domain,
            double margin, std::size_t begin, std::size_t end, Found& found) {
    std::vector<Stretch> ranges;
    std::int32_t cell = -1;
    const bool any_excluded =
        std::any_of(groups.begin(), groups.end(), [](const GrainGroup& g) { return g.motion != Motion::free; });
    const bool narrow = cells.n[0] < 3 || cells.n[1] < 3 || cells.n[2] < 3;
    for (std::size_t i = begin; i < end; ++i) {
        const std::int32_t now = cells.of(grains.x[i]);
        if (now != cell) collect(cells, domain, cell = now, ranges);
        const double reach_i = grains.radius[i] + margin;
        for (const Stretch& range : ranges) {
            const Vec3 xi = grains.x[i] + range.shift;
            for (auto j = static_cast<std::size_t>(std::max(range.begin, static_cast<std::int32_t>(i) + 1));
                 j < static_cast<std::size_t>(range.end); ++j) {
                Vec3 dx = xi - grains.x[j];
                if (narrow) dx = domain.minimum_image(dx);
                const double reach = reach_i + grains.radius[j];
                if (dx.squaredNorm() >= reach * reach) continue;
                if (any_excluded && excluded(groups, grains.group[i], grains.group[j])) continue;
                found.i.push_back(static_cast<std::int32_t>(i));
                found.j.push_back(static_cast<std::int32_t>(j));
            }
        }
    }
}

/// Lists the pairs in ascending order of i and pads them with the index of the record that touches nothing.
void list_pairs(Neighbours& list, const Cells& cells, const Grains& grains, const std::vector<GrainGroup>& groups,
                const Domain& domain) {
    const std::size_t n = grains.size();
    std::vector<Found> found((n + parallel_chunk - 1) / parallel_chunk);
    parallel_chunks(n, [&](std::size_t begin, std::size_t end) {
        search(cells, grains, groups, domain, list.reach + list.skin, begin, end, found[begin / parallel_chunk]);
    });
    list.count = 0;
    for (const Found& part : found) list.count += part.i.size();
    const std::size_t padded = (list.count + 7) / 8 * 8;
    list.i.assign(padded, static_cast<std::int32_t>(n));
    list.j.assign(padded, static_cast<std::int32_t>(n));
    std::size_t at = 0;
    for (const Found& part : found) {
        std::copy(part.i.begin(), part.i.end(), list.i.begin() + static_cast<std::ptrdiff_t>(at));
        std::copy(part.j.begin(), part.j.end(), list.j.begin() + static_cast<std::ptrdiff_t>(at));
        at += part.i.size();
    }
}

/// Both ways from a grain to its pairs.
void index_pairs(Neighbours& list, std::size_t n) {
    list.own.assign(n + 1, 0);
    list.incoming_begin.assign(n + 1, 0);
    for (std::size_t p = 0; p < list.count; ++p) {
        ++list.own[static_cast<std::size_t>(list.i[p]) + 1];
        ++list.incoming_begin[static_cast<std::size_t>(list.j[p]) + 1];
    }
    for (std::size_t k = 0; k < n; ++k) {
        list.own[k + 1] += list.own[k];
        list.incoming_begin[k + 1] += list.incoming_begin[k];
    }
    std::vector<std::int32_t> next(list.incoming_begin.begin(), list.incoming_begin.end());
    list.incoming.resize(list.count);
    for (std::size_t p = 0; p < list.count; ++p)
        list.incoming[static_cast<std::size_t>(next[static_cast<std::size_t>(list.j[p])]++)] =
            static_cast<std::int32_t>(p);
}

/// Slots of the forces of every grain; the line after the last pair is the zero.
void fill_slots(Neighbours& list, std::size_t n) {
    const auto zero = static_cast<std::int32_t>(list.padded());
    list.slots.resize(n);
    parallel_for(n, [&](std::size_t k) {
        for (std::int32_t q = 0; q < ForceSlots::width; ++q) {
            const std::int32_t own = list.own[k] + q, other = list.incoming_begin[k] + q;
            ForceSlots& slots = list.slots[k];
            slots.own[static_cast<std::size_t>(q)] = own < list.own[k + 1] ? own : zero;
            slots.incoming[static_cast<std::size_t>(q)] =
                other < list.incoming_begin[k + 1] ? list.incoming[static_cast<std::size_t>(other)] : zero;
        }
    });
}

void mark_crossings(Neighbours& list, const Grains& grains, const Domain& domain) {
    list.crosses.assign(list.padded() / 8, 0);
    const Vec3 half = 0.5 * domain.size;
    parallel_for(list.crosses.size(), [&](std::size_t block) {
        for (std::size_t p = 8 * block; p < std::min(list.count, 8 * block + 8); ++p) {
            const Vec3 dx =
                grains.x[static_cast<std::size_t>(list.i[p])] - grains.x[static_cast<std::size_t>(list.j[p])];
            for (int c = 0; c < 3; ++c)
                if (domain.periodic[static_cast<std::size_t>(c)] && std::abs(dx[c]) > half[c]) list.crosses[block] = 1;
        }
    });
}

void restore(Neighbours& list, const Grains& grains, const std::vector<RememberedContact>& memory) {
    const std::vector<std::int32_t> place = positions_of_ids(grains);
    for (const RememberedContact& contact : memory) {
        const std::int32_t first = place[static_cast<std::size_t>(contact.first)];
        const std::int32_t second = place[static_cast<std::size_t>(contact.second)];
        const auto owner = static_cast<std::size_t>(std::min(first, second));
        const double sign = first < second ? 1.0 : -1.0;
        for (auto p = static_cast<std::size_t>(list.own[owner]); p < static_cast<std::size_t>(list.own[owner + 1]); ++p)
            if (list.j[p] == std::max(first, second)) {
                for (int h = 0; h < list.history; ++h)
                    list.remembered(p, h) = sign * contact.stretch[static_cast<std::size_t>(h)];
                if (list.bridges) list.bridge[p] = contact.bridge;
            }
    }
}

} // namespace

std::vector<RememberedContact> remembered_contacts(const Neighbours& list, const Grains& grains) {
    std::vector<RememberedContact> memory;
    if (list.history == 0 && !list.bridges) return memory;
    memory.reserve(list.count);
    for (std::size_t p = 0; p < list.count; ++p) {
        RememberedContact contact{
            grains.id[static_cast<std::size_t>(list.i[p])], grains.id[static_cast<std::size_t>(list.j[p])], {}};
        if (list.bridges) contact.bridge = list.bridge[p];
        bool any = contact.bridge != 0.0;
        for (int h = 0; h < list.history; ++h) {
            contact.stretch[static_cast<std::size_t>(h)] = list.remembered(p, h);
            any = any || contact.stretch[static_cast<std::size_t>(h)] != 0.0;
        }
        if (any) memory.push_back(contact);
    }
    return memory;
}

std::vector<std::int32_t> rebuild(Neighbours& list, Grains& grains, const std::vector<GrainGroup>& groups,
                                  const Domain& domain, const std::vector<RememberedContact>& memory) {
    for (std::size_t k = 0; k < grains.size(); ++k) {
        const Vec3 inside = domain.wrapped(grains.x[k]);
        for (int c = 0; c < 3; ++c) grains.turns[k][c] += std::nearbyint((grains.x[k][c] - inside[c]) / domain.size[c]);
        grains.x[k] = inside;
    }
    const double largest = grains.radius.empty() ? 0.0 : *std::max_element(grains.radius.begin(), grains.radius.end());
    Cells cells = sized_cells(domain, 2.0 * largest + list.reach + list.skin, grains.size());
    std::vector<std::int32_t> order = sort_by_cell(cells, grains);
    grains.x_listed = grains.x;
    list_pairs(list, cells, grains, groups, domain);
    index_pairs(list, grains.size());
    fill_slots(list, grains.size());
    mark_crossings(list, grains, domain);
    list.stretch.assign(list.padded() * static_cast<std::size_t>(list.history), 0.0);
    list.bridge.assign(list.bridges ? list.padded() : 0, 0.0);
    restore(list, grains, memory);
    list.force.assign(list.padded() + 1, PairForce{});
    list.couple.assign(list.rolls ? list.padded() : 0, PairCouple{});
    return order;
}

} // namespace plumb
