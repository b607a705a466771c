#include "core/table.hpp"

#include "core/errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace plumb {

namespace {

std::string shown(const toml::node& node) {
    std::ostringstream out;
    if (node.is_table())
        out << "a table";
    else if (node.is_array())
        out << "an array of " << node.as_array()->size();
    else
        out << toml::node_view<const toml::node>(node);
    return out.str();
}

std::string joined(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

} // namespace

bool Range::contains(double x) const {
    return (open_lower ? x > lower : x >= lower) && (open_upper ? x < upper : x <= upper);
}

std::string Range::text() const {
    const double huge = std::numeric_limits<double>::max();
    const std::string low = lower == -huge ? "(-inf" : fmt::format("{}{}", open_lower ? '(' : '[', lower);
    const std::string high = upper == huge ? "inf)" : fmt::format("{}{}", upper, open_upper ? ')' : ']');
    return fmt::format("{}, {}", low, high);
}

struct Table::Read {
    std::set<std::string, std::less<>> keys;
    std::vector<Table> children;
};

Table::Table(const toml::table& table, std::string path, std::string file)
    : table_(std::make_shared<const toml::table>(table)), path_(std::move(path)), file_(std::move(file)),
      read_(std::make_shared<Read>()) {}

void Table::fail(std::string_view key, std::string_view what) const {
    std::string line = fmt::format("{}: {}: {}", file_, joined(path_, key), what);
    for (std::size_t at = 0; (at = line.find('\n', at)) != std::string::npos;) line.replace(at, 1, "\\n");
    throw InputError(line); // one line, whatever the value or the key holds
}

bool Table::has(std::string_view key) const { return table_->contains(key); }

toml::node_type Table::type(std::string_view key) const {
    const toml::node* node = table_->get(key);
    return node == nullptr ? toml::node_type::none : node->type();
}

const toml::node& Table::required(std::string_view key, std::string_view expected) {
    const toml::node* node = table_->get(key);
    if (node == nullptr) fail(key, fmt::format("missing; expected {}", expected));
    read_->keys.emplace(key);
    return *node;
}

double Table::checked(std::string_view key, const toml::node& node, const Range& range) const {
    if (!node.is_number()) fail(key, fmt::format("{} is not a number", shown(node)));
    const double x = node.is_integer() ? static_cast<double>(*node.value<std::int64_t>()) : *node.value<double>();
    if (!std::isfinite(x)) fail(key, fmt::format("{} is not finite", x));
    if (!range.contains(x)) fail(key, fmt::format("{} is outside the allowed range {}", x, range.text()));
    return x;
}

double Table::number(std::string_view key, const Range& range) {
    return checked(key, required(key, fmt::format("a number in {}", range.text())), range);
}

double Table::number_or(std::string_view key, double absent, const Range& range) {
    return has(key) ? number(key, range) : absent;
}

std::int64_t Table::integer(std::string_view key, std::int64_t lower, std::int64_t upper) {
    const toml::node& node = required(key, "a whole number");
    if (!node.is_integer()) fail(key, fmt::format("{} is not a whole number", shown(node)));
    const std::int64_t x = *node.value<std::int64_t>();
    if (x < lower || x > upper) fail(key, fmt::format("{} is outside the allowed range [{}, {}]", x, lower, upper));
    return x;
}

bool Table::flag(std::string_view key) {
    const toml::node& node = required(key, "true or false");
    if (!node.is_boolean()) fail(key, fmt::format("{} is not true or false", shown(node)));
    return *node.value<bool>();
}

std::string Table::text(std::string_view key) {
    const toml::node& node = required(key, "a string");
    if (!node.is_string()) fail(key, fmt::format("{} is not a string", shown(node)));
    return *node.value<std::string>();
}

std::string Table::text_or(std::string_view key, std::string_view absent) {
    return has(key) ? text(key) : std::string(absent);
}

std::string Table::choice(std::string_view key, const std::vector<std::string_view>& choices) {
    std::string value = text(key);
    if (std::find(choices.begin(), choices.end(), value) == choices.end())
        fail(key, fmt::format("\"{}\" is not one of \"{}\"", value, fmt::join(choices, "\", \"")));
    return value;
}

std::vector<std::string> Table::texts(std::string_view key) {
    const toml::array* array = required(key, "an array of strings").as_array();
    if (array == nullptr) fail(key, "expected an array of strings");
    std::vector<std::string> values;
    for (const toml::node& node : *array) {
        if (!node.is_string()) fail(key, fmt::format("{} is not a string", shown(node)));
        values.push_back(*node.value<std::string>());
    }
    return values;
}

std::vector<double> Table::numbers(std::string_view key, const Range& range) {
    const toml::array* array = required(key, "an array of numbers").as_array();
    if (array == nullptr) fail(key, "expected an array of numbers");
    std::vector<double> values;
    for (const toml::node& node : *array) values.push_back(checked(key, node, range));
    return values;
}

Vec3 Table::vector(std::string_view key, const Range& range) { return components(key, 3, range); }

Vec3 Table::components(std::string_view key, int dimensions, const Range& range) {
    const auto n = static_cast<std::size_t>(dimensions);
    const std::string_view expected = n == 3 ? "three numbers [x, y, z]" : "two numbers [x, y]";
    const toml::array* array = required(key, expected).as_array();
    if (array == nullptr || array->size() != n) fail(key, fmt::format("expected {}", expected));
    Vec3 value = Vec3::Zero();
    for (std::size_t c = 0; c < n; ++c) value[static_cast<Eigen::Index>(c)] = checked(key, *array->get(c), range);
    return value;
}

std::size_t Table::length(std::string_view key) const {
    const toml::array* array = has(key) ? table_->get(key)->as_array() : nullptr;
    return array == nullptr ? 0 : array->size();
}

std::array<bool, 3> Table::flags(std::string_view key) { return component_flags(key, 3); }

std::array<bool, 3> Table::component_flags(std::string_view key, int dimensions) {
    const auto n = static_cast<std::size_t>(dimensions);
    const std::string_view expected = n == 3 ? "three of true or false" : "two of true or false";
    const toml::array* array = required(key, expected).as_array();
    if (array == nullptr || array->size() != n) fail(key, fmt::format("expected {}", expected));
    std::array<bool, 3> value{};
    for (std::size_t c = 0; c < n; ++c) {
        const toml::node& node = *array->get(c);
        if (!node.is_boolean()) fail(key, fmt::format("{} is not true or false", shown(node)));
        value[c] = *node.value<bool>();
    }
    return value;
}

std::vector<Vec3> Table::points(std::string_view key) {
    const toml::array* array = required(key, "an array of points [[x, y, z], ...]").as_array();
    if (array == nullptr) fail(key, "expected an array of points [[x, y, z], ...]");
    std::vector<Vec3> values;
    for (const toml::node& node : *array) {
        const toml::array* point = node.as_array();
        if (point == nullptr || point->size() != 3) fail(key, "every point needs three numbers [x, y, z]");
        Vec3& value = values.emplace_back();
        for (std::size_t c = 0; c < 3; ++c)
            value[static_cast<Eigen::Index>(c)] = checked(key, *point->get(c), any_number);
    }
    return values;
}

Table Table::child(const toml::table& sub, std::string path) {
    for (const Table& known : read_->children) // taken before: what was read then counts
        if (known.path_ == path) return known;
    Table made(*this);
    made.table_ = std::shared_ptr<const toml::table>(table_, &sub);
    made.path_ = std::move(path);
    made.read_ = std::make_shared<Read>();
    read_->children.push_back(made);
    return made;
}

Table Table::table(std::string_view key) {
    const toml::node& node = required(key, "a table");
    if (!node.is_table()) fail(key, fmt::format("{} is not a table", shown(node)));
    return child(*node.as_table(), joined(path_, key));
}

Table Table::law(std::string_view key) {
    const toml::node& node = required(key, "the name of a law or a table {law = \"name\", ...}");
    if (node.is_table()) return child(*node.as_table(), joined(path_, key));
    if (!node.is_string())
        fail(key, fmt::format("{} is neither the name of a law nor a table {{law = \"name\", ...}}", shown(node)));
    Table made(toml::table{{"law", *node.value<std::string>()}}, joined(path_, key), file_);
    read_->children.push_back(made);
    return made;
}

std::vector<Table> Table::tables(std::string_view key) {
    if (!has(key)) return {};
    const toml::node& node = required(key, "a table");
    std::vector<Table> values;
    if (const toml::table* sub = node.as_table()) {
        values.push_back(child(*sub, joined(path_, key)));
    } else if (const toml::array* array = node.as_array()) {
        for (std::size_t i = 0; i < array->size(); ++i) {
            const toml::table* entry = array->get(i)->as_table();
            if (entry == nullptr) fail(key, "expected a table or an array of tables");
            values.push_back(child(*entry, joined(path_, fmt::format("{}[{}]", key, i))));
        }
    } else {
        fail(key, "expected a table or an array of tables");
    }
    return values;
}

void Table::finish() const {
    for (const auto& [key, node] : *table_)
        if (!read_->keys.count(key.str()))
            fail(key.str(), fmt::format("unknown key (value {}), or one that this scene does not use", shown(node)));
    for (const Table& sub : read_->children) sub.finish();
}

} // namespace plumb
