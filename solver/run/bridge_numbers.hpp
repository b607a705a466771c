// Dimensionless numbers of the liquid bridges of a scene.
#pragma once

#include "dem/grain_system.hpp"

#include <string>
#include <vector>

namespace plumb {

/// The bridge between the smallest grains of two materials, or between the smallest grain and a wall.
struct BridgeNumbers {
    std::string a, b;              // groups or walls
    double attraction = 0.0;       // f at contact [N]
    double bond = 0.0;             // weight of the lighter grain over f: it hangs by one bridge below 1
    double largest_bond = 0.0;     // the same of the largest grains at the start; 0 where there are none yet
    double volume_ratio = 0.0;     // V/R^3
    double rupture_distance = 0.0; // [m]
    double sticking_speed = 0.0;   // of approach, below which an elastic impact does not part: sqrt(2 W/m*) [m/s]
};

/// One entry per pair of materials with bridges.
std::vector<BridgeNumbers> bridge_numbers(const GrainSystem& system);

} // namespace plumb
