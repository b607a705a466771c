// The rows of the momentum equation.
//
// Friction is the derivative of the dissipation by the velocities: every gradient that the grid knows, of the mean
// velocities over open faces, squared, times the open volume it stands for. Across a cut cell it is Gauss' theorem of
// its polygon with the wall at rest; beside a wall that ends a row of faces, the velocity over half the open width. So
// the matrix is symmetric, and creeping flow the one of least dissipation among those that keep the volume.
#include "core/parallel.hpp"
#include "grid/grid_fluid.hpp"

#include <algorithm>

namespace plumb {

namespace {

/// One row while it is made.
struct Row {
    std::array<std::pair<int, double>, 13> entry{}; // neighbours by friction and by what is carried, and itself
    std::size_t size = 0;
    double diagonal = 0.0, known = 0.0;

    /// Adds `coefficient` (neighbour - own) to the force on the control volume; the neighbour is an unknown or, with
    /// column < 0, has the value given.
    void couple(int column, double coefficient, double value) {
        diagonal += coefficient;
        if (column < 0)
            known += coefficient * value;
        else
            put(column, -coefficient);
    }

    /// Adds to the entry of a column; they stay in order.
    void put(int column, double value) {
        std::size_t at = size;
        while (at > 0 && entry[at - 1].first >= column) --at;
        if (at < size && entry[at].first == column) {
            entry[at].second += value;
            return;
        }
        std::copy_backward(entry.begin() + static_cast<std::ptrdiff_t>(at),
                           entry.begin() + static_cast<std::ptrdiff_t>(size),
                           entry.begin() + static_cast<std::ptrdiff_t>(size + 1));
        entry[at] = {column, value};
        ++size;
    }
};

/// The rows as a matrix.
RowMatrix matrix_of(const std::vector<Row>& rows) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    RowMatrix matrix(n, n);
    int* begin = matrix.outerIndexPtr();
    begin[0] = 0;
    for (std::size_t k = 0; k < rows.size(); ++k) begin[k + 1] = begin[k] + static_cast<int>(rows[k].size);
    matrix.resizeNonZeros(begin[n]);
    parallel_for(rows.size(), [&](std::size_t k) {
        for (std::size_t e = 0; e < rows[k].size; ++e) {
            matrix.innerIndexPtr()[begin[k] + static_cast<int>(e)] = rows[k].entry[e].first;
            matrix.valuePtr()[begin[k] + static_cast<int>(e)] = rows[k].entry[e].second;
        }
    });
    return matrix;
}

class RowMaker {
public:
    RowMaker(const GridFluid& fluid, std::size_t component, const Velocity& carrier, bool carries = true)
        : f(fluid), c(component), cells(fluid.grid.cells()), faces(fluid.grid.faces(component)), advects(carries) {
        if (!advects) return;
        for (std::size_t d = 0; d < f.dimensions(); ++d) {
            const Block across = f.grid.faces(d);
            flux[d].resize(across.size());
            parallel_for(across.size(), [&](std::size_t k) {
                flux[d][k] = f.density * open_area(f, d, across.place(k)) * carrier[d][k];
            });
        }
    }

    Row row(const Place& p) const {
        Row made;
        for (const int way : {0, 1}) {
            along(p, way, made);
            for (std::size_t d = 0; d < f.dimensions(); ++d)
                if (d != c) across(p, d, way, made);
        }
        return made;
    }

    /// rho eps V of the control volume of a face [kg].
    double mass(const Place& p) const {
        double sum = 0.0;
        for (const int cell : {axis(c).cell_below(p[c]), axis(c).cell_above(p[c])}) {
            if (cell < 0) continue;
            const Place q = with(p, c, cell);
            sum += 0.5 * f.eps[cells.at(q)] * f.open.cell[cells.at(q)] * f.grid.cell_volume(q);
        }
        return f.density * sum;
    }

private:
    const GridFluid& f;
    const std::size_t c;
    const Block cells, faces;
    const bool advects;
    std::array<Field<double>, 3> flux; // mass through faces [kg/s]; empty where nothing is carried

    const Axis& axis(std::size_t d) const { return f.grid.axis[d]; }
    static Place with(Place p, std::size_t d, int value) {
        p[d] = value;
        return p;
    }
    double share(const Place& face) const { return f.open.face[c][faces.at(face)]; }

    /// Mass through a face across axis d [kg/s].
    double mass_flux(std::size_t d, const Place& face) const {
        return advects ? flux[d][f.grid.faces(d).at(face)] : 0.0;
    }

    void carry(Row& row, double outward, int column, double value) const {
        if (!advects) return;
        const double weight = std::visit([&](const auto& law) { return law(outward); }, f.advection);
        row.couple(column, -outward * weight, value);
    }

    /// Through the middle of the cell on one side along the component's own axis.
    void along(const Place& p, int way, Row& row) const {
        const int cell = way == 0 ? axis(c).cell_below(p[c]) : axis(c).cell_above(p[c]);
        if (cell < 0) return; // an outflow
        const Place middle = with(p, c, cell);
        const Place other = with(p, c, way == 0 ? cell : axis(c).face_above(cell));
        const double full = f.grid.face_area(c, p), volume = f.open.cell[cells.at(middle)] * f.grid.cell_volume(middle);
        const double own = share(p) * full, next = share(other) * full;
        if (volume > 0.0) {
            const double friction = f.viscosity * f.eps[cells.at(middle)] * own / volume;
            row.couple(f.unknown[c][faces.at(other)], friction * next, f.u[c][faces.at(other)]);
            row.diagonal += friction * (own - next); // the rest of the polygon's sides is a wall at rest
        }
        const double outward = (way == 0 ? -0.5 : 0.5) * (mass_flux(c, p) + mass_flux(c, other));
        carry(row, outward, f.unknown[c][faces.at(other)], f.u[c][faces.at(other)]);
    }

