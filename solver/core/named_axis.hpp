// An axis that a scene names.
#pragma once

#include "core/table.hpp"

namespace plumb::detail {

/// Index of the axis "x", "y" or "z" at `key`.
inline Eigen::Index axis(Table& table, std::string_view key) {
    return static_cast<Eigen::Index>(axis_names.find(table.choice(key, {"x", "y", "z"})));
}

} // namespace plumb::detail
