// The state of a run at one moment, as probes see it: whatever several probes need is found once.
#pragma once

#include "core/parallel.hpp"
#include "run/touching.hpp"
#include "schemes/simulation.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace plumb {

class Sample {
public:
    explicit Sample(const Simulation& state)
        : simulation(state), grains(state.grains.grains), place(positions_of_ids(state.grains.grains)) {}

    const Simulation& simulation;
    const Grains& grains;
    const std::vector<std::int32_t> place; // of each id in the present order

    std::size_t at(std::size_t id) const { return static_cast<std::size_t>(place[id]); }
    /// Contacts in the order of ids; found when first asked for.
    const std::vector<TouchingPair>& pairs() const {
        if (!pairs_) pairs_ = touching_pairs(simulation.grains, simulation.timing.dt);
        return *pairs_;
    }
    const std::vector<TouchingWall>& walls() const {
        if (!walls_) walls_ = touching_walls(simulation.grains, simulation.timing.dt);
        return *walls_;
    }
    /// Sum of term(k) over all grains in the order of their ids; k is the place.
    template <class T, class Term> T sum(const T& zero, Term&& term) const {
        return ordered_sum(place.size(), zero, [&](std::size_t id) -> T { return term(at(id)); });
    }

private:
    mutable std::optional<std::vector<TouchingPair>> pairs_;
    mutable std::optional<std::vector<TouchingWall>> walls_;
};

} // namespace plumb
