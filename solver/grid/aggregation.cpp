#include "grid/aggregation.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb {

namespace {

constexpr double strong = 0.25;    // times the strongest coupling of a row: what may be joined
constexpr double dominant = 2.0;   // times all couplings of a row: a diagonal that one sweep halves the error of
constexpr double rounding = 1e-10; // of the diagonals added up: a joint unknown that nothing holds

/// Entry (row, column) off the diagonal, 0 where there is none.
double entry(const Equations& a, std::size_t row, int column) {
    const auto first = a.column.begin() + a.begin[row], last = a.column.begin() + a.begin[row + 1];
    const auto found = std::lower_bound(first, last, column);
    return found != last && *found == column ? a.value[static_cast<std::size_t>(found - a.column.begin())] : 0.0;
}

/// Calls visit(place of the entry) for the row.
template <class Visit> void for_each_entry(const Equations& a, std::size_t row, Visit&& visit) {
    for (auto e = static_cast<std::size_t>(a.begin[row]); e < static_cast<std::size_t>(a.begin[row + 1]); ++e) visit(e);
}

bool rules_itself(const Equations& a, std::size_t row) {
    double sum = 0.0;
    for_each_entry(a, row, [&](std::size_t e) { sum += std::abs(a.value[e]); });
    return a.diagonal[row] >= dominant * sum;
}

/// The unknowns most strongly coupled to `row` in the symmetric part, -1 where none is: of the free ones, and of those
/// that are part of a joint unknown already.
struct Partners {
    int free = -1, taken = -1;
};
Partners partners(const Equations& a, std::size_t row, const std::vector<int>& of) {
    double most = 0.0, best_free = 0.0, best_taken = 0.0;
    Partners found;
    for_each_entry(a, row, [&](std::size_t e) {
        const auto k = static_cast<std::size_t>(a.column[e]);
        const double coupling = -(a.value[e] + entry(a, k, static_cast<int>(row)));
        most = std::max(most, coupling);
        if (of[k] == -2 && coupling > best_free * (1.0 + 1e-6)) best_free = coupling, found.free = a.column[e];
        if (of[k] >= 0 && coupling > best_taken * (1.0 + 1e-6)) best_taken = coupling, found.taken = a.column[e];
    });
    if (best_free < strong * most) found.free = -1;
    if (best_taken < strong * most) found.taken = -1;
    return found;
}

/// The rows of every joint unknown, by its number.
struct Members {
    std::vector<int> begin, row;
};
Members members(const Aggregates& g) {
    Members m;
    m.begin.assign(static_cast<std::size_t>(g.count) + 1, 0);
    for (const int of : g.of)
        if (of >= 0) ++m.begin[static_cast<std::size_t>(of) + 1];
    std::partial_sum(m.begin.begin(), m.begin.end(), m.begin.begin());
    m.row.resize(static_cast<std::size_t>(m.begin.back()));
    std::vector<int> next(m.begin.begin(), m.begin.end() - 1);
    for (std::size_t k = 0; k < g.of.size(); ++k)
        if (g.of[k] >= 0)
            m.row[static_cast<std::size_t>(next[static_cast<std::size_t>(g.of[k])]++)] = static_cast<int>(k);
    return m;
}

/// Rows whose entries have been made in too long a store, moved together.
void close_gaps(Equations& a, const std::vector<int>& from, const std::vector<int>& count) {
    const std::size_t n = a.size();
    a.begin.assign(n + 1, 0);
    std::partial_sum(count.begin(), count.end(), a.begin.begin() + 1);
    std::vector<int> column(static_cast<std::size_t>(a.begin[n]));
    std::vector<double> value(column.size());
    parallel_for(n, [&](std::size_t k) {
        std::copy_n(a.column.begin() + from[k], count[k], column.begin() + a.begin[k]);
        std::copy_n(a.value.begin() + from[k], count[k], value.begin() + a.begin[k]);
    });
    a.column.swap(column);
    a.value.swap(value);
}

} // namespace

