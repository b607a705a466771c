// The three ways a run can end badly, each with its exit code. Thrown anywhere, caught once, in main.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace plumb {

enum class ExitCode : int { done = 0, invalid_input = 2, diverged = 3, io_failure = 4, interrupted = 130 };

/// The scene, the command line or a file named by them cannot be used as it is (exit code 2).
class InputError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Reading or writing failed for a reason outside the scene: disk full, no permission, broken file (exit code 4).
class IoError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The solution left the range in which the scheme means anything (exit code 3).
class Diverged : public std::runtime_error {
public:
    /// `field` at `index` (grain id or fluid particle) took `value` in `step`; `likely_limit` says which bound was
    /// broken.
    Diverged(std::int64_t step, double time, std::string field, std::int64_t index, double value,
             std::string likely_limit);

    std::int64_t step;
    double time; // [s]
    std::string field;
    std::int64_t index;
    double value;
    std::string likely_limit;
};

} // namespace plumb
