// Finds the spheres that may overlap a given one while grains are being placed. (The time loop has its own neighbour
// list; this grid takes spheres of any sizes one by one.)
#pragma once

#include "core/domain.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace plumb {

/// A grid of cells over a box; each cell lists the spheres whose bounding cubes reach into it.
class SphereGrid {
public:
    /// Cells of about `cell` [m], or larger so that their number stays below about eight per expected sphere. The grid
    /// covers the domain along periodic axes and [lower, upper] along the others; spheres beyond are found all the
    /// same.
    SphereGrid(const Domain& domain, const Vec3& lower, const Vec3& upper, double cell, std::size_t expected);

    /// Adds a sphere under the number `index`. Positions are inside the domain along periodic axes.
    void insert(std::int32_t index, const Vec3& x, double radius);

    /// True if predicate(index) holds for one of the spheres whose bounding cubes may reach that of the sphere (x,
    /// radius). A sphere may be asked about more than once.
    template <class Predicate> bool any_near(const Vec3& x, double radius, Predicate&& predicate) const {
        const Cells cells = cells_of(x, radius);
        for (std::int64_t k = 0; k < cells.count[2]; ++k)
            for (std::int64_t j = 0; j < cells.count[1]; ++j)
                for (std::int64_t i = 0; i < cells.count[0]; ++i)
                    for (std::int32_t e = head_[cell(cells, i, j, k)]; e >= 0;
                         e = entries_[static_cast<std::size_t>(e)].next)
                        if (predicate(entries_[static_cast<std::size_t>(e)].index)) return true;
        return false;
    }

private:
    struct Cells { // a block of cells, starting at `first`; along periodic axes it may run over the end
        std::array<std::int64_t, 3> first, count;
    };
    struct Entry {
        std::int32_t index;
        std::int32_t next; // -1 at the end of a cell's list
    };
    Cells cells_of(const Vec3& x, double radius) const;
    std::size_t cell(const Cells& cells, std::int64_t i, std::int64_t j, std::int64_t k) const {
        return static_cast<std::size_t>((cells.first[0] + i) % n_[0] +
                                        n_[0] *
                                            ((cells.first[1] + j) % n_[1] + n_[1] * ((cells.first[2] + k) % n_[2])));
    }

    std::array<bool, 3> periodic_{};
    Vec3 origin_, extent_;            // [m]
    std::array<std::int64_t, 3> n_{}; // cells per axis
    std::vector<std::int32_t> head_;  // first entry of each cell
    std::vector<Entry> entries_;
};

} // namespace plumb
