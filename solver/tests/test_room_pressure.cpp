// The pressure's force on fluid and grains as the derivative of one energy.
#include "coupling/room_pressure.hpp"

#include "coupled_fixtures.hpp"
#include "schemes/advance_fluid.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

const Keys shared{{"coupling.pressure_force", "\"shared\""}};

/// Grains in a cylinder and between two planes that hold them and mirror them, in a periodic fluid that goes on beyond.
std::string pot() {
    return coupled_scene_text({{"coupling.pressure_force", "\"shared\""},
                               {"coupling.at_walls", "\"mirrored\""},
                               {"coupling.mean_pressure_gradient", ""},
                               {"fluid.viscosity", "1e-12"},
                               {"grains.arrange", "{law = \"random\", count = 80, lower = [4e-4, 4e-4, 4e-4], "
                                                  "upper = [1.2e-3, 1.2e-3, 1.2e-3], seed = 3}"}}) +
           "[[wall]]\nname = \"side\"\nshape = \"cylinder\"\nside = \"inside\"\npoint = [8e-4, 8e-4, 0]\n"
           "axis = [0, 0, 1]\nradius = 4.2e-4\nholds = \"grains\"\ncontact = \"none\"\n"
           "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 4.5e-4]\nnormal = [0, 0, 1]\nholds = "
           "\"grains\"\n"
           "contact = \"none\"\n"
           "[[wall]]\nname = \"roof\"\nshape = \"plane\"\npoint = [0, 0, 1.15e-3]\nnormal = [0, 0, -1]\n"
           "holds = \"grains\"\ncontact = \"none\"\n";
}

/// eps of every particle when fluid and grains have gone on for `ahead` [s] with their velocities, by plain sums.
std::vector<double> eps_ahead(CoupledBench& bench, double ahead) {
    Coupling& c = *bench.simulation.coupling;
    const SphFluid& f = bench.fluid();
    GrainPlaces places = c.places;
    for (std::size_t k = 0; k < bench.grains().size(); ++k)
        places.x[static_cast<std::size_t>(bench.grains().id[k])] += ahead * bench.grains().v[k];
    place_mirrors(places.mirrored, bench.simulation.grains.walls, places.x, places.volume);
    const double h = c.weights.h.porosity;
    std::vector<double> eps(f.slots(), 1.0);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const Vec3 at = entry(f, f.x, k) + ahead * entry(f, f.v, k);
        const auto take = [&](const Vec3& x, double volume) {
            const double q = f.domain.minimum_image(at - x).norm() / h;
            if (q < 2.0) eps[k] -= volume * WendlandC2::sigma(3) / (h * h * h) * WendlandC2::w(q);
        };
        for (std::size_t j = 0; j < places.size(); ++j) take(places.x[j], places.volume[j]);
        for (std::size_t q = 0; q < places.mirrored.size(); ++q) take(places.mirrored.x[q], places.mirrored.volume[q]);
    }
    return eps;
}

/// A bench whose fluid is compressed and stirred, with everything evaluated where it is.
void evaluate_here(CoupledBench& bench, std::vector<Vec3>& stress) {
    SphFluid& f = bench.fluid();
    Coupling& c = *bench.simulation.coupling;
    stir(bench);
    for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] *= 1.0 + 0.02 * std::sin(3.0 * f.id[k]);
    start(f);
    choose_mirrors(c, f, bench.simulation.grains);
    renew_weights(c.weights, f, c.places);
    place_grains(c.weights, f.domain, c.places);
    set_porosity(f, c.weights);
    evaluate_middle(f, 0.0, 1);
    add_room_pressure(f, c.weights);
    stress.resize(c.places.size());
    gather_room_pressure(c.weights, f, c.places.mirrored, bench.simulation.grains.walls, c.places.x, stress);
}

/// The pressure's work is what compression stores, and what wetting the grains takes from it.
void expect_no_work_but_stored(CoupledBench& bench) {
    std::vector<Vec3> stress;
    evaluate_here(bench, stress);
    const SphFluid& f = bench.fluid();
    const double ahead = 3e-6; // 1e-8 m of 2e-4
    const std::vector<double> before = eps_ahead(bench, -ahead), now = eps_ahead(bench, 0.0),
                              after = eps_ahead(bench, ahead);
    double power = 0.0, stored = 0.0, size = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k) {
        if (f.id[k] < 0) continue;
        EXPECT_NEAR(now[k], f.eps[k], 1e-12);
        power += f.mass * f.share[k] * entry(f, f.a, k).dot(entry(f, f.v, k));
        const double rate = f.drho[k] / f.rho[k] - (after[k] - before[k]) / (2.0 * ahead * f.eps[k]);
        const double p = pressure(f, f.rho[k] * f.share[k] / f.eps[k]);
        stored += f.eps[k] * p * f.mass / f.rho[k] * rate;
        size += std::abs(f.eps[k] * p * f.mass / f.rho[k] * rate);
        const double wetted = (1.0 - f.eps[k]) * f.drho[k] / f.rho[k] + (after[k] - before[k]) / (2.0 * ahead);
        stored += f.wetting_pressure * f.mass / f.rho[k] * wetted; // - kappa d/dt sum V (1 - eps)
        size += std::abs(f.wetting_pressure * f.mass / f.rho[k] * wetted);
    }
    for (std::size_t k = 0; k < bench.grains().size(); ++k) {
        const auto id = static_cast<std::size_t>(bench.grains().id[k]);
        power += bench.simulation.coupling->places.volume[id] * stress[id].dot(bench.grains().v[k]);
    }
    EXPECT_GT(bench.simulation.coupling->places.mirrored.size(), 200U);
    EXPECT_LT(std::abs(power + stored), 1e-6 * size);
}

} // namespace

