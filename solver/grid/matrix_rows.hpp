// Sparse matrices made row by row, by several threads.
#pragma once

#include "core/parallel.hpp"
#include "grid/grid_fluid.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace plumb {

/// Entries of a row of a matrix, in the order of their columns.
struct Entries {
    struct Entry {
        int column;
        double value;
    };
    std::array<Entry, 26> entry; // those from `size` on are not set
    std::size_t size = 0;

    void put(int column, double value) {
        std::size_t at = size;
        while (at > 0 && entry[at - 1].column >= column) --at;
        if (at < size && entry[at].column == column) {
            entry[at].value += value;
            return;
        }
        for (std::size_t e = size++; e > at; --e) entry[e] = entry[e - 1];
        entry[at] = {column, value};
    }
};

/// A matrix, a share of its rows after the other.
struct MatrixRows {
    std::vector<int> count, column;
    std::vector<double> value;

    void add(const Entries& entries) {
        count.push_back(static_cast<int>(entries.size));
        for (std::size_t e = 0; e < entries.size; ++e) {
            column.push_back(entries.entry[e].column);
            value.push_back(entries.entry[e].value);
        }
    }
};

inline RowMatrix matrix_of(const std::vector<MatrixRows>& parts, Eigen::Index n) {
    RowMatrix matrix(n, n);
    int* begin = matrix.outerIndexPtr();
    std::vector<std::size_t> first; // row of each part
    Eigen::Index row = 0;
    begin[0] = 0;
    for (const MatrixRows& part : parts) {
        first.push_back(static_cast<std::size_t>(row));
        for (const int count : part.count) begin[row + 1] = begin[row] + count, ++row;
    }
    matrix.resizeNonZeros(begin[n]);
    parallel_for(parts.size(), [&](std::size_t q) {
        std::copy(parts[q].column.begin(), parts[q].column.end(), matrix.innerIndexPtr() + begin[first[q]]);
        std::copy(parts[q].value.begin(), parts[q].value.end(), matrix.valuePtr() + begin[first[q]]);
    });
    return matrix;
}

} // namespace plumb
