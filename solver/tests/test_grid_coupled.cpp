// Grains in a fluid on a grid.
#include "core/errors.hpp"
#include "schemes/simulation.hpp"

#include "coupling/drag_laws.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace plumb {
namespace {

using Changes = std::map<std::string, std::string>;

constexpr const char* scene_format = R"(
[domain]
size = [1.6e-3, 1.6e-3, 1.6e-3]
periodic = {}
gravity = {}
[fluid]
method = "grid"
dimensions = 3
density = 1000.0
viscosity = 1e-3
{}
initial = {{law = "rest"}}
{}
[grains]
name = "grain"
diameter = 1e-4
density = 2500.0
rotation = false
motion = {}
velocity = {}
contact = {}
arrange = {}
[coupling]
direction = {}
kernel = {}
kernel_width = {{times_diameter = {}}}
drag = {}
forces = {}
exchange = {}
own_volume = {}
least_porosity = 0.2
self_disturbance = {}
suspension_viscosity = "none"
{}
[time]
end = 1.0
output_interval = 1.0
integrator = {}
step = {}
grain_step = "auto"
)";

/// Grains of 0.1 mm in water in a periodic cube of 1.6 mm, their weight carried by the mean pressure gradient.
std::string scene_text(const Changes& changes = {}) {
    Changes values{{"gravity", "[1.0, 0.0, -9.81]"},
                   {"fluid", "spacing = 2e-4\nadvection = \"central\"\npressure = \"dynamic\"\nresidual = 1e-10"},
                   {"motion", "\"free\""},
                   {"contact", "\"none\""},
                   {"velocity", "[0.0, 0.0, 0.0]"},
                   {"arrange",
                    "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = [1.6e-3, 1.6e-3, 1.6e-3], "
                    "spacing = 2e-4}"},
                   {"walls", ""},
                   {"drag", "\"di_felice\""},
                   {"exchange", "\"exponential\""},
                   {"forces", "[\"buoyancy\", \"pressure_gradient\", \"virtual_mass\"]"},
                   {"kernel", "\"gaussian\""},
                   {"width", "1.5"},
                   {"own_volume", "\"included\""},
                   {"self", "\"none\""},
                   {"mean", "mean_pressure_gradient = \"balances_weight\""},
                   {"integrator", "\"implicit_euler\""},
                   {"step", "1e-4"},
                   {"periodic", "[true, true, true]"},
                   {"direction", "\"two_way\""}};
    for (const auto& [key, value] : changes) values[key] = value;
    return fmt::format(fmt::runtime(scene_format), values["periodic"], values["gravity"], values["fluid"],
                       values["walls"], values["motion"], values["velocity"], values["contact"], values["arrange"],
                       values["direction"], values["kernel"], values["width"], values["drag"], values["forces"],
                       values["exchange"], values["own_volume"], values["self"], values["mean"], values["integrator"],
                       values["step"]);
}

Simulation simulation(const Changes& changes) {
    Scene scene = scene_from_text(scene_text(changes), "scene.toml", "/");
    return make_simulation(scene);
}

/// Of grains, fluid, and what one owes the other; `scale` is the sum of the grains' parts without regard to sign.
struct Momentum {
    Vec3 sum = Vec3::Zero();
    double scale = 0.0;
};
Momentum momentum(const Simulation& s) {
    Momentum all;
    const Grains& g = s.grains.grains;
    for (std::size_t k = 0; k < g.size(); ++k) {
        all.sum += g.mass[k] * g.v[k] - s.grid_coupling->owed[static_cast<std::size_t>(g.id[k])];
        all.scale += g.mass[k] * g.v[k].norm();
    }
    const GridFluid& f = *s.grid;
    for (std::size_t c = 0; c < 3; ++c)
        for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
            all.sum[static_cast<Eigen::Index>(c)] +=
                f.density * face_eps(f, c, p) * s.grid_coupling->weights.face_volume[c][k] * f.u[c][k];
        });
    return all;
}

const std::string single = "{law = \"single\", position = [0.71e-3, 0.83e-3, 0.92e-3]}";

