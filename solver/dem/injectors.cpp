#include "dem/injectors.hpp"

#include "core/csv.hpp"
#include "dem/sphere_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb {

namespace {

constexpr double same_time = 1e-9;                  // of an interval: time is a rounded multiple of the step
constexpr std::int64_t most_events = 1'000'000'000; // per point; more is a mistyped interval

std::int32_t group_index(Table& table, const std::vector<GrainGroup>& groups) {
    const std::string name = table.text("group");
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const GrainGroup& g) { return g.name == name; });
    if (found == groups.end()) table.fail("group", fmt::format("there is no group \"{}\"", name));
    if (found->motion != Motion::free)
        table.fail("group", fmt::format("the grains of \"{}\" do not move freely", name));
    return static_cast<std::int32_t>(found - groups.begin());
}

void read_points(Table& table, Injector& injector) {
    const bool listed = std::holds_alternative<FileDiameters>(injector.diameter);
    if (table.has("points") == table.has("path")) table.fail("points", "give either points or path");
    if (table.has("points")) {
        if (listed) table.fail("diameter", "the law \"file\" needs path instead of points");
        injector.points = table.points("points");
        if (injector.points.empty()) table.fail("points", "has no point");
        return;
    }
    const Csv csv(input_path(table, "path"));
    injector.points = points(csv);
    if (listed) injector.point_diameter = csv.column("diameter", "m");
    for (std::size_t p = 0; p < injector.point_diameter.size(); ++p)
        if (!(injector.point_diameter[p] > 0.0))
            csv.fail(p, fmt::format("the diameter {} is not positive", injector.point_diameter[p]));
    csv.allow_only(listed ? std::vector<std::string_view>{"x", "y", "z", "diameter"}
                          : std::vector<std::string_view>{"x", "y", "z"});
}

double largest_radius(const Injector& injector, std::size_t point) {
    if (!injector.point_diameter.empty()) return 0.5 * injector.point_diameter[point];
    return 0.5 * std::visit([](const auto& law) { return law.largest(); }, injector.diameter);
}

/// A grid of the injector's points with the largest grains they may release.
SphereGrid grid_of_points(const Injector& injector, const Domain& domain) {
    const std::size_t count = injector.points.size();
    Vec3 lower = injector.points[0], upper = lower;
    double sum = 0.0;
    for (std::size_t p = 0; p < count; ++p) {
        lower = lower.cwiseMin(injector.points[p]);
        upper = upper.cwiseMax(injector.points[p]);
        sum += largest_radius(injector, p);
    }
    return SphereGrid(domain, lower, upper, 2.0 * sum / static_cast<double>(count), count);
}

void check_points(Table& table, Injector& injector, const Domain& domain, const std::vector<WallBody>& walls) {
    SphereGrid grid = grid_of_points(injector, domain);
    for (std::size_t p = 0; p < injector.points.size(); ++p) {
        const double radius = largest_radius(injector, p);
        const Vec3 x = injector.points[p] = domain.wrapped(injector.points[p]);
        const auto fail = [&](const std::string& what) {
            table.fail(table.has("points") ? "points" : "path",
                       fmt::format("point {} at ({:.9g}, {:.9g}, {:.9g}) m {}", p, x.x(), x.y(), x.z(), what));
        };
        for (Eigen::Index c = 0; c < 3; ++c)
            if (!(x[c] >= 0.0 && x[c] <= domain.size[c])) fail("is outside the domain");
        for (const WallBody& wall : walls)
            wall.touch(x, radius, 0.0, [&](const WallPoint&) {
                fail(fmt::format("is nearer to the wall \"{}\" than the largest radius, {:.9g} m", wall.name, radius));
            });
        grid.any_near(x, radius, [&](std::int32_t q) {
            const auto other = static_cast<std::size_t>(q);
            const double apart = radius + largest_radius(injector, other);
            if (domain.minimum_image(x - injector.points[other]).norm() < apart)
                fail(fmt::format("is nearer to point {} than the largest diameter, {:.9g} m", q, apart));
            return false;
        });
        grid.insert(static_cast<std::int32_t>(p), x, radius);
    }
}

} // namespace

