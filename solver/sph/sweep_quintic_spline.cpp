#include "sph/sweep.hpp"

namespace plumb {
template void evaluate_with<QuinticSpline>(SphFluid&);
} // namespace plumb
