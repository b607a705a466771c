#include "dem/arrange.hpp"

#include "core/sphere.hpp"
#include "dem/sphere_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb {

namespace {

constexpr double most_grains = 1e8; // 30 GB of state: more is a mistyped length, not a scene

void read_region(Table& table, Vec3& lower, Vec3& upper) {
    lower = table.vector("lower");
    upper = table.vector("upper");
    for (Eigen::Index c = 0; c < 3; ++c)
        if (!(lower[c] < upper[c]))
            table.fail("upper", fmt::format("component {} is {}, not above lower, {}",
                                            axis_names[static_cast<std::size_t>(c)], upper[c], lower[c]));
}

/// Whether a grain at a place would touch a wall.
bool touches_wall(const Site& site, const Vec3& place, double radius) {
    bool touches = false;
    for (const WallBody& wall : site.walls) wall.touch(place, radius, 0.0, [&](const WallPoint&) { touches = true; });
    return touches;
}

std::vector<Vec3> places_in_cell(const std::string& kind) {
    if (kind == "cubic") return {{0.0, 0.0, 0.0}};
    if (kind == "bcc") return {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}};
    if (kind == "fcc") return {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}};
    // hcp: two close-packed layers; the second sits above the hollows of the first, 1/3 of the cell in y.
    return {{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.0, 1.0 / 3.0, 0.5}, {0.5, 5.0 / 6.0, 0.5}};
}

} // namespace

Lattice::Lattice(Table& table)
    : kind(table.choice("kind", {"cubic", "bcc", "fcc", "hcp"})), spacing(table.number("spacing", positive)),
      table_(table) {
    read_region(table, lower, upper);
}

Lattice::Cells Lattice::cells(const Domain& domain) const {
    constexpr double whole = 1e-9; // cells: far above the round-off of decimal lengths, far below a grain
    Cells found{Vec3::Constant(spacing), places_in_cell(kind), {}};
    if (kind == "hcp") found.edges = spacing * Vec3(1.0, std::sqrt(3.0), std::sqrt(8.0 / 3.0)); // ideal ratio of axes
    Vec3 number;
    for (Eigen::Index c = 0; c < 3; ++c) {
        const double length = upper[c] - lower[c];
        number[c] = length / found.edges[c];
        const double rounded = std::round(number[c]);
        const bool spans_period =
            domain.periodic[static_cast<std::size_t>(c)] && length >= domain.size[c] * (1.0 - whole);
        if (spans_period) {
            if (length > domain.size[c] * (1.0 + whole))
                table_.fail("upper", fmt::format("component {}: the region is longer than the periodic box",
                                                 axis_names[static_cast<std::size_t>(c)]));
            if (rounded < 1.0 || std::abs(number[c] - rounded) > whole * rounded)
                table_.fail("spacing",
                            fmt::format("{} puts {:.9g} cells along the periodic axis {}; expected a whole number",
                                        spacing, number[c], axis_names[static_cast<std::size_t>(c)]));
            found.edges[c] = domain.size[c] / rounded; // closes without a gap of round-off
            number[c] = rounded;
        }
    }
    for (const Vec3& place : found.places) {
        std::array<std::int64_t, 3> counts{};
        for (Eigen::Index c = 0; c < 3; ++c) {
            const double n =
                std::ceil(number[c] - place[c] - whole * std::max(1.0, number[c])); // half-open: upper is out
            if (n > most_grains)
                table_.fail("spacing", fmt::format("{} makes more than {:g} grains", spacing, most_grains));
            counts[static_cast<std::size_t>(c)] = std::max<std::int64_t>(0, static_cast<std::int64_t>(n));
        }
        found.counts.push_back(counts);
    }
    return found;
}

std::size_t Lattice::count(const Domain& domain) const {
    double total = 0.0;
    for (const auto& n : cells(domain).counts)
        total += static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
    if (total > most_grains)
        table_.fail("spacing", fmt::format("{} makes {:g} grains; allowed are {:g}", spacing, total, most_grains));
    return static_cast<std::size_t>(total);
}

std::vector<Vec3> Lattice::operator()(const Site& site, const std::vector<double>& radius) const {
    const Cells all = cells(site.domain);
    std::array<std::int64_t, 3> most{};
    for (const auto& n : all.counts)
        for (std::size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], n[c]);
    std::vector<Vec3> x;
    x.reserve(radius.size());
    for (std::int64_t k = 0; k < most[2]; ++k)
        for (std::int64_t j = 0; j < most[1]; ++j)
            for (std::int64_t i = 0; i < most[0]; ++i)
                for (std::size_t p = 0; p < all.places.size(); ++p) {
                    if (i >= all.counts[p][0] || j >= all.counts[p][1] || k >= all.counts[p][2]) continue;
                    const Vec3 cell(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
                    x.push_back(lower + all.edges.cwiseProduct(cell + all.places[p]));
                }
    return x;
}

