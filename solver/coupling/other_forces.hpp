// Forces of the fluid on one grain besides drag and history: buoyancy, undisturbed flow, virtual mass, lift.
//
// Each law maps (fluid at the grain, grain, gravity) to a force on the grain [N]. V = pi d^3/6. A fluid that nothing
// else pushes obeys rho Du/Dt = -grad p + div tau + rho g, so the stress it would exert on the volume of the grain, V
// (-grad p + div tau), is the sum of `buoyancy` and `pressure_gradient`. A force that no computed fluid may exert,
// because that fluid does not carry the pressure behind it, says so with `from_outside`: what a grain receives by it,
// the fluid does not lose. To add a force: write the struct, name it in OtherForce at the end, add its test and its
// README row.
#pragma once

#include "core/laws.hpp"
#include "core/sphere.hpp"
#include "coupling/local_fluid.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace plumb {

/// -rho V g: Archimedes' force of the hydrostatic pressure.
struct Buoyancy {
    static constexpr std::string_view name = "buoyancy";
    static constexpr LawInfo info{"-rho V g", "any", "Archimedes"};
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& gravity) const {
        return -fluid.density * sphere_volume(grain.diameter) * gravity;
    }
    /// All of it: the hydrostatic pressure is left out of a computed fluid's.
    Vec3 from_outside(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& gravity,
                      const Vec3& /*mean_gradient*/) const {
        return (*this)(fluid, grain, gravity);
    }
};

/// V (-grad P + div tau): stress of the undisturbed flow, without its hydrostatic part. It is rho V Du/Dt in a flow
/// that nothing else pushes, where Du/Dt follows the fluid (+u . grad u; some papers print a minus or the derivative
/// along the grain's path); among grains the fluid pays their drag out of it, too. Maxey & Riley 1983, Auton et al.
/// 1988.
struct PressureGradient {
    static constexpr std::string_view name = "pressure_gradient";
    static constexpr LawInfo info{"V (-grad P + div tau)", "grains small against the flow's scale",
                                  "Maxey & Riley 1983, Phys. Fluids 26, 883-889"};
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& /*gravity*/) const {
        return sphere_volume(grain.diameter) * fluid.stress;
    }
    /// The share of a mean pressure gradient [Pa/m], which drives fluid and grains alike.
    Vec3 from_outside(const LocalFluid& /*fluid*/, const LocalGrain& grain, const Vec3& /*gravity*/,
                      const Vec3& mean_gradient) const {
        return -sphere_volume(grain.diameter) * mean_gradient;
    }
};

/// rho V u . grad u: of the stress of the undisturbed flow no more than the part by which it is carried along. What
/// some solvers call the pressure-gradient force; the gradient that friction and drag take is left out.
struct ConvectiveAcceleration {
    static constexpr std::string_view name = "convective_acceleration";
    static constexpr bool needs_gradient = true;
    static constexpr LawInfo info{"rho V u . grad u", "steady flow without friction",
                                  "DDPM-DEM mud-cake paper, Table 1 (its u div u read as u . grad u)"};
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& /*gravity*/) const {
        return fluid.density * sphere_volume(grain.diameter) * (fluid.gradient * fluid.u);
    }
};

/// C_m rho V (Du/Dt - dv/dt), C_m = 1/2 for a sphere. Du/Dt is what the fluid does, and not the stress over its
/// density: a bed that is held in a steady flow has the one's drag, and nothing of the other. Returned is the part of
/// the fluid's acceleration; the part -C_m rho V dv/dt is inertia that moves with the grain and is treated as such: the
/// integrator adds `added_mass` to the mass of the grain on the left-hand side, which is stable for any density ratio.
struct VirtualMass {
    static constexpr std::string_view name = "virtual_mass";
    static constexpr LawInfo info{"1/2 rho V (Du/Dt - dv/dt)", "one sphere; eps near 1",
                                  "Auton, Hunt & Prud'homme 1988, J. Fluid Mech. 197, 241-257"};
    static constexpr double coefficient = 0.5; // sphere in potential flow, e.g. Lamb 1932, art. 92
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& /*gravity*/) const {
        return mass(fluid.density, grain.diameter) * fluid.acceleration;
    }
    /// C_m rho V [kg].
    static double mass(double density, double diameter) { return coefficient * density * sphere_volume(diameter); }
};