    /// Mean of eps in the up to four cells around an edge.
    double edge_eps(const Place& p, std::size_t d, int next) const {
        double sum = 0.0;
        int count = 0;
        for (const int a : {axis(c).cell_below(p[c]), axis(c).cell_above(p[c])})
            for (const int b : {p[d], next})
                if (a >= 0 && b >= 0) sum += f.eps[cells.at(with(with(p, c, a), d, b))], ++count;
        return sum / count;
    }

    /// Mass that leaves across axis d on one side of the control volume [kg/s].
    double outward_flux(const Place& p, std::size_t d, int way) const {
        double sum = 0.0;
        const int face = way == 0 ? p[d] : axis(d).face_above(p[d]);
        for (const int a : {axis(c).cell_below(p[c]), axis(c).cell_above(p[c])})
            if (a >= 0) sum += 0.5 * mass_flux(d, with(with(p, c, a), d, face));
        return way == 0 ? -sum : sum;
    }

    bool edge_open(const Place& p, std::size_t d, int way) const {
        if (f.open.corner.empty()) return true;
        const int own = p[c], other = p[d] + way;
        return c == 0 ? f.open.corner_open(f.grid, own, other) : f.open.corner_open(f.grid, other, own);
    }

    /// Through the side towards the next face across the component's axis.
    void across(const Place& p, std::size_t d, int way, Row& row) const {
        double area = axis(c).dual_width(p[c]);
        for (std::size_t e = 0; e < 3; ++e)
            if (e != c && e != d) area *= axis(e).width(p[e]);
        const int next = axis(d).next(p[d], way);
        const double own = 0.5 * share(p) * axis(d).width(p[d]);
        const double friction = f.viscosity * edge_eps(p, d, next) * area;
        if (!edge_open(p, d, way)) {
            row.diagonal += friction / own;
        } else if (next >= 0) {
            const Place other = with(p, d, next);
            const int column = f.unknown[c][faces.at(other)];
            const double value = f.u[c][faces.at(other)];
            row.couple(column, friction / (own + 0.5 * share(other) * axis(d).width(next)), value);
            carry(row, outward_flux(p, d, way), column, value);
        } else {
            at_side(p, d, way, friction / own, row);
        }
    }

    void at_side(const Place& p, std::size_t d, int way, double friction, Row& row) const {
        const GridSide& side = f.sides[d][static_cast<std::size_t>(way)];
        if (side.kind == GridSide::Kind::no_slip) row.couple(-1, friction, side.velocity[static_cast<Eigen::Index>(c)]);
        if (side.kind == GridSide::Kind::inflow) { // comes in without a velocity along the side
            row.couple(-1, friction, 0.0);
            if (advects) row.couple(-1, std::max(-outward_flux(p, d, way), 0.0), 0.0);
        }
    }
};

/// What the pressure behind an outflow pushes.
double outflow_force(const GridFluid& f, std::size_t c, const Place& p) {
    const Axis& axis = f.grid.axis[c];
    if (axis.periodic) return 0.0;
    if (p[c] == 0) return open_area(f, c, p) * f.sides[c][0].pressure;
    if (p[c] == axis.cells()) return -open_area(f, c, p) * f.sides[c][1].pressure;
    return 0.0;
}

} // namespace

MomentumRows momentum_rows(const GridFluid& f, std::size_t c, const Velocity& carrier, double per_time) {
    const auto n = static_cast<std::size_t>(f.unknowns[c]);
    const Block faces = f.grid.faces(c);
    std::vector<std::size_t> face_of(n);
    for (std::size_t k = 0; k < faces.size(); ++k)
        if (f.unknown[c][k] >= 0) face_of[static_cast<std::size_t>(f.unknown[c][k])] = k;
    const RowMaker maker(f, c, carrier);
    std::vector<Row> rows(n);
    MomentumRows made;
    made.known.resize(f.unknowns[c]);
    made.mass.resize(f.unknowns[c]);
    made.room.resize(f.unknowns[c]);
    parallel_for(n, [&](std::size_t k) {
        const Place p = faces.place(face_of[k]);
        const auto at = static_cast<Eigen::Index>(k);
        Row& row = rows[k];
        row = maker.row(p);
        made.mass[at] = maker.mass(p);
        made.room[at] = open_area(f, c, p) * f.grid.axis[c].dual_width(p[c]);
        made.known[at] = row.known + outflow_force(f, c, p);
        const double drag = f.drag[c].empty() ? 0.0 : f.drag[c][face_of[k]];
        row.put(static_cast<int>(k), row.diagonal + per_time * made.mass[at] + drag);
    });
    made.matrix = matrix_of(rows);
    return made;
}

Field<double> friction_on_faces(const GridFluid& f, std::size_t c) {
    const Block faces = f.grid.faces(c);
    std::vector<double> u(static_cast<std::size_t>(f.unknowns[c]));
    for (std::size_t k = 0; k < faces.size(); ++k)
        if (f.unknown[c][k] >= 0) u[static_cast<std::size_t>(f.unknown[c][k])] = f.u[c][k];
    const RowMaker maker(f, c, f.u, false);
    Field<double> force(faces.size(), 0.0);
    parallel_for(faces.size(), [&](std::size_t k) {
        if (f.unknown[c][k] < 0) return;
        const Place p = faces.place(k);
        const Row row = maker.row(p);
        double sum = row.known - row.diagonal * f.u[c][k];
        for (std::size_t e = 0; e < row.size; ++e)
            sum -= row.entry[e].second * u[static_cast<std::size_t>(row.entry[e].first)];
        force[k] = sum / face_eps(f, c, p);
    });
    return force;
}

} // namespace plumb
