#include "core/triangle_mesh.hpp"

#include "core/csv.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace plumb {

namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Sets of numbers that are joined two by two; the representative of a set is its lowest member.
class Joined {
public:
    explicit Joined(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
    std::size_t representative(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::size_t i, std::size_t j) {
        i = representative(i), j = representative(j);
        parent_[std::max(i, j)] = std::min(i, j);
    }

private:
    std::vector<std::size_t> parent_;
};

enum Feature : std::int8_t { face, corner_0, corner_1, corner_2, edge_01, edge_12, edge_20 };

/// The part of the triangle a b c nearest to x, and where: at + u (b - a) + w (c - a) (Ericson 2005, section 5.1.5).
Feature nearest_feature(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c, Vec3& point) {
    const Vec3 ab = b - a, ac = c - a;
    const double ab_a = ab.dot(x - a), ac_a = ac.dot(x - a);
    if (ab_a <= 0.0 && ac_a <= 0.0) return point = a, corner_0;
    const double ab_b = ab.dot(x - b), ac_b = ac.dot(x - b);
    if (ab_b >= 0.0 && ac_b <= ab_b) return point = b, corner_1;
    const double ab_c = ab.dot(x - c), ac_c = ac.dot(x - c);
    if (ac_c >= 0.0 && ab_c <= ac_c) return point = c, corner_2;
    // Signed areas opposite to each corner: negative beyond the edge.
    if (ab_a * ac_b - ab_b * ac_a <= 0.0 && ab_a >= 0.0 && ab_b <= 0.0)
        return point = a + ab * (ab_a / (ab_a - ab_b)), edge_01;
    if (ab_c * ac_a - ab_a * ac_c <= 0.0 && ac_a >= 0.0 && ac_c <= 0.0)
        return point = a + ac * (ac_a / (ac_a - ac_c)), edge_20;
    const double from_b = ac_b - ab_b, from_c = ab_c - ac_c;
    if (ab_b * ac_c - ab_c * ac_b <= 0.0 && from_b >= 0.0 && from_c >= 0.0)
        return point = b + (c - b) * (from_b / (from_b + from_c)), edge_12;
    return face;
}

} // namespace

struct TriangleMesh::Nearest {
    Vec3 point;
    double distance;
    std::int32_t triangle;
    std::int32_t element;
    Feature feature;
};

TriangleMesh::TriangleMesh(Table& table)
    : TriangleMesh(read_stl(input_path(table, "path"), table.number_or("scale", 1.0, positive))) {}

