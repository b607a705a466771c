#include "sph/contact_angle.hpp"

#include "sph/vector_at.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

void set_colour(SphFluid& f, std::size_t k, double colour) {
    f.surface.colour[static_cast<std::size_t>(f.clusters.record_of_passive[k])] = colour;
}

void colour_images(SphFluid& f) {
    Field<double>& colour = f.surface.colour;
    parallel_for(colour.size(),
                 [&](std::size_t r) { colour[r] = colour[static_cast<std::size_t>(f.clusters.image_of[r])]; });
}

/// Colour of a wet wall's mirror points at a depth [h]: half the kernel reaches beyond the wall at its surface.
double wet_cover(const ColourProfile& profile, double depth) {
    const double at = depth / profile.spacing;
    const auto k = static_cast<std::size_t>(at);
    if (k + 1 >= profile.colour.size()) return 1.0;
    return profile.colour[k] + (at - static_cast<double>(k)) * (profile.colour[k + 1] - profile.colour[k]);
}

/// Sharp within a spacing: `inside` is the distance from the surface, in spacings.
double step(double inside) { return std::clamp(inside + 0.5, 0.0, 1.0); }

/// Distance from the continued surface of a wall particle [m], and how much of the layer told it.
struct Continued {
    double distance = 0.0, weight = 0.0;
};

template <class KernelLaw> Continued continued(const SphFluid& f, std::size_t k, std::span<const std::int32_t> near) {
    const BoundaryParticles& b = f.boundary;
    const Vec3 x = vector_at(b.x, k, f.dimensions), mirror = vector_at(b.mirror, k, f.dimensions),
               normal = vector_at(b.normal, k, f.dimensions);
    const double depth = 0.5 * (mirror - x).norm();
    const double cosine = b.cos_contact[k], sine = std::sqrt(1.0 - cosine * cosine);
    Continued sum;
    for (const std::int32_t record : near) {
        const auto r = static_cast<std::size_t>(record);
        const SurfaceRecord& s = f.surface.records[r];
        if (s.weight == 0.0) continue;
        const FluidRecord& at = f.clusters.records[r];
        const Vec3 n(s.nx, s.ny, s.nz), along = n - n.dot(normal) * normal;
        const double length = along.norm();
        if (length < 0.1) continue; // the surface runs along the wall
        const double q = (Vec3(at.x, at.y, at.z) - mirror).norm() / f.h;
        if (q >= KernelLaw::support) continue;
        // Beside the wall the layer is itself made with these colours: what is farther away tells more.
        const double away = ((Vec3(at.x, at.y, at.z) - mirror).dot(normal) + depth) / f.h;
        const double weight = s.weight * KernelLaw::w(q) * std::min(away * away, 1.0);
        // An arc from the layer's point to the wall, its chord between both directions; from there on straight.
        const Vec3 towards = sine / length * along - cosine * normal, chord = n + towards;
        const Vec3 point(s.x, s.y, s.z);
        const double height = (point - mirror).dot(normal) + depth, run = chord.dot(along) / length;
        if (run < 0.1) continue;
        const Vec3 line = point - height * normal + height * chord.dot(normal) / (run * length) * along;
        sum.distance += weight * towards.dot(x - line);
        sum.weight += weight;
    }
    sum.distance /= std::max(sum.weight, 1e-300);
    return sum;
}

constexpr double enough = 0.02; // weight of the layer that can tell where it goes on

} // namespace

void mirror_colour(SphFluid& f) {
    const BoundaryParticles& b = f.boundary;
    if (b.size() == 0) return;
    const double steepness = f.surface.profile.steepest / f.h;
    parallel_for(b.size(), [&](std::size_t k) {
        if (b.side[k] >= 0) return; // open sides are fluid
        const double depth = 0.5 * (vector_at(b.x, k, f.dimensions) - vector_at(b.mirror, k, f.dimensions)).norm();
        const double share = b.cover[k] / wet_cover(f.surface.profile, depth / f.h);
        set_colour(f, k, step((share - 0.5) / (steepness * f.spacing)));
    });
    colour_images(f);
}

void continue_colour(SphFluid& f) {
    const BoundaryParticles& b = f.boundary;
    if (b.size() == 0) return;
    std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            parallel_for(b.member.size() / pack_width, [&](std::size_t g) {
                for (std::size_t lane = 0; lane < pack_width; ++lane) {
                    const std::size_t entry = pack_width * g + lane;
                    if (entry >= b.size()) break;
                    const auto k = static_cast<std::size_t>(b.member[entry]);
                    if (b.side[k] >= 0 || std::isnan(b.cos_contact[k])) continue;
                    const Continued c = continued<KernelLaw>(f, k, b.near_mirror.near(g));
                    if (c.weight > enough) set_colour(f, k, step(c.distance / f.spacing));
                }
            });
        },
        f.kernel);
    colour_images(f);
}

} // namespace plumb
