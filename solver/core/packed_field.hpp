// Eight neighbouring entries of a field as a pack: group g is entries 8 g to 8 g + 7.
#pragma once

#include "core/field.hpp"
#include "core/simd.hpp"

#include <cstring>

namespace plumb {

[[gnu::always_inline]] inline Pack load(const Field<double>& field, std::size_t group) {
    Pack value;
    std::memcpy(&value, &field[pack_width * group], sizeof value);
    return value;
}

[[gnu::always_inline]] inline void store(Field<double>& field, std::size_t group, Pack value) {
    std::memcpy(&field[pack_width * group], &value, sizeof value);
}

[[gnu::always_inline]] inline void add(Field<double>& field, std::size_t group, Pack change) {
    store(field, group, load(field, group) + change);
}

} // namespace plumb
