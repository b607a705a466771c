// Random numbers with the same bits everywhere: the standard fixes the engine, but not its distributions.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace plumb {

class Random {
public:
    explicit Random(std::int64_t seed) : engine_(static_cast<std::uint64_t>(seed)) {}

    /// Uniform in [0, 1), 53 bits.
    double uniform() { return static_cast<double>(engine_() >> 11U) * 0x1.0p-53; }
    double uniform(double lower, double upper) { return lower + (upper - lower) * uniform(); }

    /// Standard normal deviate, polar method of Marsaglia & Bray (1964).
    double normal() {
        for (;;) {
            const double a = uniform(-1.0, 1.0);
            const double b = uniform(-1.0, 1.0);
            const double s = a * a + b * b;
            if (s > 0.0 && s < 1.0) return a * std::sqrt(-2.0 * std::log(s) / s);
        }
    }

private:
    std::mt19937_64 engine_;
};

} // namespace plumb
