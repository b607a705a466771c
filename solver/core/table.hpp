// A strict reader of TOML tables: every key that is read is checked, every key that is not read is an error.
#pragma once

#include "core/vec.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

namespace plumb {

/// Allowed values of a number; `open_*` excludes the end itself.
struct Range {
    double lower = -std::numeric_limits<double>::max();
    double upper = std::numeric_limits<double>::max();
    bool open_lower = false;
    bool open_upper = false;

    bool contains(double x) const;
    std::string text() const; // e.g. "(0, 1]"
};

inline constexpr Range any_number{};
inline constexpr Range positive{0.0, std::numeric_limits<double>::max(), true, false};
inline constexpr Range non_negative{0.0, std::numeric_limits<double>::max(), false, false};
inline constexpr Range fraction{0.0, 1.0, false, false};         // [0, 1]
inline constexpr Range positive_fraction{0.0, 1.0, true, false}; // (0, 1]

/// One table of the scene, with its path ("grains.contact") for messages. Reading a key marks it as used; finish()
/// throws for keys nobody read. All readers throw InputError naming file, key, value and what is allowed.
class Table {
public:
    Table(const toml::table& table, std::string path, std::string file);

    bool has(std::string_view key) const;
    /// The kind of the value at `key`; toml::node_type::none when absent. Does not mark it as read.
    toml::node_type type(std::string_view key) const;

    double number(std::string_view key, const Range& range = any_number);
    double number_or(std::string_view key, double absent, const Range& range = any_number);
    std::int64_t integer(std::string_view key, std::int64_t lower = std::numeric_limits<std::int64_t>::min(),
                         std::int64_t upper = std::numeric_limits<std::int64_t>::max());
    bool flag(std::string_view key);
    std::string text(std::string_view key);
    std::string text_or(std::string_view key, std::string_view absent);
    std::vector<std::string> texts(std::string_view key);
    /// An array of any number of numbers.
    std::vector<double> numbers(std::string_view key, const Range& range = any_number);
    Vec3 vector(std::string_view key, const Range& range = any_number);
    std::array<bool, 3> flags(std::string_view key);
    /// Two or three numbers, or flags, as the scene has dimensions; the third is 0 (false) in the plane.
    Vec3 components(std::string_view key, int dimensions, const Range& range = any_number);
    std::array<bool, 3> component_flags(std::string_view key, int dimensions);
    /// Entries of the array at `key`; 0 when it is no array. Does not mark it as read.
    std::size_t length(std::string_view key) const;
    std::vector<Vec3> points(std::string_view key);
    /// The sub-table at `key`; missing or of another type is an error. Taken twice, both remember what either read.
    Table table(std::string_view key);
    /// A law: `key = "name"` or `key = {law = "name", ...}`; both give a table whose text("law") is the name.
    Table law(std::string_view key);
    /// One table or an array of tables: both give a list, absent gives an empty one.
    std::vector<Table> tables(std::string_view key);
    /// One of `choices`; anything else is an error that lists them.
    std::string choice(std::string_view key, const std::vector<std::string_view>& choices);

    /// Throws InputError if a key of this table or of a sub-table taken from it was never read.
    void finish() const;
    /// Throws InputError about `key` of this table: "<file>: <path>.<key>: <what>".
    [[noreturn]] void fail(std::string_view key, std::string_view what) const;

    const std::string& path() const { return path_; }
    const std::string& file() const { return file_; }

private:
    struct Read; // which keys were read, shared by copies of this table
    const toml::node& required(std::string_view key, std::string_view expected);
    double checked(std::string_view key, const toml::node& node, const Range& range) const;
    Table child(const toml::table& sub, std::string path);

    std::shared_ptr<const toml::table> table_;
    std::string path_;
    std::string file_;
    std::shared_ptr<Read> read_;
};

} // namespace plumb
