// Source terms: what is added to the rates of a particle at its own place and time.
//
// To add one: write the struct, name it in Source at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"
#include "core/manufactured_flow.hpp"

#include <variant>

namespace plumb {

struct SourceRates {
    Vec3 acceleration = Vec3::Zero(); // [m/s2]
    double density_rate = 0.0;        // [kg/(m3 s)]
};

/// Nothing is added.
struct NoSource {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"s_v = 0, s_rho = 0", "any", "definition"};
    SourceRates operator()(const Vec3& /*x*/, double /*t*/, const FluidNumbers& /*f*/) const { return {}; }
};

/// What turns the flow of manufactured_flow.hpp into a solution of
///     Drho/Dt = -rho div v + s_rho,   Dv/Dt = -grad p/rho + mu/rho lap v + s_v,   p = p(rho).
struct ManufacturedSource {
    static constexpr std::string_view name = "manufactured";
    static constexpr LawInfo info{
        "s_v = v_t + v.grad v + (grad p - mu lap v)/rho, s_rho = (p_t + v.grad p)/(dp/drho) + rho div v",
        "square box in the plane", "verification/mms, eq. 3; Roache 2002, J. Fluids Eng. 124, 4"};
    ManufacturedFlow flow;
    ManufacturedSource() = default;
    explicit ManufacturedSource(Table& table) : flow(table) {}
    SourceRates operator()(const Vec3& x, double t, const FluidNumbers& f) const {
        const ManufacturedFlow::State s = flow.at(x, t, f);
        const double rho =
            std::visit([&](const auto& l) { return l.density(s.p, f.density, f.sound_speed); }, f.equation_of_state);
        const double slope =
            std::visit([&](const auto& l) { return l.slope(rho, f.density, f.sound_speed); }, f.equation_of_state);
        return {s.v_rate + s.convection + (s.p_gradient - f.viscosity * s.laplacian) / rho,
                (s.p_rate + s.v.dot(s.p_gradient)) / slope + rho * s.div_v};
    }
};

using Source = std::variant<NoSource, ManufacturedSource>;

} // namespace plumb
