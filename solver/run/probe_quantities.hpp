// What a probe can measure. A quantity is a law of the family ProbeQuantity: besides name and info it has
//     static constexpr std::string_view units
//     void bind(const Simulation&, const Table&)    optional: checks and resolves names against the scene
//     operator()(const Sample&) const               the value, or a vector with one value per grain by id
// To add one: write the struct, name it in ProbeQuantity at the end, add its test and its README row.
// Sums run in the order of ids, so that neither threads nor the sorting of the grains change a bit.
#pragma once

#include "core/laws.hpp"
#include "run/fluid_probes.hpp"
#include "run/sample.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace plumb {

/// Key `axis`: the component that is meant.
struct Component {
    Eigen::Index axis;
    explicit Component(Table& table);
    double of(const Vec3& v) const { return v[axis]; }
};

/// Key `grain`: one grain, by its order of creation.
struct OneGrain {
    std::size_t id;
    explicit OneGrain(Table& table);
    void bind(const Simulation& simulation, const Table& table) const;
};

/// Key `group`: the grains of one group, or all without it.
struct Members {
    std::optional<std::string> name;
    std::int32_t group = -1;
    explicit Members(Table& table);
    void bind(const Simulation& simulation, const Table& table);
    bool contain(const Grains& grains, std::size_t k) const { return group < 0 || grains.group[k] == group; }
    double count(const Sample& sample) const;
};

