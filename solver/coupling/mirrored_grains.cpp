#include "coupling/mirrored_grains.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

namespace plumb {

namespace {

constexpr int panels = 400; // of every integral; the share of a kernel is good to 1e-5

/// Integral of g over [a, b] by the midpoint rule.
template <class G> double integral(double a, double b, G&& g) {
    double sum = 0.0;
    for (int k = 0; k < panels; ++k) sum += g(a + (b - a) * (k + 0.5) / panels);
    return sum * (b - a) / panels;
}

/// Share of a circle (in the plane) or a sphere of radius r about a point, `from_centre` away from the middle of a
/// round wall, that is inside it.
double share_inside(bool circle, double radius, double from_centre, double r) {
    if (from_centre + r <= radius) return 1.0;
    if (std::abs(from_centre - r) >= radius) return 0.0;
    const double cosine =
        std::clamp((radius * radius - from_centre * from_centre - r * r) / (2.0 * from_centre * r), -1.0, 1.0);
    return circle ? 1.0 - std::acos(cosine) / std::numbers::pi : 0.5 * (1.0 + cosine);
}

/// Share of the kernel about a point that is inside a cylinder or a sphere.
double kernel_inside(const SpaceKernel& kernel, bool cylinder, double radius, double from_centre) {
    const double reach = kernel.reach();
    return integral(0.0, reach, [&](double r) {
        const double shell = cylinder
                                 ? 2.0 * std::numbers::pi * r * // of all points at r from the axis through the middle
                                       integral(-std::sqrt(reach * reach - r * r), std::sqrt(reach * reach - r * r),
                                                [&](double z) { return kernel(std::hypot(r, z)); })
                                 : 4.0 * std::numbers::pi * r * r * kernel(r);
        return shell * share_inside(cylinder, radius, from_centre, r);
    });
}

/// `sign` as of the walls: -1 where the grains are inside.
MirrorShare share_at(const SpaceKernel& kernel, bool cylinder, double radius, double sign) {
    constexpr int entries = 100;
    constexpr double least = 1e-6; // of a kernel that comes back: the quotient of less is that of the entry before
    const double reach = kernel.reach();
    const auto open = [&](double distance) {
        const double inside = kernel_inside(kernel, cylinder, radius, std::max(radius + sign * distance, 0.0));
        return sign < 0.0 ? inside : 1.0 - inside;
    };
    MirrorShare table{reach / entries, {}};
    const double whole = kernel_inside(kernel, cylinder, 1e3 * reach, 0.0); // 1 but for the rule of the integrals
    for (int k = 0; k <= entries; ++k) {
        const double distance = k * table.step, back = open(-distance);
        const double behind = (sign < 0.0 ? whole : 1.0) - open(distance);
        table.share.push_back(back > least || table.share.empty() ? behind / back : table.share.back());
    }
    return table;
}

/// In one wall.
Reflection one_reflection(const MirrorShare& share, const WallBody& wall, std::int32_t element, const Vec3& x) {
    Reflection found{x, Eigen::Matrix3d::Identity(), 0.0, Vec3::Zero()};
    wall.touch(x, std::numeric_limits<double>::infinity(), 0.0, [&](const WallPoint& p) {
        if (p.element != element) return;
        found.x = x - 2.0 * p.distance * p.normal;
        found.share = share(p.distance);
        found.share_gradient = share.slope(p.distance) * p.normal;
        found.turn -= 2.0 * p.normal * p.normal.transpose();
        std::visit(
            [&](const auto& shape) { // along a round wall mirrors are as much further apart as they are from its middle
                using Shape = std::decay_t<decltype(shape)>;
                if constexpr (std::is_same_v<Shape, Cylinder> || std::is_same_v<Shape, SphereWall>) {
                    const double before = shape.radius + shape.sign * p.distance;
                    const double stretch = (2.0 * shape.radius - before) / before - 1.0;
                    found.turn += stretch * (Eigen::Matrix3d::Identity() - p.normal * p.normal.transpose());
                    if constexpr (std::is_same_v<Shape, Cylinder>)
                        found.turn -= stretch * shape.axis * shape.axis.transpose();
                }
            },
            wall.shape);
    });
    return found;
}

} // namespace

double MirrorShare::operator()(double distance) const {
    if (share.empty()) return 1.0;
    const double at = std::clamp(distance / step, 0.0, static_cast<double>(share.size() - 1));
    const auto k = std::min(static_cast<std::size_t>(at), share.size() - 2);
    return share[k] + (at - static_cast<double>(k)) * (share[k + 1] - share[k]);
}

double MirrorShare::slope(double distance) const {
    if (share.empty()) return 0.0;
    const double at = distance / step;
    if (at < 0.0 || at >= static_cast<double>(share.size() - 1)) return 0.0;
    const auto k = static_cast<std::size_t>(at);
    return (share[k + 1] - share[k]) / step;
}

bool has_mirror(const Wall& wall) {
    return std::visit(
        [](const auto& shape) {
            using Shape = std::decay_t<decltype(shape)>;
            return std::is_same_v<Shape, Plane> || std::is_same_v<Shape, Box> || std::is_same_v<Shape, Cylinder> ||
                   std::is_same_v<Shape, SphereWall>;
        },
        wall);
}

void prepare_mirrors(MirroredGrains& m, const std::vector<WallBody>& walls, const SpaceKernel& kernel) {
    m.share_of_wall.assign(walls.size(), {});
    for (std::size_t w = 0; w < walls.size(); ++w) {
        if (const auto* cylinder = std::get_if<Cylinder>(&walls[w].shape))
            m.share_of_wall[w] = share_at(kernel, true, cylinder->radius, cylinder->sign);
        if (const auto* sphere = std::get_if<SphereWall>(&walls[w].shape))
            m.share_of_wall[w] = share_at(kernel, false, sphere->radius, sphere->sign);
    }
}

void choose_mirrors(MirroredGrains& m, const std::vector<WallBody>& walls, const std::vector<Vec3>& x,
                    const std::vector<double>& volume, double reach) {
    m.of.clear();
    if (!m.wanted) return;
    for (std::size_t j = 0; j < x.size(); ++j) {
        const std::size_t first = m.of.size();
        std::vector<Mirror> near; // one for each wall
        for (std::size_t w = 0; w < walls.size(); ++w)
            walls[w].touch(x[j], reach, 0.0, [&](const WallPoint& p) {
                near.push_back(
                    {static_cast<std::int32_t>(j), {static_cast<std::int32_t>(w), -1, -1}, {p.element, -1, -1}});
            });
        for (const Mirror& next : near) // by it alone, and after all that the walls before it have made
            for (std::size_t q = first, before = m.of.size(); q <= before; ++q) {
                Mirror made = q < before ? m.of[q] : next;
                if (q < before) {
                    const auto free = std::find(made.wall.begin(), made.wall.end(), -1);
                    if (free == made.wall.end()) continue;
                    made.element[static_cast<std::size_t>(free - made.wall.begin())] = next.element[0];
                    *free = next.wall[0];
                }
                m.of.push_back(made);
            }
    }
    place_mirrors(m, walls, x, volume);
}

Reflection reflection(const MirroredGrains& m, const Mirror& mirror, const std::vector<WallBody>& walls,
                      const Vec3& x) {
    Reflection seen{x};
    for (std::size_t k = 0; k < mirror.wall.size() && mirror.wall[k] >= 0; ++k) {
        const auto w = static_cast<std::size_t>(mirror.wall[k]);
        const Reflection next = one_reflection(m.share_of_wall[w], walls[w], mirror.element[k], seen.x);
        seen.share_gradient =
            next.share * seen.share_gradient + seen.share * seen.turn.transpose() * next.share_gradient;
        seen.share *= next.share;
        seen.turn = next.turn * seen.turn;
        seen.x = next.x;
    }
    return seen;
}

void place_mirrors(MirroredGrains& m, const std::vector<WallBody>& walls, const std::vector<Vec3>& x,
                   const std::vector<double>& volume) {
    m.x.resize(m.size());
    m.volume.resize(m.size());
    parallel_for(m.size(), [&](std::size_t q) {
        const auto j = static_cast<std::size_t>(m.of[q].grain);
        const Reflection seen = reflection(m, m.of[q], walls, x[j]);
        m.x[q] = seen.x;
        m.volume[q] = seen.share * volume[j];
    });
}

} // namespace plumb
