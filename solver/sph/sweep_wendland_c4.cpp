#include "sph/sweep.hpp"

namespace plumb {
template void evaluate_with<WendlandC4>(SphFluid&);
} // namespace plumb
