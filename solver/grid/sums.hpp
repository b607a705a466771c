// The fluid on a grid as a whole, and at the centres of its cells.
#pragma once

#include "core/parallel.hpp"
#include "grid/grid_fluid.hpp"

namespace plumb {

/// Open volume of the control volume of a face [m3].
double control_volume(const GridFluid& fluid, std::size_t c, const Place& face);

/// Mean over the fluid's volume of term(u_c, x), u_c a component of the velocity [m/s] and x its face's centre.
template <class Term> double volume_mean(const GridFluid& f, std::size_t c, Term&& term) {
    const Block faces = f.grid.faces(c);
    const auto over_faces = [&](auto&& of) {
        return ordered_sum(faces.size(), 0.0, [&](std::size_t k) {
            const Place p = faces.place(k);
            return control_volume(f, c, p) * of(k, p);
        });
    };
    const double volume = over_faces([](std::size_t /*k*/, const Place& /*p*/) { return 1.0; });
    return over_faces([&](std::size_t k, const Place& p) { return term(f.u[c][k], f.grid.face_centre(c, p)); }) /
           volume;
}

/// Velocity in the middle of a cell: of a cubic through four faces where they and the cells between them are open, else
/// the mean of two [m/s].
Vec3 centre_velocity(const GridFluid& fluid, const Place& cell);

} // namespace plumb
