// Eight neighbouring entries of a field as a pack: group g is entries 8 g to 8 g + 7.
#pragma once

#include "core/field.hpp"
#include "core/simd.hpp"

#include <cstring>

namespace plumb {

/// The eight numbers from an address on, aligned or not.
[[gnu::always_inline]] inline Pack load(const double* at) {
    Pack value;
    std::memcpy(&value, at, sizeof value);
    return value;
}
[[gnu::always_inline]] inline void store(double* at, Pack value) { std::memcpy(at, &value, sizeof value); }

[[gnu::always_inline]] inline Pack load(const Field<double>& field, std::size_t group) {
    return load(&field[pack_width * group]);
}

[[gnu::always_inline]] inline void store(Field<double>& field, std::size_t group, Pack value) {
    store(&field[pack_width * group], value);
}

[[gnu::always_inline]] inline void add(Field<double>& field, std::size_t group, Pack change) {
    store(field, group, load(field, group) + change);
}

} // namespace plumb
