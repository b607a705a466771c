// Systems whose couplings are those of neighbours on a grid, solved roughly: by a Krylov method that is preconditioned
// with a sweep of Gauss and Seidel forwards, a correction from the joint unknowns of the next coarser level, a sweep
// backwards. Each coarser system is solved in the same way by at most two steps, which keeps the number of cycles
// independent of the grid's size (K-cycle: Notay & Vassilevski 2008, Numer. Linear Algebra Appl. 15, 473). Cycles know
// advection as upwind differences have it, the Krylov method on the finest level as it is.
//
// In single precision: what calls it corrects errors. Sweeps go through blocks of rows of fixed length, each with what
// its neighbours had before, so that bits do not depend on the number of threads.
#pragma once

#include "grid/aggregation.hpp"

#include <Eigen/LU>

namespace plumb {

class Multigrid {
public:
    /// The pattern of `matrix` has to be symmetric.
    explicit Multigrid(const RowMatrix& matrix);
    /// A solution of `matrix` x = right that leaves at most `reduction` of the right-hand side, or what `most_cycles`
    /// leave. Not to be called at the same time from two threads.
    Eigen::VectorXd solve(const Eigen::VectorXd& right, double reduction, int most_cycles);

private:
    using Numbers = std::vector<float>;
    struct Rows {
        Numbers diagonal;
        std::vector<int> begin, column; // of the entries off the diagonal
        Numbers value;
    };
    struct Level {
        Rows rows;
        Numbers inverse_diagonal;                       // 0 where nothing holds an unknown
        std::vector<int> block_begin, upper, block_end; // of each row: entries of its block, those after the diagonal
        std::vector<int> joint;                         // number on the next level, -1 none
        std::vector<int> member_begin, member;          // of the joint unknowns of the next level
        Numbers right, x, left, remains;                // what a cycle and the Krylov method work with
        std::vector<Numbers> search, image;
        std::size_t size() const { return inverse_diagonal.size(); }
    };
    static Rows single(const Equations& equations);
    static void multiply(const Rows& rows, const Numbers& x, Numbers& y);
    void add_level(const Equations& equations);
    static void join(Level& level, const Aggregates& aggregates);
    void cycle(std::size_t level, const Numbers& right, Numbers& x);
    void sweep_forwards(const Level& level, const Numbers& right, Numbers& x) const;
    void sweep_backwards(Level& level, const Numbers& right, Numbers& x) const;
    void correct_from_next(std::size_t level, const Numbers& right, Numbers& x);
    void krylov(std::size_t level, const Rows& rows, double reduction, int most_cycles);
    void solve_coarsest(const Numbers& right, Numbers& x) const;

    Rows given_; // with advection as it is
    std::vector<Level> levels_;
    Eigen::PartialPivLU<Eigen::MatrixXd> coarsest_;
};

} // namespace plumb
