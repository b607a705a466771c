#include "grid/apertures.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// Share of the segment from a to b that is open, the distances of whose ends are given.
double open_share(const std::function<double(const Vec3&)>& distance, const Vec3& a, const Vec3& b, double at_a,
                  double at_b) {
    if ((at_a > 0.0) == (at_b > 0.0)) return at_a > 0.0 ? 1.0 : 0.0;
    double open = 0.0, closed = 1.0; // shares of the way from the open end
    const Vec3 from = at_a > 0.0 ? a : b, to = at_a > 0.0 ? b : a;
    constexpr int halvings = 50; // to rounding
    for (int k = 0; k < halvings; ++k) {
        const double middle = 0.5 * (open + closed);
        (distance(from + middle * (to - from)) > 0.0 ? open : closed) = middle;
    }
    constexpr double least = 1e-6; // slits that carry nothing but bad conditioning
    return open < least ? 0.0 : open;
}

/// Share of a unit square that lies on the open side: corners are open or not, counterclockwise from the origin, and
/// `share` is the open part of the side from each to the next.
double open_area(const std::array<bool, 4>& corner, const std::array<double, 4>& share) {
    constexpr std::array<std::array<double, 2>, 4> place{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    std::array<std::array<double, 2>, 8> polygon{};
    std::size_t n = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        if (corner[k]) polygon[n++] = place[k];
        if (corner[k] == corner[next]) continue;
        const double s = corner[k] ? share[k] : 1.0 - share[k];
        polygon[n++] = {place[k][0] + s * (place[next][0] - place[k][0]),
                        place[k][1] + s * (place[next][1] - place[k][1])};
    }
    double twice = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        const auto &p = polygon[k], &q = polygon[(k + 1) % n];
        twice += p[0] * q[1] - p[1] * q[0];
    }
    return std::clamp(0.5 * twice, 0.0, 1.0);
}

} // namespace

Apertures open_grid(const Grid& grid) {
    Apertures open;
    for (std::size_t c = 0; c < 3; ++c) open.face[c].assign(grid.faces(c).size(), 1.0);
    open.cell.assign(grid.cells().size(), 1.0);
    return open;
}

Apertures cut_plane(const Grid& grid, const std::function<double(const Vec3&)>& distance) {
    Apertures open = open_grid(grid);
    const Axis &x = grid.axis[0], &y = grid.axis[1];
    const std::size_t nx = x.node.size(), ny = y.node.size();
    const auto at = [&](std::size_t i, std::size_t j) { return Vec3(x.node[i], y.node[j], 0.0); };
    std::vector<double> corner(nx * ny);
    for (std::size_t j = 0; j < ny; ++j)
        for (std::size_t i = 0; i < nx; ++i) corner[i + nx * j] = distance(at(i, j));
    open.corner.resize(nx * ny);
    std::transform(corner.begin(), corner.end(), open.corner.begin(), [](double d) { return d > 0.0 ? 1 : 0; });
    const auto share = [&](std::size_t i, std::size_t j, std::size_t i2, std::size_t j2) {
        return open_share(distance, at(i, j), at(i2, j2), corner[i + nx * j], corner[i2 + nx * j2]);
    };
    const Block across_x = grid.faces(0), across_y = grid.faces(1), cells = grid.cells();
    for_each_place(across_x, [&](const Place& p, std::size_t k) {
        const auto i = static_cast<std::size_t>(p[0]), j = static_cast<std::size_t>(p[1]);
        open.face[0][k] = share(i, j, i, j + 1);
    });
    for_each_place(across_y, [&](const Place& p, std::size_t k) {
        const auto i = static_cast<std::size_t>(p[0]), j = static_cast<std::size_t>(p[1]);
        open.face[1][k] = share(i, j, i + 1, j);
    });
    for_each_place(cells, [&](const Place& p, std::size_t k) {
        const auto is_open = [&](int i, int j) { return open.corner_open(grid, i, j); };
        const std::array<bool, 4> corners{is_open(p[0], p[1]), is_open(p[0] + 1, p[1]), is_open(p[0] + 1, p[1] + 1),
                                          is_open(p[0], p[1] + 1)};
        const Place right{x.face_above(p[0]), p[1], 0}, above{p[0], y.face_above(p[1]), 0};
        open.cell[k] = open_area(corners, {open.face[1][across_y.at(p)], open.face[0][across_x.at(right)],
                                           open.face[1][across_y.at(above)], open.face[0][across_x.at(p)]});
    });
    return open;
}

} // namespace plumb
