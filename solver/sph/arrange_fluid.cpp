#include "sph/arrange_fluid.hpp"

#include "core/random.hpp"

#include <cmath>

namespace plumb {

void fill_box(SphFluid& f, double jitter, std::uint64_t seed) {
    std::array<std::int64_t, 3> n{1, 1, 1};
    for (int c = 0; c < f.dimensions; ++c) {
        n[static_cast<std::size_t>(c)] = std::llround(f.domain.size[c] / f.spacing);
    }
    const auto count = static_cast<std::size_t>(n[0] * n[1] * n[2]);
    for (VectorField* field : {&f.x, &f.v, &f.a, &f.x_listed})
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) (*field)[c].assign(count, 0.0);
    f.rho.assign(count, f.density);
    f.drho.assign(count, 0.0);
    f.id.resize(count);
    Random random(seed);
    for (std::size_t k = 0; k < count; ++k) {
        f.id[k] = static_cast<std::int32_t>(k);
        const auto at = static_cast<std::int64_t>(k);
        const std::array<std::int64_t, 3> cell{at % n[0], at / n[0] % n[1], at / (n[0] * n[1])};
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
            f.x[c][k] = (static_cast<double>(cell[c]) + 0.5 + (jitter > 0.0 ? random.uniform(-jitter, jitter) : 0.0)) *
                        f.spacing;
    }
}

} // namespace plumb
