#include "core/csv.hpp"
#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace plumb {
namespace {

std::string written(const std::string& text) {
    const std::string path =
        ::testing::TempDir() + "plumb_csv_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

/// The message of the InputError that reading `text` gives; empty if there is none.
std::string fault(const std::string& text) {
    try {
        const Csv csv(written(text));
    } catch (const InputError& e) {
        return e.what();
    }
    return {};
}

TEST(Csv, ReadsColumnsByNameWithUnits) {
    const Csv csv(written("# made by hand\n z [m] ,x [m], Re [-] ,y [m]\r\n3, 1.5e-3,100,-2\n\n# middle\n6,4,200,0\n"));
    ASSERT_EQ(csv.rows(), 2U);
    EXPECT_EQ(csv.column("x", "m"), (std::vector<double>{1.5e-3, 4.0}));
    EXPECT_EQ(csv.column("Re", "-"), (std::vector<double>{100.0, 200.0}));
    EXPECT_EQ(points(csv)[0], Vec3(1.5e-3, -2.0, 3.0));
    EXPECT_TRUE(csv.has("y"));
    EXPECT_FALSE(csv.has("w"));
}

TEST(Csv, ChecksNamesAndUnits) {
    const Csv csv(written("x [mm],y [m],z [m]\n1,2,3\n"));
    EXPECT_THROW(csv.column("x", "m"), InputError);
    EXPECT_THROW(csv.column("w", "m"), InputError);
    EXPECT_THROW(csv.allow_only({"x", "y"}), InputError);
    EXPECT_NO_THROW(csv.allow_only({"x", "y", "z", "diameter"}));
}

TEST(Csv, RefusesBrokenFilesNamingTheLine) {
    EXPECT_NE(fault("x [m],y [m]\n1,2\n3\n").find(".csv, line 3: has 1 fields, the header 2"), std::string::npos);
    EXPECT_NE(fault("x [m]\n1\nnan\n").find("line 3, column \"x\": \"nan\" is not a finite number"), std::string::npos);
    EXPECT_NE(fault("x [m]\n1e999\n").find("line 2"), std::string::npos);
    EXPECT_NE(fault("x [m]\n1 2\n").find("line 2"), std::string::npos);
    EXPECT_NE(fault("x [m]\n\"1\"\n").find("line 2"), std::string::npos);
    EXPECT_NE(fault("x [m],y [m]\n1,2,3\n").find("has 3 fields"), std::string::npos);
    EXPECT_NE(fault("x [m],y [m]\n1,\n").find("line 2, column \"y\""), std::string::npos);
    EXPECT_NE(fault("x [m],x [m]\n1,2\n").find("appears twice"), std::string::npos);
    EXPECT_NE(fault("1,2,3\n4,5,6\n").find("not a column with its unit"), std::string::npos);
    EXPECT_NE(fault("x [m]\n0.1\n0.12").find("line 3: the last line is not ended"), std::string::npos);
    EXPECT_NE(fault("x [m]\n").find("no rows"), std::string::npos);
    EXPECT_NE(fault("# nothing\n").find("no header"), std::string::npos);
    EXPECT_NE(fault("").find("is empty"), std::string::npos);
}

TEST(Csv, RefusesWhatIsNoFile) {
    EXPECT_THROW(Csv("/nowhere/at/all.csv"), InputError);
    EXPECT_THROW(Csv{::testing::TempDir()}, InputError);
    EXPECT_THROW(Csv("/dev/null"), InputError);
}

TEST(Csv, RefusesHugeFiles) {
    const std::string path = written("x [m]\n1\n");
    std::filesystem::resize_file(path, (std::uintmax_t{1} << 30U) + 1); // sparse: takes no space
    EXPECT_THROW(Csv{path}, InputError);
    std::filesystem::remove(path);
}

TEST(InputPath, StartsAtTheFolderOfTheScene) {
    const auto toml = toml::parse("near = 'a/b.csv'\nfar = '/c.csv'\nempty = ''");
    Table table(toml, "", "scenes/one.toml");
    EXPECT_EQ(input_path(table, "near"), "scenes/a/b.csv");
    EXPECT_EQ(input_path(table, "far"), "/c.csv");
    EXPECT_THROW(input_path(table, "empty"), InputError);
    Table here(toml, "", "one.toml");
    EXPECT_EQ(input_path(here, "near"), "a/b.csv");
}

} // namespace
} // namespace plumb