/// 1.615 d^2 sqrt(rho mu/|omega|) C (u - v) x omega, omega = curl u, with Mei's C(Re, alpha), Re = rho |u-v| d/mu,
/// alpha = |omega| d/(2 |u-v|):
///     C = (1 - 0.3314 sqrt(alpha)) exp(-Re/10) + 0.3314 sqrt(alpha)   for Re <= 40,   0.0524 sqrt(alpha Re)   above.
/// Saffman's 6.46 mu a^2 |u-v| sqrt(G rho/mu) (1965; 81.2 in the first print, corrected 1968) is 1.615 on the diameter.
/// Direction: a grain that lags the fluid moves towards the faster side, one that leads towards the slower side; some
/// papers print the opposite sign, or a constant in place of the factor sqrt(nu/|omega|).
/// Limits: C -> 1 at Re -> 0 for fixed omega d^2 rho/mu; no shear or no slip: no force. At Re = 40 the source's C steps
/// down by (1 - 0.3314 sqrt(alpha)) exp(-4).
struct SaffmanMei {
    static constexpr std::string_view name = "saffman_mei";
    static constexpr bool needs_gradient = true;
    static constexpr LawInfo info{
        "1.615 d^2 sqrt(rho mu/|curl u|) C (u-v) x curl u, C = (1 - 0.3314 sqrt(alpha)) exp(-Re/10) + 0.3314 "
        "sqrt(alpha) for "
        "Re <= 40, 0.0524 sqrt(alpha Re) above; Re = rho |u-v| d/mu, alpha = |curl u| d/(2 |u-v|)",
        "Re <= 100, 0.005 <= alpha <= 0.4, far from walls",
        "Saffman 1965, J. Fluid Mech. 22, 385-400 (corrected 1968); Mei 1992, Int. J. Multiphase Flow 18, 145-147"};
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& /*gravity*/) const {
        const Vec3 omega = vorticity(fluid.gradient), slip = fluid.u - grain.velocity;
        const double rate = omega.norm(), speed = slip.norm(), d = grain.diameter;
        if (!(rate > 0.0) || !(speed > 0.0)) return Vec3::Zero();
        const double re = fluid.density * speed * d / fluid.viscosity;
        const double c = finite_re_factor(re, 0.5 * rate * d / speed);
        const double saffman = 6.46 / 4.0; // Saffman 1965, corrigendum 1968; 6.46 on the radius
        return saffman * c * d * d * std::sqrt(fluid.density * fluid.viscosity / rate) * slip.cross(omega);
    }
    /// C. Constants: Mei 1992.
    static double finite_re_factor(double re, double alpha) {
        if (re > 40.0) return 0.0524 * std::sqrt(alpha * re);
        // sqrt(alpha) grows without bound as the slip vanishes, but only as Re^-1/2 while 1 - exp(-Re/10) falls as Re.
        return std::exp(-0.1 * re) - 0.3314 * std::sqrt(alpha) * std::expm1(-0.1 * re);
    }
};

