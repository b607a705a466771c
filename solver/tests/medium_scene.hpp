// A scene of a medium that fills a grid.
#pragma once

namespace plumb::fixture::checkpoint_scenes {

/// A medium whose porosity moves.
inline constexpr const char* medium_on_grid = R"(
[domain]
size = [1.0, 1.0]
periodic = [true, true]
gravity = [0.0, 0.0]
[fluid]
method = "grid"
density = 1.0
viscosity = 0.02
spacing = 0.125
advection = "linear_upwind"
residual = 1e-8
pressure = "full"
porosity = {law = "wave", mean = 0.7, amplitude = 0.15, waves = [1, 2], period = 0.5}
resistance = {law = "ergun", diameter = 0.6}
body_force = [1.0, 0.5]
initial = {law = "rest"}
[time]
end = 10.0
output_interval = 0.1
integrator = "bdf2"
step = 0.01
[[probe]]
name = "energy"
quantity = "fluid_kinetic_energy"
)";

} // namespace plumb::fixture::checkpoint_scenes
