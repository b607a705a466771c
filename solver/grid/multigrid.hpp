// Systems whose couplings are those of neighbours on a grid, solved roughly: by a Krylov method that is preconditioned
// with Jacobi's sweeps before and after a correction from the joint unknowns of the next coarser level. Each coarser
// system is solved in the same way by at most two steps, which keeps the number of cycles independent of the grid's
// size (K-cycle: Notay & Vassilevski 2008, Numer. Linear Algebra Appl. 15, 473). Cycles know advection as upwind
// differences have it, the Krylov method on the finest level as it is.
//
// In single precision: what calls it corrects errors.
#pragma once

#include "grid/slices.hpp"

#include <optional>

namespace plumb {

class Multigrid {
public:
    /// The pattern of `matrix` has to be symmetric. `sweeps` before, and after, each correction.
    Multigrid(const RowMatrix& matrix, int sweeps);
    /// A solution of `matrix` x = right that leaves at most `reduction` of the right-hand side, or what `most_cycles`
    /// leave. Not to be called at the same time from two threads.
    Eigen::VectorXd solve(const Eigen::VectorXd& right, double reduction, int most_cycles);

private:
    struct Level {
        std::size_t rows = 0;
        Slices matrix;
        Numbers step;                          // of a sweep: a share of 1/diagonal, 0 where nothing holds an unknown
        std::vector<int> joint;                // place on the next level, of every place; 0, where a zero is, for none
        std::vector<int> member_begin, member; // by row of the next level: the places that it joins
        Numbers right, x, left, remains;       // what a cycle and the Krylov method work with
        std::vector<Numbers> search, image;
    };
    void add_level(const Equations& equations);
    static void join(Level& level, const Aggregates& aggregates);
    void cycle(std::size_t level, const Numbers& right, Numbers& x);
    static void sweep(Level& level, const Numbers& right, Numbers& x);
    void correct_from_next(std::size_t level, const Numbers& right, Numbers& x);
    void krylov(std::size_t level, const Slices& matrix, double reduction, int most_cycles);
    void solve_coarsest(Level& level) const;

    int sweeps_;
    std::optional<Slices> given_; // the finest level's matrix, where some couplings are positive
    std::vector<Level> levels_;
    Eigen::MatrixXd coarsest_; // inverse of the coarsest level's matrix, where that is small
};

} // namespace plumb