CountedPlaces::CountedPlaces(Table& table)
    : number(table.integer("count", 1, static_cast<std::int64_t>(most_grains))), seed(table.integer("seed")),
      table_(table) {
    read_region(table, lower, upper);
}

JitteredPlaces::JitteredPlaces(Table& table)
    : CountedPlaces(table), spacing(table.number("spacing", positive)), jitter(table.number("jitter", non_negative)) {}

std::vector<Vec3> JitteredPlaces::operator()(const Site& site, const std::vector<double>& radius) const {
    const double largest = 2.0 * *std::max_element(radius.begin(), radius.end());
    if (2.0 * jitter > spacing - largest)
        table_.fail("jitter", fmt::format("{} m leaves grains of {} m that are {} m apart no room: at most {:.4g} m",
                                          jitter, largest, spacing, 0.5 * (spacing - largest)));
    const double edge = std::sqrt(2.0) * spacing;
    const auto cells = [&](Eigen::Index c) {
        return static_cast<std::int64_t>(std::ceil((upper[c] - lower[c]) / edge));
    };
    if (static_cast<double>(cells(0)) * static_cast<double>(cells(1)) * static_cast<double>(cells(2)) > most_grains)
        table_.fail("spacing", fmt::format("{} makes more than {:g} places", spacing, most_grains));
    Random random = random_stream(seed, Stream::places);
    const std::vector<Vec3> in_cell = places_in_cell("fcc");
    std::vector<Vec3> x;
    for (std::int64_t k = 0; k < cells(2); ++k)
        for (std::int64_t j = 0; j < cells(1); ++j)
            for (std::int64_t i = 0; i < cells(0); ++i)
                for (const Vec3& in : in_cell) {
                    if (x.size() == radius.size()) return x;
                    Vec3 away = Vec3::Constant(2.0);
                    while (away.norm() > 1.0)
                        for (Eigen::Index c = 0; c < 3; ++c) away[c] = random.uniform(-1.0, 1.0);
                    const Vec3 cell(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
                    const Vec3 place = lower + edge * (cell + in) + jitter * away;
                    const bool taken = (place.array() < lower.array()).any() || (place.array() >= upper.array()).any();
                    if (!taken && !touches_wall(site, place, radius[x.size()])) x.push_back(place);
                }
    if (x.size() < radius.size())
        table_.fail("count", fmt::format("{} grains, and {} places that no wall touches", number, x.size()));
    return x;
}

void RandomPlaces::fail(std::size_t reached, const std::vector<double>& radius) const {
    double solid = 0.0;
    for (std::size_t i = 0; i < reached; ++i) solid += sphere_volume(2.0 * radius[i]);
    const double fraction_reached = solid / (upper - lower).prod();
    table_.fail("count",
                fmt::format("no place without overlap for grain {} after {} tries: {} of {} grains are placed, a "
                            "solid fraction of {:.3f}; random addition of equal spheres cannot exceed about 0.38",
                            reached, most_tries, reached, number, fraction_reached));
}

std::vector<Vec3> RandomPlaces::operator()(const Site& site, const std::vector<double>& radius) const {
    const Domain& domain = site.domain;
    const Grains& present = site.present;
    for (Eigen::Index c = 0; c < 3; ++c)
        if (lower[c] < 0.0 || upper[c] > domain.size[c])
            table_.fail("lower",
                        fmt::format("the region leaves the domain along {}", axis_names[static_cast<std::size_t>(c)]));
    std::vector<Vec3> x = present.x;
    std::vector<double> r = present.radius;
    const double sum = std::accumulate(radius.begin(), radius.end(), std::accumulate(r.begin(), r.end(), 0.0));
    const std::size_t total = present.size() + radius.size();
    SphereGrid grid(domain, lower, upper, 2.0 * sum / static_cast<double>(total), total);
    for (std::size_t i = 0; i < x.size(); ++i) grid.insert(static_cast<std::int32_t>(i), x[i], r[i]);

    Random random = random_stream(seed, Stream::places);
    const auto is_taken = [&](const Vec3& place, double own) {
        const auto overlaps = [&](std::int32_t j) {
            const auto k = static_cast<std::size_t>(j);
            const double apart = own + r[k];
            return domain.minimum_image(place - x[k]).squaredNorm() < apart * apart;
        };
        return touches_wall(site, place, own) || grid.any_near(place, own, overlaps);
    };
    for (std::size_t i = 0; i < radius.size(); ++i) {
        Vec3 place = Vec3::Zero();
        bool found = false;
        for (std::int64_t tries = 0; tries < most_tries && !found; ++tries) {
            for (Eigen::Index c = 0; c < 3; ++c) place[c] = random.uniform(lower[c], upper[c]);
            found = !is_taken(place, radius[i]);
        }
        if (!found) fail(i, radius);
        grid.insert(static_cast<std::int32_t>(x.size()), place, radius[i]);
        x.push_back(place);
        r.push_back(radius[i]);
    }
    x.erase(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(present.size()));
    return x;
}

} // namespace plumb
