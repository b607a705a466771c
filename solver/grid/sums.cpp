#include "grid/sums.hpp"

namespace plumb {

double control_volume(const GridFluid& f, std::size_t c, const Place& face) {
    const Block cells = f.grid.cells();
    double volume = 0.0;
    for (const int cell : {f.grid.axis[c].cell_below(face[c]), f.grid.axis[c].cell_above(face[c])}) {
        Place p = face;
        p[c] = cell;
        if (cell >= 0) volume += 0.5 * f.open.cell[cells.at(p)] * f.grid.cell_volume(p);
    }
    return volume;
}

Vec3 centre_velocity(const GridFluid& f, const Place& cell) {
    Vec3 v = Vec3::Zero();
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const Axis& axis = f.grid.axis[c];
        const Block faces = f.grid.faces(c), cells = f.grid.cells();
        const auto at = [&](int face) {
            Place p = cell;
            p[c] = face;
            return f.u[c][faces.at(p)];
        };
        const auto whole = [&](int k) { // a cell that no wall cuts, as wide as this one
            Place p = cell;
            p[c] = k;
            return k >= 0 && f.open.cell[cells.at(p)] == 1.0 &&
                   std::abs(axis.width(k) - axis.width(cell[c])) < 1e-6 * axis.width(k);
        };
        const int below = axis.next(cell[c], 0), above = axis.next(cell[c], 1);
        const double two = 0.5 * (at(cell[c]) + at(axis.face_above(cell[c])));
        const bool four = whole(below) && whole(cell[c]) && whole(above);
        v[static_cast<Eigen::Index>(c)] =
            four ? two + (two - 0.5 * (at(below) + at(axis.face_above(above)))) / 8.0 : two;
    }
    return v;
}

} // namespace plumb
