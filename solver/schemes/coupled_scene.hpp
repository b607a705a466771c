// What the [coupling] table says of smoothed particles and grains.
#pragma once

#include "core/table.hpp"
#include "schemes/advance_coupled.hpp"
#include "schemes/stable_step.hpp"

#include <functional>

namespace plumb {

/// Of the grains there are and of those that may be injected [m].
double largest_diameter(const GrainSystem& grains);

/// Kernels, their widths and the direction.
Coupling read_coupling(Table& coupling, SphFluid& fluid, const GrainSystem& grains);

/// InputError when smoothing lengths that follow the density would be cut off among the grains; after couple(), which
/// finds the porosity.
void check_growth(const Table& coupling, const SphFluid& fluid);

/// The forces of the fluid on the grains.
FluidOnGrains fluid_on_grains(Table& coupling, const SphFluid& fluid);

/// The same for any computed fluid; `full_pressure`: its pressure holds its weight, so buoyancy is in the gradient.
FluidOnGrains fluid_on_grains(Table& coupling, double density, double viscosity, bool full_pressure);

/// The mean pressure gradient that the scene names, `balancing` for "balances_weight", zero for none [Pa/m].
Vec3 read_mean_gradient(Table& coupling, const FluidOnGrains& on_grains, bool two_way,
                        const std::function<Vec3()>& balancing);

/// A mean pressure gradient, if the scene names one; after couple(), which sets the masses that it may have to balance.
void drive(Table& coupling, SphFluid& fluid, FluidOnGrains& on_grains, const Coupling& state,
           const GrainSystem& grains);

/// Limits of the fluid's step among the grains: friction is the greatest that the closure allows,
/// and acts on the least mass.
std::vector<StepLimit> coupled_limits(const SphFluid& fluid, const Coupling& coupling);

/// Steps of the grains in one of the fluid: what their limits ask for, or `time.grain_step`.
std::int64_t grain_steps(Table& time, double dt, const std::vector<StepLimit>& limits);

} // namespace plumb
