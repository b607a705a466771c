#include "core/scene.hpp"

#include "core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace plumb {

namespace {

// No scene written by hand or by a script comes near this; grains belong in a CSV file.
constexpr std::uintmax_t largest_scene = 16U << 20U; // [bytes]

std::string file_content(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) throw InputError(fmt::format("{}: no such file", path));
    if (error) throw InputError(fmt::format("{}: {}", path, error.message()));
    if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a directory, not a scene file", path));
    if (!fs::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", path));
    const std::uintmax_t bytes = fs::file_size(path, error);
    if (error) throw InputError(fmt::format("{}: {}", path, error.message()));
    if (bytes > largest_scene)
        throw InputError(
            fmt::format("{}: {} bytes is too large for a scene; at most {} are allowed", path, bytes, largest_scene));
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
    std::ostringstream content;
    if (bytes > 0) content << file.rdbuf();
    if (file.bad() || content.str().size() != bytes) throw InputError(fmt::format("{}: cannot be read", path));
    return content.str();
}

toml::table parsed(std::string_view text, const std::string& path) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& e) {
        const toml::source_position where = e.source().begin;
        throw InputError(fmt::format("{}: line {}, column {}: not valid TOML: {}", path, where.line, where.column,
                                     std::string_view(e.description())));
    }
}

std::string printed(const toml::table& data) {
    std::ostringstream out;
    out << data << '\n';
    return out.str();
}

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
    return begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
}

/// One `key.path=value`, split and checked. The messages name the override as it was typed.
struct Override {
    std::vector<std::string> keys;
    toml::table holder; // the value, under the key "value"

    explicit Override(const std::string& text) {
        if (text.find('\n') != std::string::npos) throw InputError("--set: a value must stand on one line");
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(fmt::format("--set {}: expected key.path=value", text));
        std::string path = text.substr(0, equals);
        std::string value = text.substr(equals + 1);
        std::stringstream parts(path);
        for (std::string key; std::getline(parts, key, '.');) keys.push_back(trimmed(key));
        if (path.back() == '.' || std::find(keys.begin(), keys.end(), "") != keys.end())
            throw InputError(fmt::format("--set {}: a key in \"{}\" is empty", text, path));
        if (keys == std::vector<std::string>{"probe"})
            throw InputError(fmt::format("--set {}: the list of probes cannot be set", text));
        try {
            holder = toml::parse("value = " + value);
        } catch (const toml::parse_error&) {
            holder.clear();
        }
        if (holder.size() != 1)
            throw InputError(
                fmt::format("--set {}: \"{}\" is not a TOML value; a string needs quotes: --set '{}=\"{}\"'", text,
                            value, path, value));
    }
};

std::string_view kind(const toml::node& node) {
    if (node.is_table()) return "a table";
    if (node.is_array()) return "an array";
    if (node.is_string()) return "a string";
    if (node.is_number()) return "a number";
    return node.is_boolean() ? "true or false" : "a date";
}

std::size_t array_index(const toml::array& array, const std::string& key, const std::string& text) {
    std::size_t index = 0;
    const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), index);
    if (error != std::errc{} || end != key.data() + key.size())
        throw InputError(
            fmt::format("--set {}: \"{}\" must be a place in the array, 0 to {}", text, key, array.size() - 1));
    if (index >= array.size())
        throw InputError(fmt::format("--set {}: there is no entry {}; the array has {}", text, key, array.size()));
    return index;
}

void apply(toml::table& data, const std::string& text) {
    const Override change(text);
    const toml::node& value = *change.holder.get("value");
    toml::node* place = &data;
    for (std::size_t k = 0; k < change.keys.size(); ++k) {
        const std::string& key = change.keys[k];
        const bool last = k + 1 == change.keys.size();
        if (toml::table* table = place->as_table()) {
            if (last)
                value.visit([&](const auto& v) { table->insert_or_assign(key, v); });
            else if (!table->contains(key))
                table->insert(key, toml::table{});
            place = table->get(key);
        } else if (toml::array* array = place->as_array()) {
            const std::size_t index = array_index(*array, key, text);
            if (last) value.visit([&](const auto& v) { array->replace(array->cbegin() + static_cast<int>(index), v); });
            place = array->get(index);
        } else {
            throw InputError(
                fmt::format("--set {}: \"{}\" is {}, not a table", text, change.keys[k - 1], kind(*place)));
        }
    }
}

} // namespace

std::uint64_t fnv1a64(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325U; // offset basis, RFC 9923
    for (const char c : bytes) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3U; // prime, RFC 9923
    }
    return hash;
}

Scene scene_from_text(std::string_view text, const std::string& path, const std::string& folder,
                      const std::vector<std::string>& overrides) {
    toml::table data = parsed(text, path);
    if (data.empty()) throw InputError(fmt::format("{}: is empty; a scene needs at least [domain] and [time]", path));
    for (const std::string& change : overrides) apply(data, change);
    std::string merged = printed(data);
    std::string hash = fmt::format("fnv1a64:{:016x}", fnv1a64(merged));
    Table root(data, "", path);
    return {std::move(data), std::move(root), path, folder, std::move(merged), std::move(hash), overrides};
}

Scene load_scene(const std::string& path, const std::vector<std::string>& overrides) {
    const std::string text = file_content(path);
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(path, error);
    return scene_from_text(text, path, absolute.parent_path().string(), overrides);
}

} // namespace plumb
