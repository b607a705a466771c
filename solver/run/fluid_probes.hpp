// Probes of a computed fluid: means over smoothed particles, in the order of ids, or over the volume of a grid.
#pragma once

#include "core/laws.hpp"
#include "run/sample.hpp"

#include <string_view>

namespace plumb {

/// InputError for a scene without a fluid that is computed.
void demand_computed_fluid(const Simulation& s, const Table& t);

struct FluidKineticEnergy {
    static constexpr std::string_view name = "fluid_kinetic_energy", units = "m2/s2";
    static constexpr LawInfo info{"mean of v^2/2 over particles or volume", "sph and grid", "definition"};
    explicit FluidKineticEnergy(Table& /*table*/) {}
    static void bind(const Simulation& s, const Table& t) { demand_computed_fluid(s, t); }
    double operator()(const Sample& s) const;
};

struct FluidMeanVelocity {
    static constexpr std::string_view name = "fluid_mean_velocity", units = "m/s";
    static constexpr LawInfo info{"mean of v[axis] over particles or volume", "sph and grid", "definition"};
    std::size_t axis;
    explicit FluidMeanVelocity(Table& table);
    static void bind(const Simulation& s, const Table& t) { demand_computed_fluid(s, t); }
    double operator()(const Sample& s) const;
};

struct FluidGreatestSpeed {
    static constexpr std::string_view name = "fluid_greatest_speed", units = "m/s";
    static constexpr LawInfo info{"max |v|", "sph and grid", "definition"};
    explicit FluidGreatestSpeed(Table& /*table*/) {}
    static void bind(const Simulation& s, const Table& t) { demand_computed_fluid(s, t); }
    double operator()(const Sample& s) const;
};

/// Variance of the particles' places along an axis: R^2/4 of a disc, R^2/5 of a ball. Not across periodic sides.
struct FluidSecondMoment {
    static constexpr std::string_view name = "fluid_second_moment", units = "m2";
    static constexpr LawInfo info{"mean of (x[axis] - its mean)^2 over particles", "sph", "definition"};
    std::size_t axis;
    explicit FluidSecondMoment(Table& table);
    static void bind(const Simulation& s, const Table& t);
    double operator()(const Sample& s) const;
};

/// Amplitude of one wave in a velocity component, by projection: 2/n sum v[axis] sin(k x) or cos(k x).
struct FluidVelocityWave {
    static constexpr std::string_view name = "fluid_velocity_wave", units = "m/s";
    static constexpr LawInfo info{"2 times the mean of v[axis] sin or cos (2 pi waves x[along]/size)", "sph and grid",
                                  "definition"};
    std::size_t axis, along;
    double waves;
    bool sine;
    explicit FluidVelocityWave(Table& table);
    static void bind(const Simulation& s, const Table& t) { demand_computed_fluid(s, t); }
    double operator()(const Sample& s) const;
};

/// Keys `lower`, `upper`: a box; the particles, or the cells whose centres, lie in it.
struct FluidMeanPressure {
    static constexpr std::string_view name = "fluid_mean_pressure", units = "Pa";
    static constexpr LawInfo info{
        "mean of p over the room of particles, or the open volume of cells with centres, from "
        "`lower` to `upper`",
        "sph and grid", "definition"};
    Vec3 lower, upper;
    explicit FluidMeanPressure(Table& table);
    void bind(const Simulation& s, const Table& t) const;
    double operator()(const Sample& s) const;
};

/// The pressure of a sliver that a wall leaves of a cell is hardly felt by anything, so it may be anything.
struct FluidGreatestPressure {
    static constexpr std::string_view name = "fluid_greatest_pressure", units = "Pa";
    static constexpr LawInfo info{"max p over the cells that are half open at least", "grid", "definition"};
    explicit FluidGreatestPressure(Table& /*table*/) {}
    static void bind(const Simulation& s, const Table& t);
    double operator()(const Sample& s) const;
};

/// Keys `axis`, `at` [m]: the row of faces nearest to a place.
struct FluidFlowRate {
    static constexpr std::string_view name = "fluid_flow_rate", units = "m3/s";
    static constexpr LawInfo info{"sum of eps u[axis] over the open area of the faces nearest to `at`", "grid",
                                  "definition"};
    std::size_t axis;
    double at;
    explicit FluidFlowRate(Table& table);
    static void bind(const Simulation& s, const Table& t);
    double operator()(const Sample& s) const;
};

} // namespace plumb
