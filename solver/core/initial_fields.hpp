// Velocity and pressure of the fluid at the start.
//
// To add one: write the struct, name it in InitialField at the end, add its test and its README row.
#pragma once

#include "core/laws.hpp"
#include "core/manufactured_flow.hpp"
#include "core/manufactured_medium.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace plumb {

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

/// A pulse of sound that travels along x through a uniform flow, to first order in U/c: with g = exp(-(x - centre)^2/(2
/// width^2)), u = flow + U g, p = rho c U g towards +x and u = flow - U g, p = rho c U g towards -x.
struct PulseField {
    static constexpr std::string_view name = "pulse";
    static constexpr LawInfo info{"u_x = flow +- speed g, p = rho c speed g, g = exp(-(x - centre)^2/(2 width^2))",
                                  "speed << c", "Lighthill 1978, Waves in fluids, sec. 1.1"};
    double speed, centre, width, flow; // [m/s], [m], [m], [m/s]
    bool forwards;
    explicit PulseField(Table& table)
        : speed(table.number("speed", positive)), centre(table.number("centre")),
          width(table.number("width", positive)), flow(table.number("flow")),
          forwards(table.choice("towards", {"+x", "-x"}) == "+x") {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const double s = (x[0] - centre) / width, u = speed * std::exp(-0.5 * s * s);
        return {Vec3(flow + (forwards ? u : -u), 0.0, 0.0), f.density * f.sound_speed * u};
    }
};

/// Developed laminar flow along x between plates: u = 3/2 mean (1 - (y - centre)^2/half_width^2), p falling to 0 at the
/// far side of the box.
struct ChannelField {
    static constexpr std::string_view name = "channel";
    static constexpr LawInfo info{"u_x = 3/2 mean (1 - (y - centre)^2/half_width^2), dp/dx = -3 mu mean/half_width^2",
                                  "between plates across y", "Poiseuille 1840"};
    double mean_speed, centre, half_width; // [m/s], [m], [m]
    explicit ChannelField(Table& table)
        : mean_speed(table.number("mean_speed", positive)), centre(table.number("centre")),
          half_width(table.number("half_width", positive)) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const double s = (x[1] - centre) / half_width;
        return {Vec3(1.5 * mean_speed * (1.0 - s * s), 0.0, 0.0),
                3.0 * f.viscosity * mean_speed / (half_width * half_width) * (f.size[0] - x[0])};
    }
};

/// The same velocity everywhere, p = 0.
struct UniformField {
    static constexpr std::string_view name = "uniform";
    static constexpr LawInfo info{"u = velocity, p = 0", "any", "definition"};
    Vec3 velocity; // [m/s]
    explicit UniformField(Table& table)
        : velocity(table.components("velocity", table.length("velocity") == 2 ? 2 : 3)) {}
    FlowState operator()(const Vec3& /*x*/, const FluidNumbers& /*f*/) const { return {velocity, 0.0}; }
};

/// The flow of the manufactured solution (manufactured_flow.hpp) at t = 0.
struct ManufacturedField {
    static constexpr std::string_view name = "manufactured";
    static constexpr LawInfo info{"u = curl psi + d grad chi, psi, chi and p sums of waves at t = 0",
                                  "square box in the plane", "verification/mms, eq. 2"};
    ManufacturedFlow flow;
    explicit ManufacturedField(Table& table) : flow(table) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const ManufacturedFlow::State s = flow.at(x, 0.0, f);
        return {s.v, s.p};
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
        const double potential = std::max(g * surface + f.gravity.dot(x), 0.0); // g times depth
        return {
            Vec3::Zero(),
            std::visit([&](const auto& law) { return law.hydrostatic_pressure(potential, f.density, f.sound_speed); },
                       f.equation_of_state)};
    }
};

/// Rigid rotation of a square without walls, u = rate (y_c - y, x - x_c), with the pressure that vanishes on its sides:
/// lap p = 2 rho rate^2. It is negative everywhere inside. With X, Y from a corner, L the side and n odd,
///     p = rho rate^2 {X (X - L) + sum 8 L^2/(n pi)^3 sin(n pi X/L) cosh(n pi (Y - L/2)/L)/cosh(n pi/2)}
struct RotatingSquareField {
    static constexpr std::string_view name = "rotating_square";
    static constexpr LawInfo info{"u = rate (y_c - y, x - x_c), lap p = 2 rho rate^2 with p = 0 on the sides",
                                  "a square in the plane, sides along the axes", "Colagrossi 2005, thesis, Rome"};
    double rate, side; // [1/s], [m]
    Vec3 centre;       // [m]
    explicit RotatingSquareField(Table& table)
        : rate(table.number("rate")), side(table.number("side", positive)), centre(table.components("centre", 2)) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const Vec3 r = x - centre;
        return {rate * Vec3(-r[1], r[0], 0.0), f.density * rate * rate * side * side * shape(r[0] / side, r[1] / side)};
    }

private:
    /// p/(rho rate^2 L^2) at places in units of L from the middle; zero outside. The terms left out sum to < 1e-6.
    static double shape(double a, double b) {
        if (std::abs(a) >= 0.5 || std::abs(b) >= 0.5) return 0.0;
        double sum = (a + 0.5) * (a - 0.5);
        for (int n = 1; n < 200; n += 2) {
            const double k = n * std::numbers::pi;
            sum += 8.0 / (k * k * k) * std::sin(k * (a + 0.5)) * std::cosh(k * b) / std::cosh(0.5 * k);
        }
        return sum;
    }
};

/// The flow of verification/mms_grid at t = 0.
struct ManufacturedMediumField {
    static constexpr std::string_view name = "manufactured_medium";
    static constexpr LawInfo info{"eps u = curl psi + c (eps - mean), a moving wave of eps", "square box in the plane",
                                  "verification/mms_grid, eq. 2"};
    ManufacturedMedium flow;
    explicit ManufacturedMediumField(Table& table) : flow(table) {}
    FlowState operator()(const Vec3& x, const FluidNumbers& f) const {
        const ManufacturedMedium::State s = flow.at(x, 0.0, f.size, f.density);
        return {s.u, s.p};
    }
};

using InitialField = std::variant<RestField, UniformPressureField, TaylorGreenField, TaylorGreenCube, ShearWaveField,
                                  SoundWaveField, PulseField, HydrostaticField, RotatingSquareField, ChannelField,
                                  UniformField, ManufacturedField, ManufacturedMediumField>;

} // namespace plumb
