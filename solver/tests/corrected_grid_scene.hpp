// Grains in a fluid on a grid, their own disturbance taken out: a scene that is broken off and resumed.
#pragma once

namespace plumb::fixture::checkpoint_scenes {

/// Grains fall in a cube and are told their own wakes.
inline constexpr const char* corrected_on_grid = R"(
[domain]
size = [1.6e-3, 1.6e-3, 1.6e-3]
periodic = [true, true, true]
gravity = [1.0, 0.0, -9.81]
[fluid]
method = "grid"
dimensions = 3
density = 1000.0
viscosity = 1e-3
spacing = 2e-4
advection = "central"
residual = 1e-6
pressure = "dynamic"
initial = {law = "rest"}
[grains]
name = "grains"
diameter = 1e-4
density = 2500.0
rotation = false
motion = "free"
velocity = [0.0, 0.0, 0.0]
arrange = {law = "random", count = 5, lower = [0.0, 0.0, 0.0], upper = [1.6e-3, 1.6e-3, 1.6e-3], seed = 2}
contact = "none"
[coupling]
direction = "two_way"
kernel = "gaussian"
kernel_width = {times_diameter = 2.0}
drag = "di_felice"
forces = ["buoyancy", "pressure_gradient"]
exchange = "exponential"
mean_pressure_gradient = "balances_weight"
own_volume = "included"
least_porosity = 0.3
self_disturbance = {law = "oseen_brinkman", history = "unsteady", advection = "slip", structure = "lone"}
suspension_viscosity = "none"
[time]
end = 0.02
output_interval = 0.005
integrator = "bdf2"
step = 1e-3
grain_step = "auto"
[[probe]]
name = "v"
quantity = "grain_mean_velocity"
axis = "z"
)";

} // namespace plumb::fixture::checkpoint_scenes
