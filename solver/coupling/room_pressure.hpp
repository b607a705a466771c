// The pressure's force on fluid and grains as the derivative of one energy.
//
// A particle's density is that of its mass in the room that grains leave it, rho share/eps with eps = 1 - sum V_j W, so
// the energy of the compressed fluid depends on where its particles are and where the grains are. Its derivatives are
//
//     m_a dv_a/dt = -m^2 sum_b (eps_a p_a/rho_a^2 + eps_b p_b/rho_b^2) grad W + p_a V_a grad eps_a,       V_a = m/rho_a
//     (1) m_j dv_j/dt = -V_j sum_a p_a V_a grad_j W(x_j - x_a) (2)
//
// that is -eps grad p for the fluid, split as a duct of varying width splits it, and -grad p on the room of a grain:
// model A. What a particle gets from a grain's room in (1) the grain gets turned round in (2), so momentum is kept, and
// the pressure does no work but what compresses the fluid: no particle or grain can draw on it at rest, however steep
// eps is and whatever the speed of sound. Where instead grains gather grad p and hand it on, the fluid's lattice is
// unstable beside them (verification/porosity_step). After Monaghan & Kocharyan 1995, Comput. Phys. Commun. 87, 225,
// sec. 3, whose gas and dust share the pressure likewise.
#pragma once

#include "core/walls.hpp"
#include "coupling/weights.hpp"

#include <vector>

namespace plumb {

/// Adds p_a V_a grad eps_a/m_a to the accelerations of the fluid, whose records hold eps p/rho^2.
void add_room_pressure(SphFluid& fluid, const Weights& weights);

/// -sum_a p_a V_a grad_j W by id [N/m3], what the pressure does to a grain's volume; with its mirrors in walls.
void gather_room_pressure(const Weights& weights, const SphFluid& fluid, const MirroredGrains& mirrored,
                          const std::vector<WallBody>& walls, const std::vector<Vec3>& x, std::vector<Vec3>& stress);

} // namespace plumb
