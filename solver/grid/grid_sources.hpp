// What is added to the momentum equation of the fluid on a grid at a place and a time.
//
// To add one: write the struct, name it in GridSource at the end, add its test and its README row.
#pragma once

#include "core/manufactured_medium.hpp"
#include "grid/resistance.hpp"

#include <variant>

namespace plumb {

/// Nothing is added.
struct NoGridSource {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"s = 0", "any", "definition"};
    Vec3 operator()(const Vec3& /*x*/, double /*t*/, const FluidNumbers& /*f*/) const { return Vec3::Zero(); }
};

/// What turns the flow of manufactured_medium.hpp into a solution of
///     eps rho (du/dt + u . grad u) = -eps grad p + div(eps mu grad u) - beta u + eps rho s.
struct ManufacturedMediumSource {
    static constexpr std::string_view name = "manufactured_medium";
    static constexpr LawInfo info{"s = u_t + u . grad u + (grad p - mu div(eps grad u)/eps + beta u/eps)/rho",
                                  "square box in the plane",
                                  "verification/mms_grid, eq. 3; Roache 2002, J. Fluids Eng. 124, 4"};
    ManufacturedMedium flow;
    Resistance resistance;
    explicit ManufacturedMediumSource(Table& table)
        : flow(table), resistance(make_family<Resistance>(table.law("resistance"))) {}
    /// [m/s2]
    Vec3 operator()(const Vec3& x, double t, const FluidNumbers& f) const {
        const ManufacturedMedium::State s = flow.at(x, t, f.size, f.density);
        const double beta = std::visit(
            [&](const auto& law) { return law(s.eps, s.u.norm(), f.density, f.viscosity).beta; }, resistance);
        return s.u_rate + s.convection + (s.p_gradient - f.viscosity * s.friction + beta / s.eps * s.u) / f.density;
    }
};

using GridSource = std::variant<NoGridSource, ManufacturedMediumSource>;

} // namespace plumb
