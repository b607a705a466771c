// A run that goes on from a checkpoint has the bits of the unbroken one; a file that is not whole is refused.
#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "run/checkpoint.hpp"
#include "run/checkpoint_fields.hpp"
#include "run/diff.hpp"
#include "run/hdf5_file.hpp"
#include "run/time_loop.hpp"

#include "checkpoint_bed_scene.hpp"
#include "checkpoint_scenes.hpp"
#include "corrected_grid_scene.hpp"
#include "drop_scene.hpp"
#include "lumps_scene.hpp"
#include "medium_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>
#include <unistd.h>

// HDF5 1.10 loses a few hundred bytes whenever it meets a damaged record; that is not ours to report. The sanitizer
// calls this function, by this name, if it is there.
extern "C" const char* __lsan_default_suppressions();                           // NOLINT
extern "C" const char* __lsan_default_suppressions() { return "leak:libhdf5"; } // NOLINT

namespace plumb {
namespace {

using testing::HasSubstr;
using namespace plumb::fixture::checkpoint_scenes;
namespace fs = std::filesystem;

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
    if (s.grid)
        for_each_grid_field(*s.grid, [&](const std::string&, const Field<double>& field) {
            for (const double x : field) put(x);
        });
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

TEST_F(CheckpointFiles, HoldNoTimeOfDay) {
    const auto run = made(passing);
    save_checkpoint(path("a.h5"), run, {});
    std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // the library's times are whole seconds
    save_checkpoint(path("b.h5"), run, {});
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

INSTANTIATE_TEST_SUITE_P(Scenes, Checkpoint,
                         testing::Values(dry, lumps, wet, flowing, passing, drop, published, on_grid, medium_on_grid,
                                         grains_on_grid, corrected_on_grid, bed));

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