TEST(GridCoupled, MomentumIsKeptForStepsOfAnyLength) {
    // tau_p = 1.4e-3 s. Steps are first order, so the porosity, which stays, has to be uniform in time: a lattice.
    for (const char* step : {"1e-4", "1e-2", "0.5"})
        for (const char* exchange : {"\"exponential\"", "\"implicit\""}) {
            Simulation s = simulation({{"step", step},
                                       {"exchange", exchange},
                                       {"velocity", "[0.01, 0.0, 0.02]"},
                                       {"forces", "[\"buoyancy\", \"pressure_gradient\"]"}});
            const Vec3 before = momentum(s).sum;
            for (int k = 0; k < 4; ++k) {
                advance(s, 1);
                const Momentum now = momentum(s);
                EXPECT_LT((now.sum - before).norm(), 1e-7 * now.scale) << step << " " << exchange << " " << k;
            }
        }
}

TEST(GridCoupled, SlipRelaxesToOneVelocityWhateverTheStep) {
    // without weight grains and fluid end at their common mean velocity: 1/8 pi/6 of the room at 2500, the rest at 1000
    const double solid = 0.125 * std::numbers::pi / 6.0;
    const double common = 0.03 * 2500.0 * solid / (2500.0 * solid + 1000.0 * (1.0 - solid));
    for (const char* step : {"2.5e-4", "2.5e-3", "1e-1"}) {
        Simulation s = simulation({{"step", step},
                                   {"gravity", "[0.0, 0.0, 0.0]"},
                                   {"mean", ""},
                                   {"forces", "[\"pressure_gradient\"]"},
                                   {"velocity", "[0.03, 0.0, 0.0]"}});
        advance(s, static_cast<std::int64_t>(0.03 / std::stod(step)) + 2);
        for (const Vec3& v : s.grains.grains.v) EXPECT_LT((v - Vec3(common, 0.0, 0.0)).norm(), 2e-4 * common) << step;
    }
}

TEST(GridCoupled, DenseFreeGrainsComeTogetherInLongSteps) {
    // 50 relaxation times a step; half of the room; where the way or the stress of the step's start is taken this grows
    for (const char* forces : {"[]", "[\"pressure_gradient\"]"})
        for (const char* integrator : {"\"implicit_euler\"", "\"bdf2\""}) {
            Simulation s =
                simulation({{"step", "6.25e-2"},
                            {"integrator", integrator},
                            {"gravity", "[0.0, 0.0, 0.0]"},
                            {"mean", ""},
                            {"drag", "\"stokes\""},
                            {"forces", forces},
                            {"arrange", "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.0], upper = "
                                        "[1.6e-3, 1.6e-3, 1.6e-3], spacing = 1e-4}"},
                            {"velocity", "{law = \"uniform_random\", speed = 1e-7, seed = 3}"}});
            advance(s, 12);
            const std::vector<Vec3>& v = s.grains.grains.v;
            Vec3 mean = Vec3::Zero(); // which nothing stops
            for (const Vec3& one : v) mean += one / static_cast<double>(v.size());
            double greatest = 0.0;
            for (const Vec3& one : v) greatest = std::max(greatest, (one - mean).norm());
            EXPECT_LT(greatest, 1e-9) << forces << " " << integrator;
            // the room that the fluid was taken to have is the whole box less the grains
            const GridFluid& f = *s.grid;
            double taken = 0.0;
            for (const double eps : f.eps_taken) taken += eps / static_cast<double>(f.eps_taken.size());
            EXPECT_NEAR(taken, 1.0 - std::numbers::pi / 6.0, 1e-9);
        }
}

/// Volume of the fluid as its mass equation has it [m3], and what flows out of the box along z, less what flows in
/// [m3/s].
double volume_taken(const GridFluid& f) {
    const Field<double>& eps = f.eps_taken.empty() ? f.eps : f.eps_taken;
    double sum = 0.0;
    for_each_place(f.grid.cells(), [&](const Place& p, std::size_t k) { sum += eps[k] * f.grid.cell_volume(p); });
    return sum;
}
double net_outflow(const GridFluid& f) {
    double sum = 0.0;
    for_each_place(f.grid.faces(2), [&](const Place& p, std::size_t k) {
        if (p[2] == 0) sum -= open_area(f, 2, p) * f.u[2][k];
        if (p[2] == f.grid.axis[2].cells()) sum += open_area(f, 2, p) * f.u[2][k];
    });
    return sum;
}

