// A wall made of triangles, read from an STL file.
//
// A sphere may touch faces, edges and corners from either side. What counts as one contact:
//   1. a contact is a point of the mesh whose distance to the centre is a local minimum over the mesh: the nearest
//   point
//      of a triangle does not count if it lies on an edge or corner and a neighbour there is nearer still;
//   2. a point that lies in or behind the tangent plane of a nearer contact is hidden by it: the sphere reaches it only
//      because it overlaps the nearer one. (The far face of a thin plate, edges that do not share their corners.)
// So a flat or convex surface is touched once however it is cut into triangles, and a concave corner once per side.
// Triangles that continue each other in one plane have one element number, and so do edges in one line.
#pragma once

#include "core/laws.hpp"
#include "core/stl.hpp"
#include "core/wall_point.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb {

class TriangleMesh {
public:
    static constexpr std::string_view name = "stl";
    static constexpr LawInfo info{"distance to the nearest point of each face, edge and corner",
                                  "both sides; overlap below the thickness of the wall",
                                  "after Ericson 2005, Real-Time Collision Detection, section 5.1.5"};
    /// Keys `path` (relative to the scene's folder) and `scale` (metres per unit of the file; 1 when absent: metres).
    explicit TriangleMesh(Table& table);
    /// No triangle may be degenerate.
    explicit TriangleMesh(Triangles triangles);

    template <class Visit> void touch(const Vec3& x, double reach, Visit&& visit) const {
        static thread_local std::vector<WallPoint> kept; // keeps its memory from call to call
        std::vector<WallPoint> found = std::move(kept);
        contacts(x, reach, found);
        for (const WallPoint& point : found) visit(point);
        kept = std::move(found);
    }

    const Triangles& triangles() const { return mesh_; }
    /// Number of flat faces after joining triangles in one plane.
    std::int32_t face_count() const { return faces_; }

private:
    struct Edge {
        std::array<std::int32_t, 2> ends; // points
        std::size_t first;                // of its triangles in edge_triangles_
        std::int32_t element;
    };
    struct Node { // of the bounding-box tree; the left child follows its parent
        Vec3 lower, upper;
        std::int32_t first; // leaf: first triangle; otherwise the right child
        std::int32_t count; // of triangles in a leaf, 0 otherwise
    };
    struct Nearest;

    void find_edges();
    void number_faces();
    void number_edges();
    void build_tree(std::vector<std::int32_t>& order, std::size_t begin, std::size_t end);
    void sort_by_tree(const std::vector<std::int32_t>& order);
    void contacts(const Vec3& x, double reach, std::vector<WallPoint>& found) const;
    void collect(const Vec3& x, double reach, std::vector<Nearest>& nearest) const;
    Nearest nearest_point(std::int32_t triangle, const Vec3& x) const;
    bool is_local_minimum(const Nearest& p, const Vec3& x, double slack) const;
    bool is_flat(std::int32_t s, std::int32_t t, const Edge& edge) const;
    std::int32_t opposite_corner(std::int32_t triangle, const Edge& edge) const;
    const Vec3& corner(std::int32_t triangle, std::size_t k) const;
    std::pair<std::size_t, std::size_t> triangles_of(std::size_t edge) const;

    Triangles mesh_;
    double flatness_ = 0.0;          // distance below which points count as coplanar [m]
    std::vector<Vec3> normals_;      // per triangle, unit
    std::vector<std::int32_t> face_; // element of each triangle
    std::int32_t faces_ = 0;
    std::vector<Edge> edges_;
    std::vector<std::int32_t> edge_triangles_;
    std::vector<std::array<std::int32_t, 3>> triangle_edges_; // edge k joins corners k and k + 1
    std::vector<std::size_t> point_first_;                    // per point: its edges in point_edges_
    std::vector<std::int32_t> point_edges_;
    std::vector<std::int32_t> point_element_;
    std::vector<Node> nodes_;
};

} // namespace plumb
