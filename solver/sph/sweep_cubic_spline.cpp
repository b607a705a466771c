#include "sph/sweep.hpp"

namespace plumb {
template void evaluate_with<CubicSpline>(SphFluid&);
} // namespace plumb