// Work of the pressure that is not what compression stores: a gradient of the porosity with the wrong sign or width, a
// mirror whose part the grain does not get, at the planes, at the cylinder or in their corners.
TEST(RoomPressure, DoesNoWorkButCompression) {
    CoupledBench bench(pot());
    expect_no_work_but_stored(bench);
}

// Sums of masses in one of the two, of volumes in the other: particles here have rooms that differ by half.
TEST(RoomPressure, DoesNoWorkButCompressionByVolumes) {
    std::string text = pot();
    const std::string key = "operators = \"plain\"";
    text.replace(text.find(key), key.size(), "operators = \"volume_weighted\"");
    CoupledBench bench(text);
    SphFluid& f = bench.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) f.rho[k] *= 1.0 + 0.2 * std::sin(static_cast<double>(f.id[k]));
    expect_no_work_but_stored(bench);
}

// Capillarity that grains do not feel, or that water feels within itself.
TEST(RoomPressure, WettingTakesItsEnergy) {
    CoupledBench without(pot()), with(pot());
    expect_no_work_but_stored(without);
    with.fluid().wetting_pressure = 40.0;
    expect_no_work_but_stored(with);
    double apart = 0.0;
    for (std::size_t k = 0; k < with.fluid().slots(); ++k)
        apart = std::max(apart, std::abs(with.fluid().a[2][k] - without.fluid().a[2][k]));
    EXPECT_GT(apart, 1e-3);
}

// What the grains get and the fluid does not lose.
TEST(RoomPressure, MomentumAndBits) {
    Keys keys = shared;
    expect_momentum_and_bits(keys);
    keys["coupling.porosity_width"] = "{times_diameter = 3.0}"; // further than forces are spread
    expect_momentum_and_bits(keys);
}

TEST(RoomPressure, RefusesWhatItCannot) {
    const auto refused = [](Keys keys, std::initializer_list<std::string_view> parts) {
        keys.emplace("coupling.pressure_force", "\"shared\"");
        expect_error([&] { CoupledBench bad(keys); }, parts);
    };
    refused({{"coupling.porosity", "\"overlap\""}}, {"coupling.pressure_force", "porosity"});
    refused({{"coupling.forces", "[\"buoyancy\"]"}, {"coupling.mean_pressure_gradient", ""}},
            {"coupling.pressure_force", "pressure_gradient"});
    const auto refused_pot = [](const std::string& key, const std::string& value, std::string_view part) {
        std::string text = pot();
        text.replace(text.find(key), key.size(), value);
        expect_error([&] { CoupledBench bad(text); }, {part});
    };
    refused_pot("at_walls = \"mirrored\"", "at_walls = \"cut\"", "coupling.pressure_force");
    refused_pot("radius = 4.2e-4", "radius = 3.5e-4", "narrower than the kernel's reach");
    refused({{"fluid.background_pressure", "1.0"}, {"coupling.pressure_force", "\"gathered\""}},
            {"coupling.pressure_force", "background_pressure", "shared"});
}

// A background that grains feel, or that is taken for pressure where the fluid's is read.
TEST(RoomPressure, KnowsNoBackground) {
    CoupledBench without(pot()), with(pot());
    with.fluid().background_pressure = 3.0;
    std::vector<Vec3> stress, stress_with;
    evaluate_here(without, stress);
    evaluate_here(with, stress_with);
    for (std::size_t k = 0; k < stress.size(); ++k) EXPECT_LT((stress[k] - stress_with[k]).norm(), 1e-9 * 3.0 / 2e-4);
    double felt = 0.0; // the particles do feel it: they are not on a lattice of equal volumes
    for (std::size_t k = 0; k < with.fluid().slots(); ++k)
        felt = std::max(felt,
                        (entry(with.fluid(), with.fluid().a, k) - entry(without.fluid(), without.fluid().a, k)).norm());
    EXPECT_GT(felt, 0.0);
}

// A reaction that is taken off the water twice: held grains in water that a wave of pressure has just begun to move
// feel half of its acceleration times the step, not less by phi/eps, here 0.6.
TEST(RoomPressure, IsNoLossOfTheFluid) {
    Keys keys = shared;
    keys["grains.motion"] = "\"fixed\"";
    keys["grains.diameter"] = "1.2e-4";
    keys["grains.arrange"] = "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], "
                             "upper = [1.6e-3, 1.6e-3, 1.6e-3], spacing = 1.3333333333333333e-4}";
    keys["coupling.mean_pressure_gradient"] = "";
    keys["time.step"] = "1e-5";
    CoupledBench bench(keys);
    SphFluid& f = bench.fluid();
    const double wave = 2.0 * std::numbers::pi / 1.6e-3;
    for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] *= 1.0 + 1e-4 * std::sin(wave * f.x[0][k]);
    advance(bench.simulation, 1);
    const FluidOnGrains& on = *bench.simulation.fluid;
    const double d = 1.2e-4;
    int steep = 0;
    for (std::size_t k = 0; k < bench.grains().size(); ++k) {
        const auto id = static_cast<std::size_t>(bench.grains().id[k]);
        if (std::abs(std::cos(wave * bench.grains().x[k][0])) < 0.5) continue;
        ++steep;
        const double slip = 0.5 * 1e-5 * on.at_grains.stress[id][0] / f.density;
        const double expected =
            drag_resistance(on.drag, f.density, f.viscosity, d, on.at_grains.eps[id], std::abs(slip)) * slip;
        EXPECT_NEAR(on.last_drag[id][0], expected, 0.1 * std::abs(expected));
    }
    EXPECT_GT(steep, 500);
}
