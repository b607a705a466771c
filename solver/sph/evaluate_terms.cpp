#include "sph/sweep.hpp"

namespace plumb {

void evaluate_terms(SphFluid& f) {
    std::visit([&](const auto& kernel) { evaluate_with<std::decay_t<decltype(kernel)>>(f); }, f.kernel);
}

} // namespace plumb
