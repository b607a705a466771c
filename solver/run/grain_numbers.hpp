// Dimensionless numbers of grains in a prescribed fluid, and what they say about the models that are chosen.
#pragma once

#include "schemes/simulation.hpp"

#include <string>
#include <vector>

namespace plumb {

/// One size of grain of one group in the fluid in the middle of the domain at the start.
struct GrainNumbers {
    std::string group;
    double diameter = 0.0;          // [m]
    double density_ratio = 0.0;     // grain / fluid
    double tau_p = 0.0;             // m/(3 pi mu d) [s]
    double terminal_velocity = 0.0; // steady slip under gravity by the chosen drag law, without the other forces [m/s]
    double re = 0.0;                // rho d u_t/mu, superficial
    bool drag_in_range = true;      // at that Re
    double st_impact = 0.0;         // density ratio Re/9: does a grain bounce off a wall in the fluid?
    double st_flow = 0.0;           // tau_p over the time scale of the flow; 0 for a steady uniform one
    double galileo = 0.0;           // sqrt(|ratio - 1| g d^3)/nu
};

/// The smallest and the largest grain of every group (one entry if they are the same). Empty without a fluid.
std::vector<GrainNumbers> grain_numbers(const Simulation& simulation);

/// Slip at which the drag of `fluid` carries the force `weight` [N] on a grain of `diameter` [m]; infinity without
/// drag.
double terminal_slip(const FluidOnGrains& fluid, double diameter, double eps, double weight);

/// A model and why it is named.
struct Remark {
    std::string model, reason;
};

/// Models that the scene leaves out although the numbers say they change something by more than a hundredth.
std::vector<Remark> missing_models(const Simulation& simulation);

/// Models that the scene declares although they cannot change anything.
std::vector<Remark> idle_models(const Simulation& simulation);

} // namespace plumb
