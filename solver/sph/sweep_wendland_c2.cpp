#include "sph/sweep.hpp"

namespace plumb {
template void evaluate_with<WendlandC2>(SphFluid&);
} // namespace plumb
