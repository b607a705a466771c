// The weights between grains and the nodes of a grid.
#include "coupling/grid_weights.hpp"

#include "core/random.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace plumb {
namespace {

/// A box of 1.2 by 1 by 0.8 m, periodic along x, with walls across the others.
GridFluid box(int nx, int ny, int nz) {
    GridFluid f;
    f.grid.dimensions = 3;
    f.domain.size = Vec3(1.2, 1.0, 0.8);
    f.domain.periodic = {true, false, false};
    f.grid.axis = {even_axis(1.2, nx, true), stretched_axis({0.0, 1.0}, {1.5 / ny, 0.5 / ny}, false),
                   even_axis(0.8, nz, false)};
    f.viscosity = 0.3;
    f.density = 2.0;
    for (std::size_t c = 1; c < 3; ++c)
        for (GridSide& side : f.sides[c]) side.kind = GridSide::Kind::no_slip;
    f.open = open_grid(f.grid);
    for (std::size_t c = 0; c < 3; ++c) f.u[c].assign(f.grid.faces(c).size(), 0.0);
    f.p.assign(f.grid.cells().size(), 0.0);
    f.eps.assign(f.grid.cells().size(), 1.0);
    number_unknowns(f);
    return f;
}

std::vector<Vec3> random_places(std::size_t n, const Vec3& lower, const Vec3& upper) {
    std::vector<Vec3> x;
    Random random(3);
    for (std::size_t k = 0; k < n; ++k) {
        Vec3 u;
        for (Eigen::Index c = 0; c < 3; ++c) u[c] = random.uniform();
        x.push_back(lower + u.cwiseProduct(upper - lower));
    }
    return x;
}

GridWeights weights(const GridFluid& f, GridKernel kernel, double width, const std::vector<Vec3>& x) {
    GridWeights w;
    w.kernel = kernel;
    w.width = width;
    measure(w, f);
    set_weights(w, f, x);
    return w;
}

TEST(GridWeights, ColumnsSumToOneWhereverTheGrainIs) {
    const GridFluid f = box(12, 10, 8);
    // beyond the periodic side too, and in the corners
    std::vector<Vec3> x = random_places(40, {-0.5, 0.0, 0.0}, {1.7, 1.0, 0.8});
    x.emplace_back(0.0, 0.0, 0.0);
    x.emplace_back(1.2, 1.0, 0.8);
    for (const GridKernel& kernel :
         {GridKernel(GaussianKernel{}), GridKernel(CellCounting{}), GridKernel(WendlandC2{})}) {
        const GridWeights w = weights(f, kernel, 0.12, x);
        for (std::size_t j = 0; j < x.size(); ++j) {
            EXPECT_NEAR(w.cells.gathered(j, 0.0, [](std::size_t) { return 1.0; }), 1.0, 1e-14);
            for (std::size_t c = 0; c < 3; ++c) {
                EXPECT_NEAR(w.faces[c].gathered(j, 0.0, [](std::size_t) { return 1.0; }), 1.0, 1e-14);
                w.faces[c].spread(j, [&](std::size_t k, double) { EXPECT_GE(f.unknown[c][k], 0); });
            }
        }
    }
}

TEST(GridWeights, ImagesAreTheSamePlace) {
    const GridFluid f = box(12, 10, 8);
    const Vec3 x(0.05, 0.4, 0.3);
    const GridWeights w = weights(f, GaussianKernel{}, 0.15, {x, x + Vec3(1.2, 0, 0), x - Vec3(2.4, 0, 0)});
    std::vector<double> all(f.eps.size(), 0.0);
    w.cells.spread(0, [&](std::size_t k, double weight) { all[k] += weight; });
    for (const std::size_t image : {1, 2}) {
        std::vector<double> same(f.eps.size(), 0.0);
        w.cells.spread(image, [&](std::size_t k, double weight) { same[k] += weight; });
        for (std::size_t k = 0; k < all.size(); ++k) EXPECT_NEAR(same[k], all[k], 1e-15);
    }
}

TEST(GridWeights, APlaceWithoutFluidInReachHasNone) {
    const GridFluid f = box(12, 10, 8);
    const GridWeights w = weights(f, WendlandC2{}, 0.1, {Vec3(0.5, 1.3, 0.4), Vec3(0.5, 0.9, 0.4)});
    EXPECT_TRUE(w.cells.empty(0));
    EXPECT_TRUE(w.faces[0].empty(0));
    EXPECT_FALSE(w.cells.empty(1));
    EXPECT_TRUE(weights(f, CellCounting{}, 0.0, {Vec3(0.5, 1.3, 0.4)}).cells.empty(0));
}

TEST(GridPorosity, TakesTheGrainsVolumeFromTheFluidAndIsBounded) {
    GridFluid f = box(12, 10, 8);
    const std::vector<Vec3> x = random_places(200, {0.4, 0.4, 0.3}, {0.6, 0.6, 0.5});
    const std::vector<double> volume(x.size(), 1e-3); // 0.2 m3 in 0.96, most of it into 0.008
    double sum = 0.0;
    for (const GridKernel& kernel : {GridKernel(GaussianKernel{}), GridKernel(CellCounting{})})
        for (const double least : {0.0, 0.4}) {
            const GridWeights w = weights(f, kernel, 0.08, x);
            const BoundedPorosity found = porosity(f, w, volume, least);
            EXPECT_GT(found.bounded, 0);
            sum = 0.0;
            for (std::size_t k = 0; k < found.eps.size(); ++k) {
                EXPECT_GE(found.eps[k], least);
                EXPECT_LE(found.eps[k], 1.0);
                sum += (1.0 - found.eps[k]) * w.cell_volume[k];
            }
            EXPECT_NEAR(sum, 0.2, 1e-12) << least;
        }
}

TEST(GridPorosity, WhatIsGatheredGoesWhereTheVolumeWent) {
    GridFluid f = box(12, 10, 8);
    const std::vector<Vec3> x = random_places(200, {0.4, 0.4, 0.3}, {0.6, 0.6, 0.5});
    const std::vector<double> volume(x.size(), 1e-3);
    const GridWeights w = weights(f, GaussianKernel{}, 0.08, x);
    const BoundedPorosity found = porosity(f, w, volume, 0.4);
    const Field<double> solid = per_volume(w, found.relief, volume);
    std::vector<Vec3> field(f.eps.size());
    for (std::size_t k = 0; k < field.size(); ++k)
        field[k] = Vec3(std::sin(0.1 * static_cast<double>(k)), 1.0, std::cos(0.7 * static_cast<double>(k)));
    Vec3 in_cells = Vec3::Zero(), at_grains = Vec3::Zero();
    for (std::size_t k = 0; k < field.size(); ++k) {
        EXPECT_NEAR(solid[k], 1.0 - found.eps[k], 1e-12);
        in_cells += w.cell_volume[k] * solid[k] * field[k];
    }
    found.relief.gather(field);
    for (std::size_t j = 0; j < x.size(); ++j)
        at_grains += volume[j] * w.cells.gathered(j, Vec3(Vec3::Zero()), [&](std::size_t k) { return field[k]; });
    EXPECT_LT((in_cells - at_grains).norm(), 1e-12);
}

TEST(CellFields, AreExactForWhatIsLinear) {
    GridFluid f = box(6, 10, 8);
    Eigen::Matrix3d gradient;
    gradient << 0.0, 2.0, -0.7, 0.0, 0.4, 1.1, 0.0, 0.3, -0.4; // does not depend on x
    for (std::size_t c = 0; c < 3; ++c)
        for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
            f.u[c][k] = (gradient * f.grid.face_centre(c, p))[static_cast<Eigen::Index>(c)];
        });
    for_each_place(f.grid.cells(),
                   [&](const Place& p, std::size_t k) { f.p[k] = Vec3(0.0, 5.0, -3.0).dot(f.grid.centre(p)); });
    const CellFields fields = cell_fields(f, true);
    for_each_place(f.grid.cells(), [&](const Place& p, std::size_t k) {
        if (p[1] < 2 || p[1] > 7 || p[2] < 2 || p[2] > 5) return; // away from the walls, which the field does not know
        EXPECT_TRUE(fields.gradient[k].isApprox(gradient, 1e-12));
        // along the stretched axis the sum over the cells is exact, and each to the second order of their widths'
        // growth
        EXPECT_NEAR(fields.stress[k][0], 0.0, 1e-11);
        EXPECT_NEAR(fields.stress[k][1], -5.0, 0.05);
        EXPECT_NEAR(fields.stress[k][2], 3.0, 1e-11);
    });
}

} // namespace
} // namespace plumb
