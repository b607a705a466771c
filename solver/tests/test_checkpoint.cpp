// A run that goes on from a checkpoint has the bits of the unbroken one; a file that is not whole is refused.
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "run/checkpoint.hpp"
#include "run/diff.hpp"
#include "run/hdf5_file.hpp"
#include "run/time_loop.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

// HDF5 1.10 loses a few hundred bytes whenever it meets a damaged record; that is not ours to report. The sanitizer
// calls this function, by this name, if it is there.
extern "C" const char* __lsan_default_suppressions();                           // NOLINT
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; } // NOLINT

namespace plumb {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// Grains of two sizes fall on a floor and on each other, rub, roll; more are injected.
constexpr const char* dry = R"(
[domain]
size = [0.012, 0.012, 0.03]
periodic = [true, true, false]
gravity = [0.5, 0.0, -9.81]
[[grains]]
name = "sand"
density = 2500.0
diameter = {law = "uniform", minimum = 0.9e-3, maximum = 1.3e-3, seed = 3}
rotation = true
motion = "free"
arrange = {law = "random", count = 150, lower = [0.0, 0.0, 0.001], upper = [0.012, 0.012, 0.012], seed = 4}
velocity = {law = "uniform_random", speed = 0.5, seed = 5}
angular_velocity = [0.0, 100.0, 0.0]
contact = {law = "linear_spring", stiffness = 1000.0, restitution = 0.8, friction = 0.5, tangential_stiffness = 300.0, tangential_damping = 0.01, rolling = {law = "elastic_plastic", friction = 0.1, stiffness = 1e-6, damping = 0.3}}
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
contact = "as_grains"
[[injector]]
group = "sand"
diameter = 1e-3
points = [[0.006, 0.006, 0.025]]
interval = 2e-3
velocity = [0.0, 0.0, -1.0]
start = 0.0
end = 1.0
[time]
end = 0.02
output_interval = 2e-3
integrator = "velocity_verlet"
step = "auto"
snapshots = true
[[probe]]
name = "energy"
quantity = "grain_kinetic_energy"
[[probe]]
name = "weight"
quantity = "wall_force"
wall = "floor"
axis = "z"
)";

/// A few grains in an oscillating fluid with every force that remembers something.
constexpr const char* wet = R"(
[domain]
size = [0.01, 0.01, 0.01]
periodic = [true, true, true]
gravity = [0.0, 0.0, -9.81]
[fluid]
method = "prescribed"
density = 1000.0
viscosity = 1e-3
flow = {law = "oscillating", amplitude = [0.05, 0.0, 0.0], frequency = 50.0}
[grains]
name = "glass"
density = 2500.0
diameter = 5e-4
rotation = true
motion = "free"
arrange = {law = "random", count = 30, lower = [0.0, 0.0, 0.0], upper = [0.01, 0.01, 0.01], seed = 1}
velocity = {law = "uniform_random", speed = 0.05, seed = 2}
angular_velocity = [0.0, 0.0, 0.0]
contact = {law = "hertz_mindlin", young = 1e6, poisson = 0.3, restitution = 0.7, friction = 0.3, rolling = "none"}
[coupling]
direction = "one_way"
drag = "schiller_naumann"
forces = ["buoyancy", "pressure_gradient", "virtual_mass", "basset"]
exchange = "exponential"
basset = {law = "exponentials", count = 8, window = 0.1}
[time]
end = 0.02
output_interval = 2e-3
integrator = "velocity_verlet"
step = "auto"
[[probe]]
name = "drag"
quantity = "grain_drag_force"
axis = "z"
[[probe]]
name = "force"
quantity = "grain_fluid_force"
axis = "x"
)";

