// The fields that make up a fluid's state, by their names in a checkpoint: writing and reading go through the same
// lists.
#pragma once

#include "grid/grid_fluid.hpp"
#include "sph/fluid.hpp"

#include <fmt/format.h>

namespace plumb {

inline constexpr std::int64_t format_version = 6; // to be raised with every change of the layout or of what it means
inline constexpr const char* format_name = "plumb checkpoint";

/// Fields of the smoothed particles in the order of ids; `visit` takes a name and the field.
template <class Fluid, class Visit> void for_each_fluid_field(Fluid& f, Visit&& visit) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
        visit(fmt::format("sph/x_{}", axis_names[c]), f.x[c]);
        visit(fmt::format("sph/v_{}", axis_names[c]), f.v[c]);
        visit(fmt::format("sph/a_{}", axis_names[c]), f.a[c]);
        visit(fmt::format("sph/x_listed_{}", axis_names[c]), f.x_listed[c]);
    }
    visit("sph/rho", f.rho);
    visit("sph/drho", f.drho);
    if (!f.lengths.omega.empty()) visit("sph/omega", f.lengths.omega);
    if (f.among_grains()) visit("sph/share", f.share);
    if (f.memory == 0.0) return;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        visit(fmt::format("sph/a_before_{}", axis_names[c]), f.a_before[c]);
    visit("sph/drho_before", f.drho_before);
}

/// Fields of the boundary particles.
template <class Boundary, class Visit> void for_each_boundary_field(Boundary& b, int dimensions, Visit&& visit) {
    for (std::size_t c = 0; c < static_cast<std::size_t>(dimensions); ++c) {
        visit(fmt::format("sph/boundary/x_{}", axis_names[c]), b.x[c]);
        visit(fmt::format("sph/boundary/mirror_{}", axis_names[c]), b.mirror[c]);
        visit(fmt::format("sph/boundary/velocity_{}", axis_names[c]), b.velocity[c]);
        visit(fmt::format("sph/boundary/mirror_velocity_{}", axis_names[c]), b.mirror_velocity[c]);
        visit(fmt::format("sph/boundary/x_listed_{}", axis_names[c]), b.x_listed[c]);
        visit(fmt::format("sph/boundary/mirror_listed_{}", axis_names[c]), b.mirror_listed[c]);
    }
    visit("sph/boundary/mean_speed", b.mean_speed);
    visit("sph/boundary/mean_pressure", b.mean_pressure);
    visit("sph/boundary/rho", b.rho);
    visit("sph/boundary/share", b.share);
    visit("sph/boundary/eps", b.eps);
}

/// Calls visit(name, field) for the state of the fluid on a grid.
template <class Fluid, class Visit> void for_each_grid_field(Fluid& f, Visit&& visit) {
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        visit(fmt::format("grid/u_{}", axis_names[c]), f.u[c]);
        if (!f.u_before[0].empty()) visit(fmt::format("grid/u_before_{}", axis_names[c]), f.u_before[c]);
    }
    visit("grid/p", f.p);
    visit("grid/eps", f.eps);
    if (!f.eps_taken.empty()) visit("grid/eps_taken", f.eps_taken);
    if (!f.eps_before.empty()) visit("grid/eps_before", f.eps_before);
}

} // namespace plumb
