#include "dem/sphere_grid.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

SphereGrid::SphereGrid(const Domain& domain, const Vec3& lower, const Vec3& upper, double cell, std::size_t expected)
    : periodic_(domain.periodic), origin_(lower), extent_(upper - lower) {
    for (Eigen::Index c = 0; c < 3; ++c)
        if (periodic_[static_cast<std::size_t>(c)]) origin_[c] = 0.0, extent_[c] = domain.size[c];
    const double most_cells = 8.0 * static_cast<double>(expected) + 64.0;
    const auto along = [&](Eigen::Index c) { return std::max(1.0, std::floor(extent_[c] / cell)); };
    while (along(0) * along(1) * along(2) > most_cells) cell *= 1.25;
    for (Eigen::Index c = 0; c < 3; ++c) n_[static_cast<std::size_t>(c)] = static_cast<std::int64_t>(along(c));
    head_.assign(static_cast<std::size_t>(n_[0] * n_[1] * n_[2]), -1);
}

SphereGrid::Cells SphereGrid::cells_of(const Vec3& x, double radius) const {
    Cells cells{};
    for (std::size_t c = 0; c < 3; ++c) {
        const auto axis = static_cast<Eigen::Index>(c);
        const auto n = static_cast<double>(n_[c]);
        const double scale = extent_[axis] > 0.0 ? n / extent_[axis] : 0.0;
        double first = std::floor((x[axis] - radius - origin_[axis]) * scale);
        double last = std::floor((x[axis] + radius - origin_[axis]) * scale);
        if (!periodic_[c]) {
            first = std::clamp(first, 0.0, n - 1.0);
            last = std::clamp(last, 0.0, n - 1.0);
        } else if (last - first + 1.0 >= n) {
            first = 0.0, last = n - 1.0;
        } else if (first < 0.0) {
            first += n, last += n;
        }
        cells.first[c] = static_cast<std::int64_t>(first);
        cells.count[c] = static_cast<std::int64_t>(last - first) + 1;
    }
    return cells;
}

void SphereGrid::insert(std::int32_t index, const Vec3& x, double radius) {
    const Cells cells = cells_of(x, radius);
    for (std::int64_t k = 0; k < cells.count[2]; ++k)
        for (std::int64_t j = 0; j < cells.count[1]; ++j)
            for (std::int64_t i = 0; i < cells.count[0]; ++i) {
                std::int32_t& head = head_[cell(cells, i, j, k)];
                entries_.push_back({index, head});
                head = static_cast<std::int32_t>(entries_.size() - 1);
            }
}

} // namespace plumb