TEST(GridCoupled, NoVolumeIsLostWhereGrainsFollowTheStreamOut) {
    const std::string ends = R"(
body_force = [0.0, 0.0, 0.0]
[[inlet]]
name = "in"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
profile = {law = "uniform", speed = 0.05}
[[outlet]]
name = "out"
point = [0.0, 0.0, 1.6e-3]
normal = [0.0, 0.0, -1.0]
pressure = 0.0
)";
    for (const char* step : {"1e-3", "5e-3"}) {
        Simulation s =
            simulation({{"walls", ends},
                        {"periodic", "[true, true, false]"},
                        {"arrange", "{law = \"lattice\", kind = \"cubic\", lower = [0.0, 0.0, 0.43e-3], upper = "
                                    "[1.6e-3, 1.6e-3, 1.58e-3], spacing = 1.1428571428571429e-4}"},
                        {"velocity", "[0.0, 0.0, 0.02]"},
                        {"mean", ""},
                        {"gravity", "[0.0, 0.0, 0.0]"},
                        {"forces", "[\"pressure_gradient\"]"},
                        {"step", step}});
        for (int k = 0; k < 6; ++k) {
            const double before = volume_taken(*s.grid);
            advance(s, 1);
            const double gained = volume_taken(*s.grid) - before;
            EXPECT_NEAR(gained, -s.timing.dt * net_outflow(*s.grid), 1e-8 * before) << step << " " << k;
        }
    }
}

TEST(GridCoupled, AGrainIsHeldOrFree) {
    // a grain on the floor of a channel that is blown upwards against the roof: contacts hold it, drag pulls it
    const std::string walls = R"(
body_force = [0.0, 0.0, 0.0]
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
slip = "free_slip"
contact = "as_grains"
[[wall]]
name = "roof"
shape = "plane"
point = [0.0, 0.0, 1.6e-3]
normal = [0.0, 0.0, -1.0]
slip = "free_slip"
contact = "as_grains"
)";
    Simulation s = simulation({{"walls", walls},
                               {"periodic", "[true, true, false]"},
                               {"arrange", "{law = \"single\", position = [0.7e-3, 0.8e-3, 0.055e-3]}"},
                               {"contact", "{law = \"linear_spring_coulomb\", stiffness = 1.0, restitution = 0.1, "
                                           "friction = 0.0, rolling = \"none\"}"},
                               {"mean", ""},
                               {"gravity", "[0.0, 0.0, -9.81]"},
                               {"step", "2e-3"}});
    advance(s, 1);
    EXPECT_LT(s.grid_coupling->freedom[0], 0.9); // it reached the floor in the first step
    advance(s, 10);
    EXPECT_LT(s.grid_coupling->freedom[0], 1e-3);
    Simulation falling = simulation({{"arrange", single}, {"step", "2e-3"}});
    advance(falling, 5);
    EXPECT_EQ(falling.grid_coupling->freedom[0], 1.0);
}

TEST(GridCoupled, FixedGrainsFeelWhatTheFluidLoses) {
    Simulation s = simulation({{"motion", "\"fixed\""},
                               {"gravity", "[0.0, 0.0, 0.0]"},
                               {"mean", "mean_pressure_gradient = [-100.0, 0.0, 0.0]"},
                               {"forces", "[\"pressure_gradient\"]"},
                               {"step", "0.05"}});
    advance(s, 60);
    // all of the gradient ends on the grains: 100 Pa/m over the cube
    Vec3 sum = Vec3::Zero();
    for (const Vec3& f : s.fluid->last_fluid_force) sum += f;
    EXPECT_NEAR(sum[0], 100.0 * 1.6e-3 * 1.6e-3 * 1.6e-3, 1e-9 * sum[0]);
    EXPECT_NEAR(sum[1], 0.0, 1e-9 * sum[0]);
}

TEST(GridCoupled, OneWayLeavesTheFluidAlone) {
    Simulation s = simulation({{"direction", "\"one_way\""}, {"mean", ""}, {"arrange", single}});
    advance(s, 30);
    for (std::size_t c = 0; c < 3; ++c)
        for (const double u : s.grid->u[c]) EXPECT_LT(std::abs(u), 1e-12);
    EXPECT_LT(s.grains.grains.v[0][2], -1e-3);
}

