// What the grid makes of a wave where its cells are cubes: the transform of a grain's weights, and the mean over all
// directions of a wave of what the second differences do to it.
#pragma once

#include "coupling/grid_kernels.hpp"

namespace plumb {

/// w^(k width): the three-dimensional Fourier transform of a grain's weights; 1 at 0. That of the kernel: what sampling
/// at the nodes adds is small where the kernel's deviation is a cell (GridShell::inside).
double kernel_transform(const GridKernel& kernel, double k_width);

/// Standard deviation of the kernel along an axis, in widths.
double deviation_in_widths(const GridKernel& kernel);

/// Waves of one number k in all directions on cubes of `cell` [m].
struct GridShell {
    double inside = 0.0; // share of the directions in which the grid knows the wave: |k_i| < pi/cell
    double square = 0.0; // [1/m2] of the friction, which is nu K^2 with K_i = (2/cell) sin(k_i cell/2): 1/<1/K^2>
};

/// The mean of 1/K^2, for by the symmetry of cubes the mean of (I - KK/K^2)/K^2 over the directions is 2/3 of it: the
/// steady creeping wake is that of the grid, a growing one to second order of what directions differ by.
GridShell grid_shell(double k, double cell);

} // namespace plumb
