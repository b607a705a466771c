// Small numeric tables in text files: the first line names the columns with their units, `x [m], diameter [m]`, every
// other line is one row of numbers. Lines that start with '#' and empty lines are skipped.
#pragma once

#include "core/table.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

/// Everything in a regular file. InputError naming the file if it is missing, a directory, unreadable, empty or larger
/// than 1 GiB.
std::string file_contents(const std::string& path);

/// The file that `key` of a scene table names. A relative path starts at the folder of the scene file.
std::string input_path(Table& table, std::string_view key);

/// A rectangular table of finite numbers. Errors name the file and, where there is one, the line.
class Csv {
public:
    /// InputError for a missing, empty or broken file: no header, a column without unit or named twice, a row with too
    /// few or too many fields, a field that is not a finite number, a last line that is not ended (a truncated file).
    explicit Csv(const std::string& path);

    std::size_t rows() const { return lines_.size(); }
    bool has(std::string_view name) const;
    /// The column `name`; InputError if it is absent or not in `unit` (as written between the brackets).
    const std::vector<double>& column(std::string_view name, std::string_view unit) const;
    /// InputError if there is a column that is not one of `names`: data that nobody reads is a mistake.
    void allow_only(const std::vector<std::string_view>& names) const;
    /// InputError about row `row`: "<file>, line <n>: <what>".
    [[noreturn]] void fail(std::size_t row, std::string_view what) const;
    const std::string& file() const { return file_; }

private:
    struct Column {
        std::string name;
        std::string unit;
        std::vector<double> values;
    };
    void read_header(std::string_view line, std::size_t number);
    void read_row(std::string_view line, std::size_t number);
    std::string column_names() const;

    std::string file_;
    std::vector<Column> columns_;
    std::vector<std::size_t> lines_; // line in the file of each row, from 1
};

/// The columns x, y, z [m] as points.
std::vector<Vec3> points(const Csv& csv);

} // namespace plumb
