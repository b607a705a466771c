#include "grid/foreseen_grains.hpp"

#include "core/parallel.hpp"
#include "grid/grid_fluid.hpp"
#include "grid/matrix_rows.hpp"

#include <cmath>

namespace plumb {

namespace {

/// A face that is solved for, between two cells.
struct Gap {
    std::size_t axis, face, below, above;
    double distance; // of the cells' centres [m]
};

/// Calls visit(gap, open area [m2], positive where its axis leads out) for the faces of a cell. What is foreseen of
/// grains stays in the box.
template <class Visit> void out_of(const GridFluid& f, const Place& p, Visit&& visit) {
    const Block cells = f.grid.cells();
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (const int way : {0, 1}) {
            Place face = p, below = p, above = p;
            if (way == 1) face[c] = f.grid.axis[c].face_above(p[c]);
            const std::size_t k = f.grid.faces(c).at(face);
            below[c] = f.grid.axis[c].cell_below(face[c]);
            above[c] = f.grid.axis[c].cell_above(face[c]);
            if (f.unknown[c][k] < 0 || below[c] < 0 || above[c] < 0) continue;
            const double area = f.open.face[c][k] * f.grid.face_area(c, face);
            visit(Gap{c, k, cells.at(below), cells.at(above), f.grid.axis[c].dual_width(face[c])},
                  way == 0 ? -area : area);
        }
}

/// What grains are foreseen to carry out of a cell at the velocity `u` after `before` and the pressures `p`, or without
/// the part of the pressures where they are not given [m3/s].
double carried_out(const GridFluid& f, std::size_t cell, const Velocity* u, const Velocity& before,
                   const Field<double>* p) {
    const ForeseenGrains& g = f.foreseen;
    double sum = 0.0;
    out_of(f, f.grid.cells().place(cell), [&](const Gap& gap, double area) {
        const auto axis = static_cast<Eigen::Index>(gap.axis);
        const auto both = [&](const Field<double>& q) { return 0.5 * (q[gap.below] + q[gap.above]); };
        const double more = (u != nullptr ? (*u)[gap.axis][gap.face] : 0.0) - before[gap.axis][gap.face];
        double flux = 0.5 * (g.drift[gap.below][axis] + g.drift[gap.above][axis]) + both(g.follows) * more;
        if (p != nullptr) flux -= both(g.yields) * ((*p)[gap.above] - (*p)[gap.below]) / gap.distance;
        sum += area * flux;
    });
    return sum;
}

} // namespace

RowMatrix yield_rows(const GridFluid& f, const Velocity& share) {
    if (f.foreseen.yields.empty()) return {};
    const Block cells = f.grid.cells();
    std::vector<MatrixRows> parts((cells.size() + parallel_chunk - 1) / parallel_chunk);
    parallel_chunks(cells.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (f.unknown_pressure[cell] < 0) continue;
            Entries row;
            row.put(f.unknown_pressure[cell], 0.0);
            out_of(f, cells.place(cell), [&](const Gap& gap, double area) {
                const double yields = 0.5 * (f.foreseen.yields[gap.below] + f.foreseen.yields[gap.above]);
                const double per_pressure = share[gap.axis][gap.face] * yields * std::abs(area) / gap.distance;
                row.put(f.unknown_pressure[cell], per_pressure);
                row.put(f.unknown_pressure[gap.below == cell ? gap.above : gap.below], -per_pressure);
            });
            parts[begin / parallel_chunk].add(row);
        }
    });
    return matrix_of(parts, f.unknown_pressures);
}

Eigen::VectorXd drift_out(const GridFluid& f) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(f.unknown_pressures);
    if (f.foreseen.drift.empty()) return out;
    parallel_for(f.unknown_pressure.size(), [&](std::size_t cell) {
        if (f.unknown_pressure[cell] >= 0) out[f.unknown_pressure[cell]] = carried_out(f, cell, nullptr, f.u, nullptr);
    });
    return out;
}

void take_foreseen(GridFluid& f, const Velocity& before, double dt) {
    if (f.foreseen.drift.empty()) return;
    f.eps_taken = f.eps;
    parallel_for(f.unknown_pressure.size(), [&](std::size_t cell) {
        if (f.unknown_pressure[cell] < 0) return; // grains leave, fluid gains
        const double volume = f.open.cell[cell] * f.grid.cell_volume(f.grid.cells().place(cell));
        if (volume == 0.0) return; // a corner too small to be measured
        f.eps_taken[cell] += dt * carried_out(f, cell, &f.u, before, &f.p) / volume;
    });
}

} // namespace plumb
