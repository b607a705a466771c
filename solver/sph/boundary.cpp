#include "sph/boundary.hpp"

#include "core/parallel.hpp"
#include "sph/fluid.hpp"
#include "sph/interpolation.hpp"
#include "sph/vector_at.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace plumb {

namespace {

constexpr double least_cover = 0.05;     // of the fluid around a mirror point, below which it counts as dry
constexpr double enough_for_slope = 0.5; // of it, above which the slope of the pressure is continued into an inlet

/// Calls visit(field) for every field of vectors.
template <class Visit> void for_each_vector_field(BoundaryParticles& b, Visit&& visit) {
    for (VectorField* field :
         {&b.x, &b.mirror, &b.velocity, &b.mirror_velocity, &b.x_listed, &b.mirror_listed, &b.excess, &b.normal})
        visit(*field);
}

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

Vec3 lane_of(const std::array<Pack, 3>& packs, int lane) { return {packs[0][lane], packs[1][lane], packs[2][lane]}; }

/// `packing`: eps over share, what the density of the fluid itself is over that of the pure fluid in as much room.
/// p is the fluid's own pressure.
FluidRecord record_of(const SphFluid& f, const Vec3& x, const Vec3& u, double p, double packing, double eps) {
    const double rho = density_of_pressure(f, p) * packing;
    return {x[0], x[1], x[2], pressure_entry(f, pushing_pressure(f, p, eps), rho), u[0], u[1], u[2], f.mass / rho};
}

FluidRecord wall_record(SphFluid& f, std::size_t k, const InterpolatedGroup& group, int lane) {
    BoundaryParticles& b = f.boundary;
    const Continuation &rule = b.rule[k], &slip = b.slip[k];
    const Vec3 x = vector_at(b.x, k, f.dimensions), fluid_u = lane_of(group.u, lane);
    const bool wet = group.covered[lane] > least_cover;
    b.cover[k] = group.covered[lane];
    const Vec3 u = wet ? Vec3(rule.turn * fluid_u + rule.offset) : Vec3(0.5 * rule.offset);
    const Vec3 excess = wet ? Vec3(slip.turn * fluid_u + slip.offset - u) : Vec3(Vec3::Zero());
    for (int c = 0; c < f.dimensions; ++c) b.excess[static_cast<std::size_t>(c)][k] = excess[c];
    const Vec3 away = f.domain.minimum_image(x - vector_at(b.mirror, k, f.dimensions));
    // the densest packing of equal spheres leaves 1 - pi/sqrt 18; a linear fit beside few particles may leave less
    b.eps[k] = wet ? std::clamp(group.eps[lane], 0.26, 1.0) : 1.0;
    return record_of(f, x, u, wet ? group.p[lane] + f.density * f.body_force.dot(away) : 0.0, 1.0, b.eps[k]);
}

/// Moves a mean towards a value; NaN takes the value.
void follow(double& mean, double value, double share) {
    mean = std::isnan(mean) ? value : mean + share * (value - mean);
}

/// State in the buffer of an open side: with e along the flow, the deviations p' and u' from the slow means at the
/// mirror point send p' + rho c u' with the flow and p' - rho c u' against it. What leaves goes on into the buffer,
/// nothing comes back. The means are the profile and the pressure of the fluid, continued linearly, at an inlet; the
/// velocity of the fluid and a pressure antisymmetric about the given one at an outlet. At an even one both are as at
/// an inlet, so that a jet which meets it is held back by its own pressure. A rigid inlet is a piston: no wave changes
/// its speed, and its pressure is what the fluid before it has, as a wall's. Also sets how the particle moves. Among
/// grains a profile is superficial, and as much mass comes in whatever room the grains leave.
FluidRecord open_record(SphFluid& f, std::size_t k, const InterpolatedGroup& group, int lane, double since) {
    BoundaryParticles& b = f.boundary;
    const OpenSide& side = f.open_sides[static_cast<std::size_t>(b.side[k])];
    const double direction = side.is_inlet() ? 1.0 : -1.0, impedance = f.density * f.sound_speed;
    const Vec3 e = direction * side.normal, x = vector_at(b.x, k, f.dimensions), fluid_u = lane_of(group.u, lane);
    const double speed = fluid_u.dot(e);
    const Vec3 away = x - vector_at(b.mirror, k, f.dimensions);
    // Into an empty vessel: the slope between the first few particles says nothing of the fluid's.
    const bool sloped = side.is_inlet() && group.covered[lane] > enough_for_slope;
    const double p = group.p[lane] + (sloped ? lane_of(group.p_slope, lane).dot(away) : 0.0);
    const double share = -std::expm1(-since / side.averaging_time);
    follow(b.mean_speed[k], speed, share);
    follow(b.mean_pressure[k], p, share);
    // the wave that leaves: against the flow at an inlet, with it at an outlet
    const double wave =
        side.rigid ? 0.0 : 0.5 * (p - b.mean_pressure[k] - direction * impedance * (speed - b.mean_speed[k]));
    const double mean_p = side.is_inlet() || side.even ? b.mean_pressure[k] : 2.0 * side.pressure - b.mean_pressure[k];
    double mean_u = side.even ? side.mean_outflow / b.eps[k] : b.mean_speed[k];
    if (side.is_inlet()) mean_u = side.inflow(x, f.dimensions) / b.eps[k];
    if (side.is_inlet()) b.share[k] = b.eps[k];
    double along = side.opening > 0.0 ? mean_u - direction * wave / impedance : 0.0; // closed: a wall
    if (!side.is_inlet() && !side.even) along = std::max(along, 0.0); // what has gone out by itself does not come back
    const Vec3 u = (side.is_inlet() ? Vec3(Vec3::Zero()) : Vec3(fluid_u - speed * e)) + along * e;
    const Vec3 moved = side.even ? Vec3(side.mean_outflow * e) : u; // as a lattice
    const Vec3 mirrored = moved - 2.0 * moved.dot(e) * e;
    for (int c = 0; c < f.dimensions; ++c) {
        b.velocity[static_cast<std::size_t>(c)][k] = moved[c];
        b.mirror_velocity[static_cast<std::size_t>(c)][k] = mirrored[c];
    }
    return record_of(f, x, u, side.opening > 0.0 && !side.rigid ? mean_p + wave : p, b.eps[k] / b.share[k], b.eps[k]);
}

} // namespace