std::string corrected(const std::string& history = "unsteady") {
    return "{law = \"oseen_brinkman\", history = \"" + history + "\", advection = \"slip\", structure = \"lone\"}";
}

// 21 tau_p; the goal for widths from two diameters on is 1 % of the speed that the drag law has. Steps that are longer
// than tau_p see the same wake.
TEST(GridCoupled, CorrectedGrainFallsAsTheLawSays) {
    const auto speed = [](const std::string& self, const std::string& step, const std::string& integrator) {
        Simulation s = simulation({{"arrange", single},
                                   {"gravity", "[0.0, 0.0, -9.81]"},
                                   {"forces", "[\"buoyancy\", \"pressure_gradient\"]"},
                                   {"width", "2.0"},
                                   {"fluid", "spacing = 2e-4\nadvection = \"central\"\npressure = \"dynamic\"\n"
                                             "residual = 1e-6"},
                                   {"self", self},
                                   {"step", step},
                                   {"integrator", integrator}});
        advance(s, std::lround(0.03 / std::stod(step)));
        return -s.grains.grains.v[0][2];
    };
    const double u_t = 6.922e-3; // Di Felice, this grain in this water
    for (const char* step : {"1e-3", "1e-2"})
        for (const char* integrator : {"\"bdf2\"", "\"implicit_euler\""})
            EXPECT_NEAR(speed(corrected(), step, integrator) / u_t, 1.0, 1e-2) << step << " " << integrator;
    EXPECT_GT(speed("\"none\"", "1e-3", "\"bdf2\"") / u_t, 1.02);
}

// The lattice has to stay one, as in the test without the correction: in steps of 0.5 s, 350 tau_p, it lasts for one.
TEST(GridCoupled, CorrectionKeepsMomentum) {
    for (const char* history : {"unsteady", "steady"})
        for (const auto& [step, steps] : {std::pair{"1e-4", 4}, std::pair{"1e-2", 4}, std::pair{"0.5", 1}}) {
            Simulation s = simulation({{"step", step},
                                       {"self", corrected(history)},
                                       {"width", "2.0"},
                                       {"velocity", "[0.01, 0.0, 0.02]"},
                                       {"forces", "[\"buoyancy\", \"pressure_gradient\"]"}});
            const Vec3 before = momentum(s).sum;
            for (int k = 0; k < steps; ++k) {
                advance(s, 1);
                const Momentum now = momentum(s);
                EXPECT_LT((now.sum - before).norm(), 1e-7 * now.scale) << step << " " << history << " " << k;
            }
        }
}

TEST(GridCoupled, WhatCannotBeMeantIsRefused) {
    const auto refused = [](const Changes& changes, const std::string& part) {
        try {
            simulation(changes);
            ADD_FAILURE() << "no error: " << part;
        } catch (const InputError& e) {
            EXPECT_THAT(e.what(), testing::HasSubstr(part));
        }
    };
    refused({{"kernel", "\"box\""}}, "coupling.kernel");
    refused({{"direction", "\"one_way\""}}, "mean_pressure_gradient");
    refused({{"fluid", "spacing = 8e-4\nadvection = \"central\"\npressure = \"dynamic\"\nresidual = 1e-10"},
             {"kernel", "\"wendland_c2\""}},
            "kernel_width");
    refused({{"fluid", "spacing = 2e-4\nadvection = \"central\"\npressure = \"full\"\nresidual = 1e-10"}}, "buoyancy");
    refused({{"self", corrected()}, {"direction", "\"one_way\""}, {"mean", ""}}, "no wake");
    refused({{"self", corrected()}, {"own_volume", "\"excluded\""}}, "own_volume");
    refused({{"self", corrected()}, {"kernel", "\"wendland_c2\""}}, "kernel_width");
    refused(
        {{"self", corrected()},
         {"fluid", "spacing = [1e-4, 2e-4, 1e-4]\nadvection = \"central\"\npressure = \"dynamic\"\nresidual = 1e-10"}},
        "equal cubes");
}

} // namespace
} // namespace plumb