/// 2 K sqrt(nu) rho d_ij (u - v)_j / (rho_p d (d_lk d_kl)^(1/4)) per mass of grain, K = 2.594, d_ij the symmetric part
/// of grad u: times the mass, (pi/3) K rho sqrt(nu) d^2 d_ij (u - v)_j / (d_lk d_kl)^(1/4). In simple shear with slip
/// along the flow the transverse part is Saffman's force, 1.615 mu d^2 |u-v| sqrt(G/nu), exactly. Saffman's
/// creeping-flow lift in any rate of deformation; no finite-Re factor. In a rigid rotation it vanishes.
struct LiAhmadi {
    static constexpr std::string_view name = "li_ahmadi";
    static constexpr bool needs_gradient = true;
    static constexpr LawInfo info{"(pi/3) K rho sqrt(nu) d^2 d_ij (u-v)_j/(d_lk d_kl)^(1/4), K = 2.594",
                                  "Re << sqrt(G d^2/nu) << 1, small grains",
                                  "Li & Ahmadi 1992, Aerosol Sci. Technol. 16, 209-226"};
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& /*gravity*/) const {
        const Eigen::Matrix3d deformation = 0.5 * (fluid.gradient + fluid.gradient.transpose());
        const double square = deformation.squaredNorm(); // d_lk d_kl of a symmetric tensor
        if (!(square > 0.0)) return Vec3::Zero();
        const double k = 2.594; // Li & Ahmadi 1992
        const double d = grain.diameter;
        const double factor = std::numbers::pi / 3.0 * k * d * d * std::sqrt(fluid.density * fluid.viscosity);
        return factor / std::sqrt(std::sqrt(square)) * (deformation * (fluid.u - grain.velocity));
    }
};

/// Choosing no force is an empty list of forces. Basset's history force carries a state: history_force.hpp.
using SoundForces = std::variant<Buoyancy, PressureGradient, ConvectiveAcceleration, VirtualMass, SaffmanMei, LiAhmadi>;

#ifdef PLUMB_PLANTED
/// Wrong on purpose, in test builds only: the stress over the density for the fluid's acceleration, which among grains
/// is the greater by what the fluid pays for their drag. What this solver itself once had.
struct PlantedVirtualMassOfStress {
    static constexpr std::string_view name = "virtual_mass_of_stress";
    static constexpr LawInfo info{"1/2 V (-grad P + div tau)", "none", "planted fault"};
    Vec3 operator()(const LocalFluid& fluid, const LocalGrain& grain, const Vec3& /*gravity*/) const {
        return VirtualMass::coefficient * sphere_volume(grain.diameter) * fluid.stress;
    }
    static double mass(double density, double diameter) { return VirtualMass::mass(density, diameter); }
};
using OtherForce = JoinedFamilies<SoundForces, std::variant<PlantedVirtualMassOfStress>>;
#else
using OtherForce = SoundForces;
#endif

/// Force of one law on the grain [N].
inline Vec3 force_on_grain(const OtherForce& law, const LocalFluid& fluid, const LocalGrain& grain,
                           const Vec3& gravity) {
    return std::visit([&](const auto& one) -> Vec3 { return one(fluid, grain, gravity); }, law);
}

/// Share of a force that no computed fluid exerts [N]; zero for laws that do not speak of it.
inline Vec3 force_from_outside(const OtherForce& law, const LocalFluid& fluid, const LocalGrain& grain,
                               const Vec3& gravity, const Vec3& mean_gradient) {
    return std::visit(
        [&](const auto& one) -> Vec3 {
            if constexpr (requires { one.from_outside(fluid, grain, gravity, mean_gradient); })
                return one.from_outside(fluid, grain, gravity, mean_gradient);
            else
                return Vec3::Zero();
        },
        law);
}

/// Whether a law reads LocalFluid::gradient; it says so with `needs_gradient`.
inline bool needs_gradient(const OtherForce& law) {
    return std::visit(
        [](const auto& one) {
            return requires { one.needs_gradient; };
        },
        law);
}

/// Inertia a law adds to a grain [kg]; zero for all but virtual mass.
inline double added_mass(const OtherForce& law, double density, double diameter) {
    return std::visit(
        [&](const auto& one) {
            if constexpr (requires { one.mass(density, diameter); })
                return one.mass(density, diameter);
            else
                return 0.0;
        },
        law);
}

} // namespace plumb
