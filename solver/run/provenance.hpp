// Where a result comes from and what it cost: run.json.
#pragma once

#include "schemes/simulation.hpp"

#include <chrono>
#include <optional>
#include <string>

namespace plumb {

/// What a run has cost. A resumed run adds to what was spent before.
struct Cost {
    double wall_s = 0.0;
    double cpu_s = 0.0;
    std::int64_t peak_bytes = 0; // largest resident set
    double updates = 0.0;        // grain steps: sum over the steps of the number of grains
};

/// Measures the cost of this process from its construction on.
class CostMeter {
public:
    explicit CostMeter(Cost before = {}) : before_(before) {}
    void add_updates(double updates) { before_.updates += updates; }
    Cost now() const;

private:
    Cost before_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The date and time of now in UTC, ISO 8601.
std::string iso_time();

/// "plumb 1.2.3 (commit, compiler)".
std::string version_text();

/// Text of run.json. `exit` is absent while the run goes on; `start` is the ISO time of the first start.
std::string provenance_json(const Scene& scene, const Simulation& simulation, const std::string& start,
                            const Cost& cost, std::optional<int> exit);

} // namespace plumb
