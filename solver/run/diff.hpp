// Bit by bit comparison of two results.
#pragma once

#include <string>

namespace plumb {

struct Comparison {
    bool same = false;
    std::string text; // what was compared, or where the first difference is
};

/// Compares series, snapshots and the last checkpoint of two result folders, in this order, without provenance and
/// cost. The first difference is named with file, dataset, time, index and both values; in the series it is the one at
/// the earliest time. InputError for a folder without a result, IoError for a file that cannot be read.
Comparison difference(const std::string& a, const std::string& b);

} // namespace plumb
