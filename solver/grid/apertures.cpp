#include "grid/apertures.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

using Point = std::array<double, 2>; // in a face, in its widths along the two axes after its own

/// The open part of a face.
struct Polygon {
    std::array<Point, 8> corner{};
    std::size_t size = 0;
    std::array<Point, 4> on_wall{}; // where the wall crosses its sides
    std::size_t crossings = 0;
    double area = 0.0;

    void add(const Point& p) { corner[size++] = p; }
    void cross(const Point& p) {
        on_wall[crossings++] = p;
        add(p);
    }
};

constexpr double least_distance = 0.01; // of a width: keeps the friction of slivers finite

/// Of a polygon whose area is known.
Point centroid(const Polygon& polygon) {
    Point sum{0.0, 0.0};
    for (std::size_t k = 0; k < polygon.size; ++k) {
        const Point &u = polygon.corner[k], &v = polygon.corner[(k + 1) % polygon.size];
        const double twice = u[0] * v[1] - u[1] * v[0];
        for (const std::size_t d : {0, 1}) sum[d] += twice * (u[d] + v[d]);
    }
    return {sum[0] / (6.0 * polygon.area), sum[1] / (6.0 * polygon.area)};
}

/// The middle of the open part of the side of a face at the lower or upper end of axis d (0 or 1); `otherwise` if it is
/// closed.
double middle_of_side(const Polygon& polygon, std::size_t d, std::size_t way, double otherwise) {
    double lowest = 2.0, highest = -1.0;
    for (std::size_t k = 0; k < polygon.size; ++k) {
        const Point& p = polygon.corner[k];
        if (p[d] != static_cast<double>(way)) continue;
        lowest = std::min(lowest, p[1 - d]);
        highest = std::max(highest, p[1 - d]);
    }
    return highest > lowest ? 0.5 * (lowest + highest) : otherwise;
}

/// For a flow that depends on the distance from the wall only, every difference between neighbours and from the wall
/// is then exact.
CutFace cut_face(const Polygon& polygon) {
    CutFace made;
    const Point c = centroid(polygon), &from = polygon.on_wall[0], &to = polygon.on_wall[1];
    for (const std::size_t d : {0, 1}) {
        const std::size_t e = 1 - d;
        const double along_d = to[d] - from[d], along_e = to[e] - from[e]; // of the wall
        const bool parallel = std::abs(along_e) < 1e-9;                    // to axis d
        for (const std::size_t way : {0, 1}) {
            const double shift = parallel ? 0.0 : (middle_of_side(polygon, d, way, c[e]) - c[e]) * along_d / along_e;
            made.to_edge[d][way] = std::clamp(std::abs(static_cast<double>(way) - (c[d] + shift)), least_distance, 1.0);
            const double wall = parallel ? 1.0 : std::abs(from[d] + (c[e] - from[e]) * along_d / along_e - c[d]);
            made.to_wall[d][way] = std::max(wall, least_distance);
        }
    }
    return made;
}

constexpr double least_share = 1e-6; // of an edge or a volume: slits that carry nothing but bad conditioning

Place raised(Place p, std::size_t axis, int by = 1) {
    p[axis] += by;
    return p;
}

/// Makes the apertures: which nodes are open, then edges, faces and cells, each of what bounds it. In the plane the
/// layer of nodes at the upper end of z is that at the lower end again.
class Cutter {
public:
    Cutter(const Grid& made_on, const std::function<double(const Vec3&)>& distance_to_wall)
        : grid(made_on), distance(distance_to_wall) {
        for (std::size_t c = 0; c < 3; ++c) nodes.n[c] = static_cast<int>(grid.axis[c].node.size());
        at_node.resize(nodes.size());
        for_each_place(nodes, [&](const Place& p, std::size_t k) { at_node[k] = distance(position(p)); });
    }

    Apertures cut() {
        open = open_grid(grid);
        for (std::size_t e = 0; e < 3; ++e) {
            const Block edges = grid.edges(e);
            open.edge[e].resize(edges.size());
            for_each_place(edges, [&](const Place& p, std::size_t k) { open.edge[e][k] = open_length(e, p); });
        }
        for (std::size_t c = 0; c < 3; ++c)
            for_each_place(grid.faces(c), [&](const Place& p, std::size_t k) { cut_one(c, p, k); });
        for_each_place(grid.cells(), [&](const Place& p, std::size_t k) { open.cell[k] = open_volume(p); });
        return std::move(open);
    }

private:
    const Grid& grid;
    const std::function<double(const Vec3&)>& distance;
    Block nodes;
    std::vector<double> at_node; // distance to the wall
    Apertures open;

    Vec3 position(const Place& p) const {
        Vec3 x = Vec3::Zero();
        for (std::size_t c = 0; c < static_cast<std::size_t>(grid.dimensions); ++c)
            x[static_cast<Eigen::Index>(c)] = grid.axis[c].node[static_cast<std::size_t>(p[c])];
        return x;
    }
    bool is_open(const Place& node) const { return at_node[nodes.at(node)] > 0.0; }
    double share(std::size_t e, const Place& p) const { return open.edge[e][grid.edges(e).at(p)]; }