TriangleMesh::TriangleMesh(Triangles triangles) : mesh_(std::move(triangles)) {
    double largest = 0.0;
    for (const Vec3& p : mesh_.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    flatness_ = 0x1p-21 * largest; // four spacings (2^-23) of the single-precision coordinates of a binary file
    std::vector<std::int32_t> order(mesh_.corners.size());
    std::iota(order.begin(), order.end(), 0);
    build_tree(order, 0, order.size());
    sort_by_tree(order);
    for (std::size_t t = 0; t < mesh_.corners.size(); ++t) {
        const auto i = static_cast<std::int32_t>(t);
        normals_.push_back((corner(i, 1) - corner(i, 0)).cross(corner(i, 2) - corner(i, 0)).normalized());
    }
    find_edges();
    number_faces();
    number_edges();
}

void TriangleMesh::sort_by_tree(const std::vector<std::int32_t>& order) {
    // What is near in space is near in memory: a look-up then touches few cache lines.
    Triangles sorted;
    std::vector<std::int32_t> renamed(mesh_.points.size(), -1);
    for (const std::int32_t t : order) {
        std::array<std::int32_t, 3> corners = mesh_.corners[at(t)];
        for (std::int32_t& p : corners) {
            if (renamed[at(p)] < 0) {
                renamed[at(p)] = static_cast<std::int32_t>(sorted.points.size());
                sorted.points.push_back(mesh_.points[at(p)]);
            }
            p = renamed[at(p)];
        }
        sorted.corners.push_back(corners);
    }
    mesh_ = std::move(sorted);
}

const Vec3& TriangleMesh::corner(std::int32_t triangle, std::size_t k) const {
    return mesh_.points[at(mesh_.corners[at(triangle)][k])];
}

std::pair<std::size_t, std::size_t> TriangleMesh::triangles_of(std::size_t edge) const {
    return {edges_[edge].first, edge + 1 < edges_.size() ? edges_[edge + 1].first : edge_triangles_.size()};
}

std::int32_t TriangleMesh::opposite_corner(std::int32_t triangle, const Edge& edge) const {
    for (const std::int32_t p : mesh_.corners[at(triangle)])
        if (p != edge.ends[0] && p != edge.ends[1]) return p;
    return -1; // only in a triangle with two equal corners, which is degenerate
}

void TriangleMesh::find_edges() {
    struct Side {
        std::array<std::int32_t, 2> ends;
        std::int32_t triangle;
        std::int32_t k;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < mesh_.corners.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [p, q] = std::minmax(mesh_.corners[t][k], mesh_.corners[t][(k + 1) % 3]);
            sides.push_back({{p, q}, static_cast<std::int32_t>(t), static_cast<std::int32_t>(k)});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle;
    });
    triangle_edges_.resize(mesh_.corners.size());
    for (const Side& side : sides) {
        if (edges_.empty() || edges_.back().ends != side.ends)
            edges_.push_back({side.ends, edge_triangles_.size(), -1});
        edge_triangles_.push_back(side.triangle);
        triangle_edges_[at(side.triangle)][at(side.k)] = static_cast<std::int32_t>(edges_.size() - 1);
    }
    point_first_.assign(mesh_.points.size() + 1, 0);
    for (const Edge& edge : edges_)
        for (const std::int32_t p : edge.ends) ++point_first_[at(p) + 1];
    std::partial_sum(point_first_.begin(), point_first_.end(), point_first_.begin());
    point_edges_.resize(2 * edges_.size());
    std::vector<std::size_t> next(point_first_.begin(), point_first_.end() - 1);
    for (std::size_t e = 0; e < edges_.size(); ++e)
        for (const std::int32_t p : edges_[e].ends) point_edges_[next[at(p)]++] = static_cast<std::int32_t>(e);
}

bool TriangleMesh::is_flat(std::int32_t s, std::int32_t t, const Edge& edge) const {
    const Vec3& origin = mesh_.points[at(edge.ends[0])];
    const Vec3 along = (mesh_.points[at(edge.ends[1])] - origin).normalized();
    const Vec3 to_s = mesh_.points[at(opposite_corner(s, edge))] - origin;
    const Vec3 to_t = mesh_.points[at(opposite_corner(t, edge))] - origin;
    const bool opposite_sides = (to_s - along * along.dot(to_s)).dot(to_t) < 0.0; // not folded onto each other
    return opposite_sides && std::abs(normals_[at(s)].dot(to_t)) <= flatness_ &&
           std::abs(normals_[at(t)].dot(to_s)) <= flatness_;
}

void TriangleMesh::number_faces() {
    Joined joined(mesh_.corners.size());
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const auto [begin, end] = triangles_of(e);
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t j = i + 1; j < end; ++j)
                if (is_flat(edge_triangles_[i], edge_triangles_[j], edges_[e]))
                    joined.join(at(edge_triangles_[i]), at(edge_triangles_[j]));
    }
    face_.resize(mesh_.corners.size());
    for (std::size_t t = 0; t < face_.size(); ++t) {
        const std::size_t lowest = joined.representative(t);
        face_[t] = lowest == t ? faces_++ : face_[lowest];
    }
}

