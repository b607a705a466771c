#include "sph/boundary.hpp"

#include "core/parallel.hpp"
#include "sph/fluid.hpp"
#include "sph/interpolation.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace plumb {

namespace {

constexpr double least_cover = 0.05; // of the fluid around a mirror point, below which it counts as dry

/// Order of the mirror points in which neighbours are near each other: by column of the records' grid, then along it.
std::vector<std::int32_t> sorted_mirrors(const SphFluid& f, const VectorField& mirror) {
    const Columns& columns = f.clusters.grid.columns;
    const auto along = static_cast<std::size_t>(columns.along);
    std::vector<std::int32_t> order(f.boundary.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&](std::int32_t k) {
        const auto q = static_cast<std::size_t>(k);
        return std::tuple(columns.real(mirror[0][q], columns.across == 2 ? mirror[1][q] : 0.0), mirror[along][q], k);
    };
    std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
    return order;
}

FluidRecord record_of(const SphFluid& f, std::size_t k, const InterpolatedGroup& group, int lane) {
    const BoundaryParticles& b = f.boundary;
    const Continuation& rule = b.rule[k];
    const bool wet = group.covered[lane] > least_cover;
    Vec3 u = Vec3::Zero(), away = Vec3::Zero();
    FluidRecord record{};
    double* const position = &record.x;
    double* const velocity = &record.u;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
        const auto axis = static_cast<Eigen::Index>(c);
        position[c] = b.x[c][k];
        away[axis] = b.x[c][k] - b.mirror[c][k];
        u[axis] = group.u[c][lane];
    }
    u = wet ? Vec3(rule.turn * u + rule.offset) : Vec3(0.5 * rule.offset);
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        velocity[c] = u[static_cast<Eigen::Index>(c)];
    const double p =
        wet ? rule.share * (group.p[lane] + f.density * f.body_force.dot(f.domain.minimum_image(away))) + rule.pressure
            : 0.0;
    const double rho = density_of_pressure(f, p);
    record.p_over_rho_sq = p / (rho * rho);
    record.volume = f.mass / rho;
    return record;
}

} // namespace

void list_mirrors(SphFluid& f) {
    BoundaryParticles& b = f.boundary;
    if (b.size() == 0) return;
    b.member = sorted_mirrors(f, b.mirror_listed);
    while (b.member.size() % pack_width != 0) b.member.push_back(b.member.back());
    std::array<std::vector<double>, 3> place;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        for (const std::int32_t k : b.member) place[c].push_back(b.mirror_listed[c][static_cast<std::size_t>(k)]);
    list_records(b.near_mirror, f.clusters.grid, place, f.dimensions, f.clusters.reach + f.clusters.skin,
                 f.clusters.passive);
}

void continue_state(SphFluid& f) {
    const BoundaryParticles& b = f.boundary;
    parallel_chunks(
        b.member.size() / pack_width,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t g = begin; g < end; ++g) {
                std::array<Pack, 3> places{};
                for (int lane = 0; lane < pack_width; ++lane) {
                    const auto k = static_cast<std::size_t>(b.member[pack_width * g + static_cast<std::size_t>(lane)]);
                    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
                        places[c][lane] = b.mirror[c][k];
                }
                const InterpolatedGroup group = interpolated(f, places, b.near_mirror.near(g));
                for (int lane = 0; lane < pack_width; ++lane) {
                    const std::size_t entry = pack_width * g + static_cast<std::size_t>(lane);
                    if (entry >= b.size()) break; // the rest fills up the last group
                    const auto k = static_cast<std::size_t>(b.member[entry]);
                    f.clusters.records[static_cast<std::size_t>(f.clusters.record_of_passive[k])] =
                        record_of(f, k, group, lane);
                }
            }
        },
        16);
}

void move_boundary(SphFluid& f, double dt) {
    BoundaryParticles& b = f.boundary;
    if (b.fastest == 0.0) return;
    b.travelled += b.fastest * std::abs(dt);
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        parallel_for(b.size(), [&](std::size_t k) {
            b.x[c][k] += dt * b.velocity[c][k];
            b.mirror[c][k] += dt * b.velocity[c][k];
        });
}

} // namespace plumb
