// The rows of the momentum equation.
//
// Friction is the derivative of the dissipation by the velocities: every gradient that the grid knows, of the mean
// velocities over open faces, squared, times the open volume it stands for. Across a cut cell it is Gauss' theorem of
// its polygon with the wall at rest; beside a wall that ends a row of faces, the velocity over half the open width. So
// the matrix is symmetric, and creeping flow the one of least dissipation among those that keep the volume. Where
// grains hand on stress, each row of friction is times its own share of it.
#include "core/parallel.hpp"
#include "grid/grid_fluid.hpp"
#include "grid/matrix_rows.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

/// One row while it is made. What second upstream neighbours carry is kept apart, so that the preconditioner can do
/// without them.
struct Row {
    Entries near, far; // `far`: second upstream, and what it changes
    double diagonal = 0.0, far_diagonal = 0.0, known = 0.0;

    void hold(double coefficient) { diagonal += coefficient; }
    void push(double force) { known += force; }
    /// Adds `coefficient` (neighbour - own) to the force on the control volume; the neighbour is an unknown or, with
    /// column < 0, has the value given.
    void couple(int column, double coefficient, double value) {
        diagonal += coefficient;
        if (column < 0)
            known += coefficient * value;
        else
            near.put(column, -coefficient);
    }
    void couple_far(int column, double coefficient, double value) {
        far_diagonal += coefficient;
        if (column < 0)
            known += coefficient * value;
        else
            far.put(column, -coefficient);
    }
};

/// The force that a row stands for with the velocities given, without the row.
struct RowForce {
    double own; // velocity
    double force = 0.0;

    void hold(double coefficient) { force -= coefficient * own; }
    void push(double more) { force += more; }
    void couple(int /*column*/, double coefficient, double value) { force += coefficient * (value - own); }
    void couple_far(int column, double coefficient, double value) { couple(column, coefficient, value); }
};

class RowMaker {
public:
    /// `all`: what is carried and what a porous medium takes too, else friction alone.
    RowMaker(const GridFluid& fluid, std::size_t component, const Velocity& carrier, bool all = true)
        : f(fluid), c(component), flux_of(carrier), cells(fluid.grid.cells()), faces(fluid.grid.faces(component)),
          friction_only(!all) {
        if (friction_only) return;
        for (std::size_t d = 0; d < f.dimensions(); ++d) {
            const Block across = f.grid.faces(d);
            flux[d].resize(across.size());
            parallel_for(across.size(), [&](std::size_t k) {
                flux[d][k] = f.density * open_area(f, d, across.place(k)) * carrier[d][k];
            });
        }
    }

    /// Adds all that acts on the control volume of a face to a row or its force.
    template <class Made> void make(const Place& p, Made& made) const {
        if (!friction_only) resist(p, made);
        const double viscosity = f.viscosity * borne(p);
        for (const int way : {0, 1}) {
            along(p, way, viscosity, made);
            for (std::size_t d = 0; d < f.dimensions(); ++d)
                if (d != c) across(p, d, way, viscosity, made);
        }
    }