void TriangleMesh::number_edges() {
    // An edge or corner inside a flat face is part of that face; one that only continues an edge is part of the edge.
    const auto inside_face = [&](std::size_t e) {
        const auto [begin, end] = triangles_of(e);
        for (std::size_t i = begin; i < end; ++i)
            if (face_[at(edge_triangles_[i])] != face_[at(edge_triangles_[begin])]) return false;
        return end - begin > 1;
    };
    std::vector<std::vector<std::size_t>> creases(
        mesh_.points.size()); // edges at each point that are no part of a face
    for (std::size_t e = 0; e < edges_.size(); ++e)
        if (!inside_face(e))
            for (const std::int32_t p : edges_[e].ends) creases[at(p)].push_back(e);
    const auto leaving = [&](std::size_t e, std::size_t p) -> Vec3 {
        const auto [a, b] = edges_[e].ends;
        return mesh_.points[at(at(a) == p ? b : a)] - mesh_.points[p];
    };
    Joined joined(edges_.size());
    std::vector<bool> continues(mesh_.points.size(), false);
    for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
        if (creases[p].size() != 2) continue;
        const Vec3 one = leaving(creases[p][0], p), other = leaving(creases[p][1], p);
        const double bend = one.cross(other).norm() / std::max(one.norm(), other.norm());
        if (one.dot(other) >= 0.0 || bend > flatness_) continue;
        joined.join(creases[p][0], creases[p][1]);
        continues[p] = true;
    }
    std::int32_t next = faces_;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
        const std::size_t lowest = joined.representative(e);
        const bool is_face = inside_face(e);
        edges_[e].element =
            is_face ? face_[at(edge_triangles_[edges_[e].first])] : (lowest == e ? next++ : edges_[lowest].element);
    }
    point_element_.resize(mesh_.points.size());
    for (std::size_t p = 0; p < mesh_.points.size(); ++p) {
        const std::int32_t any_edge = point_edges_[point_first_[p]];
        if (creases[p].empty())
            point_element_[p] = edges_[at(any_edge)].element;
        else
            point_element_[p] = continues[p] ? edges_[creases[p][0]].element : next++;
    }
}

void TriangleMesh::build_tree(std::vector<std::int32_t>& order, std::size_t begin, std::size_t end) {
    constexpr std::size_t leaf_size = 4; // triangles; 2 to 8 are equally fast
    const std::size_t self = nodes_.size();
    Node node{corner(order[begin], 0), corner(order[begin], 0), static_cast<std::int32_t>(begin),
              static_cast<std::int32_t>(end - begin)};
    Vec3 lowest = Vec3::Constant(std::numeric_limits<double>::max()), highest = -lowest; // of three times the centroids
    const auto centroid = [&](std::int32_t t) -> Vec3 { return corner(t, 0) + corner(t, 1) + corner(t, 2); };
    for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            node.lower = node.lower.cwiseMin(corner(order[i], k));
            node.upper = node.upper.cwiseMax(corner(order[i], k));
        }
        lowest = lowest.cwiseMin(centroid(order[i]));
        highest = highest.cwiseMax(centroid(order[i]));
    }
    nodes_.push_back(node);
    if (end - begin <= leaf_size) return;
    Eigen::Index axis = 0;
    (highest - lowest).maxCoeff(&axis);
    const std::size_t middle = begin + (end - begin) / 2;
    const auto iterator = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(iterator(begin), iterator(middle), iterator(end), [&](std::int32_t s, std::int32_t t) {
        const double cs = centroid(s)[axis], ct = centroid(t)[axis];
        return cs != ct ? cs < ct : s < t;
    });
    build_tree(order, begin, middle);
    nodes_[self].first = static_cast<std::int32_t>(nodes_.size());
    nodes_[self].count = 0;
    build_tree(order, middle, end);
}

