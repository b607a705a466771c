#include "core/errors.hpp"

#include <fmt/format.h>

#include <utility>

namespace plumb {

namespace {

/// Of what a field is; a number below zero is none's.
std::string owner(const std::string& field, std::int64_t index) {
    if (index < 0) return "";
    return fmt::format(" of {} {}", field.starts_with("fluid") ? "particle" : "grain", index);
}

} // namespace

Diverged::Diverged(std::int64_t step_, double time_, std::string field_, std::int64_t index_, double value_,
                   std::string likely_limit_)
    : std::runtime_error(fmt::format("diverged in step {} at t = {:.6g} s: {}{} is {:.6g}; {}", step_, time_, field_,
                                     owner(field_, index_), value_, likely_limit_)),
      step(step_), time(time_), field(std::move(field_)), index(index_), value(value_),
      likely_limit(std::move(likely_limit_)) {}

} // namespace plumb
