// How long a step may be, and which bound rules.
#pragma once

#include "core/table.hpp"
#include "dem/grain_system.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

struct StepLimit {
    std::string name;    // key in time.safety
    double seconds;      // predicted bound times its safety factor; infinity when the scene has no such bound
    std::string formula; // with the numbers' meaning
};

/// Times of a run. Step k ends at exactly k dt; outputs are whole numbers of steps apart.
struct Timing {
    double end = 0.0;             // [s]
    double output_interval = 0.0; // [s]
    double dt = 0.0;              // [s]
    std::int64_t steps_per_output = 0;
    std::int64_t outputs = 0; // after the one at t = 0
    bool snapshots = false;
    std::vector<StepLimit> limits;
    std::string ruling; // name of the least limit, "output_interval" or "given"
};

/// Limits of the grains: the contact time of the fastest pair over `steps_per_contact`, for every pair of materials.
std::vector<StepLimit> grain_limits(const GrainSystem& system);

/// Reads the [time] table and chooses the step. InputError when an explicit step does not divide the intervals.
Timing timing(Table& time, std::vector<StepLimit> limits);

} // namespace plumb