struct GrainPosition {
    static constexpr std::string_view name = "grain_position", units = "m";
    static constexpr LawInfo info{"x[axis] of `grain`, not brought back into a periodic box", "any", "definition"};
    OneGrain grain;
    Component component;
    explicit GrainPosition(Table& table) : grain(table), component(table) {}
    void bind(const Simulation& s, const Table& t) const { grain.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainVelocity {
    static constexpr std::string_view name = "grain_velocity", units = "m/s";
    static constexpr LawInfo info{"v[axis] of `grain`", "any", "definition"};
    OneGrain grain;
    Component component;
    explicit GrainVelocity(Table& table) : grain(table), component(table) {}
    void bind(const Simulation& s, const Table& t) const { grain.bind(s, t); }
    double operator()(const Sample& s) const { return component.of(s.grains.v[s.at(grain.id)]); }
};

struct GrainAngularVelocity {
    static constexpr std::string_view name = "grain_angular_velocity", units = "rad/s";
    static constexpr LawInfo info{"omega[axis] of `grain`", "any", "definition"};
    OneGrain grain;
    Component component;
    explicit GrainAngularVelocity(Table& table) : grain(table), component(table) {}
    void bind(const Simulation& s, const Table& t) const { grain.bind(s, t); }
    double operator()(const Sample& s) const { return component.of(s.grains.omega[s.at(grain.id)]); }
};

struct GrainForce {
    static constexpr std::string_view name = "grain_force", units = "N";
    static constexpr LawInfo info{"sum of the contact forces on `grain`, [axis]", "any", "definition"};
    OneGrain grain;
    Component component;
    explicit GrainForce(Table& table) : grain(table), component(table) {}
    void bind(const Simulation& s, const Table& t) const { grain.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainMeanPosition {
    static constexpr std::string_view name = "grain_mean_position", units = "m";
    static constexpr LawInfo info{"1/n sum x[axis], not brought back into a periodic box", "any", "definition"};
    Members members;
    Component component;
    explicit GrainMeanPosition(Table& table) : members(table), component(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainMeanVelocity {
    static constexpr std::string_view name = "grain_mean_velocity", units = "m/s";
    static constexpr LawInfo info{"1/n sum v[axis]", "any", "definition"};
    Members members;
    Component component;
    explicit GrainMeanVelocity(Table& table) : members(table), component(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainKineticEnergy {
    static constexpr std::string_view name = "grain_kinetic_energy", units = "J";
    static constexpr LawInfo info{"sum 1/2 m v^2 + 1/2 I omega^2, I = 2/5 m R^2", "any", "definition"};
    Members members;
    explicit GrainKineticEnergy(Table& table) : members(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainContactEnergy {
    static constexpr std::string_view name = "grain_contact_energy", units = "J";
    static constexpr LawInfo info{"energy of all contacts: 1/2 k o^2 + 1/2 k_t s^2; Hertz 8/15 E* sqrt(R*) o^2.5 + "
                                  "1/2 S_t s^2; rolling spring 1/2 k_r b^2; bridge -(work to its rupture)",
                                  "any", "definition; Johnson 1985, Contact Mechanics, eq. 4.23 (Hertz)"};
    explicit GrainContactEnergy(Table& /*table*/) {}
    double operator()(const Sample& s) const;
};

struct GrainPotentialEnergy {
    static constexpr std::string_view name = "grain_potential_energy", units = "J";
    static constexpr LawInfo info{"-sum m g . x, x not brought back into a periodic box", "any", "definition"};
    Members members;
    explicit GrainPotentialEnergy(Table& table) : members(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainTotalEnergy {
    static constexpr std::string_view name = "grain_total_energy", units = "J";
    static constexpr LawInfo info{"kinetic + contact + potential energy of all grains", "any", "definition"};
    GrainKineticEnergy kinetic;
    GrainContactEnergy contact;
    GrainPotentialEnergy potential;
    explicit GrainTotalEnergy(Table& table) : kinetic(table), contact(table), potential(table) {}
    void bind(const Simulation& s, const Table& t) const;
    double operator()(const Sample& s) const { return kinetic(s) + contact(s) + potential(s); }
};

struct GrainMomentum {
    static constexpr std::string_view name = "grain_momentum", units = "kg m/s";
    static constexpr LawInfo info{"sum m v[axis]", "any", "definition"};
    Members members;
    Component component;
    explicit GrainMomentum(Table& table) : members(table), component(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainAngularMomentum {
    static constexpr std::string_view name = "grain_angular_momentum", units = "kg m2/s";
    static constexpr LawInfo info{"sum (m x cross v + I omega)[axis] about the origin",
                                  "the two other axes are not periodic", "definition"};
    Members members;
    Component component;
    explicit GrainAngularMomentum(Table& table) : members(table), component(table) {}
    void bind(const Simulation& s, const Table& t);
    double operator()(const Sample& s) const;
};

struct GranularTemperature {
    static constexpr std::string_view name = "granular_temperature", units = "m2/s2";
    static constexpr LawInfo info{"sum m |v - V|^2 / (3 sum m), V = sum m v / sum m", "any",
                                  "Haff 1983, J. Fluid Mech. 134, 401"};
    Members members;
    explicit GranularTemperature(Table& table) : members(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const;
};

struct GrainCount {
    static constexpr std::string_view name = "grain_count", units = "1";
    static constexpr LawInfo info{"number of grains", "any", "definition"};
    Members members;
    explicit GrainCount(Table& table) : members(table) {}
    void bind(const Simulation& s, const Table& t) { members.bind(s, t); }
    double operator()(const Sample& s) const { return members.count(s); }
};

struct ContactCount {
    static constexpr std::string_view name = "contact_count", units = "1";
    static constexpr LawInfo info{"pairs of grains in contact + contact points with walls", "any", "definition"};
    explicit ContactCount(Table& /*table*/) {}
    double operator()(const Sample& s) const;
};

struct BridgeCount {
    static constexpr std::string_view name = "bridge_count", units = "1";
    static constexpr LawInfo info{"liquid bridges between grains + those to walls, in contact or not", "any",
                                  "definition"};
    explicit BridgeCount(Table& /*table*/) {}
    double operator()(const Sample& s) const;
};

struct CoordinationNumber {
    static constexpr std::string_view name = "coordination_number", units = "1";
    static constexpr LawInfo info{"(2 pairs + wall contacts) / n: contacts of a grain on average", "any", "definition"};
    explicit CoordinationNumber(Table& /*table*/) {}
    double operator()(const Sample& s) const;
};

struct MaxOverlap {
    static constexpr std::string_view name = "max_overlap", units = "m";
    static constexpr LawInfo info{"largest overlap of all contacts, 0 without any", "any", "definition"};
    explicit MaxOverlap(Table& /*table*/) {}
    double operator()(const Sample& s) const;
};

/// Key `wall`: the name of a [[wall]].
struct WallForce {
    static constexpr std::string_view name = "wall_force", units = "N";
    static constexpr LawInfo info{"force of the grains on `wall`, [axis]", "any", "definition"};
    std::string wall;
    std::int32_t index = -1;
    Component component;
    explicit WallForce(Table& table) : wall(table.text("wall")), component(table) {}
    void bind(const Simulation& s, const Table& t);
    double operator()(const Sample& s) const;
};

/// Keys `lower`, `upper`: a box. Along an axis where it spans the whole domain it also counts what sticks out there.
struct PackingFraction {
    static constexpr std::string_view name = "packing_fraction", units = "1";
    static constexpr LawInfo info{
        "volume of the spheres in the box from `lower` to `upper` / its volume; exact for slabs, "
        "1e-6 of a sphere at edges; overlaps of spheres count twice",
        "any", "definition"};
    Vec3 lower, upper;
    explicit PackingFraction(Table& table) : lower(table.vector("lower")), upper(table.vector("upper")) {}
    void bind(const Simulation& s, const Table& t) const;
    double operator()(const Sample& s) const;
};

struct GrainFluidForce {
    static constexpr std::string_view name = "grain_fluid_force", units = "N";
    static constexpr LawInfo info{"mean force of the fluid in the last step on `grain`, or on all (of `group`), [axis]",
                                  "with a fluid", "definition"};
    std::optional<OneGrain> grain;
    Members members;
    Component component;
    explicit GrainFluidForce(Table& table);
    void bind(const Simulation& s, const Table& t);
    double operator()(const Sample& s) const;
};

struct GrainDragForce {
    static constexpr std::string_view name = "grain_drag_force", units = "N";
    static constexpr LawInfo info{"mean drag [axis] in the last step on every grain, by order of creation",
                                  "with a fluid, without injectors", "definition"};
    Component component;
    explicit GrainDragForce(Table& table) : component(table) {}
    static void bind(const Simulation& s, const Table& t);
    std::vector<double> operator()(const Sample& s) const;
};

struct GrainVelocities {
    static constexpr std::string_view name = "grain_velocities", units = "m/s";
    static constexpr LawInfo info{"v[axis] of every grain, by order of creation", "without injectors", "definition"};
    Component component;
    explicit GrainVelocities(Table& table) : component(table) {}
    static void bind(const Simulation& s, const Table& t);
    std::vector<double> operator()(const Sample& s) const;
};

struct GrainAngularVelocities {
    static constexpr std::string_view name = "grain_angular_velocities", units = "rad/s";
    static constexpr LawInfo info{"omega[axis] of every grain, by order of creation", "without injectors",
                                  "definition"};
    Component component;
    explicit GrainAngularVelocities(Table& table) : component(table) {}
    static void bind(const Simulation& s, const Table& t);
    std::vector<double> operator()(const Sample& s) const;
};

using ProbeQuantity =
    std::variant<GrainPosition, GrainVelocity, GrainAngularVelocity, GrainForce, GrainMeanPosition, GrainMeanVelocity,
                 GrainKineticEnergy, GrainContactEnergy, GrainPotentialEnergy, GrainTotalEnergy, GrainMomentum,
                 GrainAngularMomentum, GranularTemperature, GrainCount, ContactCount, BridgeCount, CoordinationNumber,
                 MaxOverlap, WallForce, PackingFraction, GrainFluidForce, GrainDragForce, GrainVelocities,
                 GrainAngularVelocities, FluidKineticEnergy, FluidMeanVelocity, FluidGreatestSpeed, FluidSecondMoment,
                 FluidVelocityWave, FluidMeanPressure, FluidGreatestPressure, FluidFlowRate>;

} // namespace plumb
