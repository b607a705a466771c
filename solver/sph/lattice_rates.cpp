#include "sph/lattice_rates.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <variant>
#include <vector>

namespace plumb {

namespace {

/// What one neighbour does to a difference between its value and ours: a matrix (a multiple of 1 for scalar terms).
struct Share {
    Vec3 dx; // place of the neighbour [m]
    Eigen::Matrix3d rate;
};

// Wave numbers tried along each axis from 0 to the shortest wave, pi/spacing. The rates vary over 1/h, so the greatest
// of them is met within 2 %.
constexpr int steps_2d = 20, steps_3d = 10;

/// The unit matrix of d dimensions, zero beyond.
Eigen::Matrix3d unit(int d) {
    Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    if (d == 2) one(2, 2) = 0.0;
    return one;
}

/// rate(dx, q) of every neighbour on the square or cubic lattice.
template <class Rate> std::vector<Share> shares(const SphFluid& f, double reach, Rate&& rate) {
    const int n = static_cast<int>(reach * f.h / f.spacing);
    std::vector<Share> all;
    for (int i = -n; i <= n; ++i)
        for (int j = -n; j <= n; ++j)
            for (int k = f.dimensions == 3 ? -n : 0; k <= (f.dimensions == 3 ? n : 0); ++k) {
                const Vec3 dx = f.spacing * Vec3(i, j, k);
                const double q = dx.norm() / f.h;
                if (q > 0.0 && q < reach) all.push_back({dx, rate(dx, q)});
            }
    return all;
}

/// Greatest eigenvalue of sum (1 - cos k.dx) rate over the waves of the lattice. Permutations and mirror images of a
/// wave number change nothing.
double greatest_rate(const SphFluid& f, const std::vector<Share>& neighbours) {
    const int n = f.dimensions == 2 ? steps_2d : steps_3d;
    double greatest = 0.0;
    for (int i = 1; i <= n; ++i)
        for (int j = 0; j <= i; ++j)
            for (int l = 0; l <= (f.dimensions == 3 ? j : 0); ++l) {
                const Vec3 k = std::numbers::pi / (n * f.spacing) * Vec3(i, j, l);
                Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
                for (const Share& s : neighbours) sum += (1.0 - std::cos(k.dot(s.dx))) * s.rate;
                const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum, Eigen::EigenvaluesOnly);
                greatest = std::max(greatest, solver.eigenvalues().maxCoeff());
            }
    return greatest;
}

/// sigma/h^(d+2): grad W = F dx with F = sigma/h^(d+2) f(q).
template <class Law> double gradient_factor(const SphFluid& f) {
    return Law::sigma(f.dimensions) / std::pow(f.h, f.dimensions + 2);
}

/// Integral of -W'/r over all neighbours [1/m2], by the midpoint rule: what a wave feels whose phase differs from
/// neighbour to neighbour as if by chance.
template <class Law> double phaseless_rate(const SphFluid& f) {
    return Law::sigma(f.dimensions) * ball_integral<Law>(f.dimensions, [](double q) { return -Law::f(q); }) /
           (f.h * f.h);
}

/// A gradient taken twice damps no wave faster than the square of the integral of |dW/dx| [1/m2]; the mean of |cos|
/// over directions is 2/pi, in space 1/2.
template <class Law> double double_gradient_rate(const SphFluid& f) {
    const double mean = f.dimensions == 2 ? 2.0 / std::numbers::pi : 0.5;
    const double gradient = mean * Law::sigma(f.dimensions) *
                            ball_integral<Law>(f.dimensions, [](double q) { return -Law::f(q) * q; }) / f.h;
    return gradient * gradient;
}

} // namespace

namespace {

/// Greatest rate of sum strength V F (dv . dx)/(r^2 + softening) dx, a damping along the lines of centres [1/s].
template <class Law> double central_rate(const SphFluid& f, double strength, double softening_sq) {
    const double factor = strength * f.mass / f.density * gradient_factor<Law>(f);
    const auto rate = [&](const Vec3& dx, double q) -> Eigen::Matrix3d {
        return -factor * Law::f(q) / (dx.squaredNorm() + softening_sq) * dx * dx.transpose();
    };
    return std::max(greatest_rate(f, shares(f, Law::support, rate)), strength * phaseless_rate<Law>(f) / f.dimensions);
}

/// The same of sum strength V F dv, which does not look at directions.
template <class Law> double scalar_rate(const SphFluid& f, double strength) {
    const double factor = strength * f.mass / f.density * gradient_factor<Law>(f);
    const auto rate = [&](const Vec3& /*dx*/, double q) -> Eigen::Matrix3d {
        return -factor * Law::f(q) * unit(f.dimensions);
    };
    return std::max(greatest_rate(f, shares(f, Law::support, rate)), strength * phaseless_rate<Law>(f));
}

} // namespace

double greatest_viscous_rate(const SphFluid& f) {
    const double volume = f.mass / f.density;
    const double artificial = f.extras.artificial * f.mass; // alpha c h; only half of the pairs approach
    const double added =
        artificial == 0.0
            ? 0.0
            : std::visit(
                  [&](const auto& kernel) {
                      return central_rate<std::decay_t<decltype(kernel)>>(f, artificial, f.extras.softening_sq);
                  },
                  f.kernel);
    return added + std::visit(
                       [&](const auto& kernel, const auto& term) {
                           using Law = std::decay_t<decltype(kernel)>;
                           using Term = std::decay_t<decltype(term)>;
                           if constexpr (std::is_same_v<Term, Inviscid>) {
                               return 0.0;
                           } else if constexpr (std::is_same_v<Term, DoubleGradient>) {
                               return f.viscosity / f.density * double_gradient_rate<Law>(f);
                           } else {
                               const double strength = term.coefficient * f.mass * volume; // 2 nu for Morris
                               if constexpr (std::is_same_v<Term, Morris>)
                                   return scalar_rate<Law>(f, strength);
                               else
                                   return central_rate<Law>(f, strength, term.softening_sq);
                           }
                       },
                       f.kernel, f.viscous_term);
}

double greatest_diffusion_rate(const SphFluid& f) {
    if (f.extras.diffusion == 0.0) return 0.0;
    return std::visit(
        [&](const auto& kernel) { return scalar_rate<std::decay_t<decltype(kernel)>>(f, f.extras.diffusion); },
        f.kernel);
}

double greatest_concentration_rate(const SphFluid& f) {
    const double volume = f.mass / f.density;
    return std::visit(
        [&](const auto& kernel) {
            using Law = std::decay_t<decltype(kernel)>;
            const double factor = volume * gradient_factor<Law>(f);
            return greatest_rate(f, shares(f, Law::support, [&](const Vec3& dx, double q) -> Eigen::Matrix3d {
                                     constexpr double e = 1e-4; // of h: f is a polynomial of q, piece by piece
                                     const double slope = (Law::f(q + e) - Law::f(q - e)) / (2.0 * e);
                                     // grad grad W = F 1 + F'(r)/r dx dx
                                     return factor * (Law::f(q) * unit(f.dimensions) +
                                                      slope / (q * f.h * f.h) * dx * dx.transpose());
                                 }));
        },
        f.kernel);
}

} // namespace plumb
