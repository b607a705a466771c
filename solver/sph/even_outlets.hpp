// Outlets that let the fluid out at one speed everywhere, as a sieve above a recirculating flow does.
//
// The buffer is a lattice that recedes as a whole. Fluid follows it; once the lattice has gone a spacing, a layer from
// its far end takes the place of the fluid at the plane. A lattice that comes in, since fluid is missing, hands its
// first layer to the fluid. So nothing is let through but what the side's speed asks for, wherever a jet meets it.
#pragma once

namespace plumb {

struct SphFluid;

/// Sets how fast even outlets let out: together what the inlets bring in, more or less by what has gathered in the box
/// or is missing.
void set_even_outflow(SphFluid& fluid);

/// Mass in front of all open sides [kg]: a row of a buffer counts more and more over its last spacing before the plane,
/// so that what passes counts steadily, wherever the fluid's own particles are.
double mass_inside(const SphFluid& fluid);

/// Fluid and lattice change places at the planes. The lists have to be renewed.
void pass_even_outlets(SphFluid& fluid);

/// After the rates of the present step are there: the speeds leave the pressure's level free, and all densities follow,
/// evenly, the pressure that the outlets are given.
void hold_open_pressure(SphFluid& fluid);

} // namespace plumb
