// The program from the outside: exit codes, one line per error, what is written and what is not.
#include "run/command_line.hpp"
#include "run/law_list.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <unistd.h>

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

constexpr const char* falling = R"(
[domain]
size = [0.01, 0.01, 1.0]
periodic = [true, true, false]
gravity = [0.0, 0.0, -9.81]
[grains]
name = "ball"
density = 2500.0
diameter = 1e-3
rotation = true
motion = "free"
arrange = {law = "single", position = [0.005, 0.005, 0.9]}
velocity = [0.0, 0.0, 0.0]
angular_velocity = [0.0, 0.0, 0.0]
contact = {law = "none"}
[time]
end = 0.1
output_interval = 0.01
integrator = "velocity_verlet"
step = 1e-3
snapshots = true
[[probe]]
name = "v"
quantity = "grain_velocity"
grain = 0
axis = "z"
)";

struct Answer {
    int code;
    std::string out, err;
};

class CommandLine : public testing::Test {
protected:
    CommandLine() : folder_((fs::path(testing::TempDir()) / ("plumb_cli_" + std::to_string(::getpid()))).string()) {
        fs::create_directories(folder_);
        std::ofstream(path("scene.toml")) << falling;
    }
    ~CommandLine() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }

    static Answer answer(std::vector<std::string> words) {
        words.insert(words.begin(), "plumb");
        std::vector<const char*> argv;
        for (const std::string& word : words) argv.push_back(word.c_str());
        testing::internal::CaptureStdout();
        testing::internal::CaptureStderr();
        const int code = program(static_cast<int>(argv.size()), argv.data());
        std::fflush(stdout);
        return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
    }
    /// Demands exit code `code` and exactly one line of complaint.
    static std::string complaint(const std::vector<std::string>& words, int code) {
        const Answer a = answer(words);
        EXPECT_EQ(a.code, code) << a.err;
        EXPECT_THAT(a.err, StartsWith("plumb: error: "));
        EXPECT_EQ(std::count(a.err.begin(), a.err.end(), '\n'), 1) << a.err;
        return a.err;
    }
    const std::string folder_;
};

TEST_F(CommandLine, RunWritesAResult) {
    const Answer a = answer({"run", path("scene.toml"), "-o", path("out"), "--threads", "1"});
    EXPECT_EQ(a.code, 0) << a.err;
    EXPECT_EQ(a.err, "");
    EXPECT_EQ(std::count(a.out.begin(), a.out.end(), '\n'), 12); // 11 outputs and the closing line
    for (const char* name : {"run.json", "series.h5", "checkpoint.h5", "result.xdmf", "snapshots/000010.h5"})
        EXPECT_TRUE(fs::exists(path("out/") + name)) << name;
    const auto info = nlohmann::json::parse(std::ifstream(path("out/run.json")));
    EXPECT_EQ(info["exit"], 0);
    EXPECT_EQ(info["steps"], 100);
    EXPECT_EQ(info["updates"], 100);
    EXPECT_EQ(info["step"], 1e-3);
    EXPECT_EQ(info["threads"], 1);
    for (const char* key :
         {"version", "commit", "dirty", "compiler", "flags", "scene", "scene_hash", "scene_path", "overrides",
          "processor", "start", "wall_s", "cpu_s", "peak_bytes", "ruling_limit", "limits"})
        EXPECT_TRUE(info.contains(key)) << key;
    EXPECT_GT(info["peak_bytes"], 1000000);
    EXPECT_EQ(answer({"diff", path("out"), path("out")}).code, 0);
}

TEST_F(CommandLine, QuietSaysNothing) {
    const Answer a = answer({"run", path("scene.toml"), "-o", path("out"), "--quiet"});
    EXPECT_EQ(a.code, 0);
    EXPECT_EQ(a.out + a.err, "");
}

