#include "sph/symbols.hpp"

#include <cmath>

namespace plumb {

namespace {

/// sin(z)/z, and j1(z)/z, which is its share along the line of a wave's crests.
double sinc(double z) { return z < 1e-2 ? 1.0 - z * z / 6.0 : std::sin(z) / z; }
double first_bessel_over(double z) {
    if (z < 0.1) return 1.0 / 3.0 - z * z / 30.0 * (1.0 - z * z / 28.0);
    return (std::sin(z) / z - std::cos(z)) / (z * z);
}

/// (2/h^2) Int (-w'/q) g(k h q) dV over the kernel's ball, with the kernel's normalisation; q in units of h.
template <class G> double slope_integral(const Kernel& kernel, double kh, G&& g) {
    return std::visit(
        [&](const auto& law) {
            using Law = std::decay_t<decltype(law)>;
            return 2.0 * Law::sigma(3) * ball_integral<Law>(3, [&](double q) { return -Law::f(q) * g(kh * q); });
        },
        kernel);
}

} // namespace

double kernel_transform(const Kernel& kernel, double kh) {
    return std::visit(
        [&](const auto& law) {
            using Law = std::decay_t<decltype(law)>;
            return Law::sigma(3) * ball_integral<Law>(3, [&](double q) { return Law::w(q) * sinc(kh * q); });
        },
        kernel);
}

double transverse_decay(const SphFluid& f, double k) {
    const double nu = f.viscosity / f.density, kh = k * f.h, over = nu / (f.h * f.h);
    // A force along the line of centres, K (dv . dx) dx f(q)/r^2: the mean of the velocity's share along that line.
    const auto central = [&](double factor) {
        return 0.5 * factor * over *
               slope_integral(f.kernel, kh, [](double z) { return 1.0 / 3.0 - first_bessel_over(z); });
    };
    struct {
        double exact, morris;
        decltype(central)& of_pairs;
        double operator()(const Inviscid& /*law*/) const { return 0.0; }
        double operator()(const Morris& /*law*/) const { return morris; }
        double operator()(const MonaghanGingold& /*law*/) const { return of_pairs(10.0); } // 2 (d + 2)
        double operator()(const Cleary& /*law*/) const { return of_pairs(2.0 * 4.96333); }
        double operator()(const DoubleGradient& /*law*/) const { return exact; }
    } const rate{nu * k * k, over * slope_integral(f.kernel, kh, [](double z) { return 1.0 - sinc(z); }), central};
    return std::visit(rate, f.viscous_term);
}

} // namespace plumb
