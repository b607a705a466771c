#include "sph/even_outlets.hpp"

#include "core/parallel.hpp"
#include "sph/fluid.hpp"
#include "sph/vector_at.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

namespace plumb {

namespace {

// Times after which a mass is made up for and the pressure's level is, over the averaging time of the outlet: long
// enough that neither swings, short enough that a leak of a millimetre per second is some per mille.
constexpr double balancing_times = 10.0, levelling_times = 4.0;

bool is_of(const SphFluid& f, std::size_t k, std::size_t side) {
    return f.boundary.side[k] == static_cast<std::int32_t>(side);
}

/// The lattice of an even outlet.
struct Lattice {
    double first = -std::numeric_limits<double>::infinity(); // distance of the layer next to the plane [m]
    double last = std::numeric_limits<double>::infinity();
    double shares = 0.0; // of all its particles

    double layers(double spacing) const { return std::round((first - last) / spacing) + 1.0; }
};

Lattice lattice_of(const SphFluid& f, std::size_t side) {
    Lattice lattice;
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        if (!is_of(f, k, side)) continue;
        const double distance = f.open_sides[side].distance(vector_at(f.boundary.x, k, f.dimensions));
        lattice.first = std::max(lattice.first, distance);
        lattice.last = std::min(lattice.last, distance);
        lattice.shares += f.boundary.share[k];
    }
    return lattice;
}

void move_along(SphFluid& f, std::size_t k, const OpenSide& side, double way) {
    BoundaryParticles& b = f.boundary;
    const Vec3 x = vector_at(b.x, k, f.dimensions) + way * side.normal, mirror = side.reflected(x);
    for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
        b.x[c][k] = x[static_cast<Eigen::Index>(c)];
        b.mirror[c][k] = mirror[static_cast<Eigen::Index>(c)];
    }
}

/// Share of a particle of the fluid in a full one's mass.
double share_of(const SphFluid& f, std::size_t slot) { return f.among_grains() ? f.share[slot] : 1.0; }

/// Takes away the fluid next to a layer: as much as the layer is, to a particle, the nearest first, and none beyond
/// `furthest`. What is behind the layer goes in any case.
void take_away(SphFluid& f, const OpenSide& side, double layer, double furthest, double shares) {
    struct Near {
        double distance;
        std::int32_t id; // the order of slots must not matter
        std::size_t slot;
    };
    std::vector<Near> near;
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const double distance = f.id[k] < 0 ? furthest : side.distance(vector_at(f.x, k, f.dimensions));
        if (distance < furthest) near.push_back({distance, f.id[k], k});
    }
    std::sort(near.begin(), near.end(),
              [](const Near& a, const Near& b) { return std::tie(a.distance, a.id) < std::tie(b.distance, b.id); });
    for (const Near& particle : near) {
        const double share = share_of(f, particle.slot);
        if (particle.distance > layer && shares < 0.5 * share) return;
        shares -= share;
        f.id[particle.slot] = -1; // vanishes with the next order of the slots
        --f.particles;
    }
}

/// The layer at the far end takes the place of the fluid at the plane.
void replace_fluid(SphFluid& f, std::size_t s, Lattice& lattice) {
    const OpenSide& side = f.open_sides[s];
    const double depth = lattice.layers(f.spacing) * f.spacing;
    double shares = 0.0;
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        if (!is_of(f, k, s)) continue;
        if (side.distance(vector_at(f.boundary.x, k, f.dimensions)) >= lattice.last + 0.5 * f.spacing) continue;
        shares += f.boundary.share[k];
        move_along(f, k, side, depth);
    }
    lattice.first += f.spacing;
    lattice.last += f.spacing;
    take_away(f, side, lattice.first, lattice.first + f.spacing, shares);
}

