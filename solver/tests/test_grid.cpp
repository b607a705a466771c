// The fluid on a grid against exact flows.
#include "core/initial_fields.hpp"
#include "grid/saddle_solver.hpp"
#include "schemes/advance_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb {
namespace {

GridFluid box(int nx, int ny, double lx, double ly, bool periodic_x, bool periodic_y) {
    GridFluid f;
    f.grid.dimensions = 2;
    f.grid.axis = {even_axis(lx, nx, periodic_x), even_axis(ly, ny, periodic_y), even_axis(1.0, 1, false)};
    f.domain.dimensions = 2;
    f.domain.size = Vec3(lx, ly, 0.0);
    f.open = open_grid(f.grid);
    f.density = 1.0;
    f.viscosity = 0.01;
    for (std::size_t c = 0; c < 2; ++c)
        if (!f.grid.axis[c].periodic) f.sides[c][0].kind = f.sides[c][1].kind = GridSide::Kind::no_slip;
    return f;
}

void make_ready(GridFluid& f) {
    f.eps.assign(f.grid.cells().size(), 1.0);
    f.p.assign(f.grid.cells().size(), 0.0);
    for (std::size_t c = 0; c < 3; ++c) f.u[c].assign(f.grid.faces(c).size(), 0.0);
    number_unknowns(f);
}

/// sqrt of the mean over faces of the square of u_c - exact(x).
template <class Exact> double error(const GridFluid& f, std::size_t c, Exact&& exact) {
    double sum = 0.0;
    for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
        const double e = f.u[c][k] - exact(f.grid.face_centre(c, p));
        sum += e * e;
    });
    return std::sqrt(sum / static_cast<double>(f.u[c].size()));
}

// Widths that double over a metre and stay: nodes by hand, n = ln(width ratio)/slope.
TEST(Grid, StretchedAxisHasTheAskedWidths) {
    const Axis axis = stretched_axis({0.0, 1.0, 2.0}, {0.1, 0.2, 0.2}, false);
    const double cells = std::log(2.0) / 0.1 + 5.0; // 11.93: twelve, narrower by 0.6 %
    ASSERT_EQ(axis.cells(), 12);
    EXPECT_EQ(axis.node.front(), 0.0);
    EXPECT_EQ(axis.node.back(), 2.0);
    EXPECT_NEAR(axis.width(11), 0.2 * cells / 12.0, 1e-12);
    EXPECT_NEAR(axis.node[1], std::expm1(0.1 * cells / 12.0), 1e-12);
    for (int k = 1; k < 12; ++k) EXPECT_GE(axis.width(k), axis.width(k - 1) * (1.0 - 1e-12));
    const Axis even = stretched_axis({0.0, 3.0}, {0.5, 0.5}, false);
    for (std::size_t k = 0; k < 7; ++k) EXPECT_NEAR(even.node[k], 0.5 * static_cast<double>(k), 1e-14);
}

// Taylor and Green's vortex decays as exp(-2 k^2 nu t): second order in space and time together.
double taylor_green_order(const Advection& advection) {
    std::vector<double> errors;
    for (const int n : {16, 32, 64}) {
        GridFluid f = box(n, n, 1.0, 1.0, true, true);
        f.advection = advection;
        make_ready(f);
        const double k = 2.0 * std::numbers::pi, end = 0.25;
        const auto u = [&](const Vec3& x) { return -std::cos(k * x[0]) * std::sin(k * x[1]); };
        const auto v = [&](const Vec3& x) { return std::sin(k * x[0]) * std::cos(k * x[1]); };
        for_each_place(f.grid.faces(0),
                       [&](const Place& p, std::size_t q) { f.u[0][q] = u(f.grid.face_centre(0, p)); });
        for_each_place(f.grid.faces(1),
                       [&](const Place& p, std::size_t q) { f.u[1][q] = v(f.grid.face_centre(1, p)); });
        const int steps = n / 2;
        for (int step = 1; step <= steps; ++step) advance_grid(f, end / steps, step);
        const double decay = std::exp(-2.0 * k * k * 0.01 * end);
        errors.push_back(error(f, 0, [&](const Vec3& x) { return decay * u(x); }));
        EXPECT_NEAR(errors.back(), error(f, 1, [&](const Vec3& x) { return decay * v(x); }), 1e-6);
        EXPECT_LT(static_cast<double>(f.iterations) / steps, 30.0);
    }
    return std::log2(errors[1] / errors[2]);
}
TEST(Grid, TaylorGreenVortexIsOfSecondOrder) {
    EXPECT_NEAR(taylor_green_order(Central{}), 2.0, 0.2);
    EXPECT_NEAR(taylor_green_order(Upwind{}), 1.0, 0.3);
}

