// Files of the result folder: HDF5 round trips, complete-or-absent writing, the folder's rules, the index.
#include "core/errors.hpp"
#include "run/aside_file.hpp"
#include "run/hdf5_file.hpp"
#include "run/result_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace plumb {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class ResultFiles : public testing::Test {
protected:
    ResultFiles() : folder_((fs::path(testing::TempDir()) / ("plumb_files_" + std::to_string(::getpid()))).string()) {
        fs::create_directories(folder_);
    }
    ~ResultFiles() override { fs::remove_all(folder_); }
    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    static std::string content(const std::string& file) {
        std::ostringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        return text.str();
    }
    const std::string folder_;
};

/// Limits the size of files this process may write, as a full disk would, until it is destroyed.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        before_signal_ = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit now{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &now);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, before_signal_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    void (*before_signal_)(int);
};

template <class Action> std::string io_complaint(Action&& action) {
    try {
        action();
    } catch (const IoError& e) {
        EXPECT_THAT(e.what(), testing::Not(HasSubstr("\n")));
        return e.what();
    }
    return "no complaint";
}

TEST_F(ResultFiles, Hdf5RoundTripKeepsBits) {
    const std::vector<double> numbers{
        0.1, -0.0, 5e-324, std::numeric_limits<double>::max(), std::numeric_limits<double>::infinity(), std::nan("")};
    for (const bool checked : {false, true}) {
        Hdf5Writer file(path("a.h5"), checked);
        file.write("group/table", numbers, {2, 3});
        file.write("counts", std::vector<std::int64_t>{-1, std::numeric_limits<std::int64_t>::max()});
        file.write("small", std::vector<std::int32_t>{7, -8});
        file.write("nothing", std::vector<double>{});
        file.write("no_rows", std::span<const double>(), {0, 4});
        file.write_bytes("text", "äö\n");
        file.attribute("group/table", "units", std::string("m/s²"));
        file.attribute("/", "time", 0.25);
        file.attribute("/", "step", std::int64_t{1} << 60U);
        EXPECT_FALSE(fs::exists(path("a.h5")) && !checked); // not before it is complete
        file.finish();
        EXPECT_FALSE(fs::exists(aside_name(path("a.h5"))));

        const Hdf5Reader read(path("a.h5"));
        const std::vector<double> back = read.doubles("group/table");
        EXPECT_EQ(std::memcmp(back.data(), numbers.data(), sizeof(double) * numbers.size()), 0);
        EXPECT_EQ(read.shape("group/table"), (Shape{2, 3}));
        EXPECT_EQ(read.shape("no_rows"), (Shape{0, 4}));
        EXPECT_EQ(read.integers("counts").back(), std::numeric_limits<std::int64_t>::max());
        EXPECT_EQ(read.integers("small"), (std::vector<std::int64_t>{7, -8}));
        EXPECT_TRUE(read.doubles("nothing").empty());
        EXPECT_EQ(read.bytes("text"), "äö\n");
        EXPECT_EQ(read.text("group/table", "units"), "m/s²");
        EXPECT_EQ(read.number("/", "time"), 0.25);
        EXPECT_EQ(read.integer("/", "step"), std::int64_t{1} << 60U);
        EXPECT_EQ(read.datasets(),
                  (std::vector<std::string>{"counts", "group/table", "no_rows", "nothing", "small", "text"}));
        EXPECT_TRUE(read.has("group/table"));
        EXPECT_FALSE(read.has("other/table"));
        EXPECT_TRUE(read.is_integer("counts"));
        EXPECT_FALSE(read.is_integer("group/table"));
    }
}

TEST_F(ResultFiles, SameDataGiveTheSameBytes) {
    for (const char* name : {"a.h5", "b.h5"}) {
        Hdf5Writer file(path(name));
        file.write("x", std::vector<double>{1.0, 2.0});
        file.attribute("x", "units", std::string("m"));
        file.finish();
    }
    EXPECT_EQ(content(path("a.h5")), content(path("b.h5")));
}

TEST_F(ResultFiles, BrokenFilesAreIoErrors) {
    EXPECT_THAT(io_complaint([&] { Hdf5Reader(path("none.h5")); }), HasSubstr("No such file"));
    std::ofstream(path("bad.h5")) << "not HDF5 at all";
    EXPECT_THAT(io_complaint([&] { Hdf5Reader(path("bad.h5")); }), HasSubstr("not a complete HDF5 file"));
    {
        Hdf5Writer file(path("x.h5"), true);
        file.write("x", std::vector<double>(1000, 1.5));
        file.finish();
    }
    std::string bytes = content(path("x.h5"));
    std::ofstream(path("cut.h5"), std::ios::binary) << bytes.substr(0, bytes.size() / 2);
    EXPECT_THAT(io_complaint([&] { Hdf5Reader(path("cut.h5")); }), HasSubstr("not a complete HDF5 file"));
    const double value = 1.5; // flip one bit of the data
    const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&value), 8)) + 8 * 500;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    std::ofstream(path("flipped.h5"), std::ios::binary) << bytes;
    EXPECT_THAT(io_complaint([&] { Hdf5Reader(path("flipped.h5")).doubles("x"); }), HasSubstr("damaged"));
}

