// The only place that knows about threads. A loop body writes its own index only and sums run over fixed chunks in a
// fixed order, hence the same bits for any number of threads.
#pragma once

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <exception>
#include <vector>

namespace plumb {

inline constexpr std::size_t parallel_chunk = 512; // items; independent of the thread count, so chunked sums are too

/// Number of threads used by every loop from now on, at least 1.
inline void set_threads(int n) { omp_set_num_threads(std::max(1, n)); }
inline int thread_count() { return omp_get_max_threads(); }

/// Calls body(begin, end) for consecutive chunks that cover [0, n). Chunks may run at the same time in any order.
/// An exception in a chunk is rethrown after the loop; with several, that of the lowest chunk, as a serial loop would.
template <class Body> void parallel_chunks(std::size_t n, Body&& body, std::size_t chunk = parallel_chunk) {
    const auto chunks = static_cast<std::ptrdiff_t>((n + chunk - 1) / chunk);
    const auto range = [&](std::ptrdiff_t c) {
        const auto begin = static_cast<std::size_t>(c) * chunk;
        body(begin, std::min(n, begin + chunk));
    };
    if (chunks <= 1 || omp_get_max_threads() == 1) {
        for (std::ptrdiff_t c = 0; c < chunks; ++c) range(c);
        return;
    }
    std::vector<std::exception_ptr> faults(static_cast<std::size_t>(chunks));
#pragma omp parallel for schedule(static)
    for (std::ptrdiff_t c = 0; c < chunks; ++c) {
        try {
            range(c);
        } catch (...) {
            faults[static_cast<std::size_t>(c)] = std::current_exception();
        }
    }
    for (const auto& fault : faults)
        if (fault) std::rethrow_exception(fault);
}

/// Calls body(i) for every i in [0, n).
template <class Body> void parallel_for(std::size_t n, Body&& body) {
    parallel_chunks(n, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Sum of term(i) over [0, n): within fixed chunks, then over the chunks, both in ascending order.
template <class T, class Term> T ordered_sum(std::size_t n, T zero, Term&& term) {
    std::vector<T> part((n + parallel_chunk - 1) / parallel_chunk, zero);
    parallel_chunks(n, [&](std::size_t begin, std::size_t end) {
        T sum = zero;
        for (std::size_t i = begin; i < end; ++i) sum += term(i);
        part[begin / parallel_chunk] = sum;
    });
    T total = zero;
    for (const T& p : part) total += p;
    return total;
}

} // namespace plumb
