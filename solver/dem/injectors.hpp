// Injectors: grains that enter during the run, one at each point every interval.
//
// Event k of every point is due at start + k interval, computed by this product, so no error builds up; events lie in
// [start, end). A grain whose point is taken by another grain waits until the point is free, and those due after it
// wait behind it: no grain is lost. What has been injected is one number per point, so a run resumes exactly.
#pragma once

#include "core/domain.hpp"
#include "core/table.hpp"
#include "core/walls.hpp"
#include "dem/grains.hpp"
#include "dem/start_laws.hpp"

#include <cstdint>
#include <vector>

namespace plumb {

struct Injector {
    std::int32_t group = 0;
    DiameterLaw diameter = EqualDiameters(0.0);
    std::vector<Vec3> points;                      // [m]
    std::vector<double> point_diameter;            // per point [m], only for diameter = {law = "file"}
    double interval = 0.0, start = 0.0, end = 0.0; // [s]
    Vec3 velocity = Vec3::Zero();                  // [m/s]

    /// Diameter [m] of grain `number` of point `point`: a pure function of both, whatever was injected before.
    double drawn_diameter(std::size_t point, std::int64_t number) const;
    double event_time(std::int64_t k) const { return start + static_cast<double>(k) * interval; }
    /// Number of events of each point up to `time`. An event counts as reached within 1e-9 of an interval.
    std::int64_t events_due(double time) const;
};

/// The state of one injector, for the checkpoint.
struct Injected {
    std::vector<std::int64_t> count; // grains that have entered, per point

    std::int64_t total() const;
};

/// One [[injector]]: group, diameter, points or path (columns x, y, z [, diameter]), interval, velocity, start, end.
/// InputError for an unknown group, one that is a block or fixed, a point outside the domain or too near to a wall for
/// the largest grain, and points so near to each other that their grains overlap.
Injector make_injector(Table& table, const std::vector<GrainGroup>& groups, const Domain& domain,
                       const std::vector<WallBody>& walls);

/// Nothing injected yet.
Injected nothing_injected(const Injector& injector);

/// Adds the grains that are due at `time` and whose point is free, at most one per point; returns how many.
std::size_t inject(Grains& grains, Injected& done, const Injector& injector, const std::vector<GrainGroup>& groups,
                   const Domain& domain, double time);

/// Number of grains that are due at `time` but still wait.
std::int64_t waiting(const Injector& injector, const Injected& done, double time);

} // namespace plumb
