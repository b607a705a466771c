#include "grid/grid_fluid.hpp"

#include <algorithm>
#include <utility>

namespace plumb {

namespace {

/// True for a face on a side of the box that prescribes its velocity.
bool prescribed(const GridFluid& f, std::size_t c, const Place& p) {
    const Axis& axis = f.grid.axis[c];
    if (axis.periodic) return false;
    const bool lower = p[c] == 0, upper = p[c] == axis.cells();
    return (lower && f.sides[c][0].kind != GridSide::Kind::outflow) ||
           (upper && f.sides[c][1].kind != GridSide::Kind::outflow);
}

} // namespace

void number_unknowns(GridFluid& f) {
    const Block cells = f.grid.cells();
    std::vector<char> reached(cells.size(), 0);
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const Block faces = f.grid.faces(c);
        f.unknown[c].assign(faces.size(), -1);
        f.unknowns[c] = 0;
        for_each_place(faces, [&](const Place& p, std::size_t k) {
            if (f.open.face[c][k] == 0.0) return;
            if (!prescribed(f, c, p)) f.unknown[c][k] = f.unknowns[c]++;
            for (const int cell : {f.grid.axis[c].cell_below(p[c]), f.grid.axis[c].cell_above(p[c])}) {
                Place q = p;
                q[c] = cell;
                if (cell >= 0) reached[cells.at(q)] = 1;
            }
        });
    }
    f.unknown_pressure.assign(cells.size(), -1);
    f.unknown_pressures = 0;
    for (std::size_t k = 0; k < cells.size(); ++k)
        if (reached[k]) f.unknown_pressure[k] = f.unknown_pressures++;
}

bool has_outflow(const GridFluid& f) {
    for (std::size_t c = 0; c < f.dimensions(); ++c)
        for (const GridSide& side : f.sides[c])
            if (side.kind == GridSide::Kind::outflow) return true;
    return false;
}

namespace {

/// eps on a side of the box: continued linearly from the outermost cell and the next one (`way` inwards), within half
/// of the outermost and 1.
double side_eps(const GridFluid& f, std::size_t c, const Place& cell, int way) {
    const Axis& axis = f.grid.axis[c];
    const Block cells = f.grid.cells();
    Place next = cell;
    next[c] = axis.next(cell[c], way);
    const double own = f.eps[cells.at(cell)];
    if (next[c] < 0) return own;
    const double width = axis.width(cell[c]), share = width / (width + axis.width(next[c]));
    return std::clamp(own + share * (own - f.eps[cells.at(next)]), 0.5 * own, 1.0);
}

} // namespace

double face_eps(const GridFluid& f, std::size_t c, const Place& face) {
    const Block cells = f.grid.cells();
    Place below = face, above = face;
    below[c] = f.grid.axis[c].cell_below(face[c]);
    above[c] = f.grid.axis[c].cell_above(face[c]);
    if (below[c] < 0) return side_eps(f, c, above, 1);
    if (above[c] < 0) return side_eps(f, c, below, 0);
    return 0.5 * (f.eps[cells.at(below)] + f.eps[cells.at(above)]);
}

double face_mean(const GridFluid& f, const Field<double>& of_cells, std::size_t c, const Place& face) {
    if (of_cells.empty()) return 0.0;
    double sum = 0.0;
    int count = 0;
    for (const int cell : {f.grid.axis[c].cell_below(face[c]), f.grid.axis[c].cell_above(face[c])}) {
        Place p = face;
        p[c] = cell;
        if (cell >= 0) sum += of_cells[f.grid.cells().at(p)], ++count;
    }
    return sum / count;
}

double open_area(const GridFluid& f, std::size_t c, const Place& face) {
    return face_eps(f, c, face) * f.open.face[c][f.grid.faces(c).at(face)] * f.grid.face_area(c, face);
}

