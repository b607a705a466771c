// What the sums over neighbours make of a wave, in the limit of many neighbours: transforms of the kernels and the rate
// at which the viscous term damps a transverse wave. lattice_rates.hpp has the same on the lattice, for limits.
#pragma once

#include "sph/fluid.hpp"

namespace plumb {

/// W^(k h): the three-dimensional Fourier transform of a kernel; 1 at 0.
double kernel_transform(const Kernel& kernel, double kh);

/// lambda(k) [1/s]: decay of a transverse wave of number k [1/m] by the fluid's viscous term (without artificial
/// viscosity) in three dimensions; nu k^2 for k h -> 0. DoubleGradient: that of an exact operator.
double transverse_decay(const SphFluid& fluid, double k);

} // namespace plumb