/// The layer at the plane becomes fluid.
void return_layer(SphFluid& f, std::size_t s, Lattice& lattice) {
    const OpenSide& side = f.open_sides[s];
    const double depth = lattice.layers(f.spacing) * f.spacing;
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        const Vec3 x = vector_at(f.boundary.x, k, f.dimensions);
        if (!is_of(f, k, s) || side.distance(x) < lattice.first - 0.5 * f.spacing) continue;
        append_particle(f, x, vector_at(f.boundary.velocity, k, f.dimensions), f.boundary.rho[k]);
        if (f.among_grains()) f.share.back() = f.boundary.share[k];
        move_along(f, k, side, -depth);
    }
    lattice.first -= f.spacing;
    lattice.last -= f.spacing;
}

/// A particle that has come through the first layer of the lattice is put back there, without its speed into it.
void stop_at_lattice(SphFluid& f, const OpenSide& side, const Lattice& lattice) {
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const double behind = lattice.first - side.distance(vector_at(f.x, k, f.dimensions));
        if (f.id[k] < 0 || behind <= 0.0) continue;
        const double into = std::min(vector_at(f.v, k, f.dimensions).dot(side.normal) + side.mean_outflow, 0.0);
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c) {
            f.x[c][k] += behind * side.normal[static_cast<Eigen::Index>(c)];
            f.v[c][k] -= into * side.normal[static_cast<Eigen::Index>(c)];
        }
        ++f.put_back;
    }
}

} // namespace

double mass_inside(const SphFluid& f) {
    double shares = ordered_sum(f.slots(), 0.0, [&](std::size_t k) { return f.id[k] < 0 ? 0.0 : share_of(f, k); });
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        if (f.boundary.side[k] < 0) continue;
        const OpenSide& side = f.open_sides[static_cast<std::size_t>(f.boundary.side[k])];
        if (side.even) continue;
        const double distance = side.distance(vector_at(f.boundary.x, k, f.dimensions));
        shares += f.boundary.share[k] * std::clamp(1.0 + distance / f.spacing, 0.0, 1.0);
    }
    for (std::size_t s = 0; s < f.open_sides.size(); ++s) {
        if (!f.open_sides[s].even) continue;
        const Lattice lattice = lattice_of(f, s); // half of its first layer is in front of the plane when it is there
        shares += lattice.shares / lattice.layers(f.spacing) * (lattice.first / f.spacing + 0.5);
    }
    return f.mass * shares;
}

void set_even_outflow(SphFluid& f) {
    double inflow = 0.0, width = 0.0;
    for (const OpenSide& side : f.open_sides) (side.is_inlet() ? inflow : width) += side.opening * side.amount;
    const bool any = std::any_of(f.open_sides.begin(), f.open_sides.end(), [](const OpenSide& s) { return s.even; });
    if (!any) return;
    const double gathered = f.mass_at_start > 0.0 ? (mass_inside(f) - f.mass_at_start) / f.density : 0.0;
    for (OpenSide& side : f.open_sides)
        if (side.even) side.mean_outflow = (inflow + gathered / (balancing_times * side.averaging_time)) / width;
}

void pass_even_outlets(SphFluid& f) {
    for (std::size_t s = 0; s < f.open_sides.size(); ++s) {
        if (!f.open_sides[s].even) continue;
        Lattice lattice = lattice_of(f, s);
        while (lattice.first <= -f.spacing) replace_fluid(f, s, lattice);
        while (lattice.first > 0.0) return_layer(f, s, lattice);
        stop_at_lattice(f, f.open_sides[s], lattice);
    }
}

void hold_open_pressure(SphFluid& f) {
    const BoundaryParticles& b = f.boundary;
    for (std::size_t s = 0; s < f.open_sides.size(); ++s) {
        const OpenSide& side = f.open_sides[s];
        if (!side.even) continue;
        double sum = 0.0, count = 0.0;
        for (std::size_t k = 0; k < b.size(); ++k) {
            if (!is_of(f, k, s) || std::isnan(b.mean_pressure[k])) continue;
            sum += b.mean_pressure[k] - side.pressure;
            count += 1.0;
        }
        const double rate = sum / std::max(count, 1.0) /
                            (f.density * f.sound_speed * f.sound_speed * levelling_times * side.averaging_time);
        parallel_for(f.slots(), [&](std::size_t k) { f.drho[k] -= rate * f.rho[k]; });
    }
}

} // namespace plumb
