#include "grid/grid.hpp"

#include <cmath>

namespace plumb {

namespace {

/// Between two places the number of cells from the first is n(x) = Int dx/width, its inverse an exponential.
struct Piece {
    double from, length, width, growth; // [m], [m], [m], change of width [m]
    double cells() const { return growth == 0.0 ? length / width : length / growth * std::log1p(growth / width); }
    double place(double n) const {
        return from + (growth == 0.0 ? n * width : width * length / growth * std::expm1(n * growth / length));
    }
};

} // namespace

Axis stretched_axis(const std::vector<double>& at, const std::vector<double>& width, bool periodic) {
    std::vector<Piece> pieces;
    double total = 0.0;
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
        pieces.push_back({at[k], at[k + 1] - at[k], width[k], width[k + 1] - width[k]});
        total += pieces.back().cells();
    }
    const auto count = static_cast<int>(std::ceil(total * (1.0 - 1e-9)));
    Axis axis;
    axis.periodic = periodic;
    axis.node.push_back(at.front());
    std::size_t piece = 0;
    double before = 0.0; // cells in the pieces before
    for (int k = 1; k < count; ++k) {
        const double n = total * static_cast<double>(k) / static_cast<double>(count);
        while (piece + 1 < pieces.size() && n > before + pieces[piece].cells()) before += pieces[piece++].cells();
        axis.node.push_back(pieces[piece].place(n - before));
    }
    axis.node.push_back(at.back());
    return axis;
}

} // namespace plumb
