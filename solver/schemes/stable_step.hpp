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

/// Shortest contact of two materials: that of their smallest grains.
struct PairTime {
    std::size_t a, b; // groups, or walls from groups.size() on
    double seconds;   // infinite when they pass through each other
};

/// The smallest grains of two materials, there or to come.
struct SizePair {
    std::size_t a, b;      // as above
    double inverse_mass;   // 1/m_a + 1/m_b, a wall's is 0 [1/kg]
    double inverse_radius; // 1/R_a + 1/R_b likewise [1/m]
    double smaller_radius; // [m]
    double lighter_mass;   // [kg]
};
std::vector<SizePair> least_pairs(const GrainSystem& system);

/// The bridge between the smallest grains of two materials.
struct PairBridge {
    SizePair pair;
    LiquidBridge law;
    double volume; // [m3]
};
std::vector<PairBridge> least_bridges(const GrainSystem& system);

/// InputError when a bridge has more liquid than its law is made for.
void check_bridges(const GrainSystem& system, const std::string& file);

/// One entry per pair of materials of which grains exist. `speed` [m/s] is that of the impact, for Hertzian contacts.
std::vector<PairTime> contact_times(const GrainSystem& system, double speed);

/// Limits of the grains: the shortest contact time over `steps_per_contact`, and with liquid bridges as many steps in
/// the time in which the steepest one pulls two grains together. A fluid carries grains at up to `fluid_speed` [m/s].
std::vector<StepLimit> grain_limits(const GrainSystem& system, double fluid_speed = 0.0);

/// Reads the [time] table and chooses the step. An automatic one divides the output interval and all
/// `probe_intervals` [s]. InputError when an explicit step does not divide the output interval, or when the intervals
/// have no common divisor near the limit.
Timing timing(Table& time, std::vector<StepLimit> limits, const std::vector<double>& probe_intervals = {});

} // namespace plumb
