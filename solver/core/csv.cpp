#include "core/csv.hpp"

#include "core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace plumb {

namespace {

constexpr std::uintmax_t largest_file = std::uintmax_t{1}
                                        << 30U; // 1 GiB: far above any table or mesh that fits a scene

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> fields(std::string_view line) {
    std::vector<std::string_view> found;
    for (;;) {
        const std::size_t comma = line.find(',');
        found.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) return found;
        line.remove_prefix(comma + 1);
    }
}

} // namespace

std::string file_contents(const std::string& path) {
    std::error_code fault;
    const std::filesystem::file_status status = std::filesystem::status(path, fault);
    if (!std::filesystem::exists(status)) throw InputError(fmt::format("{}: there is no such file", path));
    if (std::filesystem::is_directory(status)) throw InputError(fmt::format("{}: is a directory, not a file", path));
    if (!std::filesystem::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", path));
    const std::uintmax_t size = std::filesystem::file_size(path, fault);
    if (fault) throw InputError(fmt::format("{}: cannot be read: {}", path, fault.message()));
    if (size == 0) throw InputError(fmt::format("{}: is empty", path));
    if (size > largest_file)
        throw InputError(fmt::format("{}: has {} bytes, more than the allowed {}", path, size, largest_file));
    std::ifstream file(path, std::ios::binary);
    std::string contents(static_cast<std::size_t>(size), '\0');
    if (!file.read(contents.data(), static_cast<std::streamsize>(size)))
        throw InputError(fmt::format("{}: cannot be read", path));
    return contents;
}

std::string input_path(Table& table, std::string_view key) {
    const std::string name = table.text(key);
    if (name.empty()) table.fail(key, "the path is empty");
    return (std::filesystem::path(table.file()).parent_path() / name).string();
}

Csv::Csv(const std::string& path) : file_(path) {
    const std::string contents = file_contents(path);
    std::string_view rest = contents;
    for (std::size_t number = 1; !rest.empty(); ++number) {
        const std::size_t end = rest.find('\n');
        // A cut number ("0.12" of "0.1234") looks like a number; only the missing line end shows the cut.
        if (end == std::string_view::npos)
            throw InputError(
                fmt::format("{}, line {}: the last line is not ended; is the file truncated?", file_, number));
        const std::string_view line = trimmed(rest.substr(0, end));
        rest.remove_prefix(end + 1);
        if (line.empty() || line.front() == '#') continue;
        if (columns_.empty())
            read_header(line, number);
        else
            read_row(line, number);
    }
    if (columns_.empty()) throw InputError(fmt::format("{}: has no header line like \"x [m], y [m], z [m]\"", file_));
    if (lines_.empty()) throw InputError(fmt::format("{}: has a header but no rows", file_));
}

void Csv::read_header(std::string_view line, std::size_t number) {
    for (const std::string_view field : fields(line)) {
        const std::size_t open = field.find('[');
        const std::string_view name = trimmed(field.substr(0, open));
        if (name.empty() || open == std::string_view::npos || field.back() != ']')
            throw InputError(
                fmt::format("{}, line {}: \"{}\" is not a column with its unit, like \"x [m]\"", file_, number, field));
        if (has(name)) throw InputError(fmt::format("{}, line {}: column \"{}\" appears twice", file_, number, name));
        const std::string_view unit = trimmed(field.substr(open + 1, field.size() - open - 2));
        columns_.push_back({std::string(name), std::string(unit), {}});
    }
}

void Csv::read_row(std::string_view line, std::size_t number) {
    const std::vector<std::string_view> row = fields(line);
    if (row.size() != columns_.size())
        throw InputError(
            fmt::format("{}, line {}: has {} fields, the header {}", file_, number, row.size(), columns_.size()));
    for (std::size_t c = 0; c < row.size(); ++c) {
        double value = 0.0;
        const char* const end = row[c].data() + row[c].size();
        const auto [stop, fault] = std::from_chars(row[c].data(), end, value);
        if (fault != std::errc{} || stop != end || !std::isfinite(value))
            throw InputError(fmt::format("{}, line {}, column \"{}\": \"{}\" is not a finite number", file_, number,
                                         columns_[c].name, row[c]));
        columns_[c].values.push_back(value);
    }
    lines_.push_back(number);
}

bool Csv::has(std::string_view name) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
}

std::string Csv::column_names() const {
    std::string text;
    for (const Column& c : columns_) text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", c.name, c.unit);
    return text;
}

const std::vector<double>& Csv::column(std::string_view name, std::string_view unit) const {
    const auto found = std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == name; });
    if (found == columns_.end())
        throw InputError(
            fmt::format("{}: has no column \"{} [{}]\"; its columns are {}", file_, name, unit, column_names()));
    if (found->unit != unit)
        throw InputError(fmt::format("{}: column \"{}\" is in [{}]; expected [{}]", file_, name, found->unit, unit));
    return found->values;
}

void Csv::allow_only(const std::vector<std::string_view>& names) const {
    for (const Column& c : columns_)
        if (std::find(names.begin(), names.end(), c.name) == names.end())
            throw InputError(fmt::format("{}: column \"{}\" is unknown, or not used by this scene", file_, c.name));
}

void Csv::fail(std::size_t row, std::string_view what) const {
    throw InputError(fmt::format("{}, line {}: {}", file_, lines_[row], what));
}

std::vector<Vec3> points(const Csv& csv) {
    const auto& x = csv.column("x", "m");
    const auto& y = csv.column("y", "m");
    const auto& z = csv.column("z", "m");
    std::vector<Vec3> found;
    found.reserve(csv.rows());
    for (std::size_t i = 0; i < csv.rows(); ++i) found.emplace_back(x[i], y[i], z[i]);
    return found;
}

} // namespace plumb
