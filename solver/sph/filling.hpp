// Densities that are integrated do not know whether particles still fill the room: what sums over disordered
// neighbours, shifting and open sides get wrong adds up, a few per cent of the volume per exchange of the fluid.
#pragma once

namespace plumb {

struct SphFluid;

/// Lets densities follow how full the room is, within `filling_time` T: d rho_a/dt += rho_a (C_a - <C>)/T with C_a =
/// sum_b V_b W, particles of walls and open sides among the b. What gathers is pushed apart, and a volume that sums
/// lose at a rate e somewhere is kept within e T. The mean over all particles is taken off: disorder makes C some per
/// mille too great everywhere. (A new start of the densities would set C at once, with all its noise: Colagrossi &
/// Landrini 2003, J. Comput. Phys. 191, 448, sec. 3.3.)
///
/// With a free surface the room can follow, and C - 1 takes the place of C - <C>, inside the fluid only: as far as
/// |grad C| h/C is below 0.4 (1.5 at a surface, 0.13 a smoothing length below it), in full below 0.2, however full it
/// is there. Without it a thin jet, to which C = 0.6 is rho_0, fills a vessel half as high again as its volume.
void follow_filling(SphFluid& fluid);

} // namespace plumb
