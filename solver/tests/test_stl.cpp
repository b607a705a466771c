#include "core/stl.hpp"

#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

namespace plumb {
namespace {

std::string written(const std::string& bytes) {
    const std::string path =
        ::testing::TempDir() + "plumb_stl_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".stl";
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}

using Soup = std::vector<std::array<float, 9>>;

std::string binary(const Soup& soup, std::string header = "made by a test") {
    header.resize(80, '\0');
    std::string bytes = header;
    const auto append = [&](const auto& value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(raw, sizeof value);
    };
    append(static_cast<std::uint32_t>(soup.size()));
    for (const auto& triangle : soup) {
        for (int i = 0; i < 3; ++i) append(0.0F);
        for (const float x : triangle) append(x);
        append(std::uint16_t{0});
    }
    return bytes;
}

std::string ascii(const Soup& soup, const std::string& name = "made by a test") {
    std::string text = "solid " + name + "\n";
    for (const auto& t : soup) {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for (std::size_t k = 0; k < 3; ++k)
            text += "      vertex " + std::to_string(t[3 * k]) + " " + std::to_string(t[3 * k + 1]) + " " +
                    std::to_string(t[3 * k + 2]) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid " + name + "\n";
}

// A unit square of two triangles, one corner spelled as -0.
const Soup square{{0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F}, {-0.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, -0.F}};

std::string fault(const std::string& bytes) {
    try {
        read_stl(written(bytes), 1.0);
    } catch (const InputError& e) {
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
        EXPECT_NE(std::string(e.what()).find(".stl"), std::string::npos);
        return e.what();
    }
    return {};
}

void expect_square(const Triangles& mesh, double edge) {
    ASSERT_EQ(mesh.points.size(), 4U);
    ASSERT_EQ(mesh.corners.size(), 2U);
    const auto point = [&](std::size_t t, std::size_t k) {
        return mesh.points[static_cast<std::size_t>(mesh.corners[t][k])];
    };
    EXPECT_EQ(point(0, 0), Vec3(0, 0, 0));
    EXPECT_EQ(point(0, 1), Vec3(edge, 0, 0));
    EXPECT_EQ(point(1, 1), Vec3(edge, edge, 0));
    EXPECT_EQ(point(1, 2), Vec3(0, edge, 0));
    EXPECT_EQ(mesh.corners[0][0], mesh.corners[1][0]); // joined
    EXPECT_EQ(mesh.corners[0][2], mesh.corners[1][1]);
}

TEST(Stl, ReadsBinaryAndAsciiAlike) {
    expect_square(read_stl(written(binary(square)), 1.0), 1.0);
    expect_square(read_stl(written(ascii(square)), 1.0), 1.0);
    expect_square(read_stl(written(ascii(square)), 1e-3), 1e-3);
}

TEST(Stl, ReadsBinaryThatBeginsWithSolid) {
    expect_square(read_stl(written(binary(square, "solid but binary")), 1.0), 1.0);
    expect_square(read_stl(written(binary(square, std::string("solid") + std::string(75, ' '))), 1.0), 1.0);
}

TEST(Stl, ReadsAsciiVariants) {
    std::string text = ascii(square);
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    expect_square(read_stl(written(text), 1.0), 1.0);
    std::string dos = "\n  ";
    for (const char c : ascii(square, "")) dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
    expect_square(read_stl(written(dos), 1.0), 1.0);
    // Two solids in one file, one triangle each.
    expect_square(read_stl(written(ascii({square[0]}) + ascii({square[1]})), 1.0), 1.0);
}

TEST(Stl, RefusesTruncatedFiles) {
    const std::string bytes = binary(square), text = ascii(square);
    for (std::size_t n = 0; n < bytes.size(); n += 5) EXPECT_NE(fault(bytes.substr(0, n)), "") << n;
    EXPECT_NE(fault(bytes + "x"), "");
    const std::size_t closing = text.rfind("endsolid");
    for (std::size_t n = 0; n < closing + 8; n += 5) EXPECT_NE(fault(text.substr(0, n)), "") << n;
    const std::string solid = binary(square, "solid but binary");
    for (std::size_t n = 0; n < solid.size(); n += 5) EXPECT_NE(fault(solid.substr(0, n)), "") << n;
    EXPECT_NE(fault(solid.substr(0, 120)).find("has 120 bytes where its header announces 184"), std::string::npos);
}

TEST(Stl, RefusesGarbage) {
    EXPECT_NE(fault("").find("is empty"), std::string::npos);
    EXPECT_NE(fault("hello").find("neither a binary nor an ASCII STL"), std::string::npos);
    EXPECT_NE(fault(std::string(1000, '\x7f')), "");
    EXPECT_NE(fault(std::string(1000, '\0')), "");
    EXPECT_NE(fault("solid a\nendsolid a\n").find("has no triangles"), std::string::npos);
    EXPECT_NE(fault(binary({})).find("has no triangles"), std::string::npos);
    EXPECT_NE(fault("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0")
                  .find("line 4: \"zero\" stands where a number"),
              std::string::npos);
    EXPECT_THROW(read_stl("/nowhere.stl", 1.0), InputError);
    EXPECT_THROW(read_stl(::testing::TempDir(), 1.0), InputError);
}

TEST(Stl, RefusesBadTriangles) {
    Soup soup = square;
    soup[1][4] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_NE(fault(binary(soup)).find("triangle 1 (counted from 0) has a non-finite"), std::string::npos);
    EXPECT_NE(fault(ascii(soup)).find("non-finite"), std::string::npos);
    soup = square;
    soup[1] = {0.F, 0.F, 0.F, 1.F, 1.F, 0.F, 1.F, 1.F, 0.F}; // two equal corners
    EXPECT_NE(fault(binary(soup)).find("triangle 1 (counted from 0) is degenerate"), std::string::npos);
    soup[1] = {0.F, 0.F, 0.F, 1.F, 1.F, 1.F, 3.F, 3.F, 3.F}; // on a line
    EXPECT_NE(fault(binary(soup)).find("degenerate"), std::string::npos);
}

TEST(Stl, ThinIsNotDegenerate) {
    EXPECT_FALSE(is_degenerate({0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}));
    EXPECT_TRUE(is_degenerate({0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}));
    EXPECT_FALSE(is_degenerate({0, 0, 0}, {1e-9, 0, 0}, {0, 1e-9, 0})); // small, but of good shape
}

} // namespace
} // namespace plumb