/// A channel with open ends and a roof that comes down: boundary particles that move, appear and vanish.
constexpr const char* passing = R"(
[domain]
size = [1.0, 0.8]
periodic = [false, false]
gravity = [0.0, 0.0]
[fluid]
method = "sph"
density = 1000.0
viscosity = 10.0
spacing = 0.05
smoothing = 1.5
kernel = "wendland_c2"
equation_of_state = "linear"
sound_speed = 20.0
pressure = "full"
viscous_term = "morris"
operators = "plain"
density_diffusion = 0.1
shifting = 1.0
reference_velocity = 1.0
arrange = {law = "jittered", jitter = 0.1, seed = 1}
initial = {law = "channel", mean_speed = 1.0, centre = 0.4, half_width = 0.4}
[[wall]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
slip = "no_slip"
[[wall]]
name = "roof"
shape = "plane"
point = [0.0, 0.8]
normal = [0.0, -1.0]
slip = "no_slip"
velocity = [0.0, -0.02]
[[inlet]]
name = "in"
point = [0.0, 0.4]
normal = [1.0, 0.0]
averaging_time = 0.1
profile = {law = "parabolic", mean_speed = 1.0, radius = 0.4}
[[outlet]]
name = "out"
point = [1.0, 0.4]
normal = [-1.0, 0.0]
averaging_time = 0.1
pressure = 0.0
[time]
end = 1.0
output_interval = 0.1
integrator = "damped_midpoint"
step = 2e-4
[[probe]]
name = "mean"
quantity = "fluid_mean_velocity"
axis = "x"
)";

/// Smoothed particles with every term, jittered so that lists are renewed often.
constexpr const char* flowing = R"(
[domain]
size = [1.0, 1.0]
periodic = [true, true]
gravity = [0.0, 0.0]
[fluid]
method = "sph"
density = 1.0
viscosity = 0.01
spacing = 0.05
smoothing = 1.5
kernel = "wendland_c2"
equation_of_state = "tait"
sound_speed = 10.0
pressure = "full"
operators = "plain"
viscous_term = "morris"
density_diffusion = 0.1
artificial_viscosity = 0.02
shifting = 4.0
reference_velocity = 1.0
arrange = {law = "jittered", jitter = 0.1, seed = 1}
initial = {law = "taylor_green", speed = 1.0}
[time]
end = 0.2
output_interval = 0.02
integrator = "midpoint"
step = "auto"
snapshots = true
[[probe]]
name = "energy"
quantity = "fluid_kinetic_energy"
)";

class CheckpointFiles : public testing::Test {
protected:
    CheckpointFiles()
        : folder_((fs::path(testing::TempDir()) / ("plumb_checkpoint_" + std::to_string(::getpid()))).string()) {
        fs::create_directories(folder_);
    }
    ~CheckpointFiles() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    const std::string folder_;
};

class Checkpoint : public CheckpointFiles, public testing::WithParamInterface<const char*> {};

