// Diffusion and shifting of the fluid among grains.
#include "coupling/own_density.hpp"

#include "coupled_fixtures.hpp"
#include "schemes/advance_fluid.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

const Keys evened{{"fluid.density_diffusion", "0.1"}, {"fluid.shifting", "1.0"}, {"fluid.reference_velocity", "1e-2"}};

/// Densities of the fluid itself as given; masses of the particles as if they had come from elsewhere, unless `alike`.
template <class OwnDensity> void set_own_density(SphFluid& f, OwnDensity&& law, bool alike = false) {
    for (std::size_t k = 0; k < f.slots(); ++k) {
        f.share[k] = alike ? f.eps[k] : f.eps[k] * (1.0 + 0.3 * std::sin(5.0 * f.id[k]));
        f.rho[k] = law(entry(f, f.x, k)) * f.eps[k] / f.share[k];
    }
    start(f); // records
    f.drho.assign(f.slots(), 0.0);
}

/// Of a box 1.6 mm high what no kernel reaches across its periodic sides.
bool is_inside(const SphFluid& f, std::size_t k) { return f.id[k] >= 0 && std::abs(f.x[2][k] - 8e-4) < 3e-4; }

} // namespace

// A term that mixes densities of particles, which differ with their masses and the porosity, or one that carries
// pressure down a steady gradient.
TEST(OwnDensity, LeavesALinearOneAlone) {
    CoupledBench bench(evened);
    SphFluid& f = bench.fluid();
    const double slope = 5000.0; // kg/m4
    set_own_density(f, [&](const Vec3& x) { return 1000.0 + slope * (x[2] - 8e-4); });
    even_out_own_density(f, bench.simulation.coupling->weights);
    const double rate = 2.0 * 0.1 * f.sound_speed / f.h; // 1/s
    for (std::size_t k = 0; k < f.slots(); ++k)
        EXPECT_TRUE(!is_inside(f, k) || std::abs(f.drho[k]) < 1e-10 * rate * slope * 8e-4) << f.drho[k];
}

// A wave on a lattice against sums by hand: the plain diffusion's factor, and what the gradients take off it.
TEST(OwnDensity, DiffusesAsTheSumsOfItsLatticeSay) {
    Keys keys = evened;
    keys["grains.arrange"] = "{law = \"single\", position = [8e-4, 8e-4, 8e-4]}";
    keys["grains.diameter"] = "1e-6";
    keys["coupling.kernel_width"] = "2e-4";
    CoupledBench bench(keys);
    SphFluid& f = bench.fluid();
    const double wave_number = 4.0 * std::numbers::pi / 1.6e-3, amplitude = 0.1, dx = f.spacing, h = f.h;
    set_own_density(
        f, [&](const Vec3& x) { return 1000.0 + amplitude * std::cos(wave_number * x[0]); }, true);
    even_out_own_density(f, bench.simulation.coupling->weights);
    double gradient = 0.0, moment = 0.0, plain = 0.0;
    for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j)
            for (int l = -3; l <= 3; ++l) {
                const Vec3 r = dx * Vec3(i, j, l);
                const double q = r.norm() / h;
                if (q >= 2.0) continue;
                const double slope = -WendlandC2::sigma(3) / std::pow(h, 5) * WendlandC2::f(q) * dx * dx * dx;
                gradient += slope * r[0] * std::sin(wave_number * r[0]);
                moment += slope * r[0] * r[0];
                plain += slope * (std::cos(wave_number * r[0]) - 1.0);
            }
    const double factor = 2.0 * 0.1 * h * f.sound_speed * (plain + 0.5 * gradient * gradient / moment);
    EXPECT_LT(factor, 0.0); // it decays, and less than without the gradients
    EXPECT_GT(factor, 0.9 * 2.0 * 0.1 * h * f.sound_speed * plain);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        if (f.id[k] < 0) continue;
        EXPECT_NEAR(f.drho[k], factor * amplitude * std::cos(wave_number * f.x[0][k]),
                    2e-3 * std::abs(factor) * amplitude);
    }
}

// What a shift changes: the own density stays on its field, and the room that grains leave is the new place's.
TEST(OwnDensity, ShiftedParticlesTakeTheRoomOfTheirNewPlace) {
    CoupledBench bench(evened);
    SphFluid& f = bench.fluid();
    const double slope = 200.0, own_slope = 3000.0; // 1/m, kg/m4
    for (std::size_t k = 0; k < f.slots(); ++k) f.eps[k] = 0.6 + slope * (f.x[2][k] - 8e-4);
    set_own_density(f, [&](const Vec3& x) { return 1000.0 + own_slope * (x[2] - 8e-4); });
    for (std::size_t k = 0; k < f.slots(); ++k) f.spread[0][k] = f.spread[1][k] = 1.0, f.spread[2][k] = 2.0;
    even_out_own_density(f, bench.simulation.coupling->weights);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        if (!is_inside(f, k)) continue;
        const double own = f.rho[k] * f.share[k] / f.eps[k];
        EXPECT_NEAR(f.drho_spread[k], 2.0 * (own_slope * f.eps[k] + own * slope) / f.share[k], 1e-6 * own * slope);
    }
}

// Diffusion keeps momentum; with shifting, which gives particles the velocities of their new places, bits are the same.
TEST(OwnDensity, MomentumAndBits) {
    expect_momentum_and_bits({{"fluid.density_diffusion", "0.1"}});
    CoupledBench one(evened), four(evened);
    const auto run = [](CoupledBench& bench, int n) {
        const Threads threads(n);
        stir(bench);
        advance(bench.simulation, 20);
    };
    run(one, 1), run(four, 4);
    expect_same_state(one, four);
}
