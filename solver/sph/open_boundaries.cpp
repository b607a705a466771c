#include "sph/open_boundaries.hpp"

#include "sph/even_outlets.hpp"
#include "sph/fluid.hpp"
#include "sph/vector_at.hpp"
#include "sph/wall_particles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb {

namespace {

constexpr double along_weight = 1e-3; // of a distance squared along the flow against one across, in row_mate

std::int64_t buffer_layers(const SphFluid& f) {
    return static_cast<std::int64_t>(std::ceil((f.clusters.reach + f.clusters.skin) / f.spacing));
}

double buffer_depth(const SphFluid& f) { return static_cast<double>(buffer_layers(f)) * f.spacing; }

void put(VectorField& field, std::size_t k, const Vec3& x, int dimensions) {
    for (int c = 0; c < dimensions; ++c) field[static_cast<std::size_t>(c)][k] = x[c];
}

Vec3 turned(const OpenSide& side, const Vec3& v) { return v - 2.0 * v.dot(side.normal) * side.normal; }

void append(SphFluid& f, std::size_t side, const Vec3& x, const Vec3& velocity) {
    append_boundary_particle(f.boundary, f.dimensions,
                             {x,
                              f.open_sides[side].reflected(x),
                              velocity,
                              turned(f.open_sides[side], velocity),
                              static_cast<std::int32_t>(side),
                              {},
                              {}});
}

/// Particles of inlet buffers that have come in leave a copy of themselves in the fluid and go back to the far end;
/// those of outlets that a wave has brought back become fluid again.
void let_in(SphFluid& f) {
    BoundaryParticles& b = f.boundary;
    const double depth = buffer_depth(f);
    std::vector<std::int32_t> kept;
    for (std::size_t k = 0; k < b.size(); ++k) {
        kept.push_back(static_cast<std::int32_t>(k));
        if (b.side[k] < 0 || f.open_sides[static_cast<std::size_t>(b.side[k])].even) continue;
        const OpenSide& side = f.open_sides[static_cast<std::size_t>(b.side[k])];
        Vec3 x = vector_at(b.x, k, f.dimensions);
        if (side.distance(x) < 0.0) continue;
        append_particle(f, x, vector_at(b.velocity, k, f.dimensions), b.rho[k]);
        if (f.among_grains()) f.share.back() = b.share[k];
        if (!side.is_inlet()) {
            kept.pop_back();
            continue;
        }
        x -= depth * side.normal;
        put(b.x, k, x, f.dimensions);
        put(b.mirror, k, side.reflected(x), f.dimensions);
    }
    if (kept.size() < b.size()) keep_boundary_particles(b, f.dimensions, kept);
}

/// Of the particles before `end` in the buffer of a side the one that is nearest to x across the flow, and of those in
/// line the one nearest along it; `end` if the buffer is empty.
std::size_t row_mate(const SphFluid& f, std::size_t side, const Vec3& x, std::size_t end) {
    std::size_t mate = end;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < end; ++k) {
        if (f.boundary.side[k] != static_cast<std::int32_t>(side)) continue;
        const Vec3 away = f.domain.minimum_image(vector_at(f.boundary.x, k, f.dimensions) - x);
        const double along = away.dot(f.open_sides[side].normal);
        const double distance = away.squaredNorm() - (1.0 - along_weight) * along * along;
        if (distance < least) {
            least = distance;
            mate = k;
        }
    }
    return mate;
}

/// A newcomer to the buffer of an outlet takes over the means of the particle ahead of it in its row. If it started
/// them anew from the state it brings, a wave that passes would be taken for the mean and be sent back; taken from
/// another row, where the mean speed is another one, they would look like a wave.
void inherit_means(SphFluid& f, std::size_t side) {
    BoundaryParticles& b = f.boundary;
    const std::size_t newcomer = b.size() - 1;
    const std::size_t k = row_mate(f, side, vector_at(b.x, newcomer, f.dimensions), newcomer);
    if (k == newcomer) return;
    b.mean_speed[newcomer] = b.mean_speed[k];
    b.mean_pressure[newcomer] = b.mean_pressure[k];
}

