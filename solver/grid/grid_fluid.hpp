// The fluid on a grid: an incompressible fluid of which each cell holds the share eps.
//
//     d(eps)/dt + div(eps u) = 0
//     eps rho (du/dt + u . grad u) = -eps grad p + div(eps mu grad u) - beta u + eps rho (f + s) + ...
//
// (Anderson & Jackson 1967, Ind. Eng. Chem. Fundam. 6, 527; model A). One velocity per face, normal to it.
#pragma once

#include "core/domain.hpp"
#include "core/field.hpp"
#include "core/inlet_profiles.hpp"
#include "grid/advection.hpp"
#include "grid/apertures.hpp"
#include "grid/foreseen_grains.hpp"
#include "grid/grid.hpp"
#include "grid/grid_sources.hpp"
#include "grid/resistance.hpp"

#include <Eigen/SparseCore>

#include <array>
#include <optional>
#include <vector>

namespace plumb {

/// What the fluid meets on a side of the box.
struct GridSide {
    enum class Kind { periodic, no_slip, free_slip, inflow, outflow };
    Kind kind = Kind::periodic;
    Vec3 velocity = Vec3::Zero(); // of a wall, along itself [m/s]
    double pressure = 0.0;        // behind an outflow [Pa]
};

using Velocity = std::array<Field<double>, 3>; // by face of each axis [m/s]

struct GridFluid {
    Grid grid;
    Domain domain;
    std::array<std::array<GridSide, 2>, 3> sides{}; // at the lower and the upper end of each axis
    Apertures open;

    double density = 0.0, viscosity = 0.0; // [kg/m3], dynamic [Pa s]
    Vec3 body_force = Vec3::Zero();        // [m/s2]
    Advection advection = NoAdvection{};
    std::optional<MediumPorosity> medium;   // what fills the grid, if anything does
    Resistance resistance = NoResistance{}; // of it
    GridSource source = NoGridSource{};
    bool second_order = true; // in time: backward differences over two steps, else over one
    double residual = 1e-8;   // of the momentum and mass equations, relative to what drives the step

    Velocity u;        // unknown or, on sides that prescribe it, given
    Velocity u_before; // a step before, empty before the second step
    Field<double> p;   // by cell [Pa]
    Field<double> eps; // by cell, at the end of the last step; while a step is made, at its end
    // What the mass equation took eps to be at the end of the last step: eps and what it foresaw of the grains' ways
    // beyond it. Empty where that is eps itself.
    Field<double> eps_taken;
    // one and two steps before eps, as taken; empty as long as they are not known, or where eps never changes
    Field<double> eps_before, eps_before_2;

    // what grains do to the fluid in the coming step, by face; empty without grains
    Velocity drag; // per velocity [N s/m], implicit
    Velocity push; // [N]
    ForeseenGrains foreseen;

    // which faces and cells are solved for: their number, by face and cell, -1 where they are not
    std::array<std::vector<int>, 3> unknown;
    std::vector<int> unknown_pressure;
    std::array<int, 3> unknowns{};
    int unknown_pressures = 0;

    std::int64_t iterations = 0;    // of the linear solver, over all steps
    double greatest_residual = 0.0; // left by it in any step

    std::size_t dimensions() const { return static_cast<std::size_t>(grid.dimensions); }
};

/// Numbers the unknowns: faces that are open and not prescribed, cells with an open face. The sides and the apertures
/// are there.
void number_unknowns(GridFluid& fluid);

/// Whether the fluid can leave by some side.
bool has_outflow(const GridFluid& fluid);

/// Mean of eps on either side of a face; on a side of the box, continued from within.
double face_eps(const GridFluid& fluid, std::size_t c, const Place& face);

/// Mean of a field of the cells on either side of a face; on a side of the box the one cell's; 0 of an empty field.
double face_mean(const GridFluid& fluid, const Field<double>& of_cells, std::size_t c, const Place& face);

/// eps times the open area of a face [m2].
double open_area(const GridFluid& fluid, std::size_t c, const Place& face);

using RowMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// One component of the momentum equation: matrix u = known + ..., in newtons.
struct MomentumRows {
    RowMatrix matrix;
    RowMatrix compact;     // without second upstream neighbours, for the preconditioner; empty where there are none
    Eigen::VectorXd known; // what prescribed velocities and pressures add to the right-hand side
    Eigen::VectorXd mass;  // of the control volumes, rho eps V [kg]
    Eigen::VectorXd room;  // eps times open area times dual width [m3]: what a uniform force per volume acts on
};

/// Friction and what the mass flux of `carrier` carries, plus mass times `per_time` [1/s].
MomentumRows momentum_rows(const GridFluid& fluid, std::size_t c, const Velocity& carrier, double per_time);

/// Force of the friction of the present velocities on the control volumes of the faces, over the fluid fraction there
/// [N].
Field<double> friction_on_faces(const GridFluid& fluid, std::size_t c);

/// div((eps + share) u) over the cells by unknown velocities of component c [m2]; `share` by cell, or empty. On sides
/// of the box it counts only where `on_sides`: stress acts there, but what is foreseen of grains stays in the box.
RowMatrix divergence_rows(const GridFluid& fluid, std::size_t c, const Field<double>& share, bool on_sides);

/// -div(share yields grad p) over the cells by unknown pressures [m4 s/kg], `share` by face; no rows where nothing
/// yields.
RowMatrix yield_rows(const GridFluid& fluid, const Velocity& share);

/// What grains are foreseen to carry out of the cells beyond what follows the velocity and the pressure at the step's
/// end [m3/s]; the present velocity is that of the step's start.
Eigen::VectorXd drift_out(const GridFluid& fluid);

/// After a step that began with the velocity `before`: eps_taken.
void take_foreseen(GridFluid& fluid, const Velocity& before, double dt);

/// What prescribed velocities carry out of the cells [m3/s].
Eigen::VectorXd known_divergence(const GridFluid& fluid);

/// Called before a step with the porosity of its end; those of the steps before move on.
void change_porosity(GridFluid& fluid, Field<double> eps);

/// What the fluid's medium leaves it at a time [s], by cell; the fluid has a medium.
Field<double> medium_porosity(const GridFluid& fluid, double t);

/// V d(eps)/dt of the cells at the end of a step of `dt` [m3/s], what their fluid gains: a backward difference over two
/// steps where they are known and the fluid is of second order in time, else over one.
Eigen::VectorXd porosity_gain(const GridFluid& fluid, double dt);

} // namespace plumb
