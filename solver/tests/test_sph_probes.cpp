// Probes of the smoothed particles.
#include "sph_scene_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;
using namespace plumb::fixture::sph_scene;

namespace {

/// Value of one probe at the start of a scene after change(fluid).
template <class Change> double probed(const std::string& probe, const Keys& fluid, int dimensions, Change&& change) {
    Bench bench(scene_text(dimensions, fluid, {}, "[[probe]]\nname = \"p\"\n" + probe));
    change(bench.fluid());
    record(bench.probes, bench.simulation);
    return bench.probes.front().value.front();
}
double probed(const std::string& probe, const Keys& fluid = {}, int dimensions = 2) {
    return probed(probe, fluid, dimensions, [](SphFluid&) {});
}

/// Gives one particle a velocity; its copies, if it has any, follow as in a run.
void push(SphFluid& f, std::int32_t id, const Vec3& v) {
    std::size_t k = slots_by_id(f)[static_cast<std::size_t>(id)];
    do {
        for (int c = 0; c < f.dimensions; ++c) f.v[static_cast<std::size_t>(c)][k] = v[c];
    } while (++k < f.slots() && f.id[k] < 0);
}

} // namespace

// Probes that count copies, forget a factor or a component, or take the wrong axis.
TEST(SphScene, ProbesByHand) {
    const auto kick = [](SphFluid& f) { // particle 5: x = 0.275, y = 0.025, in space z = 0.025
        push(f, 5, f.dimensions == 2 ? Vec3(3.0, 4.0, 0.0) : Vec3(3.0, 4.0, 12.0));
    };
    EXPECT_NEAR(probed("quantity = \"fluid_kinetic_energy\"", {}, 2, kick), 12.5 / 320.0, 1e-15);
    EXPECT_NEAR(probed("quantity = \"fluid_kinetic_energy\"", {}, 3, kick), 84.5 / 3840.0, 1e-15);
    EXPECT_EQ(probed("quantity = \"fluid_greatest_speed\"", {}, 2, kick), 5.0);
    EXPECT_EQ(probed("quantity = \"fluid_greatest_speed\"", {}, 3, kick), 13.0);
    EXPECT_NEAR(probed("quantity = \"fluid_mean_velocity\"\naxis = \"y\"", {}, 2, kick), 4.0 / 320.0, 1e-15);
    EXPECT_NEAR(probed("quantity = \"fluid_mean_velocity\"\naxis = \"z\"", {}, 3, kick), 12.0 / 3840.0, 1e-15);
    const std::string wave = "quantity = \"fluid_velocity_wave\"\nwaves = 3\naxis = \"y\"\nalong = \"x\"\nshape = ";
    EXPECT_NEAR(probed(wave + "\"sin\"", {}, 2, kick), 8.0 / 320.0 * std::sin(6.0 * pi * 0.275), 1e-15);
    EXPECT_NEAR(probed(wave + "\"cos\"", {}, 2, kick), 8.0 / 320.0 * std::cos(6.0 * pi * 0.275), 1e-15);
}

// The moment about the origin, or of copies: 20 and 16 particles 0.05 m apart, (n^2 - 1)/12 spacings squared.
TEST(SphScene, SecondMoment) {
    const std::string probe = "quantity = \"fluid_second_moment\"\naxis = ";
    EXPECT_NEAR(probed(probe + "\"x\""), 399.0 / 12.0 * 0.0025, 1e-14);
    EXPECT_NEAR(probed(probe + "\"y\""), 255.0 / 12.0 * 0.0025, 1e-14);
    expect_refused(scene_text(2, {}, {}, "[[probe]]\nname = \"p\"\n" + probe + "\"z\""), {"axis", "z"});
}

// Particles weighed by number instead of room, or those outside the box.
TEST(SphScene, MeanPressureOfABox) {
    const auto press = [](SphFluid& f) {
        for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] = f.density * (f.x[0][k] < 0.5 ? 1.01 : 1.02);
    };
    const Keys linear{{"equation_of_state", "\"linear\""}}; // p = c^2 (rho - rho_0): 4000 and 8000 Pa
    const std::string probe = "quantity = \"fluid_mean_pressure\"\n";
    EXPECT_NEAR(probed(probe + "lower = [0.0, 0.0]\nupper = [0.5, 0.8]", linear, 2, press), 4000.0, 1e-8);
    EXPECT_NEAR(probed(probe + "lower = [0.0, 0.0]\nupper = [1.0, 0.8]", linear, 2, press),
                (4000.0 / 1.01 + 8000.0 / 1.02) / (1.0 / 1.01 + 1.0 / 1.02), 1e-8);
}

// The wave's amplitude is not that of the wave: sums of sin^2 over a lattice are exactly n/2.
TEST(SphScene, WaveProbeFindsTheAmplitude) {
    for (const int d : {2, 3}) {
        const Keys wave{{"initial", "{law = \"shear_wave\", speed = 0.3, waves = 2}"}};
        const std::string probe = "quantity = \"fluid_velocity_wave\"\naxis = \"x\"\nalong = \"y\"\n";
        EXPECT_NEAR(probed(probe + "waves = 2\nshape = \"sin\"", wave, d), 0.3, 1e-13);
        EXPECT_NEAR(probed(probe + "waves = 2\nshape = \"cos\"", wave, d), 0.0, 1e-13);
        EXPECT_NEAR(probed(probe + "waves = 1\nshape = \"sin\"", wave, d), 0.0, 1e-13);
        EXPECT_NEAR(probed("quantity = \"fluid_kinetic_energy\"", wave, d), 0.25 * 0.09, 1e-13);
        EXPECT_NEAR(probed("quantity = \"fluid_mean_velocity\"\naxis = \"x\"", wave, d), 0.0, 1e-13);
    }
}

// A third component read in the plane, where it does not exist.
TEST(SphScene, BadProbesAreInputErrors) {
    const std::string head = "[[probe]]\nname = \"p\"\nquantity = ";
    const std::string wave = head + "\"fluid_velocity_wave\"\nwaves = 1\nshape = \"sin\"\n";
    expect_refused(scene_text(2, {}, {}, head + "\"fluid_mean_velocity\"\naxis = \"z\""), {"probe[0].axis", "z"});
    expect_refused(scene_text(2, {}, {}, wave + "axis = \"z\"\nalong = \"x\""), {"probe[0].axis", "z"});
    expect_refused(scene_text(2, {}, {}, wave + "axis = \"x\"\nalong = \"z\""), {"probe[0].along", "z"});
    expect_refused(scene_text(3, {}, {}, wave + "axis = \"x\""), {"probe[0].along: missing"});
    expect_refused(scene_text(3, {}, {}, head + "\"fluid_mean_velocity\"\naxis = \"w\""), {"probe[0].axis", "w"});
}