TEST_F(ResultFiles, FailedWritesKeepTheOlderFile) {
    write_text(path("t.txt"), "old");
    {
        Hdf5Writer file(path("d.h5"));
        file.write("x", std::vector<double>{1.0});
        file.finish();
    }
    const std::string before = content(path("d.h5"));
    {
        const FileSizeLimit limit(4096);
        EXPECT_THAT(io_complaint([&] { write_text(path("t.txt"), std::string(10000, 'x')); }), HasSubstr("too large"));
        EXPECT_THAT(io_complaint([&] {
                        Hdf5Writer file(path("d.h5"));
                        file.write("x", std::vector<double>(10000, 1.0));
                        file.finish();
                    }),
                    HasSubstr("too large"));
    }
    EXPECT_EQ(content(path("t.txt")), "old");
    EXPECT_EQ(content(path("d.h5")), before);
    EXPECT_FALSE(fs::exists(aside_name(path("t.txt"))));
    EXPECT_FALSE(fs::exists(aside_name(path("d.h5"))));
}

TEST_F(ResultFiles, FolderThatIsNoneIsAnIoError) {
    EXPECT_THAT(io_complaint([&] { write_text(path("none/t.txt"), "x"); }), HasSubstr("No such file or directory"));
    EXPECT_THAT(io_complaint([&] { Hdf5Writer(path("none/d.h5")); }), HasSubstr("No such file or directory"));
    EXPECT_THAT(io_complaint([] { make_folder("/proc/plumb"); }), HasSubstr("cannot be made"));
}

TEST_F(ResultFiles, OldResultIsRemovedAndNothingElse) {
    const std::string out = path("out");
    fs::create_directories(out + "/snapshots");
    for (const char* name :
         {"run.json", "series.h5", "checkpoint.h5", "result.xdmf", "series.h5.tmp", "notes.txt", "snapshots/000003.h5",
          "snapshots/diverged.h5", "snapshots/000004.h5.tmp", "snapshots/mine.h5"})
        std::ofstream(out + "/" + name) << "x";
    const ResultFolder folder = ResultFolder::fresh(out);
    std::vector<std::string> left;
    for (const auto& entry : fs::recursive_directory_iterator(out))
        if (entry.is_regular_file()) left.push_back(entry.path().filename().string());
    EXPECT_THAT(left, testing::UnorderedElementsAre("notes.txt", "mine.h5"));
}

TEST_F(ResultFiles, ForeignFoldersAreRefused) {
    fs::create_directories(path("photos"));
    std::ofstream(path("photos/a.jpg")) << "x";
    EXPECT_THROW(ResultFolder::fresh(path("photos")), InputError);
    EXPECT_THROW(ResultFolder::fresh(path("photos/a.jpg")), InputError);
    EXPECT_THROW(ResultFolder::existing(path("nowhere")), InputError);
    fs::create_directories(path("empty"));
    EXPECT_NO_THROW(ResultFolder::fresh(path("empty")));
    EXPECT_TRUE(fs::exists(path("photos/a.jpg")));
}

TEST_F(ResultFiles, OneRunPerFolder) {
    const ResultFolder first = ResultFolder::fresh(path("out"));
    write_text(first.file("run.json"), "{}");
    EXPECT_THROW(ResultFolder::fresh(path("out")), InputError);
    EXPECT_THROW(ResultFolder::existing(path("out")), InputError);
    EXPECT_TRUE(fs::exists(path("out/run.json")));
}

TEST_F(ResultFiles, SnapshotIsInTheOrderOfIds) {
    Simulation s;
    Grains& g = s.grains.grains;
    s.grains.groups = {{"a", 1000.0, true, Motion::free}};
    for (int k = 0; k < 3; ++k)
        add_grain(g, s.grains.groups, 0, 0.5 + k, Vec3(k, 10 + k, 20 + k), Vec3(0, 0, k), Vec3(k, 0, 0));
    reorder(g, {2, 0, 1});
    s.grains.step = 4;
    s.timing.dt = 0.25;
    write_snapshot(path("s.h5"), s);
    const Hdf5Reader file(path("s.h5"));
    EXPECT_EQ(file.doubles("grains/x"), (std::vector<double>{0, 10, 20, 1, 11, 21, 2, 12, 22}));
    EXPECT_EQ(file.doubles("grains/diameter"), (std::vector<double>{1, 3, 5}));
    EXPECT_EQ(file.integers("grains/id"), (std::vector<std::int64_t>{0, 1, 2}));
    EXPECT_EQ(file.number("/", "time"), 1.0);
    EXPECT_EQ(file.text("grains/omega", "units"), "rad/s");
}

TEST_F(ResultFiles, IndexNamesEverySnapshot) {
    write_xdmf(path("result.xdmf"), {{"snapshots/000000.h5", 0.0, 5}, {"snapshots/000001.h5", 0.1, 7}});
    const std::string text = content(path("result.xdmf"));
    EXPECT_THAT(text, HasSubstr("<Time Value=\"0.10000000000000001\"/>"));
    EXPECT_THAT(text, HasSubstr("TopologyType=\"Polyvertex\" NumberOfElements=\"7\""));
    EXPECT_THAT(text, HasSubstr("Dimensions=\"7 3\" NumberType=\"Float\" Precision=\"8\" "
                                "Format=\"HDF\">snapshots/000001.h5:/grains/v</DataItem>"));
    EXPECT_THAT(text, HasSubstr("CollectionType=\"Temporal\""));
}

} // namespace
} // namespace plumb
