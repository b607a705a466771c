#include "sph/surface_tension.hpp"

#include "sph/contact_angle.hpp"
#include "sph/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

// A particle belongs to the surface layer from a fifth of the steepest gradient on, wholly from two fifths on: to a
// depth of about 0.9 h, where a disordered bulk (h |G| below 0.1) has no say.
constexpr double layer_from = 0.2, layer_whole = 0.4;
// Share of the kernel's weight that has to lie in the layer for its curvature to count wholly: it fades at about two
// kernel lengths from the surface.
constexpr int continuations = 2; // of the surface into walls, each from the layer that the last one made
constexpr double least_layer = 0.05;

double layer_weight(double steepness) { // G over that of a flat surface
    return std::clamp((steepness - layer_from) / (layer_whole - layer_from), 0.0, 1.0);
}

/// Colour and its gradient at eight particles, without the kernel's constants.
template <int d> struct ColourSums {
    Pack colour;
    Components<Pack, d> gradient;
};

template <class KernelLaw, int d>
ColourSums<d> colour_sums(const SphFluid& f, std::size_t cluster, const Pack (&lanes)[8]) {
    const Pack zero = broadcast<Pack>(0.0), inverse_h = broadcast<Pack>(1.0 / f.h);
    ColourSums<d> sums{zero, fluid_sweep::components<d>(zero, zero, zero)};
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const auto r = static_cast<std::size_t>(record);
        const FluidRecord& b = f.clusters.records[r];
        const auto dx = fluid_sweep::components<d>(lanes[0] - b.x, lanes[1] - b.y, lanes[2] - b.z);
        const Pack q = square_root(dot(dx, dx)) * inverse_h;
        const Pack volume = broadcast<Pack>(f.surface.colour[r] * b.volume);
        sums.colour += volume * KernelLaw::w(q);
        add(sums.gradient, volume * KernelLaw::f(q), dx);
    }
    return sums;
}

/// The surface above a particle: the point, the direction into the fluid, and how far the particle belongs to it.
SurfaceRecord surface_point(const ColourProfile& profile, double h, const Vec3& x, double colour,
                            const Vec3& gradient) {
    const double steep = gradient.norm(), weight = layer_weight(steep * h / profile.steepest);
    if (weight == 0.0) return {x[0], x[1], x[2], 0.0, 0.0, 0.0, 0.0, 0.0};
    const Vec3 n = gradient / steep, y = x - profile.depth(colour) * h * n;
    return {y[0], y[1], y[2], weight, n[0], n[1], n[2], 0.0};
}

/// Colours and gradients of the clusters: the surface layer's records, and the push.
template <class KernelLaw, int d> void find_layer(SphFluid& f) {
    const double value = KernelLaw::sigma(d) / std::pow(f.h, d), slope = value / (f.h * f.h);
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            Pack lanes[8];
            load_cluster(f.clusters, c, lanes);
            const ColourSums<d> sums = colour_sums<KernelLaw, d>(f, c, lanes);
            std::array<Pack, 3> gradient{};
            std::size_t axis = 0;
            for_components<d>([&](const Pack& g) { gradient[axis++] = broadcast<Pack>(slope) * g; }, sums.gradient);
            store(f.surface.cover, c, broadcast<Pack>(value) * sums.colour);
            for (int lane = 0; lane < pack_width; ++lane) {
                const Vec3 x(lanes[0][lane], lanes[1][lane], lanes[2][lane]);
                const Vec3 g(gradient[0][lane], gradient[1][lane], gradient[2][lane]);
                const std::int32_t own = f.clusters.record_of[pack_width * c + static_cast<std::size_t>(lane)];
                f.surface.records[static_cast<std::size_t>(own)] =
                    surface_point(f.surface.profile, f.h, x, value * sums.colour[lane], g);
            }
        }
    });
}

/// kappa of eight particles of the layer; no sharper than the kernel can tell.
template <class KernelLaw, int d>
Pack curvature(const SphFluid& f, std::size_t cluster, const Pack (&own)[8], const Pack (&place)[8]) {
    Pack turned = broadcast<Pack>(0.0), apart = turned;
    const Pack inverse_h = broadcast<Pack>(1.0 / f.h);
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const auto r = static_cast<std::size_t>(record);
        const SurfaceRecord& b = f.surface.records[r];
        if (b.weight == 0.0) continue;
        const FluidRecord& at = f.clusters.records[r];
        const auto dx = fluid_sweep::components<d>(place[0] - at.x, place[1] - at.y, place[2] - at.z);
        const auto dy = fluid_sweep::components<d>(own[0] - b.x, own[1] - b.y, own[2] - b.z);
        const auto dn = fluid_sweep::components<d>(own[4] - b.nx, own[5] - b.ny, own[6] - b.nz);
        const Pack weight = broadcast<Pack>(b.weight) * KernelLaw::w(square_root(dot(dx, dx)) * inverse_h);
        turned -= weight * dot(dn, dy);
        apart += weight * dot(dy, dy);
    }
    const Pack none = broadcast<Pack>(0.0), most = broadcast<Pack>((d - 1) / f.h);
    const Pack least = broadcast<Pack>(1e-6 * f.h * f.h);
    const Pack kappa = broadcast<Pack>(d - 1.0) * turned / larger(apart, least);
    const Pack bounded = smaller(larger(kappa, none - most), most);
    return select(own[3] > none, bounded, none);
}