// Between plates the parabola is met up to the mean of its curvature over half a cell at the wall, f h^2/(8 nu).
TEST(Grid, PlateFlowIsExactUpToTheHalfCell) {
    GridFluid f = box(4, 16, 0.25, 1.0, true, false);
    f.body_force = Vec3(0.08, 0.0, 0.0);
    make_ready(f);
    advance_grid(f, 1e9, 1);
    const double h = 1.0 / 16.0, g = 0.08 / 0.01;
    EXPECT_LT(error(f, 0, [&](const Vec3& x) { return 0.5 * g * x[1] * (1.0 - x[1]) + g * h * h / 8.0; }), 1e-7 * g);
    EXPECT_LT(error(f, 1, [](const Vec3&) { return 0.0; }), 1e-7 * g);
}

// One cylinder in a periodic cell: the force per length over mu U of Sangani & Acrivos (1982), 51.53 at a solid
// fraction of 0.2, from below at second order.
TEST(Grid, CylinderArrayIsOfSecondOrder) {
    std::vector<double> errors;
    for (const int n : {24, 48, 96}) {
        GridFluid f = box(n, n, 1.0, 1.0, true, true);
        const double radius = std::sqrt(0.2 / std::numbers::pi);
        f.open = cut_grid(f.grid, [&](const Vec3& x) { return std::hypot(x[0] - 0.513, x[1] - 0.4871) - radius; });
        f.viscosity = 1.0;
        f.body_force = Vec3(1.0, 0.0, 0.0);
        make_ready(f);
        advance_grid(f, 1e9, 1);
        double flux = 0.0;
        for_each_place(f.grid.faces(0), [&](const Place& p, std::size_t k) {
            if (p[0] == 0) flux += f.u[0][k] * open_area(f, 0, p);
        });
        errors.push_back(1.0 / flux / 51.53 - 1.0);
    }
    EXPECT_LT(std::abs(errors[1]), 0.006);
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.3);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.3);
}

// Fluid at a changing eps in a pipe with one open end: what the cells lose leaves there. eps = 1 - b t^2 differs from
// its backward difference over two steps by nothing, over one by b dt.
TEST(Grid, FallingPorosityPushesTheFluidOut) {
    for (const bool second_order : {true, false}) {
        GridFluid f = box(8, 1, 1.0, 0.5, false, true);
        f.sides[0][1].kind = GridSide::Kind::outflow;
        f.second_order = second_order;
        make_ready(f);
        const double b = 2.0, dt = 0.05;
        for (int step = 1; step <= 4; ++step) {
            const double t = step * dt, eps = 1.0 - b * t * t;
            change_porosity(f, Field<double>(8, eps));
            advance_grid(f, dt, step);
            const double rate = second_order && step > 1 ? 2.0 * b * t : 2.0 * b * (t - 0.5 * dt);
            for_each_place(f.grid.faces(0), [&](const Place& p, std::size_t k) {
                EXPECT_NEAR(eps * f.u[0][k], rate * f.grid.face_centre(0, p)[0], 1e-7) << step;
            });
        }
    }
}

/// An open box of stretched cells with everything prescribed on its sides.
GridFluid stretched_box() {
    GridFluid f = box(12, 10, 1.0, 1.0, false, false);
    f.grid.axis[0] = stretched_axis({0.0, 1.0}, {0.04, 0.12}, false);
    f.grid.axis[1] = stretched_axis({0.0, 0.5, 1.0}, {0.05, 0.15, 0.05}, false);
    f.open = open_grid(f.grid);
    for (std::size_t c = 0; c < 2; ++c) f.sides[c][0].kind = f.sides[c][1].kind = GridSide::Kind::inflow;
    f.viscosity = 0.0;
    return f;
}

