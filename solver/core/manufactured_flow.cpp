#include "core/manufactured_flow.hpp"

#include "core/manufactured_medium.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

enum class Swing { steady, cosine, sine }; // factor 1, cos(w t), sin(w t)

/// amplitude * swing(t) * cos(a X + b Y - phase), X = 2 pi x/L, Y = 2 pi y/L.
struct Wave {
    double amplitude, a, b, phase;
    Swing swing;
};

constexpr double sine = 0.5 * std::numbers::pi; // cos(q - pi/2) = sin q

// verification/mms, equation 2: psi k/U, chi k/U and p/(rho_0 U^2)
constexpr std::array stream{Wave{0.5, 1, -1, 0.0, Swing::steady}, Wave{-0.5, 1, 1, 0.0, Swing::steady},
                            Wave{0.5, 2, 1, 0.0, Swing::cosine}};
constexpr std::array potential{Wave{0.5, 1, -2, 0.0, Swing::steady}, Wave{1.0, 1, -2, 0.0, Swing::sine}};
constexpr std::array pressure_waves{Wave{0.25, 2, 0, 0.0, Swing::steady}, Wave{0.25, 0, 1, 0.0, Swing::steady},
                                    Wave{0.5, 1, 2, sine, Swing::sine}};

/// A sum of waves and its derivatives by X, Y and w t.
struct Derivatives {
    double value = 0.0, rate = 0.0;
    double x = 0.0, y = 0.0, x_rate = 0.0, y_rate = 0.0;
    double xx = 0.0, xy = 0.0, yy = 0.0;
    double lap_x = 0.0, lap_y = 0.0; // d/dX and d/dY of the Laplacian
};

template <std::size_t n> Derivatives sum_of(const std::array<Wave, n>& waves, double x, double y, double wt) {
    const std::array<double, 3> factors{1.0, std::cos(wt), std::sin(wt)}, rates{0.0, -factors[2], factors[1]};
    Derivatives d;
    for (const Wave& w : waves) {
        const auto swing = static_cast<std::size_t>(w.swing);
        const double angle = w.a * x + w.b * y - w.phase;
        const double c = w.amplitude * std::cos(angle), s = w.amplitude * std::sin(angle);
        const double now = factors[swing], rate = rates[swing], k_sq = w.a * w.a + w.b * w.b;
        d.value += now * c, d.rate += rate * c;
        d.x -= now * w.a * s, d.y -= now * w.b * s;
        d.x_rate -= rate * w.a * s, d.y_rate -= rate * w.b * s;
        d.xx -= now * w.a * w.a * c, d.xy -= now * w.a * w.b * c, d.yy -= now * w.b * w.b * c;
        d.lap_x += now * k_sq * w.a * s, d.lap_y += now * k_sq * w.b * s;
    }
    return d;
}

} // namespace

ManufacturedFlow::State ManufacturedFlow::at(const Vec3& x, double t, const FluidNumbers& fluid) const {
    const double k = 2.0 * std::numbers::pi / fluid.size[0], w = k * speed, d = divergence;
    const double along_x = k * x[0], along_y = k * x[1];
    const Derivatives psi = sum_of(stream, along_x, along_y, w * t);
    const Derivatives chi = sum_of(potential, along_x, along_y, w * t);
    const Derivatives p = sum_of(pressure_waves, along_x, along_y, w * t);
    State s;
    s.v = speed * Vec3(psi.y + d * chi.x, -psi.x + d * chi.y, 0.0);
    s.v_rate = speed * w * Vec3(psi.y_rate + d * chi.x_rate, -psi.x_rate + d * chi.y_rate, 0.0);
    const Vec3 by_x = speed * k * Vec3(psi.xy + d * chi.xx, -psi.xx + d * chi.xy, 0.0);
    const Vec3 by_y = speed * k * Vec3(psi.yy + d * chi.xy, -psi.xy + d * chi.yy, 0.0);
    s.convection = s.v[0] * by_x + s.v[1] * by_y;
    s.laplacian = speed * k * k * Vec3(psi.lap_y + d * chi.lap_x, -psi.lap_x + d * chi.lap_y, 0.0);
    s.div_v = by_x[0] + by_y[1];
    const double scale = fluid.density * speed * speed;
    s.p = scale * p.value;
    s.p_rate = scale * w * p.rate;
    s.p_gradient = scale * k * Vec3(p.x, p.y, 0.0);
    return s;
}

// eps u = F: derivatives of u = F/eps by those of F and eps.
ManufacturedMedium::State ManufacturedMedium::at(const Vec3& x, double t, const Vec3& size, double density) const {
    const double k = 2.0 * std::numbers::pi / size[0], w = k * speed;
    const Derivatives psi = sum_of(stream, k * x[0], k * x[1], w * t);
    const Derivatives p = sum_of(pressure_waves, k * x[0], k * x[1], w * t);
    const Vec3 number = k * porosity.waves; // wave vector of eps
    const double omega = 2.0 * std::numbers::pi / porosity.period, angle = porosity.angle(x, t, size);
    const Vec3 c = omega / number.squaredNorm() * number;
    const double swing = porosity.amplitude * std::sin(angle), slope = porosity.amplitude * std::cos(angle);
    const double eps = porosity.mean + swing, eps_rate = -omega * slope;
    const Vec3 eps_gradient = slope * number;
    const double eps_laplacian = -number.squaredNorm() * swing;

    const Vec3 flux = speed * Vec3(psi.y, -psi.x, 0.0) + swing * c;
    const Vec3 flux_rate = speed * w * Vec3(psi.y_rate, -psi.x_rate, 0.0) + eps_rate * c;
    const Vec3 flux_x = speed * k * Vec3(psi.xy, -psi.xx, 0.0) + eps_gradient[0] * c;
    const Vec3 flux_y = speed * k * Vec3(psi.yy, -psi.xy, 0.0) + eps_gradient[1] * c;
    const Vec3 flux_laplacian = speed * k * k * Vec3(psi.lap_y, -psi.lap_x, 0.0) + eps_laplacian * c;

    State s;
    s.eps = eps;
    s.u = flux / eps;
    s.u_rate = (flux_rate - eps_rate * s.u) / eps;
    const Vec3 by_x = (flux_x - eps_gradient[0] * s.u) / eps, by_y = (flux_y - eps_gradient[1] * s.u) / eps;
    s.convection = s.u[0] * by_x + s.u[1] * by_y;
    // lap F = eps lap u + 2 grad eps . grad u + u lap eps
    s.friction = (flux_laplacian - eps_gradient[0] * by_x - eps_gradient[1] * by_y - eps_laplacian * s.u) / eps;
    const double scale = density * speed * speed;
    s.p = scale * p.value;
    s.p_gradient = scale * k * Vec3(p.x, p.y, 0.0);
    return s;
}

} // namespace plumb
