#include "run/bridge_numbers.hpp"

#include "schemes/stable_step.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// Place of the largest grain of each group; the number of grains where there is none.
std::vector<std::size_t> largest_grains(const GrainSystem& system) {
    const Grains& g = system.grains;
    std::vector<std::size_t> largest(system.groups.size(), g.size());
    for (std::size_t k = 0; k < g.size(); ++k) {
        std::size_t& known = largest[static_cast<std::size_t>(g.group[k])];
        if (known == g.size() || g.radius[k] > g.radius[known]) known = k;
    }
    return largest;
}

/// Bond number of the largest grains of two materials, 0 when one of them has none.
double bond_of_largest(const GrainSystem& system, const PairBridge& bridge, const std::vector<std::size_t>& largest) {
    const Grains& g = system.grains;
    const bool wall = bridge.pair.b >= system.groups.size();
    const std::size_t a = largest[bridge.pair.a], b = wall ? a : largest[bridge.pair.b];
    if (a == g.size() || b == g.size()) return 0.0;
    const double inverse_radius = 1.0 / g.radius[a] + (wall ? 0.0 : 1.0 / g.radius[b]);
    return std::min(g.mass[a], g.mass[b]) * system.domain.gravity.norm() /
           LiquidBridge::attraction(bridge.law.parameters, 0.0, bridge.volume, inverse_radius);
}

} // namespace

std::vector<BridgeNumbers> bridge_numbers(const GrainSystem& system) {
    const auto name = [&](std::size_t m) {
        const std::size_t groups = system.groups.size();
        return m < groups ? system.groups[m].name : system.walls[m - groups].name;
    };
    const std::vector<std::size_t> largest = largest_grains(system);
    std::vector<BridgeNumbers> all;
    for (const PairBridge& bridge : least_bridges(system)) {
        const SizePair& pair = bridge.pair;
        const double radius = 2.0 / pair.inverse_radius;
        BridgeNumbers n{name(pair.a), name(pair.b)};
        n.attraction = LiquidBridge::attraction(bridge.law.parameters, 0.0, bridge.volume, pair.inverse_radius);
        n.bond = pair.lighter_mass * system.domain.gravity.norm() / n.attraction;
        n.largest_bond = bond_of_largest(system, bridge, largest);
        n.volume_ratio = bridge.volume / (radius * radius * radius);
        n.rupture_distance = bridge.law.rupture_distance(bridge.volume);
        n.sticking_speed =
            std::sqrt(2.0 * bridge.law.work_to_rupture(0.0, bridge.volume, pair.inverse_radius) * pair.inverse_mass);
        all.push_back(n);
    }
    return all;
}

} // namespace plumb