    /// Share of the friction on a face's fluid that its row bears, with what grains hand on of theirs.
    double borne(const Place& p) const {
        if (friction_only || f.foreseen.hands_on.empty()) return 1.0;
        return 1.0 + face_mean(f, f.foreseen.hands_on, c, p) / face_eps(f, c, p);
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
    const Velocity& flux_of;
    const Block cells, faces;
    const bool friction_only;
    std::array<Field<double>, 3> flux; // mass through faces [kg/s]; empty where nothing is carried

    const Axis& axis(std::size_t d) const { return f.grid.axis[d]; }
    static Place with(Place p, std::size_t d, int value) {
        p[d] = value;
        return p;
    }
    double share(const Place& face) const { return f.open.face[c][faces.at(face)]; }

    /// Mass through a face across axis d [kg/s].
    double mass_flux(std::size_t d, const Place& face) const {
        return friction_only ? 0.0 : flux[d][f.grid.faces(d).at(face)];
    }

    template <class Made> void couple(Made& row, const Place& face, double coefficient) const {
        const std::size_t k = faces.at(face);
        row.couple(f.unknown[c][k], coefficient, f.u[c][k]);
    }

    /// A face upstream of the upstream one, and how far the flux is from that over the distance of the two.
    struct Second {
        Place face{};
        double reach = 0.0; // 0: there is none
    };

    template <class Made> void carry(Made& row, double outward, const Place& other, const Second& second) const {
        if (friction_only) return;
        const auto weight = [&](double reach) {
            return std::visit([&](const auto& law) { return law(outward, reach); }, f.advection);
        };
        const Carried near = weight(0.0), all = weight(second.reach);
        couple(row, other, -outward * near.next);
        if (all.second == 0.0) return;
        const std::size_t next = faces.at(other), beyond = faces.at(second.face);
        row.couple_far(f.unknown[c][next], -outward * (all.next - near.next), f.u[c][next]);
        row.couple_far(f.unknown[c][beyond], -outward * all.second, f.u[c][beyond]);
    }

    /// Upstream of `face` along the component's own axis, on the side `way`; the flux is in the middle of a cell of
    /// width `across`.
    Second second_along(const Place& face, int way, double across) const {
        const int cell = way == 0 ? axis(c).cell_below(face[c]) : axis(c).cell_above(face[c]);
        if (cell < 0) return {};
        const Place beyond = with(face, c, way == 0 ? cell : axis(c).face_above(cell));
        if (share(beyond) == 0.0 || f.open.cell[cells.at(with(face, c, cell))] == 0.0) return {};
        return {beyond, 0.5 * across / axis(c).width(cell)};
    }

    /// Upstream of `face` along another axis.
    Second second_across(const Place& face, std::size_t d, int way) const {
        const int beyond = axis(d).next(face[d], way);
        if (beyond < 0 || edge_share(face, d, way) == 0.0) return {};
        const double width = axis(d).width(face[d]);
        return {with(face, d, beyond), width / (width + axis(d).width(beyond))};
    }

    /// What the porous medium around a face takes: beta(|u|) u, linear around the carrier's speed as Newton's method
    /// has it, which is of second order in time like the carrier and does not overshoot in long steps.
    template <class Made> void resist(const Place& p, Made& row) const {
        if (std::holds_alternative<NoResistance>(f.resistance)) return;
        const double speed = face_speed(p);
        for (const int cell : {axis(c).cell_below(p[c]), axis(c).cell_above(p[c])}) {
            if (cell < 0) continue;
            const std::size_t k = cells.at(with(p, c, cell));
            const double volume = 0.5 * f.open.cell[k] * f.grid.cell_volume(with(p, c, cell));
            const Resisted r =
                std::visit([&](const auto& law) { return law(f.eps[k], speed, f.density, f.viscosity); }, f.resistance);
            row.hold((r.beta + r.rise) * volume);
            row.push(r.rise * volume * flux_of[c][faces.at(p)]);
        }
    }

    /// Speed of the carrier at a face: other components are the mean of the four around it [m/s].
    double face_speed(const Place& p) const {
        double square = std::pow(flux_of[c][faces.at(p)], 2);
        for (std::size_t d = 0; d < f.dimensions(); ++d) {
            if (d == c) continue;
            double sum = 0.0;
            int count = 0;
            for (const int a : {axis(c).cell_below(p[c]), axis(c).cell_above(p[c])}) {
                if (a < 0) continue;
                for (const int b : {p[d], axis(d).face_above(p[d])})
                    sum += flux_of[d][f.grid.faces(d).at(with(with(p, c, a), d, b))], ++count;
            }
            square += std::pow(sum / count, 2);
        }
        return std::sqrt(square);
    }

    /// Through the middle of the cell on one side along the component's own axis.
    template <class Made> void along(const Place& p, int way, double viscosity, Made& row) const {
        const int cell = way == 0 ? axis(c).cell_below(p[c]) : axis(c).cell_above(p[c]);
        if (cell < 0) return; // an outflow
        const Place middle = with(p, c, cell);
        const Place other = with(p, c, way == 0 ? cell : axis(c).face_above(cell));
        const double full = f.grid.face_area(c, p), volume = f.open.cell[cells.at(middle)] * f.grid.cell_volume(middle);
        const double own = share(p) * full, next = share(other) * full;
        if (volume > 0.0) {
            const double friction = viscosity * f.eps[cells.at(middle)] * own / volume;
            couple(row, other, friction * next);
            row.hold(friction * (own - next)); // the rest of the polygon's sides is a wall at rest
        }
        const double outward = (way == 0 ? -0.5 : 0.5) * (mass_flux(c, p) + mass_flux(c, other));
        const double across = axis(c).width(cell);
        carry(row, outward, other, outward < 0.0 ? second_along(other, way, across) : second_along(p, 1 - way, across));
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

    /// Of the edge between a face and the next one across axis d.
    double edge_share(const Place& p, std::size_t d, int way) const {
        return f.open.edge_share(f.grid, 3 - c - d, with(p, d, p[d] + way));
    }

    /// Through the side towards the next face across the component's axis.
    template <class Made> void across(const Place& p, std::size_t d, int way, double viscosity, Made& row) const {
        double area = axis(c).dual_width(p[c]);
        for (std::size_t e = 0; e < 3; ++e)
            if (e != c && e != d) area *= axis(e).width(p[e]);
        const int next = axis(d).next(p[d], way);
        const std::size_t k = faces.at(p), at = static_cast<std::size_t>(way), back = 1 - at;
        const double own = f.open.to_edge(c, k, d, at) * axis(d).width(p[d]);
        const double open = edge_share(p, d, way), all = viscosity * edge_eps(p, d, next) * area;
        const double closed = edge_share(p, d, 1 - way) - open; // a wall at rest lies between the two edges
        if (closed > 0.0) row.hold(closed * all / (f.open.to_wall(c, k, d, at) * axis(d).width(p[d])));
        if (open == 0.0) return;
        const double friction = open * all;
        if (next >= 0) {
            const Place other = with(p, d, next);
            const double beyond = f.open.to_edge(c, faces.at(other), d, back) * axis(d).width(next);
            couple(row, other, friction / (own + beyond));
            const double outward = outward_flux(p, d, way);
            carry(row, outward, other, outward < 0.0 ? second_across(other, d, way) : second_across(p, d, 1 - way));
        } else {
            at_side(p, d, way, friction / own, row);
        }
    }

    template <class Made> void at_side(const Place& p, std::size_t d, int way, double friction, Made& row) const {
        const GridSide& side = f.sides[d][static_cast<std::size_t>(way)];
        if (side.kind == GridSide::Kind::no_slip) row.couple(-1, friction, side.velocity[static_cast<Eigen::Index>(c)]);
        if (side.kind == GridSide::Kind::inflow) { // comes in without a velocity along the side
            row.couple(-1, friction, 0.0);
            if (!friction_only) row.couple(-1, std::max(-outward_flux(p, d, way), 0.0), 0.0);
        }
    }
};

/// What the pressure behind an outflow pushes.
double outflow_force(const GridFluid& f, std::size_t c, const Place& p) {
    const Axis& axis = f.grid.axis[c];
    if (axis.periodic) return 0.0;
    if (p[c] != 0 && p[c] != axis.cells()) return 0.0;
    const double area = open_area(f, c, p) * (1.0 + face_mean(f, f.foreseen.hands_on, c, p) / face_eps(f, c, p));
    return p[c] == 0 ? area * f.sides[c][0].pressure : -area * f.sides[c][1].pressure;
}

} // namespace

MomentumRows momentum_rows(const GridFluid& f, std::size_t c, const Velocity& carrier, double per_time) {
    const auto n = static_cast<std::size_t>(f.unknowns[c]);
    const Block faces = f.grid.faces(c);
    std::vector<std::size_t> face_of(n);
    for (std::size_t k = 0; k < faces.size(); ++k)
        if (f.unknown[c][k] >= 0) face_of[static_cast<std::size_t>(f.unknown[c][k])] = k;
    const RowMaker maker(f, c, carrier);
    MomentumRows made;
    made.known.resize(f.unknowns[c]);
    made.mass.resize(f.unknowns[c]);
    made.room.resize(f.unknowns[c]);
    const std::size_t parts = (n + parallel_chunk - 1) / parallel_chunk;
    std::vector<MatrixRows> near(parts), all(parts);
    std::vector<char> any_far(parts, 0);
    parallel_chunks(n, [&](std::size_t begin, std::size_t end) {
        const std::size_t part = begin / parallel_chunk;
        for (std::size_t k = begin; k < end; ++k) {
            const Place p = faces.place(face_of[k]);
            const auto at = static_cast<Eigen::Index>(k);
            Row row;
            maker.make(p, row);
            made.mass[at] = maker.mass(p);
            made.room[at] = open_area(f, c, p) * f.grid.axis[c].dual_width(p[c]);
            made.known[at] = row.known + outflow_force(f, c, p);
            const double drag = f.drag[c].empty() ? 0.0 : f.drag[c][face_of[k]];
            row.near.put(static_cast<int>(k), row.diagonal + (per_time * made.mass[at] + drag));
            near[part].add(row.near);
            if (row.far.size > 0) any_far[part] = 1;
            for (std::size_t e = 0; e < row.far.size; ++e)
                row.near.put(row.far.entry[e].column, row.far.entry[e].value);
            row.near.put(static_cast<int>(k), row.far_diagonal);
            all[part].add(row.near);
        }
    });
    const bool far = std::any_of(any_far.begin(), any_far.end(), [](char any) { return any != 0; });
    if (far) made.compact = matrix_of(near, f.unknowns[c]);
    made.matrix = matrix_of(all, f.unknowns[c]);
    return made;
}

Field<double> friction_on_faces(const GridFluid& f, std::size_t c) {
    const Block faces = f.grid.faces(c);
    const RowMaker maker(f, c, f.u, false);
    Field<double> force(faces.size(), 0.0);
    parallel_for(faces.size(), [&](std::size_t k) {
        if (f.unknown[c][k] < 0) return;
        const Place p = faces.place(k);
        RowForce sum{f.u[c][k]};
        maker.make(p, sum);
        force[k] = sum.force / face_eps(f, c, p);
    });
    return force;
}

} // namespace plumb
