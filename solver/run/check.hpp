// `plumb check`: what a scene means in numbers, before it is run.
#pragma once

#include "run/run_state.hpp"

#include <string>

namespace plumb {

/// Derived numbers of a run that has not started: grains, contact times, step limits, dimensionless numbers of the
/// grains in the fluid, predicted cost, and which models could matter or do nothing. As text, or the same as JSON.
std::string check_report(const Run& run, bool json);

} // namespace plumb
