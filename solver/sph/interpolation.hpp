// State of the fluid at places between its particles, by moving least squares.
#pragma once

#include "core/vec.hpp"
#include "sph/clusters.hpp"

#include <array>

namespace plumb {

struct SphFluid;

/// Velocity [m/s], pressure [Pa], its slope [Pa/m] and the fluid fraction at eight places; `covered` is sum V W, 1 well
/// inside the fluid and 0 far outside. The pressure is the fluid's own (own_pressure).
struct InterpolatedGroup {
    std::array<Pack, 3> u{}, p_slope{};
    Pack p{}, eps = broadcast<Pack>(1.0), covered{};
};

/// At eight places, from the records listed near them: the linear function that fits best with weights V W (exact for
/// linear fields). Where the particles do not determine a linear function, their weighted mean; 0 where there are none.
/// Lancaster & Salkauskas 1981, Math. Comput. 37, 141.
InterpolatedGroup interpolated(const SphFluid& fluid, const std::array<Pack, 3>& places,
                               std::span<const std::int32_t> near);

} // namespace plumb
