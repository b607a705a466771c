// Radial functions, tabulated: in each of 512 cells the cubic through the four nodes about it. For the functions of
// porosity_laws.hpp the error is below 1e-6 of the value at r = 0 (the fourth derivative is at most some 100 G(0)/h^4
// and a cell at most h/85, which makes 5e-8).
#pragma once

#include "core/field.hpp"
#include "core/simd.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

struct RadialTables {
    static constexpr std::size_t cells = 512, stride = 4 * (cells + 1);
    using Numbers = std::array<std::int32_t, pack_width>; // of tables, by lane

    std::vector<double> inverse_cell; // [tables] [1/m]
    Field<double> coefficients;       // [tables][cells + 1][4], of powers of the place in the cell; 0 beyond the reach

    std::size_t size() const { return inverse_cell.size(); }

    /// Tabulates g(r), r >= 0, which is 0 from `reach` on.
    template <class G> void append(double reach, G&& g) {
        const double cell = reach / static_cast<double>(cells);
        std::vector<double> node(cells + 3, 0.0); // node k + 1 is g(k cell)
        for (std::size_t k = 0; k < cells; ++k) node[k + 1] = g(static_cast<double>(k) * cell);
        node[0] =
            4.0 * (node[1] + node[3]) - 6.0 * node[2] - node[4]; // on the cubic of the first four: |r|^3 has a kink
        inverse_cell.push_back(1.0 / cell);
        for (std::size_t k = 0; k < cells; ++k) {
            const double a = node[k], b = node[k + 1], c = node[k + 2], d = k + 3 < node.size() ? node[k + 3] : 0.0;
            coefficients.insert(coefficients.end(),
                                {b, c - a / 3.0 - b / 2.0 - d / 6.0, (a + c) / 2.0 - b, (d - a) / 6.0 + (b - c) / 2.0});
        }
        coefficients.insert(coefficients.end(), {0.0, 0.0, 0.0, 0.0});
    }

    /// Values at r [m] of the table of each lane.
    Pack operator()(const Numbers& table, const Pack& r) const {
        Pack place, c0, c1, c2, c3;
        for (int lane = 0; lane < pack_width; ++lane) {
            const auto number = static_cast<std::size_t>(table[static_cast<std::size_t>(lane)]);
            const double t = smaller(r[lane] * inverse_cell[number], static_cast<double>(cells)); // a NaN is beyond
            const auto cell = static_cast<std::size_t>(static_cast<std::int32_t>(t));
            const double* c = &coefficients[number * stride + 4 * cell];
            place[lane] = t - static_cast<double>(cell);
            c0[lane] = c[0], c1[lane] = c[1], c2[lane] = c[2], c3[lane] = c[3];
        }
        return c0 + place * (c1 + place * (c2 + place * c3));
    }
};

} // namespace plumb
