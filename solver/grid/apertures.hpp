// What immersed walls leave of the grid: the open shares of edges, faces and cells.
//
// Walls cross the edges of the grid; between these points a cut face is a polygon and a cut cell a polyhedron. Volumes
// and fluxes are those of polyhedron and polygon, velocities the means over the open parts of the faces (Cheny &
// Botella 2010, J. Comput. Phys. 229, 1043, place them so too).
#pragma once

#include "core/field.hpp"
#include "core/vec.hpp"
#include "grid/grid.hpp"

#include <functional>

namespace plumb {

/// Where the velocity of a face that a wall cuts stands in it, in space: its centroid, as the edges and the wall see
/// it. Along the two axes after the face's own, towards the lower and the upper end, in widths of the face.
struct CutFace {
    // to the line of the edge, from the place at the height of the edge's open part that is as far from the wall
    std::array<std::array<double, 2>, 2> to_edge{};
    std::array<std::array<double, 2>, 2> to_wall{}; // along the axis
};

struct Apertures {
    std::array<Field<double>, 3> face; // open share, by face of each axis
    Field<double> cell;                // open share of the volume
    std::array<Field<double>, 3> edge; // open share, by edge along each axis; empty where nothing is immersed
    // In space only; in the plane the middle of a face's open part is all there is to know.
    std::array<std::vector<int>, 3> cut; // by face of each axis: number in `cut_face`, -1 if it is not cut
    std::vector<CutFace> cut_face;

    /// Of face k of axis c along axis d, as CutFace has them.
    double to_edge(std::size_t c, std::size_t k, std::size_t d, std::size_t way) const {
        const CutFace* found = cut_at(c, k);
        return found ? found->to_edge[(d + 2 - c) % 3][way] : 0.5 * face[c][k];
    }
    double to_wall(std::size_t c, std::size_t k, std::size_t d, std::size_t way) const {
        const CutFace* found = cut_at(c, k);
        return found ? found->to_wall[(d + 2 - c) % 3][way] : 0.5 * face[c][k];
    }

    /// Of the edge along axis e at a place of `grid.edges(e)`.
    double edge_share(const Grid& grid, std::size_t e, const Place& place) const {
        return edge[e].empty() ? 1.0 : edge[e][grid.edges(e).at(place)];
    }

private:
    const CutFace* cut_at(std::size_t c, std::size_t k) const {
        return cut[c].empty() || cut[c][k] < 0 ? nullptr : &cut_face[static_cast<std::size_t>(cut[c][k])];
    }
};

/// Everything open.
Apertures open_grid(const Grid& grid);

/// The grid outside what has a negative `distance` [m] to its surface, which may be off by a factor that is smooth. In
/// the plane nothing is cut along z, and `distance` is that at z = 0.
Apertures cut_grid(const Grid& grid, const std::function<double(const Vec3&)>& distance);

} // namespace plumb
