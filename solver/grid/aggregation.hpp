// Coarser systems for the multigrid method: unknowns that are strongly coupled are joined in pairs, pairs in fours, and
// the equations of those that are joined are added up (Notay 2010, Electron. Trans. Numer. Anal. 37, 123; for matrices
// that are not symmetric 2012, SIAM J. Sci. Comput. 34, A2288).
#pragma once

#include "grid/grid_fluid.hpp"

#include <cstddef>
#include <vector>

namespace plumb {

/// A square matrix by rows: the diagonal, and the rest of each row in the order of columns.
struct Equations {
    std::vector<double> diagonal;
    std::vector<int> begin; // of each row among the entries, and the end
    std::vector<int> column;
    std::vector<double> value;

    std::size_t size() const { return diagonal.size(); }
};

/// The matrix in that form.
Equations equations(const RowMatrix& matrix);

/// No positive coupling left, as with upwind differences: what is positive is taken from both couplings of a pair and
/// given to the diagonals. Sums over rows and columns stay, and the places of the entries. The pattern of `a` has to be
/// symmetric.
Equations without_positive_couplings(Equations a);

/// For each unknown the joint unknown it becomes part of, -1 where its own diagonal rules its equation. Unknowns are
/// joined in pairs; what finds no free partner is joined to the pair of the neighbour that it is coupled to most, since
/// a cell that hangs on one neighbour alone, behind a slit, would else remain on every level to the coarsest.
struct Aggregates {
    std::vector<int> of;
    int count = 0;
};
Aggregates pairs(const Equations& fine);

/// The equations of joint unknowns.
Equations joined(const Equations& fine, const Aggregates& aggregates);

} // namespace plumb
