#include "core/stl.hpp"

#include "core/csv.hpp"
#include "core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <string_view>

namespace plumb {

namespace {

// Layout of a binary file: a free header, the number of triangles, then per triangle 12 floats and two spare bytes.
constexpr std::size_t header_bytes = 80;
constexpr std::size_t preamble_bytes = header_bytes + 4;
constexpr std::size_t triangle_bytes = 50;
constexpr std::size_t normal_bytes = 12;

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian, and so is every x86-64");

template <class Number> Number number_at(std::string_view bytes, std::size_t offset) {
    Number value;
    std::memcpy(&value, bytes.data() + offset, sizeof value);
    return value;
}

std::vector<Vec3> binary_corners(std::string_view bytes) {
    const auto count = number_at<std::uint32_t>(bytes, header_bytes);
    std::vector<Vec3> soup;
    soup.reserve(std::size_t{3} * count);
    for (std::size_t t = 0; t < count; ++t)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t at = preamble_bytes + t * triangle_bytes + normal_bytes + corner * 12;
            soup.emplace_back(number_at<float>(bytes, at), number_at<float>(bytes, at + 4),
                              number_at<float>(bytes, at + 8));
        }
    return soup;
}

/// Words of an ASCII file with the line they stand in.
class Words {
public:
    Words(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// The next word in lower case; empty at the end of the file.
    std::string next() {
        while (at_ < text_.size() && is_space(text_[at_])) skip();
        std::string word;
        while (at_ < text_.size() && !is_space(text_[at_])) {
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(text_[at_])));
            skip();
        }
        return word;
    }
    void skip_line() {
        while (at_ < text_.size() && text_[at_] != '\n') skip();
    }
    void expect(std::string_view wanted) {
        const std::string word = next();
        if (word != wanted) fail(word, fmt::format("\"{}\"", wanted));
    }
    double number() {
        const std::string word = next();
        const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
        double value = 0.0;
        const auto [stop, fault] = std::from_chars(begin, word.data() + word.size(), value);
        if (word.empty() || fault != std::errc{} || stop != word.data() + word.size()) fail(word, "a number");
        return value;
    }
    Vec3 vector() {
        const double x = number(), y = number();
        return {x, y, number()};
    }
    [[noreturn]] void fail(const std::string& word, std::string_view wanted) const {
        if (word.empty())
            throw InputError(fmt::format("{}, line {}: the file ends where {} should follow; is it truncated?", file_,
                                         line_, wanted));
        throw InputError(fmt::format("{}, line {}: \"{}\" stands where {} should; not an STL file", file_, line_,
                                     word.substr(0, 40), wanted));
    }

private:
    static bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
    void skip() { line_ += text_[at_++] == '\n' ? 1 : 0; }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
};

std::vector<Vec3> ascii_corners(std::string_view text, const std::string& file) {
    Words words(text, file);
    std::vector<Vec3> soup;
    words.expect("solid");
    words.skip_line(); // the rest of the line is a free name
    for (;;) {
        const std::string word = words.next();
        if (word == "endsolid") {
            words.skip_line();
            const std::string more = words.next(); // a file may hold several solids
            if (more.empty()) return soup;
            if (more != "solid") words.fail(more, "\"solid\" or the end of the file");
            words.skip_line();
            continue;
        }
        if (word != "facet") words.fail(word, "\"facet\" or \"endsolid\"");
        words.expect("normal");
        words.vector(); // follows from the corners
        words.expect("outer");
        words.expect("loop");
        for (int corner = 0; corner < 3; ++corner) {
            words.expect("vertex");
            soup.push_back(words.vector());
        }
        words.expect("endloop");
        words.expect("endfacet");
    }
}

bool begins_with_solid(std::string_view bytes) {
    constexpr std::string_view solid = "solid";
    const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    return bytes.size() - begin >= solid.size() &&
           std::equal(
               solid.begin(), solid.end(), bytes.begin() + static_cast<std::ptrdiff_t>(begin),
               [](char a, char b) { return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b))); });
}

std::vector<Vec3> stl_corners(std::string_view bytes, const std::string& path) {
    // Binary headers may begin with "solid" too, so the length decides first: no text has bytes 80 to 83 that fit it.
    std::optional<std::size_t> expected;
    if (bytes.size() >= preamble_bytes)
        expected = preamble_bytes + triangle_bytes * std::size_t{number_at<std::uint32_t>(bytes, header_bytes)};
    if (expected == bytes.size()) return binary_corners(bytes);
    const bool has_zero_byte = bytes.find('\0') != std::string_view::npos;
    if (begins_with_solid(bytes) && !has_zero_byte) return ascii_corners(bytes, path);
    if (expected && has_zero_byte)
        throw InputError(
            fmt::format("{}: is no complete binary STL file: it has {} bytes where its header announces {}", path,
                        bytes.size(), *expected));
    throw InputError(fmt::format("{}: is neither a binary nor an ASCII STL file", path));
}

} // namespace

Triangles joined_triangles(const std::vector<Vec3>& soup) {
    std::vector<std::int32_t> order(soup.size());
    std::iota(order.begin(), order.end(), 0);
    const auto point = [&](std::int32_t i) -> const Vec3& { return soup[static_cast<std::size_t>(i)]; };
    std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
        const Vec3 &a = point(i), &b = point(j);
        for (Eigen::Index c = 0; c < 3; ++c)
            if (a[c] != b[c]) return a[c] < b[c];
        return i < j;
    });
    Triangles mesh;
    mesh.corners.resize(soup.size() / 3);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Vec3& p = point(order[k]);
        if (k == 0 || p != mesh.points.back()) mesh.points.push_back(p);
        const auto corner = static_cast<std::size_t>(order[k]);
        mesh.corners[corner / 3][corner % 3] = static_cast<std::int32_t>(mesh.points.size() - 1);
    }
    return mesh;
}

bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double thinnest = 1e-6; // about ten times the spacing of single-precision numbers, 1.2e-7
    const double longest_sq = std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
    return !((b - a).cross(c - a).norm() > thinnest * longest_sq);
}

Triangles read_stl(const std::string& path, double scale) {
    std::vector<Vec3> soup = stl_corners(file_contents(path), path);
    if (soup.empty()) throw InputError(fmt::format("{}: has no triangles", path));
    for (std::size_t i = 0; i < soup.size(); ++i) {
        soup[i] *= scale;
        if (!soup[i].allFinite())
            throw InputError(fmt::format("{}: triangle {} (counted from 0) has a non-finite coordinate", path, i / 3));
    }
    for (std::size_t t = 0; 3 * t < soup.size(); ++t)
        if (is_degenerate(soup[3 * t], soup[3 * t + 1], soup[3 * t + 2]))
            throw InputError(fmt::format(
                "{}: triangle {} (counted from 0) is degenerate: its corners ({}, {}, {}), ({}, "
                "{}, {}), ({}, {}, {}) lie on a line",
                path, t, soup[3 * t][0], soup[3 * t][1], soup[3 * t][2], soup[3 * t + 1][0], soup[3 * t + 1][1],
                soup[3 * t + 1][2], soup[3 * t + 2][0], soup[3 * t + 2][1], soup[3 * t + 2][2]));
    return joined_triangles(soup);
}

} // namespace plumb
