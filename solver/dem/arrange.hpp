// Where the grains are at the start: one law per kind of arrangement, and the reader of the [grains] tables.
//
// The regions [lower, upper) of all laws bound the centres of the grains.
#pragma once

#include "core/csv.hpp"
#include "core/domain.hpp"
#include "core/laws.hpp"
#include "core/walls.hpp"
#include "dem/grains.hpp"
#include "dem/start_laws.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace plumb {

/// What an arrangement may have to respect.
struct Site {
    const Domain& domain;
    const Grains& present; // grains of the tables before
    const std::vector<WallBody>& walls;
};

/// A group that starts empty: its grains come from an injector.
struct NoGrains {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"no grains at the start", "groups of injectors", "-"};
    NoGrains() = default;
    std::size_t count(const Domain& /*domain*/) const { return 0; }
    std::vector<Vec3> operator()(const Site& /*site*/, const std::vector<double>& /*radius*/) const { return {}; }
};

struct SingleGrain {
    static constexpr std::string_view name = "single";
    static constexpr LawInfo info{"x = position", "inside the domain", "-"};
    explicit SingleGrain(Table& table) : position(table.vector("position")) {}
    Vec3 position; // [m]
    std::size_t count(const Domain& /*domain*/) const { return 1; }
    std::vector<Vec3> operator()(const Site& /*site*/, const std::vector<double>& /*radius*/) const {
        return {position};
    }
};

/// A crystal whose first point is `lower`. A region that spans a periodic box must hold a whole number of cells, so
/// that the crystal continues across the side.
struct Lattice {
    static constexpr std::string_view name = "lattice";
    static constexpr LawInfo info{
        "kind cubic, bcc, fcc: spacing = edge of the cubic cell; hcp: spacing = distance of centres",
        "periodic sides: whole number of cells within 1e-9", "-"};
    explicit Lattice(Table& table);
    std::string kind;
    double spacing;    // [m]
    Vec3 lower, upper; // [m]
    std::size_t count(const Domain& domain) const;
    std::vector<Vec3> operator()(const Site& site, const std::vector<double>& radius) const;

private:
    struct Cells {
        Vec3 edges;                                      // of the cell [m]
        std::vector<Vec3> places;                        // of the points in a cell, in edges
        std::vector<std::array<std::int64_t, 3>> counts; // of cells per place and axis
    };
    Cells cells(const Domain& domain) const;
    Table table_; // for messages
};

/// What arrangements of a stated number of grains by chance share: how many, where and with which seed.
struct CountedPlaces {
    explicit CountedPlaces(Table& table);
    std::int64_t number;
    Vec3 lower, upper; // [m]
    std::int64_t seed;
    std::size_t count(const Domain& /*domain*/) const { return static_cast<std::size_t>(number); }

protected:
    Table table_; // for messages
};

/// Random sequential addition: each grain in turn takes the first of a sequence of random places where it overlaps
/// neither a grain nor a wall.
struct RandomPlaces : CountedPlaces {
    static constexpr std::string_view name = "random";
    static constexpr LawInfo info{"uniform in [lower, upper), drawn again on overlap",
                                  "solid fraction up to about 0.38",
                                  "Zhang & Torquato 2013, Phys. Rev. E 88, 053312 (saturation at 0.3841)"};
    static constexpr std::int64_t most_tries = 200'000; // per grain; one in 4e4 succeeds at a solid fraction of 0.36
    using CountedPlaces::CountedPlaces;
    std::vector<Vec3> operator()(const Site& site, const std::vector<double>& radius) const;

private:
    [[noreturn]] void fail(std::size_t reached, const std::vector<double>& radius) const;
};

/// A loose close packing whose points are moved at random, as far as leaves grains apart, and left out where a wall is:
/// for columns too dense for random addition, to be let settle.
struct JitteredPlaces : CountedPlaces {
    static constexpr std::string_view name = "jittered";
    static constexpr LawInfo info{"fcc, centres `spacing` apart, each moved within a ball of radius jitter; the lowest "
                                  "`count` that no wall touches",
                                  "2 jitter <= spacing - diameter; solid fraction up to 0.74 (diameter/spacing)^3",
                                  "-"};
    explicit JitteredPlaces(Table& table);
    double spacing, jitter; // [m]
    std::vector<Vec3> operator()(const Site& site, const std::vector<double>& radius) const;
};

/// A CSV file with the columns x, y, z [m], and diameter [m] or vx, vy, vz [m/s] if the laws of sizes or velocities say
/// so.
struct FilePlaces {
    static constexpr std::string_view name = "file";
    static constexpr LawInfo info{"columns x [m], y [m], z [m] of a CSV file", "inside the domain", "-"};
    explicit FilePlaces(Table& table) : csv(input_path(table, "path")) {}
    Csv csv;
    std::size_t count(const Domain& /*domain*/) const { return csv.rows(); }
    std::vector<Vec3> operator()(const Site& /*site*/, const std::vector<double>& /*radius*/) const {
        return points(csv);
    }
};

using Arrangement = std::variant<NoGrains, SingleGrain, Lattice, RandomPlaces, JitteredPlaces, FilePlaces>;

/// Reads all [grains] tables in turn: appends to `groups` and `grains`. Keys: name (required if there are several),
/// density, diameter, rotation (true when absent), motion ("free" when absent), arrange, velocity and angular_velocity
/// (at rest when absent). `contact` and `overlap` are left to their readers. Positions are wrapped into the box along
/// periodic axes. InputError as the laws say, and for more than 10^8 grains.
void add_grains(Grains& grains, std::vector<GrainGroup>& groups, std::vector<Table>& tables, const Domain& domain,
                const std::vector<WallBody>& walls);

/// True if grains of the two groups (indices) push each other; the others may overlap.
using PairTouches = std::function<bool(std::int32_t, std::int32_t)>;

/// Throws InputError naming group, index and position for a grain that is outside the domain, larger than a periodic
/// box, or overlaps a wall or another grain by more than 5 % of the (smaller) radius. Overlaps are allowed in groups
/// whose table says `overlap = "allow"`, among fixed grains and within a block. Takes O(N) operations.
void check_start(const Grains& grains, const std::vector<GrainGroup>& groups, std::vector<Table>& tables,
                 const Domain& domain, const std::vector<WallBody>& walls, const PairTouches& pair_touches);

} // namespace plumb
