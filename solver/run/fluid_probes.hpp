// Probes of the smoothed particles. Sums run in the order of ids, as those over grains.
#pragma once

#include "core/laws.hpp"
#include "run/sample.hpp"

#include <string_view>

namespace plumb {

/// InputError for a scene without smoothed particles.
void demand_particles(const Simulation& s, const Table& t);

struct FluidKineticEnergy {
    static constexpr std::string_view name = "fluid_kinetic_energy", units = "m2/s2";
    static constexpr LawInfo info{"1/n sum v^2/2 over the fluid's particles", "fluid.method = \"sph\"", "definition"};
    explicit FluidKineticEnergy(Table& /*table*/) {}
    static void bind(const Simulation& s, const Table& t) { demand_particles(s, t); }
    double operator()(const Sample& s) const;
};

struct FluidMeanVelocity {
    static constexpr std::string_view name = "fluid_mean_velocity", units = "m/s";
    static constexpr LawInfo info{"1/n sum v[axis]", "fluid.method = \"sph\"", "definition"};
    std::size_t axis;
    explicit FluidMeanVelocity(Table& table);
    static void bind(const Simulation& s, const Table& t) { demand_particles(s, t); }
    double operator()(const Sample& s) const;
};

struct FluidGreatestSpeed {
    static constexpr std::string_view name = "fluid_greatest_speed", units = "m/s";
    static constexpr LawInfo info{"max |v|", "fluid.method = \"sph\"", "definition"};
    explicit FluidGreatestSpeed(Table& /*table*/) {}
    static void bind(const Simulation& s, const Table& t) { demand_particles(s, t); }
    double operator()(const Sample& s) const;
};

/// Amplitude of one wave in a velocity component, by projection: 2/n sum v[axis] sin(k x) or cos(k x).
struct FluidVelocityWave {
    static constexpr std::string_view name = "fluid_velocity_wave", units = "m/s";
    static constexpr LawInfo info{"2/n sum v[axis] sin or cos (2 pi waves x[along]/size)", "fluid.method = \"sph\"",
                                  "definition"};
    std::size_t axis, along;
    double waves;
    bool sine;
    explicit FluidVelocityWave(Table& table);
    static void bind(const Simulation& s, const Table& t) { demand_particles(s, t); }
    double operator()(const Sample& s) const;
};

} // namespace plumb
