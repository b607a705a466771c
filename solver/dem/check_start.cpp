// Is the start a state that the contact laws can begin with?
#include "core/errors.hpp"
#include "dem/arrange.hpp"
#include "dem/sphere_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb {

namespace {

// Overlap over the smaller radius. The contact laws hold for overlap << radius; a crystal under load (centre distance
// 0.995 d, overlap 0.01 R) is far below, a mistyped length far above.
constexpr double most_overlap = 0.05;

struct Start {
    const Grains& grains;
    const std::vector<GrainGroup>& groups;
    const std::vector<Table>& tables;
    const Domain& domain;

    std::size_t group(std::size_t i) const { return static_cast<std::size_t>(grains.group[i]); }
    std::string described(std::size_t i) const {
        const Vec3& x = grains.x[i];
        const auto first = std::find(grains.group.begin(), grains.group.end(), grains.group[i]) - grains.group.begin();
        return fmt::format("grain {} of group \"{}\" (id {}) at ({:.9g}, {:.9g}, {:.9g}) m",
                           i - static_cast<std::size_t>(first), groups[group(i)].name, grains.id[i], x.x(), x.y(),
                           x.z());
    }
    [[noreturn]] void fail(std::size_t i, const std::string& what) const {
        tables[group(i)].fail("arrange", fmt::format("{} {}", described(i), what));
    }
};

void check_sides(const Start& start) {
    for (std::size_t i = 0; i < start.grains.size(); ++i)
        for (Eigen::Index c = 0; c < 3; ++c) {
            const double x = start.grains.x[i][c], size = start.domain.size[c];
            const char axis = axis_names[static_cast<std::size_t>(c)];
            if (!start.domain.periodic[static_cast<std::size_t>(c)]) {
                if (!(x >= 0.0 && x <= size))
                    start.fail(i, fmt::format("is outside the domain: {} is not in [0, {:.9g}] m", axis, size));
            } else if (2.0 * start.grains.radius[i] > size) {
                start.fail(i, fmt::format("has a diameter of {:.9g} m, larger than the periodic box along {}, {:.9g} m",
                                          2.0 * start.grains.radius[i], axis, size));
            }
        }
}

void check_walls(const Start& start, const std::vector<WallBody>& walls, const std::vector<bool>& may_overlap) {
    for (std::size_t i = 0; i < start.grains.size(); ++i) {
        if (may_overlap[start.group(i)] || start.groups[start.group(i)].motion == Motion::fixed) continue;
        const double radius = start.grains.radius[i];
        for (const WallBody& wall : walls)
            wall.touch(start.grains.x[i], radius * (1.0 - most_overlap), 0.0, [&](const WallPoint& point) {
                start.fail(
                    i, fmt::format("overlaps the wall \"{}\" by {:.3g} of its radius at the start; allowed is {:g} (or "
                                   "overlap = \"allow\")",
                                   wall.name, 1.0 - point.distance / radius, most_overlap));
            });
    }
}

void check_pairs(const Start& start, const std::vector<bool>& may_overlap, const PairTouches& pair_touches) {
    const Grains& grains = start.grains;
    if (grains.size() == 0) return;
    const auto is_free_to_overlap = [&](std::size_t i, std::size_t j) {
        const std::size_t a = start.group(i), b = start.group(j);
        const Motion of_a = start.groups[a].motion, of_b = start.groups[b].motion;
        return may_overlap[a] || may_overlap[b] || (of_a == Motion::fixed && of_b == Motion::fixed) ||
               (a == b && of_a == Motion::block) || !pair_touches(grains.group[i], grains.group[j]);
    };
    Vec3 lower = grains.x[0], upper = grains.x[0];
    for (const Vec3& x : grains.x) lower = lower.cwiseMin(x), upper = upper.cwiseMax(x);
    const double sum = std::accumulate(grains.radius.begin(), grains.radius.end(), 0.0);
    SphereGrid grid(start.domain, lower, upper, 2.0 * sum / static_cast<double>(grains.size()), grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const auto check = [&](std::int32_t other) {
            const auto j = static_cast<std::size_t>(other);
            const double smaller = std::min(grains.radius[i], grains.radius[j]);
            const double distance = start.domain.minimum_image(grains.x[i] - grains.x[j]).norm();
            const double overlap = grains.radius[i] + grains.radius[j] - distance;
            if (overlap > most_overlap * smaller && !is_free_to_overlap(i, j))
                start.fail(
                    i,
                    fmt::format("overlaps {} by {:.3g} of the smaller radius at the start; allowed is {:g} (or overlap "
                                "= \"allow\")",
                                start.described(j), overlap / smaller, most_overlap));
            return false;
        };
        grid.any_near(grains.x[i], grains.radius[i], check);
        grid.insert(static_cast<std::int32_t>(i), grains.x[i], grains.radius[i]);
    }
}

} // namespace

void check_start(const Grains& grains, const std::vector<GrainGroup>& groups, std::vector<Table>& tables,
                 const Domain& domain, const std::vector<WallBody>& walls, const PairTouches& pair_touches) {
    std::vector<bool> may_overlap;
    may_overlap.reserve(tables.size());
    for (Table& table : tables)
        may_overlap.push_back(table.has("overlap") && table.choice("overlap", {"allow", "forbid"}) == "allow");
    const Start start{grains, groups, tables, domain};
    check_sides(start);
    check_walls(start, walls, may_overlap);
    check_pairs(start, may_overlap, pair_touches);
}

} // namespace plumb
