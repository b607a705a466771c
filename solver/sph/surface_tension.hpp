// Surface tension of a free surface without a gas: a continuum surface force whose curvature is that of the surface
// itself, at whatever depth below it a particle lies.
//
// For every particle the colour C = sum V W and its gradient G = sum V grad W, which points into the fluid along n =
// G/|G|. Below a flat surface C is a function of the depth s/h alone, so s follows from C, and y = x - s n lies on the
// surface. From pairs of such points of the surface layer, each of weight w (1 where |G| is large),
//     kappa_a = -(d - 1) sum w W (n_b - n_a).(y_b - y_a)/sum w W |y_b - y_a|^2,
// which is 1/R for a circle and 2/R for a sphere exactly, however the particles lie. The mean of it over the layer
// around a particle, with weights w W, fades to zero some two h deep; with it
//     dv_a/dt = tension {kappa_a sum m (1/rho_a^2 + 1/rho_b^2) grad W - (1/C_a - 1)/rho_a sum V (kappa_b - kappa_a)
//     grad_t W}.
// The first sum is the pressure's own for a pressure of -tension kappa_a everywhere: under even curvature a drop is in
// equilibrium at p = tension kappa to rounding, whatever the arrangement of its particles, and nothing pulls along the
// surface. It acts where the surface's delta 2 |G| is, 0.5 h below the surface on average, where flows that wave along
// the surface have faded; the work that misses is that of the gradient of kappa along the surface (grad_t), of which
// sums over half a neighbourhood see the share C only. The second sum, only in the layer, makes up for it
// (verification/ oscillating_drop). The forces on a closed surface sum to zero to the accuracy of kappa only.
//
// A force derived from an energy of C and G keeps momentum and energy, but pulls along the surface: the particles
// gather in clumps at which G is small, and the tension fades (verification/static_drop).
#pragma once

#include "core/laws.hpp"
#include "sph/clusters.hpp"
#include "sph/kernels.hpp"

#include <variant>
#include <vector>

namespace plumb {

/// No surface tension.
struct NoSurfaceTension {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"dv/dt = 0", "any", "-"};
};

/// The force above.
struct ContinuumSurfaceForce {
    static constexpr std::string_view name = "continuum_surface_force";
    static constexpr LawInfo info{
        "dv/dt = tension kappa sum m (1/rho_a^2 + 1/rho_b^2) grad W + along the surface; "
        "kappa = -div n",
        "free surfaces, radii of curvature above 5 h; smoothing 2, h sqrt(tension/(rho R))/nu "
        "below 20 or artificial viscosity",
        "Brackbill, Kothe & Zemach 1992, J. Comput. Phys. 100, 335 (the force); "
        "sph/surface_tension.hpp (the curvature)"};
    double tension; // [N/m]
    explicit ContinuumSurfaceForce(Table& table) : tension(table.number("tension", positive)) {}
};

using SurfaceLaw = std::variant<NoSurfaceTension, ContinuumSurfaceForce>;

/// What a pair of the surface layer reads of one particle; x, y, z: the point of the surface above it.
struct alignas(64) SurfaceRecord {
    double x, y, z, weight, nx, ny, nz, curvature;
};

/// C below a flat surface: colour[k] at the depth k h support/(size - 1), from 1/2 to 1.
struct ColourProfile {
    std::vector<double> colour;
    double spacing = 0.0;  // of depths [h]
    double steepest = 0.0; // h |G| on the surface

    /// Depth over h; negative above the surface.
    double depth(double c) const;
};
ColourProfile colour_profile(const Kernel& kernel, int dimensions);

/// The law, and its fields of the last evaluation, which no later one reads.
struct Surface {
    SurfaceLaw law;
    ColourProfile profile;
    Field<SurfaceRecord> records;  // [records]
    Field<double> colour;          // [records] how much of a particle is fluid: 1, of walls as far as they are wet
    Field<double> cover;           // [slots] C
    Field<double> curvature, mean; // [slots] of the layer, and its mean around a particle [1/m]
};

struct SphFluid;

/// Tension [N/m]; 0 without.
double surface_tension(const Surface& surface);

/// Adds the accelerations of surface tension for the state in the records.
void add_surface_tension(SphFluid& fluid);

} // namespace plumb
