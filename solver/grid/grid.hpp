// A Cartesian grid: cells between nodes along each axis, velocities on the faces normal to them, pressure in the cells
// (Harlow & Welch 1965, Phys. Fluids 8, 2182).
#pragma once

#include "core/vec.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace plumb {

/// One axis. Face k is at node k; on a periodic axis the last node is the first.
struct Axis {
    std::vector<double> node; // [m], ascending
    bool periodic = false;

    int cells() const { return static_cast<int>(node.size()) - 1; }
    int faces() const { return cells() + (periodic ? 0 : 1); }
    double width(int cell) const {
        const auto k = static_cast<std::size_t>(cell);
        return node[k + 1] - node[k];
    }
    double centre(int cell) const {
        const auto k = static_cast<std::size_t>(cell);
        return 0.5 * (node[k] + node[k + 1]);
    }
    /// The cells on either side of a face, -1 where the grid ends.
    int cell_below(int face) const { return face > 0 ? face - 1 : (periodic ? cells() - 1 : -1); }
    int cell_above(int face) const { return face < cells() ? face : -1; }
    int face_above(int cell) const { return periodic && cell + 1 == cells() ? 0 : cell + 1; }
    /// The next cell in one direction (way = 0 down, 1 up), -1 where the grid ends.
    int next(int cell, int way) const { return way == 0 ? cell_below(cell) : cell_above(face_above(cell)); }
    /// Length of the control volume around a face: half of each cell that is there.
    double dual_width(int face) const {
        const int below = cell_below(face), above = cell_above(face);
        return 0.5 * ((below < 0 ? 0.0 : width(below)) + (above < 0 ? 0.0 : width(above)));
    }
};

/// A number along each axis.
using Place = std::array<int, 3>;

/// The shape of an array over the grid, x fastest.
struct Block {
    Place n{1, 1, 1};
    std::size_t size() const {
        return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
    }
    std::size_t at(const Place& p) const {
        return static_cast<std::size_t>(p[0]) +
               static_cast<std::size_t>(n[0]) *
                   (static_cast<std::size_t>(p[1]) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(p[2]));
    }
    Place place(std::size_t k) const {
        const auto nx = static_cast<std::size_t>(n[0]), ny = static_cast<std::size_t>(n[1]);
        return {static_cast<int>(k % nx), static_cast<int>(k / nx % ny), static_cast<int>(k / (nx * ny))};
    }
};

/// Calls visit(place, number) for all of a block in its order.
template <class Visit> void for_each_place(const Block& block, Visit&& visit) {
    std::size_t k = 0;
    Place p;
    for (p[2] = 0; p[2] < block.n[2]; ++p[2])
        for (p[1] = 0; p[1] < block.n[1]; ++p[1])
            for (p[0] = 0; p[0] < block.n[0]; ++p[0]) visit(static_cast<const Place&>(p), k++);
}

/// Cells and faces. In the plane there is one cell along z, which no equation looks at: 1 m around z = 0, or the depth
/// of a box of three dimensions in which nothing of the fluid depends on z.
struct Grid {
    int dimensions = 2;
    std::array<Axis, 3> axis{};

    Block cells() const { return {{axis[0].cells(), axis[1].cells(), axis[2].cells()}}; }
    /// Faces across axis c.
    Block faces(std::size_t c) const {
        Block block = cells();
        block.n[c] = axis[c].faces();
        return block;
    }
    /// Edges along axis e: between nodes that are neighbours on it, those at the end of a periodic axis too.
    Block edges(std::size_t e) const {
        Block block;
        for (std::size_t c = 0; c < 3; ++c) block.n[c] = axis[c].cells() + (c == e ? 0 : 1);
        return block;
    }
    double cell_volume(const Place& p) const { return axis[0].width(p[0]) * axis[1].width(p[1]) * axis[2].width(p[2]); }
    /// Of the whole face, open or not [m2].
    double face_area(std::size_t c, const Place& p) const {
        double area = 1.0;
        for (std::size_t d = 0; d < 3; ++d)
            if (d != c) area *= axis[d].width(p[d]);
        return area;
    }
    Vec3 centre(const Place& p) const { return {axis[0].centre(p[0]), axis[1].centre(p[1]), axis[2].centre(p[2])}; }
    Vec3 face_centre(std::size_t c, const Place& p) const {
        Vec3 x;
        for (std::size_t d = 0; d < 3; ++d)
            x[static_cast<Eigen::Index>(d)] =
                d == c ? axis[d].node[static_cast<std::size_t>(p[d])] : axis[d].centre(p[d]);
        return x;
    }
};

/// `cells` equal cells over `length` [m].
inline Axis even_axis(double length, int cells, bool periodic) {
    Axis axis;
    axis.periodic = periodic;
    axis.node.resize(static_cast<std::size_t>(cells) + 1);
    for (std::size_t k = 0; k < axis.node.size(); ++k)
        axis.node[k] = length * static_cast<double>(k) / static_cast<double>(cells);
    return axis;
}

/// Cells whose width goes linearly from each of the places `at` [m] to the next, `width` [m] there, over [0,
/// at.back()]; all are narrowed by the one factor that makes their number whole.
Axis stretched_axis(const std::vector<double>& at, const std::vector<double>& width, bool periodic);

} // namespace plumb
