// Stirred particles and grains among them, and what the coupling makes of both.
#pragma once

#include "coupling/weights.hpp"

#include "core/random.hpp"
#include "core/sphere.hpp"
#include "fluid_fixtures.hpp"
#include "sph/arrange_fluid.hpp"

#include <functional>
#include <numbers>

namespace plumb::fixture {

inline constexpr double spacing = 0.1;

/// A box of 1.2 x 1.1 x 1.3 m of jittered particles, each with a velocity, an acceleration and a share of its own.
inline SphFluid stirred(const std::array<bool, 3>& periodic, double jitter) {
    SphFluid f;
    f.dimensions = 3;
    f.domain.size = Vec3(1.2, 1.1, 1.3);
    f.domain.periodic = periodic;
    f.density = 1000.0, f.sound_speed = 10.0, f.spacing = spacing, f.h = 1.5 * spacing;
    f.mass = 1000.0 * std::pow(spacing, 3);
    f.body_force = Vec3(0.1, -0.2, 0.3);
    f.clusters.reach = 2.0 * f.h, f.clusters.skin = 0.25 * spacing, f.clusters.images = 0.4;
    fill_box(f, jitter, 3);
    Random random(5);
    for (std::size_t c = 0; c < 3; ++c) f.a[c].assign(f.slots(), 0.0);
    f.share.assign(f.slots(), 1.0);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            f.v[c][k] = random.uniform(-1.0, 1.0);
            f.a[c][k] = random.uniform(-1.0, 1.0);
        }
        f.rho[k] = random.uniform(950.0, 1050.0);
        f.share[k] = random.uniform(0.5, 1.0);
    }
    renew_lists(f);
    return f;
}

inline void write_records(SphFluid& f) {
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0)
            f.clusters.records[static_cast<std::size_t>(f.clusters.record_of[k])] = {
                f.x[0][k], f.x[1][k], f.x[2][k], 0.0, f.v[0][k], f.v[1][k], f.v[2][k], f.mass / f.rho[k]};
    update_images(f.clusters, f.domain);
}

struct Setting {
    SphFluid fluid;
    Weights weights;
    GrainPlaces grains;
    std::vector<double> mass;
    GatheredFluid at;
};

/// Lists, porosity and what is gathered; the grains have moved since the lists were built, as far as these hold.
inline Setting coupled(SphFluid fluid, Weights weights, GrainPlaces grains, std::vector<double> mass) {
    Setting s{std::move(fluid), std::move(weights), std::move(grains), std::move(mass), {}};
    s.at.wants_gradient = true;
    for (const double volume : s.grains.volume)
        s.weights.largest_diameter = std::max(s.weights.largest_diameter, std::cbrt(6.0 * volume / std::numbers::pi));
    if (s.fluid.clusters.images < reach(s.weights)) {
        s.fluid.clusters.images = reach(s.weights);
        renew_lists(s.fluid);
    }
    const Vec3 moved = Vec3(0.3, -0.4, 0.2) * spacing * 0.2; // 0.11 of 0.125 spacings
    for (Vec3& x : s.grains.x) x -= moved;
    renew_weights(s.weights, s.fluid, s.grains);
    for (Vec3& x : s.grains.x) x += moved;
    place_grains(s.weights, s.fluid.domain, s.grains);
    set_porosity(s.fluid, s.weights);
    write_records(s.fluid);
    gather(s.weights, s.fluid, s.mass, true, s.at);
    return s;
}

/// Grains of 10 to 30 mm at random. `lattice` gives another velocity to particles on a lattice of one density.
inline Setting setting(const std::array<bool, 3>& periodic, CouplingWidths widths, std::size_t count = 60,
                       const std::function<void(SphFluid&)>& lattice = {}, const PorosityLaw& porosity = {},
                       bool own_volume = true) {
    SphFluid fluid = stirred(periodic, lattice ? 0.0 : 0.2);
    if (lattice) {
        std::fill(fluid.rho.begin(), fluid.rho.end(), fluid.density);
        lattice(fluid);
    }
    Weights weights;
    weights.kernel = WendlandC2{};
    weights.h = widths;
    weights.porosity = porosity;
    weights.own_volume = own_volume;
    GrainPlaces grains;
    std::vector<double> mass;
    Random random(7);
    for (std::size_t j = 0; j < count; ++j) { // some beyond periodic sides, none beyond open ones
        Vec3 x;
        for (int c = 0; c < 3; ++c) {
            const bool wraps = periodic[static_cast<std::size_t>(c)];
            x[c] = fluid.domain.size[c] * random.uniform(wraps ? -0.5 : 0.1, wraps ? 1.5 : 0.9);
        }
        grains.x.push_back(x);
        grains.volume.push_back(sphere_volume(random.uniform(0.01, 0.03)));
        mass.push_back(random.uniform(0.01, 0.1));
    }
    return coupled(std::move(fluid), std::move(weights), std::move(grains), std::move(mass));
}

/// W(r, h) of the Wendland C2 kernel in space.
inline double kernel(const Setting& s, const Vec3& a, const Vec3& b, double h) {
    const double q = s.fluid.domain.minimum_image(a - b).norm() / h;
    return WendlandC2::sigma(3) / (h * h * h) * (q < 2.0 ? WendlandC2::w(q) : 0.0);
}

/// Calls visit(slot, x, volume) for every particle once.
template <class Visit> void for_each_particle(const SphFluid& f, Visit&& visit) {
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) visit(k, Vec3(f.x[0][k], f.x[1][k], f.x[2][k]), f.mass / f.rho[k]);
}

inline const CouplingWidths different{0.15, 0.2, 0.12};

} // namespace plumb::fixture
