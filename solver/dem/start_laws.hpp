// Sizes and first velocities of grains. Every random law has its own seed; the streams of sizes, places and velocities
// are independent even if their seeds are equal.
#pragma once

#include "core/laws.hpp"
#include "core/random.hpp"
#include "core/vec.hpp"

#include <cstdint>
#include <string_view>
#include <variant>

namespace plumb {

enum class Stream : std::uint64_t { diameters = 1, places = 2, velocities = 3, injected = 4 };

/// The random numbers of one purpose: seeds that differ in any argument give unrelated sequences.
Random random_stream(std::int64_t seed, Stream purpose, std::int64_t first = 0, std::int64_t second = 0);

// --- diameters [m]. `listed` is the diameter in the grain's row of a file, if there is one. ---

struct EqualDiameters {
    static constexpr std::string_view name = "equal";
    static constexpr LawInfo info{"d = value (also written diameter = value)", "value > 0", "-"};
    explicit EqualDiameters(double diameter) : value(diameter) {}
    explicit EqualDiameters(Table& table);
    double value;          // [m]
    std::int64_t seed = 0; // draws nothing
    double smallest() const { return value; }
    double largest() const { return value; }
    double operator()(Random& /*random*/, double /*listed*/) const { return value; }
};

struct UniformDiameters {
    static constexpr std::string_view name = "uniform";
    static constexpr LawInfo info{"d uniform in [minimum, maximum)", "0 < minimum < maximum", "-"};
    explicit UniformDiameters(Table& table);
    double minimum, maximum; // [m]
    std::int64_t seed;
    double smallest() const { return minimum; }
    double largest() const { return maximum; }
    double operator()(Random& random, double /*listed*/) const { return random.uniform(minimum, maximum); }
};

/// Normal deviates outside [minimum, maximum] are drawn again.
struct NormalDiameters {
    static constexpr std::string_view name = "normal";
    static constexpr LawInfo info{"d = mean + deviation N(0, 1), drawn again outside [minimum, maximum]",
                                  "minimum <= mean <= maximum, deviation <= maximum - minimum", "-"};
    explicit NormalDiameters(Table& table);
    double mean, deviation, minimum, maximum; // [m]
    std::int64_t seed;
    double smallest() const { return minimum; }
    double largest() const { return maximum; }
    double operator()(Random& random, double /*listed*/) const {
        for (;;) {
            const double d = mean + deviation * random.normal();
            if (d >= minimum && d <= maximum) return d;
        }
    }
};

struct FileDiameters {
    static constexpr std::string_view name = "file";
    static constexpr LawInfo info{"d = column \"diameter [m]\" of the file of places", "d > 0", "-"};
    FileDiameters() = default;
    std::int64_t seed = 0;
    double smallest() const { return 0.0; } // the file says
    double largest() const { return 0.0; }
    double operator()(Random& /*random*/, double listed) const { return listed; }
};

using DiameterLaw = std::variant<EqualDiameters, UniformDiameters, NormalDiameters, FileDiameters>;

/// The law at the key "diameter": a number [m] or a table.
DiameterLaw make_diameters(Table& owner);

// --- first velocities [m/s]. `listed` is the velocity in the grain's row of a file, if there is one. ---

struct EqualVelocity {
    static constexpr std::string_view name = "equal";
    static constexpr LawInfo info{"v = value (also written velocity = value)", "any", "-"};
    explicit EqualVelocity(const Vec3& velocity) : value(velocity) {}
    explicit EqualVelocity(Table& table) : value(table.vector("value")) {}
    Vec3 value;
    std::int64_t seed = 0;
    Vec3 operator()(Random& /*random*/, const Vec3& /*listed*/) const { return value; }
};

struct UniformRandomVelocity {
    static constexpr std::string_view name = "uniform_random";
    static constexpr LawInfo info{"each component uniform in [-speed, speed)", "speed >= 0", "-"};
    explicit UniformRandomVelocity(Table& table);
    double speed; // [m/s]
    std::int64_t seed;
    Vec3 operator()(Random& random, const Vec3& /*listed*/) const {
        const double x = random.uniform(-speed, speed), y = random.uniform(-speed, speed);
        return {x, y, random.uniform(-speed, speed)};
    }
};

/// The equilibrium of a gas of elastic spheres of one mass; the mean velocity of the group's mass is then removed.
struct MaxwellVelocity {
    static constexpr std::string_view name = "maxwell";
    static constexpr LawInfo info{"each component normal with deviation speed; the group's momentum is removed",
                                  "speed >= 0; a single grain is left at rest", "Maxwell 1860, Philos. Mag. 19, 19"};
    explicit MaxwellVelocity(Table& table);
    double speed; // standard deviation of a component [m/s]
    std::int64_t seed;
    Vec3 operator()(Random& random, const Vec3& /*listed*/) const {
        const double x = random.normal(), y = random.normal();
        return speed * Vec3(x, y, random.normal());
    }
};

struct FileVelocity {
    static constexpr std::string_view name = "file";
    static constexpr LawInfo info{"v = columns \"vx [m/s]\", \"vy [m/s]\", \"vz [m/s]\" of the file of places", "any",
                                  "-"};
    FileVelocity() = default;
    std::int64_t seed = 0;
    Vec3 operator()(Random& /*random*/, const Vec3& listed) const { return listed; }
};

using VelocityLaw = std::variant<EqualVelocity, UniformRandomVelocity, MaxwellVelocity, FileVelocity>;

/// The law at the key "velocity": three numbers [m/s] or a table; at rest when absent.
VelocityLaw make_velocity(Table& owner);

} // namespace plumb
