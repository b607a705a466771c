// The sweep for smoothing lengths that follow the density.
#pragma once

#include "sph/fluid.hpp"

namespace plumb {

/// Accelerations and density rates with h_a = h (rho_0/rho_a)^(1/d) for every particle, and the Omega that belongs to
/// it:
///     rho_a' = 1/Omega_a sum m v_ab . grad W(h_a)
///     v_a'   = - sum m [ p_a/(Omega_a rho_a^2) grad W(h_a) + p_b/(Omega_b rho_b^2) grad W(h_b) ] + viscosity
///     Omega_a = 1 + h_a/(d rho_a) sum m dW(h_a)/dh
/// which conserve momentum, and energy with du = p/rho^2 drho (Springel & Hernquist 2002, Mon. Not. R. Astron. Soc.
/// 333, 649). Omega is that of the last evaluation. Viscosity, diffusion and shifting use the mean of both gradients. h
/// grows to VariableOperators::greatest_growth times its value at rho_0 at most. Among grains rho, P/rho^2 and m/rho in
/// the records are those of the superficial density and `share` the particle's mass: the same sums.
void evaluate_variable(SphFluid& fluid);

} // namespace plumb
