// Velocity and pressure of one step together,
//     A u - G p = f,    D u + Y p = s,
// with A the momentum rows, D the divergence, G its transpose and Y = 0 but where grains are foreseen: G and D then
// have the stress that they hand on and the volume that follows, Y what grains give way to a gradient. Krylov's method
// with one projection step as its preconditioner, so that nothing of the splitting is left in the answer (Griffith
// 2009, J. Comput. Phys. 228, 7565).
#pragma once

#include "grid/multigrid.hpp"

#include <memory>

namespace plumb {

/// The matrices of a step. Mass is weighed so that its rows are as large as those of momentum: they are times
/// `pressure_scale`, the last unknowns are p over it.
struct SaddleSystem {
    std::array<MomentumRows, 3> momentum;
    std::array<RowMatrix, 3> divergence, gradient; // D and G, by component
    std::array<RowMatrix, 3> yield;   // Y, its faces weighed by R^0, R^1 and R^2; without rows where it is 0
    Eigen::VectorXd known_divergence; // weighed like the rows of mass
    std::size_t dimensions = 2;
    double pressure_scale = 1.0; // [kg/(m2 s)]
    bool closed = false;         // no outflow: the mean pressure is arbitrary
};

/// The system of the present boundaries, apertures and porosity, with `carrier` the velocities that carry momentum and
/// the mass of the fluid added as the difference in time of a step of `dt` [s] has it: now/dt times, now 1 over one
/// step or 1.5 over two.
SaddleSystem saddle_system(const GridFluid& fluid, const Velocity& carrier, double now, double dt);

/// All unknowns in one vector: the components of u, then p.
struct SaddleLayout {
    std::array<Eigen::Index, 4> begin{};
    Eigen::Index size = 0;
};
SaddleLayout layout(const SaddleSystem& system);

/// An approximate inverse: A by multigrid (without second upstream neighbours), and the Schur complement D A^-1 G + Y
/// by
///     S^-1 = L^-1 (D Q^-1 A Q^-1 G + Y(R^2)) L^-1,    L = D Q^-1 G + Y(R),    Q = diag A
/// (least-squares commutator: Elman et al. 2006, SIAM J. Sci. Comput. 27, 1651), which is a projection step where A is
/// diagonal and knows friction, drag and advection where it is not. R is what of Q smooth velocities feel, the sums of
/// A's rows over Q, by which the faces of Y are weighed: with A = R Q, R uniform, the inverse is exact. Cheap to make,
/// so each step makes its own.
class ProjectionPreconditioner {
public:
    explicit ProjectionPreconditioner(const SaddleSystem& system);
    Eigen::VectorXd operator()(const Eigen::VectorXd& residual);

private:
    Eigen::VectorXd schur_inverse(const Eigen::VectorXd& r);

    const SaddleSystem* system_;
    SaddleLayout layout_;
    std::array<std::unique_ptr<Multigrid>, 3> velocity_;
    std::array<Eigen::VectorXd, 3> inverse_diagonal_;
    std::unique_ptr<Multigrid> poisson_;
};

struct SolveReport {
    int iterations = 0;
    double residual = 0.0; // relative to the right-hand side's scale
};

/// Improves `x` until the residual is below `tolerance` times the right-hand side, or says how far it came.
SolveReport solve(const SaddleSystem& system, ProjectionPreconditioner& preconditioner, const Eigen::VectorXd& right,
                  double tolerance, int most_iterations, Eigen::VectorXd& x);

} // namespace plumb
