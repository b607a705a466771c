#include "sph/interpolation.hpp"

#include "sph/fluid.hpp"

#include <Eigen/Dense>

namespace plumb {

namespace {

/// Moments of the particles around a place and of what they carry, with y = (x_b - x)/h.
template <int d, int fields> struct Moments {
    static constexpr int second = d * (d + 1) / 2;
    Pack zeroth{};                                   // sum V W
    std::array<Pack, d> first{};                     // sum V W y
    std::array<Pack, second> squares{};              // sum V W y y, upper triangle row by row
    std::array<Pack, fields> value{};                // sum V W g
    std::array<std::array<Pack, d>, fields> slope{}; // sum V W g y
};

/// Fields: velocity, pressure and, where it is shared, the fluid fraction.
template <class KernelLaw, int d, int fields>
Moments<d, fields> moments(const SphFluid& f, const std::array<Pack, 3>& x, std::span<const std::int32_t> near) {
    Moments<d, fields> m;
    const Pack inverse_h = broadcast<Pack>(1.0 / f.h);
    const Pack sigma = broadcast<Pack>(KernelLaw::sigma(d) / std::pow(f.h, d));
    for (const std::int32_t record : near) {
        const FluidRecord& b = f.clusters.records[static_cast<std::size_t>(record)];
        const std::array<double, 3> at{b.x, b.y, b.z}, u{b.u, b.v, b.w};
        std::array<Pack, d> y;
        Pack q_sq{};
        for (std::size_t c = 0; c < d; ++c) {
            y[c] = (broadcast<Pack>(at[c]) - x[c]) * inverse_h;
            q_sq += y[c] * y[c];
        }
        const Pack q = square_root(q_sq);
        const Pack inside = select(q < broadcast<Pack>(KernelLaw::support), broadcast<Pack>(1.0), Pack{});
        const Pack weight = inside * sigma * KernelLaw::w(q) * broadcast<Pack>(b.volume);
        std::array<double, fields> g;
        for (std::size_t c = 0; c < d; ++c) g[c] = u[c];
        double eps = 1.0;
        if constexpr (fields > d + 1) g[d + 1] = eps = f.eps_of_record[static_cast<std::size_t>(record)];
        g[d] = own_pressure(f, pressure_of(f, b), eps);
        m.zeroth += weight;
        std::size_t pair = 0;
        for (std::size_t c = 0; c < d; ++c) {
            const Pack wy = weight * y[c];
            m.first[c] += wy;
            for (std::size_t e = c; e < d; ++e) m.squares[pair++] += wy * y[e];
            for (std::size_t k = 0; k < fields; ++k) m.slope[k][c] += wy * broadcast<Pack>(g[k]);
        }
        for (std::size_t k = 0; k < fields; ++k) m.value[k] += weight * broadcast<Pack>(g[k]);
    }
    return m;
}

constexpr double least_determinant = 1e-2; // of the linear fit's matrix, relative to a full neighbourhood's

/// Value at the place of the linear function that fits lane `lane`.
template <int d, int fields>
void fit(const Moments<d, fields>& m, int lane, double full, double h, InterpolatedGroup& group) {
    using Matrix = Eigen::Matrix<double, d, d>;
    using Vector = Eigen::Matrix<double, d, 1>;
    const double zeroth = m.zeroth[lane];
    group.covered[lane] = zeroth;
    if (!(zeroth > 0.0)) return;
    Matrix squares;
    Vector first;
    std::size_t pair = 0;
    for (int c = 0; c < d; ++c) {
        first[c] = m.first[static_cast<std::size_t>(c)][lane];
        for (int e = c; e < d; ++e) squares(c, e) = squares(e, c) = m.squares[pair++][lane];
    }
    // With K = squares - first first^T/zeroth (variance), the value is (G0 - first . s)/zeroth, s = K^-1 (G1 - first
    // G0/zeroth)
    const Matrix variance = squares - first * first.transpose() / zeroth;
    const bool linear = variance.determinant() > least_determinant * std::pow(full, d);
    const Matrix inverse = linear ? Matrix(variance.inverse()) : Matrix(Matrix::Zero());
    for (std::size_t k = 0; k < fields; ++k) {
        const double mean = m.value[k][lane] / zeroth;
        Vector slope;
        for (int c = 0; c < d; ++c) slope[c] = m.slope[k][static_cast<std::size_t>(c)][lane] - first[c] * mean;
        const Vector gradient = inverse * slope; // times h
        const double value = mean - first.dot(gradient) / zeroth;
        (k > d ? group.eps : k == d ? group.p : group.u[k])[lane] = value;
        if (k == d)
            for (int c = 0; c < d; ++c) group.p_slope[static_cast<std::size_t>(c)][lane] = gradient[c] / h;
    }
}

template <class KernelLaw, int d, int fields>
InterpolatedGroup interpolate_fields(const SphFluid& f, const std::array<Pack, 3>& places,
                                     std::span<const std::int32_t> near) {
    const Moments<d, fields> m = moments<KernelLaw, d, fields>(f, places, near);
    InterpolatedGroup group;
    for (int lane = 0; lane < pack_width; ++lane) fit<d, fields>(m, lane, second_moment<KernelLaw>(d), f.h, group);
    return group;
}

template <class KernelLaw, int d>
InterpolatedGroup interpolate(const SphFluid& f, const std::array<Pack, 3>& places,
                              std::span<const std::int32_t> near) {
    return f.shares_pressure ? interpolate_fields<KernelLaw, d, d + 2>(f, places, near)
                             : interpolate_fields<KernelLaw, d, d + 1>(f, places, near);
}

} // namespace

InterpolatedGroup interpolated(const SphFluid& f, const std::array<Pack, 3>& places,
                               std::span<const std::int32_t> near) {
    return std::visit(
        [&](const auto& kernel) {
            using KernelLaw = std::decay_t<decltype(kernel)>;
            return f.dimensions == 3 ? interpolate<KernelLaw, 3>(f, places, near)
                                     : interpolate<KernelLaw, 2>(f, places, near);
        },
        f.kernel);
}

} // namespace plumb
