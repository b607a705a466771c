// Scenes whose runs are broken off and resumed: between them every state that a checkpoint has to hold.
#pragma once

namespace plumb::fixture::checkpoint_scenes {

/// Grains of two sizes fall on a floor and on each other, rub, roll; more are injected.
inline constexpr const char* dry = R"(
[domain]
size = [0.012, 0.012, 0.03]
periodic = [true, true, false]
gravity = [0.5, 0.0, -9.81]
[[grains]]
name = "sand"
density = 2500.0
diameter = {law = "uniform", minimum = 0.9e-3, maximum = 1.3e-3, seed = 3}
rotation = true
motion = "free"
arrange = {law = "random", count = 150, lower = [0.0, 0.0, 0.001], upper = [0.012, 0.012, 0.012], seed = 4}
velocity = {law = "uniform_random", speed = 0.5, seed = 5}
angular_velocity = [0.0, 100.0, 0.0]
contact = {law = "linear_spring", stiffness = 1000.0, restitution = 0.8, friction = 0.5, tangential_stiffness = 300.0, tangential_damping = 0.01, rolling = {law = "elastic_plastic", friction = 0.1, stiffness = 1e-6, damping = 0.3}}
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
contact = "as_grains"
[[injector]]
group = "sand"
diameter = 1e-3
points = [[0.006, 0.006, 0.025]]
interval = 2e-3
velocity = [0.0, 0.0, -1.0]
start = 0.0
end = 1.0
[time]
end = 0.02
output_interval = 2e-3
integrator = "velocity_verlet"
step = "auto"
snapshots = true
[[probe]]
name = "energy"
quantity = "grain_kinetic_energy"
[[probe]]
name = "weight"
quantity = "wall_force"
wall = "floor"
axis = "z"
)";

/// A few grains in an oscillating fluid with every force that remembers something.
inline constexpr const char* wet = R"(
[domain]
size = [0.01, 0.01, 0.01]
periodic = [true, true, true]
gravity = [0.0, 0.0, -9.81]
[fluid]
method = "prescribed"
density = 1000.0
viscosity = 1e-3
flow = {law = "oscillating", amplitude = [0.05, 0.0, 0.0], frequency = 50.0}
[grains]
name = "glass"
density = 2500.0
diameter = 5e-4
rotation = true
motion = "free"
arrange = {law = "random", count = 30, lower = [0.0, 0.0, 0.0], upper = [0.01, 0.01, 0.01], seed = 1}
velocity = {law = "uniform_random", speed = 0.05, seed = 2}
angular_velocity = [0.0, 0.0, 0.0]
contact = {law = "hertz_mindlin", young = 1e6, poisson = 0.3, restitution = 0.7, friction = 0.3, rolling = "none"}
[coupling]
direction = "one_way"
drag = "schiller_naumann"
forces = ["buoyancy", "pressure_gradient", "virtual_mass", "basset"]
exchange = "exponential"
basset = {law = "exponentials", count = 8, window = 0.1}
[time]
end = 0.02
output_interval = 2e-3
integrator = "velocity_verlet"
step = "auto"
[[probe]]
name = "drag"
quantity = "grain_drag_force"
axis = "z"
[[probe]]
name = "force"
quantity = "grain_fluid_force"
axis = "x"
)";