// A uniform flow carries a linear field at rho V a . grad u, whichever way it goes and however the cells are stretched.
TEST(Grid, LinearUpwindIsExactForLinearFields) {
    for (const Vec3& a : {Vec3(1.0, 0.4, 0.0), Vec3(-1.0, 0.4, 0.0), Vec3(-0.3, -0.7, 0.0)}) {
        GridFluid f = stretched_box();
        f.advection = LinearUpwind{};
        make_ready(f);
        Velocity carrier = f.u;
        for (std::size_t c = 0; c < 2; ++c) {
            std::fill(carrier[c].begin(), carrier[c].end(), a[static_cast<Eigen::Index>(c)]);
            for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
                f.u[c][k] = f.grid.face_centre(c, p).dot(Vec3(2.0, -3.0, 0.0));
            });
        }
        for (std::size_t c = 0; c < 2; ++c) {
            const MomentumRows rows = momentum_rows(f, c, carrier, 0.0);
            Eigen::VectorXd u(f.unknowns[c]);
            for (std::size_t k = 0; k < f.u[c].size(); ++k)
                if (f.unknown[c][k] >= 0) u[f.unknown[c][k]] = f.u[c][k];
            const Eigen::VectorXd force = rows.matrix * u - rows.known;
            for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
                const bool inside =
                    p[0] > 2 && p[1] > 2 && p[0] < f.grid.axis[0].cells() - 2 && p[1] < f.grid.axis[1].cells() - 2;
                if (!inside) return;
                EXPECT_NEAR(force[f.unknown[c][k]] / rows.mass[f.unknown[c][k]], a.dot(Vec3(2.0, -3.0, 0.0)), 1e-12);
            });
        }
    }
}

// What a uniform flow carries of a wave: the error of linear_upwind is h^2/3 u''' and h^3/4 u'''', of second order.
TEST(Grid, LinearUpwindIsOfSecondOrder) {
    std::vector<double> errors;
    for (const int n : {64, 128}) {
        GridFluid f = box(n, 4, 1.0, 1.0, true, true);
        f.advection = LinearUpwind{};
        f.viscosity = 0.0;
        make_ready(f);
        Velocity carrier = f.u;
        std::fill(carrier[0].begin(), carrier[0].end(), 1.0);
        const double k = 2.0 * std::numbers::pi;
        double sum = 0.0;
        for (const std::size_t c : {0, 1}) {
            const MomentumRows rows = momentum_rows(f, c, carrier, 0.0);
            Eigen::VectorXd u(f.unknowns[c]);
            for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t q) {
                u[f.unknown[c][q]] = std::sin(k * f.grid.face_centre(c, p)[0]);
            });
            const Eigen::VectorXd force = rows.matrix * u;
            double square = 0.0;
            for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t q) {
                const double slope = k * std::cos(k * f.grid.face_centre(c, p)[0]);
                const int at = f.unknown[c][q];
                square += std::pow(force[at] / rows.mass[at] - slope, 2);
            });
            sum += std::sqrt(square / static_cast<double>(f.unknowns[c]));
        }
        errors.push_back(sum);
    }
    EXPECT_NEAR(errors[1], 2.0 / 3.0 * std::pow(2.0 * std::numbers::pi, 3) * std::sqrt(0.5) / (128.0 * 128.0),
                0.01 * errors[1]);
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.05);
}

// Where the medium is all there is, a body force f drives the superficial velocity K rho f/mu; Ergun's law by hand:
// eps = 0.5, d = 1, mu = 0.01, rho = 1, u = 2: U = 1, -grad p = 150 mu 0.25/0.125 + 1.75 0.5/0.125 = 3 + 7 = 10.
TEST(Grid, ResistanceSetsTheSuperficialVelocity) {
    const auto flow = [](const Resistance& resistance, double force, int steps) {
        GridFluid f = box(4, 3, 1.0, 1.0, true, true);
        f.medium = UniformPorosity(0.5);
        f.resistance = resistance;
        f.body_force = Vec3(force, 0.0, 0.0);
        f.residual = 1e-12;
        make_ready(f);
        f.eps = medium_porosity(f, 0.0);
        for (int step = 1; step <= steps; ++step) advance_grid(f, 1e6, step);
        return f.eps[0] * f.u[0][0];
    };
    EXPECT_NEAR(flow(DarcyResistance(1e-3), 2.0, 1), 1e-3 * 2.0 / 0.01, 1e-6); // but for rho eps/(beta dt)
    const double k = 0.2 * 0.2 * 0.125 / (180.0 * 0.25);                       // of Kozeny and Carman, d = 0.2
    EXPECT_NEAR(flow(KozenyCarmanResistance(0.2), 2.0, 1), k * 2.0 / 0.01, 1e-6);
    EXPECT_NEAR(flow(ErgunResistance(1.0), 10.0, 20), 1.0, 1e-6);
}

} // namespace
} // namespace plumb
