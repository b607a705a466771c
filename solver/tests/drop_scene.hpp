// A drop on a floor, whose run is broken off and resumed.
#pragma once

namespace plumb::fixture::checkpoint_scenes {

/// A drop under surface tension that settles on a floor.
inline constexpr const char* drop = R"(
[domain]
size = [3.0, 1.5]
periodic = [false, false]
gravity = [0.0, 0.0]
[fluid]
method = "sph"
density = 1.0
viscosity = 0.1
spacing = 0.1
smoothing = 2.0
kernel = "wendland_c2"
equation_of_state = "tait"
sound_speed = 10.0
pressure = "full"
operators = "plain"
viscous_term = "monaghan_gingold"
surface = {law = "continuum_surface_force", tension = 1.0}
free_surface = true
fill = {law = "ellipsoid", centre = [1.5, 0.0], semi_axes = [1.0, 0.8]}
arrange = {law = "jittered", jitter = 0.1, seed = 1}
initial = {law = "uniform_pressure", pressure = 1.0}
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
slip = "no_slip"
contact_angle = 1.22
[time]
end = 0.2
output_interval = 0.02
integrator = "damped_midpoint"
step = "auto"
[[probe]]
name = "moment"
quantity = "fluid_second_moment"
axis = "x"
)";

} // namespace plumb::fixture::checkpoint_scenes