/// A channel with open ends and a roof that comes down: boundary particles that move, appear and vanish.
inline constexpr const char* passing = R"(
[domain]
size = [1.0, 0.8]
periodic = [false, false]
gravity = [0.0, 0.0]
[fluid]
method = "sph"
density = 1000.0
viscosity = 10.0
spacing = 0.05
smoothing = 1.5
kernel = "wendland_c2"
equation_of_state = "linear"
sound_speed = 20.0
pressure = "full"
viscous_term = "morris"
operators = "plain"
density_diffusion = 0.1
shifting = 1.0
reference_velocity = 1.0
arrange = {law = "jittered", jitter = 0.1, seed = 1}
initial = {law = "channel", mean_speed = 1.0, centre = 0.4, half_width = 0.4}
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
slip = "no_slip"
[[wall]]
name = "roof"
shape = "plane"
point = [0.0, 0.8]
normal = [0.0, -1.0]
slip = "no_slip"
velocity = [0.0, -0.02]
[[inlet]]
name = "in"
point = [0.0, 0.4]
normal = [1.0, 0.0]
averaging_time = 0.1
profile = {law = "parabolic", mean_speed = 1.0, radius = 0.4}
[[outlet]]
name = "out"
point = [1.0, 0.4]
normal = [-1.0, 0.0]
averaging_time = 0.1
pressure = 0.0
[time]
end = 1.0
output_interval = 0.1
integrator = "damped_midpoint"
step = 2e-4
[[probe]]
name = "mean"
quantity = "fluid_mean_velocity"
axis = "x"
)";

/// Smoothed particles with every term, jittered so that lists are renewed often.
inline constexpr const char* flowing = R"(
[domain]
size = [1.0, 1.0]
periodic = [true, true]
gravity = [0.0, 0.0]
[fluid]
method = "sph"
density = 1.0
viscosity = 0.01
spacing = 0.05
smoothing = 1.5
kernel = "wendland_c2"
equation_of_state = "tait"
sound_speed = 10.0
pressure = "full"
operators = "plain"
viscous_term = "morris"
density_diffusion = 0.1
artificial_viscosity = 0.02
shifting = 4.0
reference_velocity = 1.0
arrange = {law = "jittered", jitter = 0.1, seed = 1}
initial = {law = "taylor_green", speed = 1.0}
[time]
end = 0.2
output_interval = 0.02
integrator = "midpoint"
step = "auto"
snapshots = true
[[probe]]
name = "energy"
quantity = "fluid_kinetic_energy"
)";

/// One grain in a fluid with a free surface on a floor: smoothing lengths that follow the density, blended rates.
inline constexpr const char* published = R"(
[domain]
size = [2.8e-3, 2.8e-3, 3.2e-3]
periodic = [true, true, false]
gravity = [0.0, 0.0, -9.81]
[fluid]
method = "sph"
density = 1150.0
viscosity = 8.9e-3
spacing = 4e-4
smoothing = 1.5
kernel = "wendland_c2"
equation_of_state = "tait"
sound_speed = 3.0
pressure = "full"
operators = "variable_h"
viscous_term = "morris"
free_surface = true
fill = {law = "box", lower = [0.0, 0.0, 0.0], upper = [2.8e-3, 2.8e-3, 2.8e-3]}
arrange = {law = "jittered", jitter = 0.1, seed = 1}
initial = {law = "hydrostatic", surface = 2.8e-3}
[grains]
name = "grain"
density = 2500.0
diameter = 1e-4
rotation = false
motion = "free"
velocity = [0.0, 0.0, 0.0]
arrange = {law = "single", position = [1.3e-3, 1.4e-3, 1.5e-3]}
contact = "none"
[coupling]
direction = "two_way"
kernel = "wendland_c2"
kernel_width = {times_smoothing = 1.0}
fluid_mass = "pure"
drag = "di_felice"
forces = ["pressure_gradient"]
exchange = "explicit"
porosity = "kernel"
own_volume = "included"
self_disturbance = "none"
suspension_viscosity = "none"
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
slip = "no_slip"
contact = "none"
[time]
end = 0.02
output_interval = 2e-3
integrator = "damped_midpoint"
step = 4e-5
grain_step = "auto"
[[probe]]
name = "v"
quantity = "grain_mean_velocity"
axis = "z"
)";