void append_boundary_particle(BoundaryParticles& b, int dimensions, const BoundaryParticle& particle) {
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    for (int c = 0; c < dimensions; ++c) {
        const auto axis = static_cast<std::size_t>(c);
        b.x[axis].push_back(particle.x[c]);
        b.mirror[axis].push_back(particle.mirror[c]);
        b.velocity[axis].push_back(particle.velocity[c]);
        b.mirror_velocity[axis].push_back(particle.mirror_velocity[c]);
        b.x_listed[axis].push_back(particle.x[c]);
        b.mirror_listed[axis].push_back(particle.mirror[c]);
        b.excess[axis].push_back(0.0);
        b.normal[axis].push_back(particle.normal[c]);
    }
    b.side.push_back(particle.side);
    b.rule.push_back(particle.rule);
    b.slip.push_back(particle.slip);
    b.mean_speed.push_back(unknown);
    b.mean_pressure.push_back(unknown);
    b.rho.push_back(unknown);
    b.cos_contact.push_back(particle.cos_contact);
    b.cover.push_back(0.0);
    b.share.push_back(1.0);
    b.eps.push_back(1.0);
    b.fastest = std::max(b.fastest, particle.velocity.norm());
}

void keep_boundary_particles(BoundaryParticles& b, int dimensions, const std::vector<std::int32_t>& kept) {
    const auto keep = [&](auto& field) {
        for (std::size_t k = 0; k < kept.size(); ++k) field[k] = field[static_cast<std::size_t>(kept[k])];
        field.resize(kept.size());
    };
    for_each_vector_field(b, [&](VectorField& field) {
        for (std::size_t c = 0; c < static_cast<std::size_t>(dimensions); ++c) keep(field[c]);
    });
    keep(b.side);
    keep(b.rule);
    keep(b.slip);
    keep(b.mean_speed);
    keep(b.mean_pressure);
    keep(b.rho);
    keep(b.cos_contact);
    keep(b.cover);
    keep(b.share);
    keep(b.eps);
}

