// What immersed walls leave of the grid: the open shares of faces and cells, in the plane.
//
// A cell that a wall cuts is a polygon between the points in which the wall crosses the grid's lines. Volumes and
// fluxes are those of the polygon, velocities the means over the open parts of the faces (Cheny & Botella 2010, J.
// Comput. Phys. 229, 1043, place them so too).
#pragma once

#include "core/field.hpp"
#include "core/fluid_wall.hpp"
#include "grid/grid.hpp"

#include <functional>

namespace plumb {

struct Apertures {
    std::array<Field<double>, 3> face; // open share, by face of each axis
    Field<double> cell;                // open share of the volume
    Field<char> corner;                // [nodes of x times nodes of y] 1 in the fluid; empty where nothing is immersed

    bool corner_open(const Grid& grid, int node_x, int node_y) const {
        return corner.empty() ||
               corner[static_cast<std::size_t>(node_x) + static_cast<std::size_t>(node_y) * grid.axis[0].node.size()] !=
                   0;
    }
};

/// Everything open.
Apertures open_grid(const Grid& grid);

/// The plane outside what has a negative `distance` [m] to its surface, which may be off by a factor that is smooth.
Apertures cut_plane(const Grid& grid, const std::function<double(const Vec3&)>& distance);

} // namespace plumb