TEST_F(CommandLine, SetReachesTheScene) {
    EXPECT_EQ(answer({"run", "--set", "time.end=0.05", "--set", "grains.density=1000.0", path("scene.toml"), "-o",
                      path("a"), "--quiet"})
                  .code,
              0);
    EXPECT_EQ(answer({"run", path("scene.toml"), "-o", path("b"), "--quiet"}).code, 0);
    const Answer a = answer({"diff", path("a"), path("b")});
    EXPECT_EQ(a.code, 1);
    EXPECT_THAT(a.out, StartsWith("different: series.h5 /v/"));
    const auto info = nlohmann::json::parse(std::ifstream(path("a/run.json")));
    EXPECT_EQ(info["overrides"], (std::vector<std::string>{"time.end=0.05", "grains.density=1000.0"}));
}

TEST_F(CommandLine, InputErrorsWriteNothing) {
    const std::string scene = path("scene.toml"), out = path("out");
    EXPECT_THAT(complaint({"run", path("none.toml"), "-o", out}, 2), HasSubstr("no such file"));
    EXPECT_THAT(complaint({"run", folder_, "-o", out}, 2), HasSubstr("is a directory"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--set", "fluid.density=nan"}, 2), HasSubstr("coupling"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--set", "grains.density=-1.0"}, 2), HasSubstr("grains.density"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--set", "grains.colour='red'"}, 2), HasSubstr("grains.colour"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--set", "time.step=3e-3"}, 2), HasSubstr("output_interval"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--set", "probe.0.quantity='x'"}, 2),
                HasSubstr("probe[0].quantity"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--threads", "0"}, 2), HasSubstr("threads"));
    EXPECT_THAT(complaint({"run", scene, "-o", out, "--fast"}, 2), HasSubstr("--fast"));
    EXPECT_THAT(complaint({"run"}, 2), HasSubstr("scene"));
    EXPECT_THAT(complaint({"walk"}, 2), HasSubstr(""));
    EXPECT_THAT(complaint({}, 2), HasSubstr("subcommand"));
    EXPECT_FALSE(fs::exists(out));
}

TEST_F(CommandLine, FolderOfSomethingElseIsKept) {
    fs::create_directories(path("photos"));
    std::ofstream(path("photos/a.jpg")) << "x";
    EXPECT_THAT(complaint({"run", path("scene.toml"), "-o", path("photos")}, 2), HasSubstr("no plumb result"));
    EXPECT_EQ(std::distance(fs::directory_iterator(path("photos")), fs::directory_iterator()), 1);
}

TEST_F(CommandLine, UnwritableOutputIsAnIoError) {
    EXPECT_THAT(complaint({"run", path("scene.toml"), "-o", "/proc/plumb"}, 4), HasSubstr("/proc/plumb"));
}

TEST_F(CommandLine, DivergedRunNamesWhatHappened) {
    // 1 m/s and a step of 10 ms carry a grain of 1 mm through the floor
    const std::string text =
        complaint({"run", path("scene.toml"), "-o", path("out"), "--quiet", "--set", "time.step=1e-2", "--set",
                   "grains.velocity=[0.0, 0.0, -1.0]", "--set",
                   "grains.contact={law='linear_spring', stiffness=1e3, restitution=0.5, friction=0.0}"},
                  3);
    for (const char* part : {"step 1", "grain 0", "contact limit", "last state in", "snapshots/diverged.h5"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_TRUE(fs::exists(path("out/snapshots/diverged.h5")));
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(path("out/run.json")))["exit"], 3);
}

TEST_F(CommandLine, ResumeOfACompleteRunChangesNothing) {
    EXPECT_EQ(answer({"run", path("scene.toml"), "-o", path("a"), "--quiet"}).code, 0);
    EXPECT_EQ(answer({"run", path("scene.toml"), "-o", path("b"), "--quiet"}).code, 0);
    EXPECT_EQ(answer({"resume", path("a"), "--quiet"}).code, 0);
    EXPECT_EQ(answer({"diff", path("a"), path("b")}).code, 0);
    EXPECT_THAT(complaint({"resume", path("none")}, 2), HasSubstr("no such result folder"));
    fs::remove(path("a/checkpoint.h5"));
    EXPECT_THAT(complaint({"resume", path("a")}, 2), HasSubstr("no checkpoint"));
}

TEST_F(CommandLine, CheckPrintsDerivedNumbersAndWritesNothing) {
    const std::vector<std::string> water{
        "--set", "fluid={method='prescribed', density=1000.0, viscosity=1e-3, flow={law='rest'}}", "--set",
        "coupling={direction='one_way', drag='stokes', forces=['pressure_gradient'], exchange='exponential'}"};
    std::vector<std::string> words{"check", path("scene.toml"), "--json"};
    words.insert(words.end(), water.begin(), water.end());
    const Answer a = answer(words);
    ASSERT_EQ(a.code, 0) << a.err;
    const auto j = nlohmann::json::parse(a.out);
    const auto& grain = j["fluid"]["grains"][0];
    const double tau_p = 2500.0 * 1e-6 / (18.0 * 1e-3);
    EXPECT_NEAR(grain["tau_p"].get<double>() / tau_p, 1.0, 1e-12);
    EXPECT_NEAR(grain["terminal_velocity"].get<double>() / (tau_p * 9.81), 1.0, 1e-12); // no buoyancy in this scene
    EXPECT_NEAR(grain["Re"].get<double>() / (1000.0 * tau_p * 9.81 * 1e-3 / 1e-3), 1.0, 1e-12);
    EXPECT_EQ(grain["density_ratio"], 2.5);
    EXPECT_EQ(j["time"]["steps"], 100);
    std::vector<std::string> missing, idle;
    for (const auto& r : j["missing"]) missing.push_back(r["model"]);
    for (const auto& r : j["idle"]) idle.push_back(r["model"]);
    EXPECT_THAT(missing, testing::ElementsAre("drag", "buoyancy", "virtual_mass", "basset"));
    EXPECT_THAT(idle, testing::ElementsAre("pressure_gradient"));
    const Answer text = answer({"check", path("scene.toml")});
    EXPECT_THAT(text.out, HasSubstr("100 steps"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(CommandLine, CheckNamesTheBondNumberOfBridges) {
    const std::string contact =
        "grains.contact={{law='linear_spring', stiffness=1e3, restitution=0.5, friction=0.0, "
        "cohesion={{law='liquid_bridge', surface_tension=0.07, contact_angle=0.5, volume={}}}}}";
    const Answer a =
        answer({"check", path("scene.toml"), "--json", "--set", fmt::format(fmt::runtime(contact), "1e-13")});
    ASSERT_EQ(a.code, 0) << a.err;
    const auto bridges = nlohmann::json::parse(a.out)["time"]["bridges"];
    ASSERT_FALSE(bridges.empty());
    const auto& pair = bridges[0];
    const double pull = 2.0 * std::numbers::pi * 5e-4 * 0.07 * std::cos(0.5); // d = 1 mm, of its like
    const double weight = 2500.0 * std::numbers::pi / 6.0 * 1e-9 * 9.81;
    EXPECT_NEAR(pair["Bo"].get<double>() * pull / weight, 1.0, 1e-12);
    EXPECT_NEAR(pair["largest_Bo"].get<double>() * pull / weight, 1.0, 1e-12);
    EXPECT_NEAR(pair["volume_over_R3"].get<double>(), 8e-4, 1e-15);
    EXPECT_THAT(answer({"check", path("scene.toml"), "--set", fmt::format(fmt::runtime(contact), "1e-13")}).out,
                HasSubstr("Bo = "));
    EXPECT_THAT(complaint({"check", path("scene.toml"), "--set", fmt::format(fmt::runtime(contact), "2e-11")}, 2),
                HasSubstr("cohesion.volume"));
}

TEST_F(CommandLine, LawsAndVersion) {
    const auto j = nlohmann::json::parse(answer({"laws", "--json"}).out);
    for (const LawFamily& family : law_families()) {
        ASSERT_EQ(j[family.name].size(), family.laws.size());
        for (const auto& law : j[family.name])
            for (const char* key : {"name", "formula", "range", "source"})
                EXPECT_NE(law[key].get<std::string>(), "") << law["name"];
    }
    EXPECT_EQ(j["coupling.drag"][0]["name"], "none");
    EXPECT_THAT(answer({"laws"}).out, HasSubstr("di_felice"));
    EXPECT_THAT(answer({"--version"}).out, StartsWith("plumb "));
    EXPECT_EQ(answer({"--help"}).code, 0);
}

} // namespace
} // namespace plumb