TriangleMesh::Nearest TriangleMesh::nearest_point(std::int32_t triangle, const Vec3& x) const {
    Nearest p{};
    p.triangle = triangle;
    p.feature = nearest_feature(x, corner(triangle, 0), corner(triangle, 1), corner(triangle, 2), p.point);
    if (p.feature == face) {
        const double height = normals_[at(triangle)].dot(x - corner(triangle, 0));
        p.point = x - normals_[at(triangle)] * height;
        p.distance = std::abs(height);
        p.element = face_[at(triangle)];
    } else if (p.feature >= edge_01) {
        p.distance = (x - p.point).norm();
        p.element = edges_[at(triangle_edges_[at(triangle)][static_cast<std::size_t>(p.feature - edge_01)])].element;
    } else {
        p.distance = (x - p.point).norm();
        p.element = point_element_[at(mesh_.corners[at(triangle)][static_cast<std::size_t>(p.feature - corner_0)])];
    }
    return p;
}

void TriangleMesh::collect(const Vec3& x, double reach, std::vector<Nearest>& nearest) const {
    std::array<std::int32_t, 64> stack; // the tree halves, so its depth is below log2(2^31) + 1
    std::size_t open = 0;
    stack[open++] = 0;
    while (open > 0) {
        const std::int32_t n = stack[--open];
        const Node& node = nodes_[at(n)];
        const Vec3 outside = (node.lower - x).cwiseMax(x - node.upper).cwiseMax(0.0);
        if (outside.squaredNorm() >= reach * reach) continue;
        if (node.count == 0) {
            stack[open++] = node.first;
            stack[open++] = n + 1;
            continue;
        }
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
            const Nearest p = nearest_point(i, x);
            if (p.distance < reach) nearest.push_back(p);
        }
    }
}

bool TriangleMesh::is_local_minimum(const Nearest& p, const Vec3& x, double slack) const {
    if (p.feature == face) return true;
    const Vec3 to_centre = x - p.point;
    const auto points_nearer = [&](const Vec3& way) { return to_centre.dot(way) > slack * way.norm(); };
    if (p.feature >= edge_01) {
        const auto e = at(triangle_edges_[at(p.triangle)][static_cast<std::size_t>(p.feature - edge_01)]);
        const auto [begin, end] = triangles_of(e);
        for (std::size_t i = begin; i < end; ++i)
            if (points_nearer(mesh_.points[at(opposite_corner(edge_triangles_[i], edges_[e]))] - p.point)) return false;
        return true;
    }
    const auto v = at(mesh_.corners[at(p.triangle)][static_cast<std::size_t>(p.feature - corner_0)]);
    for (std::size_t i = point_first_[v]; i < point_first_[v + 1]; ++i) {
        const auto [a, b] = edges_[at(point_edges_[i])].ends;
        if (points_nearer(mesh_.points[at(at(a) == v ? b : a)] - mesh_.points[v])) return false;
    }
    return true;
}

void TriangleMesh::contacts(const Vec3& x, double reach, std::vector<WallPoint>& found) const {
    static thread_local std::vector<Nearest> nearest; // keeps its memory from call to call
    nearest.clear();
    found.clear();
    if (!(reach > 0.0)) return;
    collect(x, reach, nearest);
    std::sort(nearest.begin(), nearest.end(), [](const Nearest& a, const Nearest& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
    });
    static thread_local std::vector<Vec3> accepted;
    accepted.clear();
    for (const Nearest& p : nearest) {
        // The nearest point of all is a minimum whatever round-off says about the crack between two triangles.
        if (!found.empty() && !is_local_minimum(p, x, 1e-9 * reach))
            continue; // 1e-9: far above round-off, far below reach
        bool hidden = false;
        for (std::size_t k = 0; k < found.size() && !hidden; ++k)
            hidden = found[k].normal.dot(p.point - accepted[k]) <= flatness_;
        if (hidden) continue;
        const Vec3& n = normals_[at(p.triangle)];
        Vec3 normal = n.dot(x - p.point) < 0.0 ? Vec3(-n) : n;
        if (p.feature != face && p.distance > 0.0) normal = (x - p.point) / p.distance;
        accepted.push_back(p.point);
        found.push_back({normal, p.distance, p.element});
    }
}

} // namespace plumb
