// Inlets of a stated flow rate that open later, through a bored floor.
#include "sph/even_outlets.hpp"
#include "sph/open_boundaries.hpp"

#include "sph/vector_at.hpp"
#include "tests/sph_scene_fixtures.hpp"

#include <gtest/gtest.h>

#include <string>

using namespace plumb::fixture;
using namespace plumb::fixture::sph_scene;

namespace plumb {
namespace {

constexpr double flow_rate = 2e-6; // m3/s

/// A cylindrical cell of water, 8 mm wide and high, with a jet through a bore of 3 mm from 10 ms on.
std::string cell(const std::string& jet) {
    return "[domain]\nsize = [8e-3, 8e-3, 8e-3]\nperiodic = [false, false, false]\ngravity = [0.0, 0.0, 0.0]\n"
           "[fluid]\nmethod = \"sph\"\ndensity = 1000.0\nviscosity = 1e-2\nspacing = 1e-3\nsmoothing = 1.5\n"
           "kernel = \"wendland_c2\"\nequation_of_state = \"linear\"\noperators = \"plain\"\nsound_speed = 4.0\n"
           "pressure = \"dynamic\"\nviscous_term = \"morris\"\narrange = {law = \"lattice\"}\n"
           "initial = {law = \"rest\"}\n"
           "[[wall]]\nname = \"side\"\nshape = \"cylinder\"\nside = \"inside\"\npoint = [4e-3, 4e-3, 0.0]\n"
           "axis = [0.0, 0.0, 1.0]\nradius = 4e-3\nslip = \"no_slip\"\n"
           "[[wall]]\nname = \"floor\"\nshape = \"bored_plane\"\npoint = [4e-3, 4e-3, 0.0]\n"
           "normal = [0.0, 0.0, 1.0]\nradius = 1.5e-3\nslip = \"no_slip\"\n"
           "[[inlet]]\nname = \"jet\"\npoint = [4e-3, 4e-3, 0.0]\nnormal = [0.0, 0.0, 1.0]\naveraging_time = 0.01\n" +
           jet +
           "[[outlet]]\nname = \"top\"\npoint = [4e-3, 4e-3, 8e-3]\nnormal = [0.0, 0.0, -1.0]\n"
           "averaging_time = 0.01\npressure = 0.0\neven = true\n"
           "[time]\nend = 0.2\noutput_interval = 0.1\nintegrator = \"damped_midpoint\"\nstep = 1e-4\n";
}

const std::string pipe = "profile = {law = \"parabolic\", mean_speed = 1.0, radius = 1.5e-3}\nflow_rate = 2e-6\n";

} // namespace

// A profile that is not scaled brings in 3.5 times the stated flow here, one scaled by its integral what 12 rows make
// of it.
TEST(SphInlets, BringInTheFlowRate) {
    std::string scene = cell(pipe);
    scene.replace(scene.find("even = true"), 11, ""); // an even outlet may hand back a layer of new particles
    Bench bench(scene);
    const SphFluid& f = bench.fluid();
    const std::int32_t begun = f.next_id;
    advance(bench.simulation, 500); // 0.05 s, a hundred particles in
    const double volume = static_cast<double>(f.next_id - begun) * f.mass / f.density;
    EXPECT_NEAR(volume / 0.05, flow_rate, 0.1 * flow_rate); // of 12 rows each may be half a particle ahead
}

// An even outlet that lets a jet through, or lets more out than comes in: 0.4 s, twice the cell's water, of which rows
// by themselves lose three quarters.
TEST(SphInlets, AnEvenOutletKeepsTheCellFull) {
    std::string scene = cell(pipe);
    scene.replace(
        scene.find("viscosity = 1e-2"), 16,
        "viscosity = 1e-2\ndensity_diffusion = 0.1\nshifting = 4.0\nreference_velocity = 0.1\nfilling_time = 0.1");
    scene.replace(scene.find("step = 1e-4"), 11, "step = 5e-5");
    Bench bench(scene);
    const SphFluid& f = bench.fluid();
    const std::size_t before = f.particles;
    double jump = 0.0, mass = mass_inside(f); // a layer that took all within its reach was several particles off
    for (int k = 0; k < 400; ++k) {
        advance(bench.simulation, 20);
        jump = std::max(jump, std::abs(mass_inside(f) - mass) / f.mass);
        mass = mass_inside(f);
    }
    EXPECT_LT(jump, 1.0); // half a particle by the layer, the rest by rows that are not in step
    EXPECT_GT(f.next_id - static_cast<std::int32_t>(before), 600); // 800 come in, of 400 in the cell
    EXPECT_NEAR(mass, f.mass_at_start, 0.01 * f.mass_at_start);
}

// What is inside does not depend on how near the floor it is, whether the bore is there or not.
TEST(SphInlets, CountWhatPassesNotWhatIsNear) {
    Bench bench(cell(pipe));
    SphFluid& f = bench.fluid();
    const double before = mass_inside(f);
    for (const std::int32_t k : ordered_slots(f)) f.x[2][static_cast<std::size_t>(k)] *= 0.9;
    EXPECT_EQ(mass_inside(f), before);
}

// A closed inlet is a wall; it opens linearly.
TEST(SphInlets, OpenWhenTheyAreTold) {
    Bench bench(cell(pipe + "opens = {from = 0.1, over = 0.05}\n"));
    const SphFluid& f = bench.fluid();
    const std::int32_t begun = f.next_id;
    advance(bench.simulation, 999);
    EXPECT_EQ(f.next_id, begun);
    EXPECT_EQ(f.particles, static_cast<std::size_t>(begun));
    for (const std::int32_t k : ordered_slots(f))
        EXPECT_LT(vector_at(f.v, static_cast<std::size_t>(k), 3).norm(), 1e-12);
    advance(bench.simulation, 251); // half way
    EXPECT_NEAR(f.open_sides[0].opening, 0.5, 0.01);
    EXPECT_NEAR(f.open_sides[0].inflow(Vec3(4e-3, 4e-3, 0.0), 3), 0.5 * f.open_sides[0].scale * 2.0, 0.02);
    EXPECT_EQ(f.open_sides[1].opening, 1.0);
}

// Fields that no particle has given their size yet when the first ones come in; an inlet whose speed answers to what
// little is before it.
TEST(SphInlets, FillAnEmptyVesselOfGrains) {
    std::string scene = cell(pipe + "rigid = true\n");
    const auto replace = [&](const std::string& what, const std::string& by) {
        scene.replace(scene.find(what), what.size(), by);
    };
    for (std::size_t at = 0; (at = scene.find("slip = ", at)) != std::string::npos; at += 20)
        scene.insert(at, "holds = \"fluid\"\n"); // grains are held where they are
    const std::size_t outlet = scene.find("[[outlet]]");
    scene.erase(outlet, scene.find("[time]") - outlet);
    replace("arrange = {law = \"lattice\"}", "free_surface = true\nfill = {law = \"nothing\"}\nartificial_viscosity = "
                                             "0.1\ndensity_diffusion = 0.3\narrange = {law = \"lattice\"}");
    scene +=
        "[grains]\nname = \"seed\"\ndensity = 2000.0\ndiameter = 1e-3\nrotation = false\nmotion = \"fixed\"\n"
        "arrange = {law = \"lattice\", kind = \"cubic\", spacing = 2e-3, lower = [3e-3, 3e-3, 3e-3], upper = [6e-3, "
        "6e-3, 7e-3]}\nvelocity = [0.0, 0.0, 0.0]\ncontact = \"none\"\n"
        "[coupling]\ndirection = \"two_way\"\nkernel = \"wendland_c2\"\nkernel_width = {times_smoothing = 1.0}\n"
        "porosity = \"kernel\"\nown_volume = \"included\"\nfluid_mass = \"displaced\"\npressure_force = \"shared\"\n"
        "drag = \"gidaspow\"\nforces = [\"pressure_gradient\"]\nexchange = \"exponential\"\nself_disturbance = "
        "\"none\"\nsuspension_viscosity = \"none\"\n";
    replace("step = 1e-4", "step = 1e-4\ngrain_step = 1e-4");
    Bench bench(scene);
    const SphFluid& f = bench.fluid();
    EXPECT_EQ(f.particles, 0U);
    advance(bench.simulation, 300); // 30 ms
    double mass = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k)
        if (f.id[k] >= 0) mass += f.mass * f.share[k];
    EXPECT_NEAR(mass / f.density / 0.03, flow_rate, 0.1 * flow_rate); // of 12 rows each may be half a particle ahead
}

TEST(SphInlets, RefuseWhatCannotBe) {
    expect_refused(cell("profile = {law = \"uniform\", speed = 1.0}\nflow_rate = 0.0\n"), {"inlet", "flow_rate"});
    expect_refused(cell(pipe + "opens = {from = 0.1}\n"), {"opens", "over"});
    std::string narrow = cell(pipe);
    narrow.replace(narrow.find("radius = 1.5e-3"), 15, "radius = 0.4e-3");
    expect_refused(narrow, {"fluid.spacing", "no row of particles", "jet"});
    expect_refused(cell(pipe) + "[[outlet]]\nname = \"hole\"\npoint = [4e-3, 4e-3, 8e-3]\nnormal = [0.0, 0.0, -1.0]\n"
                                "averaging_time = 0.01\npressure = 0.0\n",
                   {"outlet", "even"});
}

} // namespace plumb
