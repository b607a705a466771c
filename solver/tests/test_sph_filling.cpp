// Densities that follow how full the room is.
#include "sph/filling.hpp"

#include "schemes/advance_fluid.hpp"
#include "sph_scene_fixtures.hpp"

#include <gtest/gtest.h>

using namespace plumb::fixture;
using namespace plumb::fixture::sph_scene;

namespace plumb {
namespace {

/// C of a particle by plain sums over a lattice whose particles have `part` of their room.
double lattice_fill(double spacing, double h, int dimensions, double part) {
    double sum = 0.0;
    const int deep = dimensions == 3 ? 4 : 0;
    for (int i = -4; i <= 4; ++i)
        for (int j = -4; j <= 4; ++j)
            for (int l = -deep; l <= deep; ++l) {
                const double q = spacing * std::sqrt(i * i + j * j + l * l) / h;
                if (q < 2.0)
                    sum += WendlandC2::w(q) * WendlandC2::sigma(dimensions) * std::pow(spacing / h, dimensions);
            }
    return part * sum;
}

} // namespace

// Particles that take a fifth too little room in one half of a box, by plain sums; the mean stays.
TEST(SphFilling, FollowsHowFullTheRoomIs) {
    for (const int d : {2, 3}) {
        Bench bench(scene_text(d, {{"filling_time", "0.25"}}, {{"gravity", d == 2 ? "[0, 0]" : "[0, 0, 0]"}}));
        SphFluid& f = bench.fluid();
        for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] = f.x[0][k] < 0.5 ? 1250.0 : 1000.0;
        start(f);
        f.drho.assign(f.slots(), 0.0);
        follow_filling(f);
        double sum = 0.0;
        const double low = lattice_fill(0.05, 0.075, d, 0.8), high = lattice_fill(0.05, 0.075, d, 1.0);
        for (std::size_t k = 0; k < f.slots(); ++k) {
            if (f.id[k] < 0) continue;
            sum += f.drho[k] / f.rho[k];
            if (std::abs(f.x[0][k] - 0.25) >= 0.09)
                continue; // the mean is that of both halves, since sums are symmetric
            EXPECT_NEAR(f.drho[k], 1250.0 * 0.5 * (low - high) / 0.25, 1e-9 * 1250.0);
        }
        EXPECT_LT(std::abs(sum), 1e-9);
    }
}

// A fluid a fifth too thin all over, with a free surface: its inside draws together, its surface, where the sum is half
// in any case, does not.
TEST(SphFilling, IsNotForSurfaces) {
    for (const int d : {2, 3}) {
        Bench bench(scene_text(d, {{"filling_time", "0.25"}, {"free_surface", "true"}},
                               {{"gravity", d == 2 ? "[0, 0]" : "[0, 0, 0]"},
                                {"periodic", d == 2 ? "[false, true]" : "[false, true, true]"}}));
        SphFluid& f = bench.fluid();
        for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] = 1250.0;
        start(f);
        f.drho.assign(f.slots(), 0.0);
        follow_filling(f);
        const double full = lattice_fill(0.05, 0.075, d, 0.8);
        int inside = 0, outside = 0;
        for (std::size_t k = 0; k < f.slots(); ++k) {
            if (f.id[k] < 0) continue;
            const double depth = std::min(f.x[0][k], f.domain.size[0] - f.x[0][k]);
            if (depth < 0.05) {
                EXPECT_EQ(f.drho[k], 0.0);
                ++outside;
            } else if (depth > 0.15) {
                EXPECT_NEAR(f.drho[k], 1250.0 * (full - 1.0) / 0.25, 1e-9 * 1250.0);
                ++inside;
            }
        }
        EXPECT_GT(std::min(inside, outside), 10);
    }
}

TEST(SphFilling, RefusesWhatIsNotFull) {
    expect_refused(scene_text(2, {{"filling_time", "0.0"}}), {"fluid.filling_time"});
    expect_refused(scene_text(2, {{"background_pressure", "1.0"}, {"free_surface", "true"}}),
                   {"fluid.background_pressure", "free surface"});
    expect_refused(scene_text(2, {{"background_pressure", "-1.0"}}), {"fluid.background_pressure"});
}

} // namespace plumb