/// Flow around a cylinder on a grid, from inlet to outlet: two steps are remembered.
inline constexpr const char* on_grid = R"(
[domain]
size = [2.0, 1.0]
periodic = [false, false]
gravity = [0.0, 0.0]
[fluid]
method = "grid"
density = 1.0
viscosity = 0.02
spacing = 0.0625
advection = "central"
residual = 1e-8
pressure = "dynamic"
initial = {law = "uniform", velocity = [1.0, 0.0]}
[[inlet]]
name = "in"
point = [0.0, 0.5]
normal = [1.0, 0.0]
profile = {law = "parabolic", mean_speed = 1.0, radius = 0.5}
[[outlet]]
name = "out"
point = [2.0, 0.5]
normal = [-1.0, 0.0]
pressure = 3.0
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
slip = "no_slip"
[[wall]]
name = "roof"
shape = "plane"
point = [0.0, 1.0]
normal = [0.0, -1.0]
slip = "no_slip"
[[wall]]
name = "cylinder"
shape = "cylinder"
point = [0.7, 0.45]
radius = 0.2
side = "outside"
slip = "no_slip"
[time]
end = 0.5
output_interval = 0.05
integrator = "bdf2"
step = "auto"
snapshots = true
[[probe]]
name = "energy"
quantity = "fluid_kinetic_energy"
)";

/// Grains are dropped into a flow in a slab and held by rows of cylinders.
inline const char* const grains_on_grid = R"(
[domain]
size = [0.006, 0.016, 0.002]
periodic = [true, false, false]
gravity = [0.0, -9.81, 0.0]
[fluid]
method = "grid"
dimensions = 2
density = 1188.0
viscosity = 2.797e-2
spacing = 4e-4
stretch_y = {at = [0.0, 0.008, 0.016], times = [2.0, 1.0, 1.0]}
advection = "upwind"
residual = 1e-6
pressure = "dynamic"
initial = {law = "rest"}
[[wall]]
name = "back"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
slip = "free_slip"
contact = "as_grains"
[[wall]]
name = "front"
shape = "plane"
point = [0.0, 0.0, 0.002]
normal = [0.0, 0.0, -1.0]
slip = "free_slip"
contact = "as_grains"
[[wall]]
name = "rows"
shape = "cylinder_rows"
lower = [0.0, 0.002, 0.0]
upper = [0.006, 0.009, 0.002]
per_row = 3
between = "one_fewer"
porosity_at = [0.002]
porosity = [0.5]
slip = "no_slip"
contact = "as_grains"
[[inlet]]
name = "top"
point = [0.003, 0.016, 0.001]
normal = [0.0, -1.0, 0.0]
profile = {law = "uniform", speed = 0.1}
[[outlet]]
name = "bottom"
point = [0.003, 0.0, 0.001]
normal = [0.0, 1.0, 0.0]
pressure = 0.0
[[grains]]
name = "grains"
density = 2376.0
rotation = true
motion = "free"
arrange = {law = "none"}
contact = {law = "linear_spring", stiffness = 500.0, restitution = 0.3, friction = 0.3, tangential_stiffness = 200.0, tangential_damping = 0.01, rolling = "none"}
[[injector]]
group = "grains"
diameter = 8e-4
points = [[0.0012, 0.0145, 0.0007], [0.0029, 0.0145, 0.0013], [0.0044, 0.0145, 0.0006]]
interval = 0.01
velocity = [0.0, -0.1, 0.0]
start = 0.0
end = 1.0
[coupling]
direction = "two_way"
drag = "di_felice"
exchange = "exponential"
forces = ["buoyancy", "pressure_gradient", "virtual_mass", "saffman_mei"]
kernel = "gaussian"
kernel_width = {times_diameter = 0.5}
own_volume = "included"
least_porosity = 0.3
self_disturbance = "none"
suspension_viscosity = "none"
[time]
end = 0.1
output_interval = 0.025
integrator = "bdf2"
step = 5e-4
grain_step = "auto"
snapshots = true
[[probe]]
name = "pressure"
quantity = "fluid_greatest_pressure"
)";

} // namespace plumb::fixture::checkpoint_scenes