RowMatrix divergence_rows(const GridFluid& f, std::size_t c, const Field<double>& share, bool on_sides) {
    const Block cells = f.grid.cells(), faces = f.grid.faces(c);
    RowMatrix rows(f.unknown_pressures, f.unknowns[c]);
    rows.reserve(2 * static_cast<Eigen::Index>(f.unknown_pressures));
    const auto area_of = [&](const Place& p) {
        const bool side = f.grid.axis[c].cell_below(p[c]) < 0 || f.grid.axis[c].cell_above(p[c]) < 0;
        if (share.empty() || (side && !on_sides)) return open_area(f, c, p);
        return (face_eps(f, c, p) + face_mean(f, share, c, p)) * f.open.face[c][faces.at(p)] * f.grid.face_area(c, p);
    };
    for_each_place(cells, [&](const Place& p, std::size_t k) {
        const int row = f.unknown_pressure[k];
        if (row < 0) return;
        Place above = p;
        above[c] = f.grid.axis[c].face_above(p[c]);
        std::array<std::pair<int, double>, 2> entry{
            {{f.unknown[c][faces.at(p)], 0.0}, {f.unknown[c][faces.at(above)], 0.0}}};
        if (entry[0].first >= 0) entry[0].second = -area_of(p);
        if (entry[1].first >= 0) entry[1].second = area_of(above);
        if (entry[1].first < entry[0].first) std::swap(entry[0], entry[1]); // the first face of a periodic axis
        rows.startVec(row);
        if (entry[0].first == entry[1].first) return; // the only cell of a periodic axis: what enters leaves
        for (const auto& [column, area] : entry)
            if (column >= 0) rows.insertBack(row, column) = area;
    });
    rows.finalize();
    return rows;
}

Eigen::VectorXd known_divergence(const GridFluid& f) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(f.unknown_pressures);
    const Block cells = f.grid.cells();
    for (std::size_t c = 0; c < f.dimensions(); ++c) {
        const Block faces = f.grid.faces(c);
        for_each_place(faces, [&](const Place& p, std::size_t k) {
            if (f.unknown[c][k] >= 0 || f.open.face[c][k] == 0.0) return;
            const double flux = open_area(f, c, p) * f.u[c][k];
            Place below = p, above = p;
            below[c] = f.grid.axis[c].cell_below(p[c]);
            above[c] = f.grid.axis[c].cell_above(p[c]);
            if (below[c] >= 0) out[f.unknown_pressure[cells.at(below)]] += flux;
            if (above[c] >= 0) out[f.unknown_pressure[cells.at(above)]] -= flux;
        });
    }
    return out;
}

void change_porosity(GridFluid& f, Field<double> eps) {
    f.eps_before_2 = std::move(f.eps_before);
    f.eps_before = std::move(f.eps_taken.empty() ? f.eps : f.eps_taken);
    f.eps_taken.clear();
    f.eps = std::move(eps);
}

Field<double> medium_porosity(const GridFluid& f, double t) {
    Field<double> eps(f.grid.cells().size());
    for_each_place(f.grid.cells(), [&](const Place& p, std::size_t k) {
        eps[k] = porosity_at(*f.medium, f.grid.centre(p), t, f.domain.size);
    });
    return eps;
}

Eigen::VectorXd porosity_gain(const GridFluid& f, double dt) {
    Eigen::VectorXd gain = Eigen::VectorXd::Zero(f.unknown_pressures);
    if (f.eps_before.empty()) return gain;
    const bool two = f.second_order && !f.eps_before_2.empty();
    for_each_place(f.grid.cells(), [&](const Place& p, std::size_t k) {
        const int row = f.unknown_pressure[k];
        if (row < 0) return;
        const double last = f.eps[k] - f.eps_before[k]; // as differences: nothing is gained where eps is at rest
        const double rise = two ? 1.5 * last - 0.5 * (f.eps_before[k] - f.eps_before_2[k]) : last;
        gain[row] = f.open.cell[k] * f.grid.cell_volume(p) * rise / dt;
    });
    // no fluid can leave a closed box: what the sum is of rounding would leave the equations without a solution
    if (has_outflow(f)) return gain;
    double sum = 0.0;
    for (const double one : gain) sum += one;
    for (double& one : gain) one -= sum / static_cast<double>(gain.size());
    return gain;
}

} // namespace plumb
