#include "coupling/grid_symbols.hpp"

#include <numbers>

namespace plumb {

namespace {

/// 3-D integral of w times a function of the distance, or of one law without a shape 0.
template <class G> double integral(const GridKernel& kernel, G&& g) {
    return std::visit(
        [&](const auto& law) {
            using Law = std::decay_t<decltype(law)>;
            if constexpr (requires { Law::support; })
                return ball_integral<Law>(3, [&](double q) { return Law::w(q) * g(q); });
            else
                return 0.0;
        },
        kernel);
}

} // namespace

double kernel_transform(const GridKernel& kernel, double k_width) {
    const auto wave = [&](double q) {
        const double z = k_width * q;
        return z < 1e-2 ? 1.0 - z * z / 6.0 : std::sin(z) / z;
    };
    return integral(kernel, wave) / integral(kernel, [](double /*q*/) { return 1.0; });
}

double deviation_in_widths(const GridKernel& kernel) {
    return std::sqrt(integral(kernel, [](double q) { return q * q; }) / 3.0 /
                     integral(kernel, [](double /*q*/) { return 1.0; }));
}

GridShell grid_shell(double k, double cell) {
    constexpr int n = 48; // midpoints in height and angle over an eighth of the sphere
    const double edge = std::numbers::pi / cell;
    int inside = 0;
    double inverse = 0.0;
    const auto part = [&](double wave) {
        const double side = 2.0 / cell * std::sin(0.5 * wave * cell);
        return side * side;
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double z = (i + 0.5) / n, angle = 0.5 * std::numbers::pi * (j + 0.5) / n;
            const double across = std::sqrt(1.0 - z * z), x = across * std::cos(angle), y = across * std::sin(angle);
            if (k * std::max({x, y, z}) >= edge) continue;
            ++inside;
            inverse += 1.0 / (part(k * x) + part(k * y) + part(k * z));
        }
    if (inside == 0) return {0.0, k * k};
    return {static_cast<double>(inside) / (n * n), inside / inverse};
}

} // namespace plumb
