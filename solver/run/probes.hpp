// Probes: named series of one quantity over time.
#pragma once

#include "run/probe_quantities.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace plumb {

struct Probe {
    std::string name;
    ProbeQuantity quantity;
    std::int64_t steps = 1;    // between two records
    std::vector<double> time;  // [s], one per record
    std::vector<double> value; // `width` per record
    std::size_t width = 1;     // numbers per record: 1, or the number of grains

    /// True for quantities with one value per grain, even if there is one grain only.
    bool per_grain() const;
    std::string units() const;
};

/// Reads the [[probe]] tables. InputError for an unknown quantity, names that are used twice or not made of
/// letters, digits, "_", "-" and ".", an interval that is not a whole number of steps, or whatever the quantity
/// refuses.
std::vector<Probe> read_probes(Scene& scene, const Simulation& simulation);

/// Appends the value of every probe that is due now. Throws nothing.
void record(std::vector<Probe>& probes, const Simulation& simulation);

/// The first step after `step` at which a probe is due; `end` if none is before.
std::int64_t next_record(const std::vector<Probe>& probes, std::int64_t step, std::int64_t end);

} // namespace plumb