Equations equations(const RowMatrix& m) {
    const auto n = static_cast<std::size_t>(m.rows());
    Equations a;
    a.diagonal.assign(n, 0.0);
    a.column.resize(static_cast<std::size_t>(m.nonZeros()));
    a.value.resize(a.column.size());
    std::vector<int> from(m.outerIndexPtr(), m.outerIndexPtr() + n), count(n, 0);
    parallel_for(n, [&](std::size_t k) {
        auto at = static_cast<std::size_t>(from[k]);
        for (RowMatrix::InnerIterator e(m, static_cast<Eigen::Index>(k)); e; ++e) {
            if (e.row() == e.col()) {
                a.diagonal[k] = e.value();
                continue;
            }
            a.column[at] = static_cast<int>(e.col());
            a.value[at++] = e.value();
        }
        count[k] = static_cast<int>(at) - from[k];
    });
    close_gaps(a, from, count);
    return a;
}

Equations without_positive_couplings(Equations a) {
    const Equations given = a;
    parallel_for(a.size(), [&](std::size_t k) {
        for_each_entry(a, k, [&](std::size_t e) {
            const double back = entry(given, static_cast<std::size_t>(a.column[e]), static_cast<int>(k));
            const double taken = std::max({0.0, a.value[e], back});
            a.diagonal[k] += taken;
            a.value[e] -= taken;
        });
    });
    return a;
}

Aggregates pairs(const Equations& a) {
    Aggregates made;
    const std::size_t n = a.size();
    made.of.assign(n, -2);
    parallel_for(n, [&](std::size_t k) {
        if (rules_itself(a, k)) made.of[k] = -1;
    });
    for (std::size_t k = 0; k < n; ++k) {
        if (made.of[k] != -2) continue;
        const Partners near = partners(a, k, made.of);
        if (near.free < 0 && near.taken >= 0) {
            made.of[k] = made.of[static_cast<std::size_t>(near.taken)];
            continue;
        }
        made.of[k] = made.count;
        if (near.free >= 0) made.of[static_cast<std::size_t>(near.free)] = made.count;
        ++made.count;
    }
    return made;
}

Equations joined(const Equations& fine, const Aggregates& g) {
    const auto n = static_cast<std::size_t>(g.count);
    const Members m = members(g);
    const auto begin = [&](std::size_t k) { return m.row.begin() + m.begin[k]; };
    std::vector<int> from(n + 1, 0), count(n, 0);
    for (std::size_t k = 0; k < n; ++k) {
        from[k + 1] = from[k];
        for (auto row = begin(k); row != begin(k + 1); ++row)
            from[k + 1] += fine.begin[static_cast<std::size_t>(*row) + 1] - fine.begin[static_cast<std::size_t>(*row)];
    }
    Equations a;
    a.diagonal.assign(n, 0.0);
    a.column.resize(static_cast<std::size_t>(from[n]));
    a.value.resize(a.column.size());
    parallel_for(n, [&](std::size_t k) {
        const auto first = static_cast<std::size_t>(from[k]);
        std::size_t last = first;
        double size = 0.0;
        const auto add = [&](int column, double value) {
            std::size_t at = last;
            while (at > first && a.column[at - 1] >= column) --at;
            if (at < last && a.column[at] == column) {
                a.value[at] += value;
                return;
            }
            for (std::size_t e = last++; e > at; --e) a.column[e] = a.column[e - 1], a.value[e] = a.value[e - 1];
            a.column[at] = column;
            a.value[at] = value;
        };
        for (auto member = begin(k); member != begin(k + 1); ++member) {
            const auto row = static_cast<std::size_t>(*member);
            a.diagonal[k] += fine.diagonal[row];
            size += fine.diagonal[row];
            for_each_entry(fine, row, [&](std::size_t e) {
                const int column = g.of[static_cast<std::size_t>(fine.column[e])];
                if (column == static_cast<int>(k))
                    a.diagonal[k] += fine.value[e];
                else if (column >= 0)
                    add(column, fine.value[e]);
            });
        }
        count[k] = static_cast<int>(last - first);
        if (count[k] == 0 && a.diagonal[k] <= rounding * size) a.diagonal[k] = 0.0; // a pocket: known up to a constant
    });
    from.pop_back();
    close_gaps(a, from, count);
    return a;
}

} // namespace plumb
