// The one time loop.
#pragma once

#include "core/errors.hpp"
#include "run/run_state.hpp"

namespace plumb {

/// Takes `run` to its end, from wherever it stands, and writes its results to `folder`: run.json at once, then at
/// outputs the probes' series, snapshots if asked for, the index and a checkpoint. What depends on the clock (how often
/// files are renewed, how many steps are taken at once, progress) never changes a result.
///
/// Returns `interrupted` after SIGINT or SIGTERM, with a checkpoint of the last whole step. Throws Diverged, naming the
/// file with the last state, and IoError; run.json then holds the exit code as well.
ExitCode run_to_end(Run& run, const ResultFolder& folder, bool quiet);

} // namespace plumb
