// What a run says while it goes on.
#pragma once

#include "run/run_state.hpp"

#include <chrono>
#include <string>

namespace plumb {

/// On a terminal one line that is redrawn, else one line per output interval; nothing when quiet. Writes to stdout.
class Progress {
public:
    Progress(bool quiet, const Run& run);

    /// After some steps that did `updates` grain steps.
    void show(const Run& run, double updates);
    /// After an output was written.
    void show_output(const Run& run);
    /// One last line.
    void end(const std::string& text);

private:
    using Clock = std::chrono::steady_clock;
    std::string line(const Run& run) const;

    bool quiet_;
    bool terminal_;
    std::int64_t first_step_;
    double updates_ = 0.0;  // grain steps of this process
    std::size_t shown_ = 0; // length of the line on the terminal
    Clock::time_point start_ = Clock::now(), drawn_ = start_;
};

} // namespace plumb