    /// Open share of an edge between two nodes.
    double open_length(std::size_t e, const Place& p) const {
        const Place q = raised(p, e);
        if (is_open(p) == is_open(q)) return is_open(p) ? 1.0 : 0.0;
        const Vec3 from = position(is_open(p) ? p : q), to = position(is_open(p) ? q : p);
        double inside = 0.0, beyond = 1.0; // shares of the way from the open end
        constexpr int halvings = 50;       // to rounding
        for (int k = 0; k < halvings; ++k) {
            const double middle = 0.5 * (inside + beyond);
            (distance(from + middle * (to - from)) > 0.0 ? inside : beyond) = middle;
        }
        return inside < least_share ? 0.0 : inside;
    }

    /// Of a face across axis c, between its open corners and where the wall crosses its sides.
    Polygon polygon(std::size_t c, const Place& p) const {
        const std::size_t a = (c + 1) % 3, b = (c + 2) % 3;
        const std::array<Place, 4> corner{p, raised(p, a), raised(raised(p, a), b), raised(p, b)};
        const std::array<double, 4> side{share(a, p), share(b, corner[1]), share(a, corner[3]), share(b, p)};
        constexpr std::array<Point, 4> place{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        Polygon found;
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t next = (k + 1) % 4;
            if (is_open(corner[k])) found.add(place[k]);
            if (is_open(corner[k]) == is_open(corner[next])) continue;
            const double s = is_open(corner[k]) ? side[k] : 1.0 - side[k];
            found.cross(
                {place[k][0] + s * (place[next][0] - place[k][0]), place[k][1] + s * (place[next][1] - place[k][1])});
        }
        double twice = 0.0;
        for (std::size_t k = 0; k < found.size; ++k) {
            const Point &u = found.corner[k], &v = found.corner[(k + 1) % found.size];
            twice += u[0] * v[1] - u[1] * v[0];
        }
        found.area = std::clamp(0.5 * twice, 0.0, 1.0);
        return found;
    }

    /// The face's share and, in space, where its velocity stands.
    void cut_one(std::size_t c, const Place& p, std::size_t k) {
        if (grid.dimensions == 2 && c < 2) {
            open.face[c][k] = share(1 - c, p);
            return;
        }
        const Polygon found = polygon(c, p);
        open.face[c][k] = found.area < least_share * least_share ? 0.0 : found.area;
        if (grid.dimensions == 2) return;
        const bool is_cut = open.face[c][k] > 0.0 && found.crossings == 2;
        open.cut[c].push_back(is_cut ? static_cast<int>(open.cut_face.size()) : -1);
        if (is_cut) open.cut_face.push_back(cut_face(found));
    }

    /// Mean of the points in which the wall crosses the edges of a cell, in the cell's own coordinates from 0 to 1, and
    /// how many there are.
    std::pair<Vec3, int> crossing(const Place& cell) const {
        Vec3 sum = Vec3::Zero();
        int count = 0;
        for (std::size_t e = 0; e < 3; ++e)
            for (int k = 0; k < 4; ++k) {
                const std::size_t a = (e + 1) % 3, b = (e + 2) % 3;
                const Place p = raised(raised(cell, a, k % 2), b, k / 2), q = raised(p, e);
                if (is_open(p) == is_open(q)) continue;
                Vec3 at;
                at[static_cast<Eigen::Index>(a)] = k % 2;
                at[static_cast<Eigen::Index>(b)] = k / 2;
                at[static_cast<Eigen::Index>(e)] = is_open(p) ? share(e, p) : 1.0 - share(e, p);
                sum += at;
                ++count;
            }
        return {count > 0 ? Vec3(sum / count) : Vec3(Vec3::Zero()), count};
    }

    /// Open share of a cell: of the pyramids from a point on the wall to its open faces (Gauss' theorem for x).
    double open_volume(const Place& p) const {
        if (grid.dimensions == 2) return open.face[2][grid.faces(2).at(p)];
        const auto [wall, count] = crossing(p);
        if (count == 0) return is_open(p) ? 1.0 : 0.0;
        double thrice = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            Place above = p;
            above[c] = grid.axis[c].face_above(p[c]);
            const Block faces = grid.faces(c);
            const double from_lower = wall[static_cast<Eigen::Index>(c)];
            thrice += from_lower * open.face[c][faces.at(p)] + (1.0 - from_lower) * open.face[c][faces.at(above)];
        }
        return std::clamp(thrice / 3.0, least_share, 1.0);
    }
};

} // namespace

Apertures open_grid(const Grid& grid) {
    Apertures open;
    for (std::size_t c = 0; c < 3; ++c) open.face[c].assign(grid.faces(c).size(), 1.0);
    open.cell.assign(grid.cells().size(), 1.0);
    return open;
}

Apertures cut_grid(const Grid& grid, const std::function<double(const Vec3&)>& distance) {
    return Cutter(grid, distance).cut();
}

} // namespace plumb
