// A scene whose state has to survive a checkpoint: free grains on a sieve, with open sides above and below.
#pragma once

namespace plumb::fixture::checkpoint_scenes {

/// Shared pressure, mirrored grains, an inlet that opens, an even outlet, diffusion, shifting and filling among grains.
inline constexpr const char* bed = R"(
[domain]
size = [7.7e-3, 7.7e-3, 8.8e-3]
periodic = [true, true, false]
gravity = [0.0, 0.0, -9.81]
[fluid]
method = "sph"
density = 997.0
viscosity = 8.93e-4
spacing = 1.1e-3
smoothing = 1.5
kernel = "wendland_c2"
equation_of_state = "linear"
operators = "plain"
artificial_viscosity = 0.02
density_diffusion = 0.1
shifting = 4.0
reference_velocity = 0.01
filling_time = 0.1
sound_speed = 1.0
pressure = "dynamic"
viscous_term = "morris"
arrange = {law = "lattice"}
initial = {law = "rest"}
[grains]
name = "seed"
density = 1160.0
diameter = 1.1e-3
rotation = true
motion = "free"
arrange = {law = "jittered", count = 100, spacing = 1.36118e-3, jitter = 0.12e-3, lower = [0.0, 0.0, 0.0], upper = [7.6e-3, 7.6e-3, 8.8e-3], seed = 1}
velocity = [0.0, 0.0, 0.0]
angular_velocity = [0.0, 0.0, 0.0]
contact = {law = "linear_spring", stiffness = 10.0, restitution = 0.5, friction = 0.3, tangential_stiffness = 2.8, tangential_damping = 0.0, rolling = {law = "none"}}
[[wall]]
name = "sieve"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
holds = "grains"
contact = "as_grains"
[[inlet]]
name = "floor"
point = [3.85e-3, 3.85e-3, 0.0]
normal = [0.0, 0.0, 1.0]
averaging_time = 0.005
profile = {law = "uniform", speed = 2e-2}
opens = {from = 0.01, over = 0.05}
[[outlet]]
name = "top"
point = [3.85e-3, 3.85e-3, 8.8e-3]
normal = [0.0, 0.0, -1.0]
averaging_time = 0.005
pressure = 0.0
even = true
[coupling]
direction = "two_way"
kernel = "wendland_c2"
kernel_width = {times_smoothing = 1.0}
at_walls = "mirrored"
porosity = "kernel"
own_volume = "included"
fluid_mass = "displaced"
pressure_force = "shared"
drag = "gidaspow"
forces = ["buoyancy", "pressure_gradient"]
exchange = "exponential"
self_disturbance = "none"
suspension_viscosity = "none"
[time]
end = 0.5
output_interval = 0.1
integrator = "damped_midpoint"
step = 5e-4
grain_step = 1e-4
[[probe]]
name = "z"
quantity = "grain_mean_position"
axis = "z"
)";

} // namespace plumb::fixture::checkpoint_scenes
