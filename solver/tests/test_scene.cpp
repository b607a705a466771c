// The loader of scenes: every kind of bad file and override gives one clear line.
#include "core/errors.hpp"
#include "core/scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace plumb {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class SceneFile : public testing::Test {
protected:
    SceneFile() : folder_(fs::path(testing::TempDir()) / ("plumb_scene_" + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
    }
    ~SceneFile() override { fs::remove_all(folder_); }
    std::string written(const std::string& content) const {
        std::ofstream(folder_ / "scene.toml", std::ios::binary) << content;
        return (folder_ / "scene.toml").string();
    }
    const fs::path folder_;
};

std::string complaint(const std::string& path, const std::vector<std::string>& overrides = {}) {
    try {
        load_scene(path, overrides);
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
        return e.what();
    }
    return "no complaint";
}

std::string override_complaint(const std::string& change,
                               const std::string& text = "a = 1\n[t]\nb = 2\n[[g]]\nd = 1.0\n") {
    try {
        scene_from_text(text, "s.toml", "/", {change});
    } catch (const InputError& e) {
        EXPECT_THAT(e.what(), Not(HasSubstr("\n")));
        return e.what();
    }
    return "no complaint";
}

TEST_F(SceneFile, BadFilesAreInputErrorsOfOneLine) {
    EXPECT_THAT(complaint((folder_ / "none.toml").string()), HasSubstr("no such file"));
    EXPECT_THAT(complaint(folder_.string()), HasSubstr("is a directory"));
    EXPECT_THAT(complaint("/dev/null"), HasSubstr("not a regular file"));
    EXPECT_THAT(complaint(written("")), HasSubstr("is empty"));
    EXPECT_THAT(complaint(written("# only a comment\n\n")), HasSubstr("is empty"));
    EXPECT_THAT(complaint(written("[domain\nsize = 1\n")), HasSubstr("line 1, column"));
    EXPECT_THAT(complaint(written("a = 1\nb = = 2\n")), HasSubstr("line 2, column 5"));
    EXPECT_THAT(complaint(written("a = 1\na = 2\n")), HasSubstr("not valid TOML"));
    EXPECT_THAT(complaint(written(std::string("a = 1\0b = 2", 11))), HasSubstr("not valid TOML"));
    EXPECT_THAT(complaint(written("\x7f\x45LF\x02\x01\x01")), HasSubstr("not valid TOML"));
}

TEST_F(SceneFile, HugeFileIsRefusedUnread) {
    const std::string path = written("a = 1\n");
    fs::resize_file(path, (16U << 20U) + 1);
    EXPECT_THAT(complaint(path), HasSubstr("too large"));
}

TEST_F(SceneFile, KeepsWhereItCameFrom) {
    const Scene scene = load_scene(written("[domain]\nsize = [1.0, 2.0, 3.0]\n"), {"domain.extra=true"});
    EXPECT_EQ(scene.path, (folder_ / "scene.toml").string());
    EXPECT_EQ(scene.folder, folder_.string());
    EXPECT_EQ(scene.overrides, std::vector<std::string>{"domain.extra=true"});
    EXPECT_THAT(scene.text, HasSubstr("extra = true"));
}

TEST(SceneText, ReadAgainGivesTheSameBits) {
    const std::string text =
        "a = 0.1\nb = 1e-300\nc = 3.3333333333333335e-1\nd = -0.0\ne = [1, 2.5, 7e22]\nf = 'x\"y'\n"
        "[t]\nu = {law = \"w\", v = [[1.0, 2.0], [3.0, 4.0]]}\n[[p]]\nn = 1\n[[p]]\nn = 2\n";
    const Scene once = scene_from_text(text, "s", "/");
    const Scene twice = scene_from_text(once.text, "s", "/");
    EXPECT_EQ(once.data, twice.data);
    EXPECT_EQ(once.text, twice.text);
    EXPECT_EQ(once.hash, twice.hash);
    EXPECT_EQ(*twice.data["a"].value<double>(), 0.1);
    EXPECT_EQ(*twice.data["e"][2].value<double>(), 7e22);
    EXPECT_TRUE(std::signbit(*twice.data["d"].value<double>()));
}

TEST(SceneText, HashIsFnv1a) {
    // Test vectors of RFC 9923, appendix C.
    EXPECT_EQ(fnv1a64(""), 0xcbf29ce484222325U);
    EXPECT_EQ(fnv1a64("a"), 0xaf63dc4c8601ec8cU);
    EXPECT_EQ(fnv1a64("foobar"), 0x85944171f73967e8U);
    const Scene a = scene_from_text("x = 1", "s", "/"), b = scene_from_text("x = 2", "s", "/");
    EXPECT_NE(a.hash, b.hash);
    EXPECT_EQ(a.hash.substr(0, 8), "fnv1a64:");
    EXPECT_EQ(a.hash.size(), 8U + 16U);
}

TEST(Overrides, ReplaceAndAddValues) {
    const std::string text = "a = 1\n[t]\nb = 2\n[[g]]\nd = 1.0\n[[g]]\nd = 2.0\nv = [1.0, 2.0]\n";
    const Scene s = scene_from_text(
        text, "s", "/",
        {"a=2.5", "t.c='new'", "g.1.d={law = \"uniform\", minimum = 1.0}", "g.1.v.0=7.0", "u.w.x=[1, 2]", "t.b = 3"});
    EXPECT_EQ(*s.data["a"].value<double>(), 2.5);
    EXPECT_EQ(*s.data["t"]["c"].value<std::string>(), "new");
    EXPECT_EQ(*s.data["g"][1]["d"]["law"].value<std::string>(), "uniform");
    EXPECT_EQ(*s.data["g"][0]["d"].value<double>(), 1.0);
    EXPECT_EQ(*s.data["g"][1]["v"][0].value<double>(), 7.0);
    EXPECT_EQ(*s.data["u"]["w"]["x"][1].value<int>(), 2);
    EXPECT_EQ(*s.data["t"]["b"].value<int>(), 3);
}

TEST(Overrides, ComplainClearly) {
    EXPECT_THAT(override_complaint("a"), HasSubstr("expected key.path=value"));
    EXPECT_THAT(override_complaint("=1"), HasSubstr("expected key.path=value"));
    EXPECT_THAT(override_complaint("t..b=1"), HasSubstr("is empty"));
    EXPECT_THAT(override_complaint("t.=1"), HasSubstr("is empty"));
    EXPECT_THAT(override_complaint("a=stokes"), HasSubstr("--set 'a=\"stokes\"'"));
    EXPECT_THAT(override_complaint("a="), HasSubstr("is not a TOML value"));
    EXPECT_THAT(override_complaint("a=1\nb = 2"), HasSubstr("on one line"));
    EXPECT_THAT(override_complaint("a.b=1"), HasSubstr("\"a\" is a number, not a table"));
    EXPECT_THAT(override_complaint("g.first.d=1"), HasSubstr("must be a place in the array, 0 to 0"));
    EXPECT_THAT(override_complaint("g.1.d=1"), HasSubstr("there is no entry 1"));
    EXPECT_THAT(override_complaint("probe=[]"), HasSubstr("cannot be set"));
}

} // namespace
} // namespace plumb
