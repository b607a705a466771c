// The matrix P between the nodes a of a grid and the grains j,
//     P_aj = V_a w(|x_a - x_j|/width) / sum_b V_b w(|x_b - x_j|/width),
// V the open volume around a node, whose columns sum to one: one for the cells, and one for the faces of each component
// of the velocity that are solved for. q P gathers a field of the fluid at the grains, f P^T spreads what grains have
// over the fluid. Stored by columns; sums over grains run in the order of ids.
#pragma once

#include "coupling/grid_kernels.hpp"
#include "grid/grid_fluid.hpp"

#include <cstdint>
#include <vector>

namespace plumb {

/// The columns of a sparse matrix: entries begin[j] to begin[j + 1] are those of grain j.
struct SparseColumns {
    std::vector<std::size_t> begin{0};
    std::vector<std::int32_t> node;
    std::vector<double> weight;

    bool empty(std::size_t j) const { return begin[j] == begin[j + 1]; }
    /// sum_a P_aj q_a.
    template <class Value, class Of> Value gathered(std::size_t j, Value sum, Of&& of) const {
        for (std::size_t k = begin[j]; k < begin[j + 1]; ++k) sum += weight[k] * of(static_cast<std::size_t>(node[k]));
        return sum;
    }
    /// Calls add(node, weight) for the column of grain j.
    template <class Add> void spread(std::size_t j, Add&& add) const {
        for (std::size_t k = begin[j]; k < begin[j + 1]; ++k) add(static_cast<std::size_t>(node[k]), weight[k]);
    }
};

struct GridWeights {
    GridKernel kernel;
    double width = 0.0; // [m]

    Field<double> cell_volume;                // open; 0 where nothing is solved for [m3]
    std::array<Field<double>, 3> face_volume; // of the control volumes, the same [m3]
    SparseColumns cells;
    std::array<SparseColumns, 3> faces;
};

/// The open volumes, which never change.
void measure(GridWeights& weights, const GridFluid& fluid);

/// The columns of grains at `x` [m], by id. A grain without an open node in reach has empty ones.
void set_weights(GridWeights& weights, const GridFluid& fluid, const std::vector<Vec3>& x);

/// u_j = sum_a P_aj u_a, component by component [m/s].
Vec3 gathered_velocity(const GridWeights& weights, const Velocity& u, std::size_t j);

/// Whether the cell around x is open.
bool is_open(const GridFluid& fluid, const Vec3& x);

/// A matrix M whose columns sum to one: how what grains have in cells that would hold too much of them moves to others.
/// The product of its passes; each takes shares of some cells to their neighbours, in equal parts.
struct Relief {
    struct Move {
        std::size_t from;
        double share;
        std::vector<std::size_t> to;
    };
    std::vector<std::vector<Move>> passes;

    /// M q for amounts by cell.
    void spread(Field<double>& amount) const;
    /// q M: of a field of the fluid, what grains gather with the weights P where M P are the ones that hold.
    void gather(std::vector<Vec3>& field) const;
};

/// Fluid fractions by cell, and how many cells would have had less than they may.
struct BoundedPorosity {
    Field<double> eps;
    std::int64_t bounded = 0;
    Relief relief;
};

/// eps_a = 1 - sum_j V_j (M P)_aj/V_a for grains of `volume` [m3] by id. Where it is less than `least` without M, what
/// is too much goes to the open neighbours, from cell to cell until there is room.
BoundedPorosity porosity(const GridFluid& fluid, const GridWeights& weights, const std::vector<double>& volume,
                         double least);

/// sum_j q_j (M P)_aj/V_a: what grains have, by id, per volume of the cells.
Field<double> per_volume(const GridWeights& weights, const Relief& relief, const std::vector<double>& of_grains);

/// What the fluid is at the grains, by cell; the grains' weights for the stress are those of the porosity, M P, so that
/// what the gradient pushes in both together is the whole of it.
struct CellFields {
    std::vector<Vec3> stress;              // -grad p + div tau [N/m3]
    std::vector<Eigen::Matrix3d> gradient; // d u_i/d x_j [1/s]
};
CellFields cell_fields(const GridFluid& fluid, bool with_gradient);

} // namespace plumb
