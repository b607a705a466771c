#include "grid/slices.hpp"

#include <algorithm>

namespace plumb {

namespace {

/// Calls visit(row, column, value) for the rows of a slice, diagonals too.
template <class Visit> void for_each_in_slice(const Equations& a, std::size_t slice, Visit&& visit) {
    const std::size_t end = std::min(a.size(), (slice + 1) * lanes);
    for (std::size_t row = slice * lanes; row < end; ++row) {
        visit(row, static_cast<int>(row), a.diagonal[row]);
        for (auto e = static_cast<std::size_t>(a.begin[row]); e < static_cast<std::size_t>(a.begin[row + 1]); ++e)
            visit(row, a.column[e], a.value[e]);
    }
}

/// Column less row of every diagonal that occurs in a slice, ascending.
void find_diagonals(const Equations& a, std::size_t slice, std::vector<int>& found) {
    found.clear();
    for_each_in_slice(a, slice, [&](std::size_t row, int column, double /*value*/) {
        const int offset = column - static_cast<int>(row);
        const auto place = std::lower_bound(found.begin(), found.end(), offset);
        if (place == found.end() || *place != offset) found.insert(place, offset);
    });
}

} // namespace

Slices slices(const Equations& a) {
    Slices made;
    const std::size_t count = (a.size() + lanes - 1) / lanes;
    made.begin.assign(count + 1, 0);
    std::vector<std::vector<int>> offsets((count + parallel_chunk - 1) / parallel_chunk); // of the slices of a chunk
    parallel_chunks(count, [&](std::size_t begin, std::size_t end) {
        std::vector<int> found;
        std::vector<int>& all = offsets[begin / parallel_chunk];
        for (std::size_t s = begin; s < end; ++s) {
            find_diagonals(a, s, found);
            made.begin[s + 1] = static_cast<int>(found.size());
            all.insert(all.end(), found.begin(), found.end());
        }
    });
    for (std::size_t s = 0; s < count; ++s) made.begin[s + 1] += made.begin[s];
    made.first.resize(static_cast<std::size_t>(made.begin[count]));
    made.value.assign(lanes * made.first.size(), 0.0F);
    parallel_chunks(count, [&](std::size_t begin, std::size_t end) {
        const int* found = offsets[begin / parallel_chunk].data();
        for (std::size_t s = begin; s < end; ++s) {
            const auto from = static_cast<std::size_t>(made.begin[s]);
            const int* last = found + (made.begin[s + 1] - made.begin[s]);
            for (const int* q = found; q != last; ++q)
                made.first[from + static_cast<std::size_t>(q - found)] = *q + static_cast<int>((s + 1) * lanes);
            for_each_in_slice(a, s, [&](std::size_t row, int column, double value) {
                const int* place = std::lower_bound(found, last, column - static_cast<int>(row));
                made.value[(from + static_cast<std::size_t>(place - found)) * lanes + row % lanes] =
                    static_cast<float>(value);
            });
            found = last;
        }
    });
    return made;
}

} // namespace plumb
