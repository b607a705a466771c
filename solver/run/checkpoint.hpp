// The complete state of a run in one file. A run that goes on from it has the bits of the unbroken one.
#pragma once

#include "run/run_state.hpp"

#include <string>

namespace plumb {

/// Writes `run`, which has cost `cost` so far, aside and renames. Throws IoError.
void save_checkpoint(const std::string& path, const Run& run, const Cost& cost);

/// The run saved at `path`. Throws IoError if the file is absent, truncated or damaged, and InputError if it belongs to
/// another format or if its scene is no longer understood as it was.
Run load_checkpoint(const std::string& path);

} // namespace plumb
