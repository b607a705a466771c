// What immersed walls leave of a grid in space.
#include "grid/apertures.hpp"
#include "schemes/advance_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace plumb {
namespace {

Grid cube(int n, bool periodic) {
    Grid grid;
    grid.dimensions = 3;
    grid.axis = {even_axis(1.0, n, periodic), even_axis(1.0, n, periodic), even_axis(1.0, n, periodic)};
    return grid;
}

double distance_to_sphere(const Vec3& x, double radius) { return (x - Vec3(0.507, 0.4913, 0.5031)).norm() - radius; }

double open_volume(const Grid& grid, const Apertures& open) {
    double sum = 0.0;
    for_each_place(grid.cells(), [&](const Place& p, std::size_t k) { sum += open.cell[k] * grid.cell_volume(p); });
    return sum;
}

// A plane cuts polyhedra, which are exact.
TEST(Apertures, ObliquePlaneLeavesItsExactVolume) {
    const Grid grid = cube(7, false);
    const Vec3 normal = Vec3(0.3, 0.5, 0.7);
    // the corner x . normal < 0.45: a tetrahedron, less the two corners beyond y = 1 and... none is (0.45/0.5 < 1),
    // and none beyond z = 1; along x it reaches 1.5 and loses the one beyond x = 1
    const Apertures open = cut_grid(grid, [&](const Vec3& x) { return x.dot(normal) - 0.45; });
    const double whole = std::pow(0.45, 3) / (6.0 * 0.3 * 0.5 * 0.7),
                 beyond = std::pow(0.15, 3) / (6.0 * 0.3 * 0.5 * 0.7);
    EXPECT_NEAR(open_volume(grid, open), 1.0 - (whole - beyond), 1e-12);
}

TEST(Apertures, SphereIsOfSecondOrderInVolumeAndSection) {
    const double radius = 0.31, exact = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    std::vector<double> errors;
    for (const int n : {8, 16, 32}) {
        const Grid grid = cube(n, true);
        const Apertures open = cut_grid(grid, [&](const Vec3& x) { return distance_to_sphere(x, radius); });
        errors.push_back(1.0 - open_volume(grid, open) - exact);
        double section = 0.0; // of the nodes' plane in the middle
        for_each_place(grid.faces(1), [&](const Place& p, std::size_t k) {
            if (p[1] == n / 2) section += (1.0 - open.face[1][k]) / (n * n);
        });
        const double disc = std::numbers::pi * (radius * radius - std::pow(0.5 - 0.4913, 2));
        EXPECT_NEAR(section / disc, 1.0, 2.1 / (n * n)) << n; // chords of 1.1 h: (1.1 h/r)^2/6
    }
    EXPECT_LT(std::abs(errors[2] / exact), 5e-3);
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.5);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.5);
}

// Spheres on a simple cubic lattice: drag over Stokes' of Zick & Homsy (1982, J. Fluid Mech. 115, 13), 4.292 at a solid
// fraction of 0.125. The mean velocity over the cell is U.
TEST(Apertures, SphereArrayIsOfSecondOrder) {
    const double radius = std::cbrt(0.125 * 3.0 / (4.0 * std::numbers::pi));
    std::vector<double> errors;
    for (const int n : {8, 16, 32}) {
        GridFluid f;
        f.grid = cube(n, true);
        f.domain.dimensions = 3;
        f.domain.size = Vec3::Ones();
        f.open = cut_grid(f.grid, [&](const Vec3& x) { return distance_to_sphere(x, radius); });
        f.density = f.viscosity = 1.0;
        f.body_force = Vec3(1.0, 0.0, 0.0);
        f.eps.assign(f.grid.cells().size(), 1.0);
        f.p.assign(f.grid.cells().size(), 0.0);
        for (std::size_t c = 0; c < 3; ++c) f.u[c].assign(f.grid.faces(c).size(), 0.0);
        number_unknowns(f);
        advance_grid(f, 1e9, 1);
        double flux = 0.0;
        for_each_place(f.grid.faces(0), [&](const Place& p, std::size_t k) {
            if (p[0] == 0) flux += f.u[0][k] * open_area(f, 0, p);
        });
        errors.push_back(1.0 / (6.0 * std::numbers::pi * radius * flux) / 4.292 - 1.0);
    }
    EXPECT_LT(std::abs(errors[2]), 0.02); // h^2/2r of the radius, and K goes as r^-3.4: verification/sphere_array
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.4);
    EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2.0, 0.4);
}

} // namespace
} // namespace plumb