template <class KernelLaw, int d> void find_curvature(SphFluid& f, const std::vector<std::uint8_t>& in_layer) {
    Field<double>& found = f.surface.curvature;
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            if (in_layer[c] == 0) continue;
            Pack own[8], place[8];
            load_cluster(f.clusters, f.surface.records, c, own);
            load_cluster(f.clusters, c, place);
            store(found, c, curvature<KernelLaw, d>(f, c, own, place));
        }
    });
    parallel_for(f.slots(), [&](std::size_t k) {
        if (in_layer[k / pack_width] != 0)
            f.surface.records[static_cast<std::size_t>(f.clusters.record_of[k])].curvature = found[k];
    });
}

/// Mean curvature of the layer around eight particles; it fades where there is little of it.
template <class KernelLaw, int d> Pack layer_curvature(const SphFluid& f, std::size_t cluster) {
    Pack lanes[8];
    load_cluster(f.clusters, cluster, lanes);
    Pack sum = broadcast<Pack>(0.0), whole = sum;
    const Pack inverse_h = broadcast<Pack>(1.0 / f.h);
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const auto r = static_cast<std::size_t>(record);
        const SurfaceRecord& s = f.surface.records[r];
        if (s.weight == 0.0) continue;
        const FluidRecord& b = f.clusters.records[r];
        const auto dx = fluid_sweep::components<d>(lanes[0] - b.x, lanes[1] - b.y, lanes[2] - b.z);
        const Pack weight = broadcast<Pack>(s.weight * b.volume) * KernelLaw::w(square_root(dot(dx, dx)) * inverse_h);
        sum += broadcast<Pack>(s.curvature) * weight;
        whole += weight;
    }
    const double least = least_layer * std::pow(f.h, d) / KernelLaw::sigma(d);
    return sum / larger(whole, broadcast<Pack>(least));
}

template <class KernelLaw, int d> void spread_curvature(SphFluid& f) {
    Field<double>& spread = f.surface.mean;
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) store(spread, c, layer_curvature<KernelLaw, d>(f, c));
    });
    parallel_for(f.slots(), [&](std::size_t k) {
        f.surface.records[static_cast<std::size_t>(f.clusters.record_of[k])].curvature = spread[k];
    });
}

/// Sums of a pull, without the kernel's constants.
template <int d> struct PullSums {
    Components<Pack, d> even;   // sum (V_a^2 + V_b^2) kappa_a grad W
    Components<Pack, d> uneven; // sum V (kappa_b - kappa_a) grad W
};

template <class KernelLaw, int d>
PullSums<d> pull_sums(const SphFluid& f, std::size_t cluster, const Pack (&lanes)[8], const Pack& kappa) {
    const Pack inverse_h = broadcast<Pack>(1.0 / f.h);
    const Sums<d> zero = fluid_sweep::no_sums<d>();
    PullSums<d> sums{zero.acceleration, zero.acceleration};
    const Pack own = lanes[7] * lanes[7];
    for (const std::int32_t record : f.clusters.near(cluster)) {
        const auto r = static_cast<std::size_t>(record);
        const FluidRecord& b = f.clusters.records[r];
        const auto dx = fluid_sweep::components<d>(lanes[0] - b.x, lanes[1] - b.y, lanes[2] - b.z);
        const bool wall = !f.boundary.of_record.empty() && f.boundary.of_record[r] >= 0;
        if (wall && b.pressure == 0.0) continue; // no pressure to be held against: a dry wall
        const Pack other = wall ? kappa : broadcast<Pack>(f.surface.records[r].curvature);
        const Pack slope = KernelLaw::f(square_root(dot(dx, dx)) * inverse_h), volume = broadcast<Pack>(b.volume);
        add(sums.even, (own + volume * volume) * kappa * slope, dx);
        add(sums.uneven, volume * slope * (other - kappa), dx);
    }
    return sums;
}

/// Accelerations of eight particles over the tension, without the kernel's constants and 1/m.
template <class KernelLaw, int d> Components<Pack, d> pull(const SphFluid& f, std::size_t cluster) {
    Pack lanes[8], layer[8];
    load_cluster(f.clusters, cluster, lanes);
    load_cluster(f.clusters, f.surface.records, cluster, layer);
    const PullSums<d> sums = pull_sums<KernelLaw, d>(f, cluster, lanes, load(f.surface.mean, cluster));
    const auto n = fluid_sweep::components<d>(layer[4], layer[5], layer[6]);
    const Pack one = broadcast<Pack>(1.0), none = broadcast<Pack>(0.0);
    const Pack lack = one / load(f.surface.cover, cluster) - one;
    const Pack missing = lanes[7] * select(layer[3] > none, lack, none);
    Components<Pack, d> a = sums.even;
    subtract(a, missing, sums.uneven);
    add(a, missing * dot(n, sums.uneven), n);
    return a;
}