double Injector::drawn_diameter(std::size_t point, std::int64_t number) const {
    return std::visit(
        [&](const auto& law) {
            Random random = random_stream(law.seed, Stream::injected, static_cast<std::int64_t>(point), number);
            return law(random, point_diameter.empty() ? 0.0 : point_diameter[point]);
        },
        diameter);
}

std::int64_t Injector::events_due(double time) const {
    const double slack = same_time * interval;
    const double last = std::min(time, end - 2.0 * slack); // an event at `end` itself, to round-off, is out
    if (last + slack < start) return 0;
    auto due = static_cast<std::int64_t>((last - start) / interval);
    while (due > 0 && event_time(due - 1) > last + slack) --due;
    while (event_time(due) <= last + slack) ++due;
    return due;
}

std::int64_t Injected::total() const { return std::accumulate(count.begin(), count.end(), std::int64_t{0}); }

Injector make_injector(Table& table, const std::vector<GrainGroup>& groups, const Domain& domain,
                       const std::vector<WallBody>& walls) {
    Injector injector;
    injector.group = group_index(table, groups);
    injector.diameter = make_diameters(table);
    read_points(table, injector);
    injector.interval = table.number("interval", positive);
    injector.velocity = table.vector("velocity");
    injector.start = table.number("start", non_negative);
    injector.end = table.number("end", Range{injector.start, std::numeric_limits<double>::max(), true, false});
    if ((injector.end - injector.start) / injector.interval > static_cast<double>(most_events))
        table.fail("interval", fmt::format("{} gives more than {} events", injector.interval, most_events));
    check_points(table, injector, domain, walls);
    return injector;
}

Injected nothing_injected(const Injector& injector) { return {std::vector<std::int64_t>(injector.points.size(), 0)}; }

std::size_t inject(Grains& grains, Injected& done, const Injector& injector, const std::vector<GrainGroup>& groups,
                   const Domain& domain, double time) {
    const std::int64_t due = injector.events_due(time);
    const std::size_t count = injector.points.size();
    if (std::all_of(done.count.begin(), done.count.end(), [&](std::int64_t n) { return n >= due; })) return 0;

    std::vector<double> radius(count, 0.0); // of the next grain of each point that has one due
    SphereGrid grid = grid_of_points(injector, domain);
    for (std::size_t p = 0; p < count; ++p) {
        if (done.count[p] >= due) continue;
        radius[p] = 0.5 * injector.drawn_diameter(p, done.count[p]);
        grid.insert(static_cast<std::int32_t>(p), injector.points[p], radius[p]);
    }
    std::vector<bool> taken(count, false);
    for (std::size_t i = 0; i < grains.size(); ++i)
        grid.any_near(grains.x[i], grains.radius[i], [&](std::int32_t index) {
            const auto p = static_cast<std::size_t>(index);
            const double apart = radius[p] + grains.radius[i];
            if (domain.minimum_image(grains.x[i] - injector.points[p]).squaredNorm() < apart * apart) taken[p] = true;
            return false;
        });
    std::size_t added = 0;
    for (std::size_t p = 0; p < count; ++p) {
        if (done.count[p] >= due || taken[p]) continue;
        add_grain(grains, groups, injector.group, radius[p], injector.points[p], injector.velocity, Vec3::Zero());
        ++done.count[p];
        ++added;
    }
    return added;
}

std::int64_t waiting(const Injector& injector, const Injected& done, double time) {
    const std::int64_t due = injector.events_due(time);
    std::int64_t sum = 0;
    for (const std::int64_t n : done.count) sum += due - n;
    return sum;
}

} // namespace plumb