std::string content(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

plumb::Run made(const char* text) { return make_run(scene_from_text(text, "scene.toml", "/")); }

/// Every bit of the state, in the order of ids.
std::vector<std::uint64_t> bits(const Simulation& s) {
    std::vector<std::uint64_t> all;
    const Grains& g = s.grains.grains;
    const auto put = [&](double x) { all.push_back(std::bit_cast<std::uint64_t>(x)); };
    for (const std::int32_t k : positions_of_ids(g)) {
        const auto at = static_cast<std::size_t>(k);
        for (const auto* field : {&g.x, &g.turns, &g.v, &g.a, &g.omega, &g.alpha})
            for (int c = 0; c < 3; ++c) put((*field)[at][c]);
        put(g.radius[at]), put(g.mass[at]), put(g.mobility[at]);
    }
    if (!s.sph) return all;
    for (const auto field : {&BoundaryParticles::x, &BoundaryParticles::mirror})
        for (std::size_t c = 0; c < 2; ++c)
            for (const double x : (s.sph->boundary.*field)[c]) put(x);
    for (const std::int32_t slot : ordered_slots(*s.sph)) {
        const auto at = static_cast<std::size_t>(slot);
        for (std::size_t c = 0; c < 2; ++c) put(s.sph->x[c][at]), put(s.sph->v[c][at]), put(s.sph->a[c][at]);
        put(s.sph->rho[at]), put(s.sph->drho[at]);
    }
    return all;
}

TEST_P(Checkpoint, GoesOnBitForBit) {
    auto unbroken = made(GetParam());
    for (const std::int64_t steps : {1, 7, 100, 500}) {
        advance(unbroken.simulation, steps);
        record(unbroken.probes, unbroken.simulation);
        save_checkpoint(path("c.h5"), unbroken, {});
        auto resumed = load_checkpoint(path("c.h5"));
        EXPECT_EQ(bits(resumed.simulation), bits(unbroken.simulation));
        EXPECT_EQ(resumed.probes[0].value, unbroken.probes[0].value);
        Simulation copy = unbroken.simulation;
        advance(copy, 150);
        advance(resumed.simulation, 150);
        EXPECT_EQ(resumed.simulation.grains.time, copy.grains.time);
        EXPECT_EQ(bits(resumed.simulation), bits(copy)) << "from step " << unbroken.simulation.grains.step;
    }
}

TEST_P(Checkpoint, SavedAgainIsTheSameState) {
    auto run = made(GetParam());
    advance(run.simulation, 333);
    save_checkpoint(path("a.h5"), run, {});
    save_checkpoint(path("b.h5"), load_checkpoint(path("a.h5")), {});
    EXPECT_EQ(content(path("a.h5")), content(path("b.h5")));
}

TEST_P(Checkpoint, RunsAreTheSameForAnyNumberOfThreads) {
    for (const int threads : {1, 2}) {
        set_threads(threads);
        auto run = made(GetParam());
        run_to_end(run, ResultFolder::fresh(path(std::to_string(threads))), true);
    }
    set_threads(1);
    const Comparison found = difference(path("1"), path("2"));
    EXPECT_TRUE(found.same) << found.text;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Checkpoint, testing::Values(dry, wet, flowing, passing));

std::string complaint(const std::string& path) {
    try {
        load_checkpoint(path);
    } catch (const IoError& e) {
        EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
        return std::string("io: ") + e.what();
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
        return std::string("input: ") + e.what();
    }
    return "no complaint";
}

TEST_F(CheckpointFiles, BrokenFilesAreRefused) {
    auto run = made(dry);
    advance(run.simulation, 50);
    save_checkpoint(path("c.h5"), run, {});
    const std::string whole = content(path("c.h5"));
    for (std::size_t k = 0; k < 10; ++k) {
        std::ofstream(path("cut.h5"), std::ios::binary) << whole.substr(0, whole.size() * k / 10);
        EXPECT_THAT(complaint(path("cut.h5")), HasSubstr("io: ")) << k;
    }
    EXPECT_THAT(complaint(path("none.h5")), HasSubstr("No such file"));
    {
        Hdf5Writer file(path("other.h5"));
        file.write("x", std::vector<double>{1.0});
        file.finish();
    }
    EXPECT_THAT(complaint(path("other.h5")), HasSubstr("no plumb checkpoint"));
}

TEST_F(CheckpointFiles, FlippedBitsNeverPassUnseen) {
    auto run = made(dry);
    advance(run.simulation, 50);
    save_checkpoint(path("c.h5"), run, {});
    const std::string whole = content(path("c.h5"));
    int refused = 0, harmless = 0;
    for (std::size_t at = 40; at < whole.size(); at += whole.size() / 97) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
        std::ofstream(path("d.h5"), std::ios::binary) << damaged;
        const std::string found = complaint(path("d.h5"));
        if (found != "no complaint") {
            ++refused;
            continue;
        }
        ++harmless; // the bit belongs to unused space of the file
        EXPECT_EQ(bits(load_checkpoint(path("d.h5")).simulation), bits(run.simulation)) << at;
    }
    EXPECT_GT(refused, 50);
}

TEST_F(CheckpointFiles, OtherFormatOrSceneIsAnInputError) {
    {
        Hdf5Writer file(path("new.h5"));
        file.attribute("/", "format", std::string("plumb checkpoint"));
        file.attribute("/", "format_version", std::int64_t{1000});
        file.finish();
    }
    EXPECT_THAT(complaint(path("new.h5")), HasSubstr("input: "));
    EXPECT_THAT(complaint(path("new.h5")), HasSubstr("format 1000"));
}

TEST_F(CheckpointFiles, DiffNamesTheFirstDifference) {
    const auto result = [&](const std::string& name, const std::vector<std::string>& overrides) {
        auto run = make_run(scene_from_text(dry, "scene.toml", "/", overrides));
        run_to_end(run, ResultFolder::fresh(path(name)), true);
    };
    result("a", {});
    result("b", {});
    result("c", {"domain.gravity.0=0.500001"});
    result("d", {"time.end=0.018"});
    EXPECT_TRUE(difference(path("a"), path("b")).same);
    const Comparison c = difference(path("a"), path("c"));
    EXPECT_FALSE(c.same);
    EXPECT_THAT(c.text, HasSubstr("series.h5 /energy/value at t = 0.002"));
    EXPECT_THAT(c.text, HasSubstr("index 1: "));
    EXPECT_THAT(difference(path("a"), path("d")).text, HasSubstr("11 entries against 10"));
    EXPECT_THROW(difference(path("a"), path("nothing")), InputError);
}

} // namespace
} // namespace plumb