namespace {

/// Which records are boundary particles', and which clusters have any of them near.
void mark_boundary_records(SphFluid& f) {
    BoundaryParticles& b = f.boundary;
    const FluidClusters& clusters = f.clusters;
    b.of_record.assign(clusters.records.size(), -1);
    for (std::size_t k = 0; k < b.size(); ++k)
        b.of_record[static_cast<std::size_t>(clusters.record_of_passive[k])] = static_cast<std::int32_t>(k);
    for (std::size_t r = 0; r < b.of_record.size(); ++r)
        b.of_record[r] = b.of_record[static_cast<std::size_t>(clusters.image_of[r])];
    b.near_clusters.clear();
    for (std::size_t c = 0; c < clusters.count; ++c) {
        const auto near = clusters.near(c);
        if (std::any_of(near.begin(), near.end(),
                        [&](std::int32_t r) { return b.of_record[static_cast<std::size_t>(r)] >= 0; }))
            b.near_clusters.push_back(static_cast<std::int32_t>(c));
    }
}

/// The correction of one cluster: - sum m excess_b . grad W = sum over dv = - excess_b; - rho_a sum V excess_b . grad W
/// where operators weigh by volume.
template <class KernelLaw> void correct_cluster(SphFluid& f, std::size_t cluster) {
    const BoundaryParticles& b = f.boundary;
    const bool by_volume = std::holds_alternative<VolumeWeightedOperators>(f.operators);
    Pack sum{}, over_room{};
    std::array<Pack, 3> x{};
    for (std::size_t lane = 0; lane < pack_width; ++lane) {
        const FluidRecord& own =
            f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[pack_width * cluster + lane])];
        const int l = static_cast<int>(lane);
        x[0][l] = own.x, x[1][l] = own.y, x[2][l] = own.z, over_room[l] = 1.0 / own.volume;
    }
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const std::int32_t k = b.of_record[static_cast<std::size_t>(record)];
        if (k < 0) continue;
        const FluidRecord& other = f.clusters.records[static_cast<std::size_t>(record)];
        const std::array<double, 3> place{other.x, other.y, other.z};
        Pack r_sq{}, excess_dx{};
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
            const Pack dx = x[c] - broadcast<Pack>(place[c]);
            r_sq += dx * dx;
            excess_dx += broadcast<Pack>(b.excess[c][static_cast<std::size_t>(k)]) * dx;
        }
        const Pack weight = by_volume ? over_room * broadcast<Pack>(other.volume) : broadcast<Pack>(1.0);
        sum -= weight * KernelLaw::f(square_root(r_sq) * broadcast<Pack>(1.0 / f.h)) * excess_dx;
    }
    const double factor = f.mass * KernelLaw::sigma(f.dimensions) / std::pow(f.h, f.dimensions + 2);
    for (std::size_t lane = 0; lane < pack_width; ++lane)
        f.drho[pack_width * cluster + lane] += factor * sum[static_cast<int>(lane)];
}

} // namespace

void correct_continuity(SphFluid& f) {
    const std::vector<std::int32_t>& clusters = f.boundary.near_clusters;
    std::visit(
        [&](const auto& kernel) {
            parallel_chunks(
                clusters.size(),
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t q = begin; q < end; ++q)
                        correct_cluster<std::decay_t<decltype(kernel)>>(f, static_cast<std::size_t>(clusters[q]));
                },
                16);
        },
        f.kernel);
}

void list_mirrors(SphFluid& f) {
    BoundaryParticles& b = f.boundary;
    if (b.size() == 0) return;
    b.member = sorted_mirrors(f, b.mirror_listed);
    while (b.member.size() % pack_width != 0) b.member.push_back(b.member.back());
    std::array<std::vector<double>, 3> place;
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        for (const std::int32_t k : b.member) place[c].push_back(b.mirror_listed[c][static_cast<std::size_t>(k)]);
    mark_boundary_records(f);
    list_records(b.near_mirror, f.clusters.grid, place, f.dimensions, f.clusters.reach + f.clusters.skin,
                 f.clusters.passive);
}

void continue_state(SphFluid& f, double since) {
    BoundaryParticles& b = f.boundary;
    const auto continue_group = [&](std::size_t g) {
        std::array<Pack, 3> places{};
        for (std::size_t lane = 0; lane < pack_width; ++lane)
            for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
                places[c][static_cast<int>(lane)] =
                    b.mirror[c][static_cast<std::size_t>(b.member[pack_width * g + lane])];
        const InterpolatedGroup group = interpolated(f, places, b.near_mirror.near(g));
        for (int lane = 0; lane < pack_width; ++lane) {
            const std::size_t entry = pack_width * g + static_cast<std::size_t>(lane);
            if (entry >= b.size()) break; // the rest fills up the last group
            const auto k = static_cast<std::size_t>(b.member[entry]);
            const FluidRecord record =
                b.side[k] < 0 ? wall_record(f, k, group, lane) : open_record(f, k, group, lane, since);
            f.clusters.records[static_cast<std::size_t>(f.clusters.record_of_passive[k])] = record;
            b.rho[k] = f.mass / record.volume;
        }
    };
    parallel_chunks(
        b.member.size() / pack_width,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t g = begin; g < end; ++g) continue_group(g);
        },
        16);
    if (f.open_sides.empty()) return;
    b.fastest = 0.0; // buffers have new velocities
    for (std::size_t k = 0; k < b.size(); ++k)
        b.fastest = std::max(b.fastest, vector_at(b.velocity, k, f.dimensions).norm());
}

void move_boundary(SphFluid& f, double dt) {
    BoundaryParticles& b = f.boundary;
    if (b.fastest == 0.0) return;
    b.travelled += b.fastest * std::abs(dt);
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
        parallel_for(b.size(), [&](std::size_t k) {
            b.x[c][k] += dt * b.velocity[c][k];
            b.mirror[c][k] += dt * b.mirror_velocity[c][k];
        });
}

} // namespace plumb
