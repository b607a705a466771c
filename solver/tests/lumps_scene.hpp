// A scene for the tests of checkpoints: liquid bridges that form, hold and break.
#pragma once

namespace plumb::fixture::checkpoint_scenes {

/// Wet grains fall on a wet floor and pull each other into lumps; some bridges break, others form, more grains come.
inline constexpr const char* lumps = R"(
[domain]
size = [0.012, 0.012, 0.03]
periodic = [true, true, false]
gravity = [0.5, 0.0, -9.81]
[grains]
name = "sand"
density = 2500.0
diameter = {law = "uniform", minimum = 0.9e-3, maximum = 1.3e-3, seed = 3}
rotation = true
motion = "free"
arrange = {law = "random", count = 150, lower = [0.0, 0.0, 0.001], upper = [0.012, 0.012, 0.012], seed = 4}
velocity = {law = "uniform_random", speed = 0.5, seed = 5}
angular_velocity = [0.0, 100.0, 0.0]
[grains.contact]
law = "hertz_mindlin"
young = 1e7
poisson = 0.3
restitution = 0.8
friction = 0.5
rolling = "none"
cohesion = {law = "liquid_bridge", surface_tension = 0.07, contact_angle = 0.2, volume = {times_diameter_cubed = 1e-3}}
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
name = "bridges"
quantity = "bridge_count"
[[probe]]
name = "contact_energy"
quantity = "grain_contact_energy"
[[probe]]
name = "weight"
quantity = "wall_force"
wall = "floor"
axis = "z"
)";

} // namespace plumb::fixture::checkpoint_scenes
