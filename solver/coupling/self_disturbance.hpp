// What a grain has done to the fluid that it gathers, to be taken out again: a drag law is defined by the fluid as it
// would be without the grain (alone) or by its mean (in a suspension), not by the wake of the grain's own push.
//
// Linear theory, in waves of number k and cosine c to the slip w, with the filters s^ (spreading) and g^ (gathering),
// the symbol lambda(k) of the scheme's own viscous term, the structure factor S(k) of the other grains, and their drag
// beta per volume and velocity where they are held (grains that settle hand on their weight whatever the fluid does,
// and screen nothing):
//     dA/dt = F - [lambda + beta/rho + i k c w] A,
//     u_self = (1/rho) (2 pi)^-3 Int s^ g^ S (I - kk/k^2) . Re A d3k.
// Each wave fades exponentially, so the past needs no store. Out of the same sums come the grain's other marks:
//     pressure and stress   -(2 pi)^-3 Int s^ g^ S [kk/k^2 F + (I - kk/k^2) lambda Re A] d3k  of its wake,
//     porosity              -V (2 pi)^-3 Int p^ g^ S d3k  by its own volume, p^ the filter of the porosity,
//     backflow              of the fluid that makes room for the moving volume: -(V/3) (2 pi)^-3 Int p^ g^ S/W^ B d3k,
//                           dB/dt = (c_s k W^)^2/lambda (v - u - B), for pressure acts through the fluid's own kernel
//                           W.
//
// A fluid on a grid is implicit in time. There the same waves take the fluid's own difference in time, over one step or
// two, and what the push of the coming step will add is known beforehand, so that the fluid's equations can have it.
//
// Sources: Horwitz & Mani 2016, J. Comput. Phys. 318, 85; Balachandar, Liu & Lakhote 2019, J. Comput. Phys. 376, 160
// (the idea); derived in verification/single_grain. Valid where |w| changes its direction slowly (the wake is turned
// with it) and for h c_s/nu >> 1 (the pressure answers at once).
#pragma once

#include "coupling/grid_kernels.hpp"
#include "coupling/structure_factors.hpp"
#include "coupling/weights.hpp"

#include <array>
#include <optional>
#include <span>

namespace plumb {

struct NoSelfDisturbance {
    static constexpr std::string_view name = "none";
    static constexpr LawInfo info{"u_self = 0", "h/d > 10", "-"};
};

struct OseenBrinkman {
    static constexpr std::string_view name = "oseen_brinkman";
    static constexpr LawInfo info{"dA/dt = F - [lambda(k) + beta/rho + i k.w] A per wave, u_self = sum of s g S A",
                                  "h/d >= 1, h c/nu >> 1",
                                  "verification/single_grain; after Horwitz & Mani 2016, J. Comput. Phys. 318, 85"};
    bool steady = false;   // history: the wake that the present force would have in the end, or the one it has
    bool advected = false; // the slip carries the grain out of its wake (Oseen), or does not (Stokes)
    StructureFactor structure;
    explicit OseenBrinkman(Table& t);
};

using SelfDisturbanceLaw = std::variant<NoSelfDisturbance, OseenBrinkman>;

/// Wave numbers at equal distances of their logarithm, times eight cosines of Gauss: 0.3 % of u_self up to w h/nu = 6.
inline constexpr std::size_t wave_numbers = 16;

struct SelfDisturbance {
    OseenBrinkman law;
    double density = 0.0; // of the fluid [kg/m3]

    // of every wave number
    std::array<double, wave_numbers> k{};        // [1/m]
    std::array<double, wave_numbers> share{};    // s^ g^ S and the measure, over both halves of the sphere [1/m3]
    std::array<double, wave_numbers> decay{};    // lambda [1/s]
    std::array<double, wave_numbers> backflow{}; // p^ g^ S/W^ and the measure, 1/3 included [1/m3]
    std::array<double, wave_numbers> settles{};  // of the backflow [1/s]
    double own_spread = 0.0, own_porosity = 0.0; // Int s g dV and Int p g dV, less what S takes [1/m3]
    double fraction = 0.0;                       // of the volume that other grains take

    std::vector<double> memory; // by id of the grain: see the .cpp
    std::vector<double> before; // the waves a step before; of a fluid on a grid
};

/// For grains of diameter d [m] in a fluid of three dimensions.
SelfDisturbance self_disturbance(const OseenBrinkman& law, const SphFluid& fluid, const Kernel& kernel,
                                 const CouplingWidths& widths, const PorosityLaw& porosity, double d);

/// The same on a grid of cubes of `cell` [m], for one kernel of `width` [m]. The fluid around has the share of the room
/// that the structure's grains leave, and no speed of sound.
struct GridSymbols {
    double density = 0.0, viscosity = 0.0; // [kg/m3], dynamic [Pa s]
    double cell = 0.0, width = 0.0;        // [m]
    GridKernel kernel;
};
SelfDisturbance self_disturbance(const OseenBrinkman& law, const GridSymbols& grid, double d);

/// Numbers that are remembered of every grain, and of its waves before.
std::size_t wake_size();
std::size_t waves_before_size();

/// Velocity [m/s] that grain `id` of volume V [m3] has given the fluid that it gathers, and the force per volume [N/m3]
/// by its wake.
struct OwnFluid {
    Vec3 u, stress;
};
OwnFluid own_fluid(const SelfDisturbance& self, std::size_t id, double volume);

/// Takes the grains' own disturbance out of what they have gathered; masses [kg] and volumes [m3] by id.
void take_out(const SelfDisturbance& self, const std::vector<double>& mass, const std::vector<double>& volume,
              GatheredFluid& at_grains);

/// What a grain did in a step: its force on the fluid [N], the velocity of the fluid less its own [m/s], and the drag
/// of other grains over the density, beta/rho [1/s].
struct Push {
    Vec3 force, slip;
    double screening = 0.0;
};

/// Carries the wakes over a step dt [s] of pushes by id.
void remember(SelfDisturbance& self, const std::vector<Push>& pushes, double dt);

// --- for a fluid that is implicit in time: a step of it in four parts ---

/// Its difference in time: over two steps (3 u' - 4 u + u_before)/(2 dt), or over one (u' - u)/dt.
struct WakeStep {
    double dt = 0.0; // [s]
    bool two_steps = false;
    double per_time() const { return (two_steps ? 1.5 : 1.0) / dt; }
};

/// The waves of all grains as they meet them after a move of dt with their last slips.
void turn_wakes(SelfDisturbance& self, double dt);

/// What is left of the waves at the end of a step, without the step's own push. Returns the velocity that each grain
/// will gather of a push in the step, over it [m/(s N)]; `pushes` say what screens the waves.
std::vector<double> fade_wakes(SelfDisturbance& self, const std::vector<Push>& pushes, const WakeStep& step);

/// Adds the pushes of the step.
void push_wakes(SelfDisturbance& self, const std::vector<Push>& pushes, const WakeStep& step);

/// The slips after it, by id [m/s].
void set_slips(SelfDisturbance& self, const std::vector<Push>& pushes);

} // namespace plumb