void join_buffer(SphFluid& f, std::size_t side, std::size_t slot) {
    append(f, side, vector_at(f.x, slot, f.dimensions), vector_at(f.v, slot, f.dimensions));
    inherit_means(f, side);
    if (f.among_grains()) f.boundary.share.back() = f.share[slot]; // the next lists give it its porosity
}

/// Fluid behind an outlet becomes part of its buffer.
void let_out(SphFluid& f) {
    for (std::size_t s = 0; s < f.open_sides.size(); ++s) {
        if (f.open_sides[s].is_inlet() || f.open_sides[s].even) continue;
        std::vector<std::pair<std::int32_t, std::size_t>> leaving; // by id: the order of slots must not matter
        for (std::size_t k = 0; k < f.slots(); ++k)
            if (f.id[k] >= 0 && f.open_sides[s].distance(vector_at(f.x, k, f.dimensions)) < 0.0)
                leaving.emplace_back(f.id[k], k);
        std::sort(leaving.begin(), leaving.end());
        for (const auto& [id, k] : leaving) {
            join_buffer(f, s, k);
            f.id[k] = -1; // vanishes with the next order of the slots
            --f.particles;
        }
    }
}

/// Buffer particles of outlets that nobody reaches any more.
void forget_far_ones(SphFluid& f) {
    const double depth = buffer_depth(f);
    std::vector<std::int32_t> kept;
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        const std::int32_t s = f.boundary.side[k];
        const bool far =
            s >= 0 && !f.open_sides[static_cast<std::size_t>(s)].is_inlet() &&
            !f.open_sides[static_cast<std::size_t>(s)].even &&
            f.open_sides[static_cast<std::size_t>(s)].distance(vector_at(f.boundary.x, k, f.dimensions)) < -depth;
        if (!far) kept.push_back(static_cast<std::int32_t>(k));
    }
    if (kept.size() < f.boundary.size()) keep_boundary_particles(f.boundary, f.dimensions, kept);
}

} // namespace

bool is_outside(const std::vector<OpenSide>& sides, const Vec3& x) {
    return std::any_of(sides.begin(), sides.end(), [&](const OpenSide& s) { return s.distance(x) < 0.0; });
}

std::optional<std::size_t> fill_buffers(SphFluid& f) {
    const double depth = buffer_depth(f), of_particle = std::pow(f.spacing, f.dimensions);
    for (std::size_t s = 0; s < f.open_sides.size(); ++s) {
        OpenSide& side = f.open_sides[s];
        std::vector<Vec3> places;
        for_each_cell(f, buffer_layers(f) + 1, [&](const Vec3& x) {
            const double distance = side.distance(x);
            if (distance < 0.0 && distance >= -depth && !is_solid(f.walls, x)) places.push_back(x);
        });
        if (places.empty()) return s;
        for (const Vec3& x : places)
            side.amount += (side.is_inlet() ? side.inflow(x, f.dimensions) : 1.0) * of_particle / depth;
        if (side.flow_rate > 0.0) {
            side.scale = side.flow_rate / side.amount;
            side.amount = side.flow_rate;
        }
        for (const Vec3& x : places)
            append(f, s, x, side.is_inlet() ? Vec3(side.inflow(x, f.dimensions) * side.normal) : Vec3(Vec3::Zero()));
    }
    set_openings(f, 0.0);
    return std::nullopt;
}

void set_openings(SphFluid& f, double time) {
    for (OpenSide& side : f.open_sides) {
        const double since = time - side.opens_from;
        side.opening = side.opens_over > 0.0 ? std::clamp(since / side.opens_over, 0.0, 1.0) : since >= 0.0 ? 1.0 : 0.0;
    }
    set_even_outflow(f);
}

void pass_open_sides(SphFluid& f) {
    if (f.open_sides.empty()) return;
    let_in(f);
    let_out(f);
    pass_even_outlets(f);
    forget_far_ones(f);
}

} // namespace plumb