template <class KernelLaw, int d> void pull_surface(SphFluid& f, double tension) {
    const Pack factor = broadcast<Pack>(tension / f.mass * KernelLaw::sigma(d) / std::pow(f.h, d + 2));
    fluid_sweep::for_cluster_parts(f, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            const Pack kappa = load(f.surface.mean, c);
            if (!any((kappa < broadcast<Pack>(0.0)) | (kappa > broadcast<Pack>(0.0)))) continue;
            std::size_t axis = 0;
            for_components<d>([&](const Pack& a) { add(f.a[axis++], c, factor * a); }, pull<KernelLaw, d>(f, c));
        }
    });
}

/// Clusters with a particle in the layer.
std::vector<std::uint8_t> layer_clusters(const SphFluid& f) {
    std::vector<std::uint8_t> in_layer(f.clusters.count, 0);
    parallel_for(f.clusters.count, [&](std::size_t c) {
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const auto own = static_cast<std::size_t>(f.clusters.record_of[pack_width * c + lane]);
            if (f.surface.records[own].weight > 0.0) in_layer[c] = 1;
        }
    });
    return in_layer;
}

void make_room(SphFluid& f) {
    Surface& s = f.surface;
    s.records.assign(f.clusters.records.size(), SurfaceRecord{});
    s.colour.assign(f.clusters.records.size(), 1.0);
    for (Field<double>* field : {&s.cover, &s.curvature, &s.mean}) renew_size(*field, f.slots());
}

template <class KernelLaw, int d> void add_tension(SphFluid& f, double tension) {
    make_room(f);
    mirror_colour(f);
    find_layer<KernelLaw, d>(f);
    update_images(f.clusters, f.surface.records, f.domain);
    for (int again = 0; f.boundary.size() > 0 && again < continuations; ++again) {
        continue_colour(f);
        find_layer<KernelLaw, d>(f);
        update_images(f.clusters, f.surface.records, f.domain);
    }
    find_curvature<KernelLaw, d>(f, layer_clusters(f));
    update_images(f.clusters, f.surface.records, f.domain);
    spread_curvature<KernelLaw, d>(f);
    update_images(f.clusters, f.surface.records, f.domain);
    pull_surface<KernelLaw, d>(f, tension);
}

/// Share of the kernel's mass beyond a plane at the distance s [h]: that of each shell's cap.
template <class KernelLaw> double beyond_plane(int dimensions, double s) {
    return KernelLaw::sigma(dimensions) * ball_integral<KernelLaw>(dimensions, [&](double q) {
               if (q <= s) return 0.0;
               const double cap = dimensions == 2 ? std::acos(s / q) / std::numbers::pi : 0.5 * (1.0 - s / q);
               return KernelLaw::w(q) * cap;
           });
}

} // namespace

double ColourProfile::depth(double c) const {
    const double side = c < 0.5 ? -1.0 : 1.0, inside = c < 0.5 ? 1.0 - c : c;
    const auto above = std::upper_bound(colour.begin(), colour.end(), inside);
    if (above == colour.begin()) return 0.0;
    if (above == colour.end()) return side * spacing * static_cast<double>(colour.size() - 1);
    const double low = *(above - 1), share = (inside - low) / (*above - low);
    return side * spacing * (static_cast<double>(above - colour.begin() - 1) + share);
}

ColourProfile colour_profile(const Kernel& kernel, int dimensions) {
    constexpr std::size_t intervals = 64;
    return std::visit(
        [&](const auto& law) {
            using KernelLaw = std::decay_t<decltype(law)>;
            ColourProfile profile;
            profile.spacing = KernelLaw::support / intervals;
            for (std::size_t k = 0; k <= intervals; ++k)
                profile.colour.push_back(1.0 -
                                         beyond_plane<KernelLaw>(dimensions, profile.spacing * static_cast<double>(k)));
            profile.steepest = (profile.colour[1] - profile.colour[0]) / profile.spacing;
            return profile;
        },
        kernel);
}

double surface_tension(const Surface& surface) {
    const auto* law = std::get_if<ContinuumSurfaceForce>(&surface.law);
    return law ? law->tension : 0.0;
}

void add_surface_tension(SphFluid& f) {
    const double tension = surface_tension(f.surface);
    if (tension == 0.0) return;
    std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            f.dimensions == 2 ? add_tension<KernelLaw, 2>(f, tension) : add_tension<KernelLaw, 3>(f, tension);
        },
        f.kernel);
}

} // namespace plumb
