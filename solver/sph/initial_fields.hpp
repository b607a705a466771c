// Velocity and pressure of the fluid at the start.
//
// To add one: write the struct, name it in InitialField at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"
#include "core/vec.hpp"
#include "sph/equation_of_state.hpp"

#include <cmath>
#include <numbers>
#include <variant>

namespace plumb {

/// Velocity [m/s] and pressure [Pa] at one place.
struct FlowState {
    Vec3 u = Vec3::Zero();
    double p = 0.0;
};

/// What an initial field may need to know of the fluid.
struct FluidNumbers {
    Vec3 size;          // of the box [m]
    double density;     // [kg/m3]
    double sound_speed; // [m/s]
    double viscosity;   // dynamic [Pa s]
    Vec3 gravity;       // that the particles feel [m/s2]
    EquationOfState equation_of_state;
};

namespace detail {
inline double wave_number(const Vec3& size, int axis, double waves) {
    return 2.0 * std::numbers::pi * waves / size[axis];
}
} // namespace detail

/// u = 0, p = 0.
struct RestField {
    static constexpr std::string_view name = "rest";
    static constexpr LawInfo info{"u = 0, p = 0", "any", "definition"};
    FlowState operator()(const Vec3& /*x*/, const FluidNumbers& /*f*/) const { return {}; }
};

/// u = 0 and one pressure everywhere: below zero the fluid is under tension.
struct UniformPressureField {
    static constexpr std::string_view name = "uniform_pressure";
    static constexpr LawInfo info{"u = 0, p = pressure", "any", "definition"};
    double pressure; // [Pa]
    explicit UniformPressureField(Table& table) : pressure(table.number("pressure")) {}
    FlowState operator()(const Vec3& /*x*/, const FluidNumbers& /*f*/) const { return {Vec3::Zero(), pressure}; }
};

/// The plane vortex u = -U cos kx sin ky, v = U sin kx cos ky, p = -rho U^2/4 (cos 2kx + cos 2ky), k = 2 pi/size.
struct TaylorGreenField {
    static constexpr std::string_view name = "taylor_green";
    static constexpr LawInfo info{"u = U (-cos kx sin ky, sin kx cos ky), p = -rho U^2/4 (cos 2kx + cos 2ky)",
                                  "square box in the plane", "Taylor & Green 1937, Proc. R. Soc. A 158, 499"};
    double speed; // U [m/s]
    explicit TaylorGreenField(Table& table) : speed(table.number("speed", positive)) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const double a = detail::wave_number(f.size, 0, 1.0) * x[0], b = detail::wave_number(f.size, 1, 1.0) * x[1];
        return {speed * Vec3(-std::cos(a) * std::sin(b), std::sin(a) * std::cos(b), 0.0),
                -0.25 * f.density * speed * speed * (std::cos(2.0 * a) + std::cos(2.0 * b))};
    }
};

/// u = U sin kx cos ky cos kz, v = -U cos kx sin ky cos kz, p = rho U^2/16 (cos 2kx + cos 2ky)(cos 2kz + 2), cubic box.
struct TaylorGreenCube {
    static constexpr std::string_view name = "taylor_green_3d";
    static constexpr LawInfo info{"u = U (sin kx cos ky cos kz, -cos kx sin ky cos kz, 0)", "cubic box",
                                  "Taylor & Green 1937, Proc. R. Soc. A 158, 499"};
    double speed; // U [m/s]
    explicit TaylorGreenCube(Table& table) : speed(table.number("speed", positive)) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const double k = detail::wave_number(f.size, 0, 1.0), a = k * x[0], b = k * x[1], c = k * x[2];
        return {speed * std::cos(c) * Vec3(std::sin(a) * std::cos(b), -std::cos(a) * std::sin(b), 0.0),
                f.density * speed * speed / 16.0 * (std::cos(2.0 * a) + std::cos(2.0 * b)) * (std::cos(2.0 * c) + 2.0)};
    }
};

/// u_x = U sin ky, p = 0, k = 2 pi waves/size_y.
struct ShearWaveField {
    static constexpr std::string_view name = "shear_wave";
    static constexpr LawInfo info{"u_x = U sin ky, k = 2 pi waves/size_y", "periodic along y", "Stokes 1851"};
    double speed, waves;
    explicit ShearWaveField(Table& table)
        : speed(table.number("speed", positive)), waves(static_cast<double>(table.integer("waves", 1, 1000))) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        return {Vec3(speed * std::sin(detail::wave_number(f.size, 1, waves) * x[1]), 0.0, 0.0), 0.0};
    }
};

/// Sound along x, k = 2 pi waves/size_x. Standing: u = U sin kx, p = 0. Travelling towards +x, to first order in U/c
/// and nu k/c: u = U cos kx, p = rho c U cos kx.
struct SoundWaveField {
    static constexpr std::string_view name = "sound_wave";
    static constexpr LawInfo info{"u_x = U sin kx, p = 0 (standing); u_x = U cos kx, p = rho c u_x (travelling)",
                                  "U << c", "Lighthill 1978, Waves in fluids, sec. 1.1"};
    double speed, waves;
    bool travelling;
    explicit SoundWaveField(Table& table)
        : speed(table.number("speed", positive)), waves(static_cast<double>(table.integer("waves", 1, 1000))),
          travelling(table.choice("kind", {"standing", "travelling"}) == "travelling") {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const double phase = detail::wave_number(f.size, 0, waves) * x[0];
        const double u = speed * (travelling ? std::cos(phase) : std::sin(phase));
        return {Vec3(u, 0.0, 0.0), travelling ? f.density * f.sound_speed * u : 0.0};
    }
};

/// At rest under gravity below a level surface: p = 0 at the height `surface` and above, and below what the fluid's own
/// compressibility makes of rho g d.
struct HydrostaticField {
    static constexpr std::string_view name = "hydrostatic";
    static constexpr LawInfo info{"u = 0, integral of dp/rho = g (surface - height)",
                                  "gravity along one axis, pressure = \"full\"", "Batchelor 1967, sec. 1.4"};
    double surface; // height against gravity, from the origin [m]
    explicit HydrostaticField(Table& table) : surface(table.number("surface")) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const double g = f.gravity.norm();
        const double potential = larger(g * surface + f.gravity.dot(x), 0.0); // g times depth
        return {
            Vec3::Zero(),
            std::visit([&](const auto& law) { return law.hydrostatic_pressure(potential, f.density, f.sound_speed); },
                       f.equation_of_state)};
    }
};

using InitialField = std::variant<RestField, UniformPressureField, TaylorGreenField, TaylorGreenCube, ShearWaveField,
                                  SoundWaveField, HydrostaticField>;

} // namespace plumb
