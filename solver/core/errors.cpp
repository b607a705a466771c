#include "core/errors.hpp"

#include <fmt/format.h>

#include <utility>

namespace plumb {

Diverged::Diverged(std::int64_t step_, double time_, std::string field_, std::int64_t index_, double value_,
                   std::string likely_limit_)
    : std::runtime_error(fmt::format("diverged in step {} at t = {:.6g} s: {} of {} {} is {:.6g}; {}", step_, time_,
                                     field_, field_.starts_with("fluid") ? "particle" : "grain", index_, value_,
                                     likely_limit_)),
      step(step_), time(time_), field(std::move(field_)), index(index_), value(value_),
      likely_limit(std::move(likely_limit_)) {}

} // namespace plumb
