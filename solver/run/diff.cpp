#include "run/diff.hpp"

#include "core/errors.hpp"
#include "run/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>
#include <optional>
#include <set>

namespace plumb {

namespace {

namespace fs = std::filesystem;

/// Two files of the same name.
struct Pair {
    std::string name;
    Hdf5Reader a, b;
};

/// A difference and when it happened, for finding the first.
struct Difference {
    double time = std::numeric_limits<double>::infinity(); // [s]
    std::string text;
};

std::string shown(const Shape& shape) {
    std::string text;
    for (const std::size_t n : shape) text += fmt::format("{}{}", text.empty() ? "" : " x ", n);
    return text;
}

/// "7", or "[7, 2]" in a table.
std::string shown_index(std::size_t at, const Shape& shape) {
    if (shape.size() < 2 || shape[1] == 0) return fmt::format("{}", at);
    return fmt::format("[{}, {}]", at / shape[1], at % shape[1]);
}

/// Place of the first entry whose bits differ, over the common length; the common length if there is none.
std::size_t first_difference(const std::vector<double>& a, const std::vector<double>& b) {
    const std::size_t n = std::min(a.size(), b.size());
    for (std::size_t k = 0; k < n; ++k)
        if (std::bit_cast<std::uint64_t>(a[k]) != std::bit_cast<std::uint64_t>(b[k])) return k;
    return n;
}

/// The first difference of one dataset that both files have. `time_of(entry)` tells when an entry belongs.
template <class TimeOf>
std::optional<Difference> dataset_difference(const Pair& files, const std::string& set, TimeOf&& time_of) {
    const Shape shape_a = files.a.shape(set), shape_b = files.b.shape(set);
    const std::vector<double> a = files.a.doubles(set), b = files.b.doubles(set);
    const std::size_t at = first_difference(a, b);
    const std::size_t width = shape_a.size() > 1 ? std::max<std::size_t>(shape_a[1], 1) : 1;
    if (at < std::min(a.size(), b.size())) {
        const double time = time_of(at / width);
        return Difference{time, fmt::format("{} /{} at t = {:.17g} s, index {}: {:.17g} against {:.17g}", files.name,
                                            set, time, shown_index(at, shape_a), a[at], b[at])};
    }
    if (shape_a == shape_b) return std::nullopt;
    const double time = time_of(at / width);
    return Difference{time, fmt::format("{} /{}: {} entries against {}; from t = {:.17g} s on in one only", files.name,
                                        set, shown(shape_a), shown(shape_b), time)};
}

/// Names in both files; a name in one only is a difference.
std::optional<Difference> name_difference(const Pair& files, std::vector<std::string>& common) {
    const std::vector<std::string> names_a = files.a.datasets(), names_b = files.b.datasets();
    std::vector<std::string> only;
    std::set_symmetric_difference(names_a.begin(), names_a.end(), names_b.begin(), names_b.end(),
                                  std::back_inserter(only));
    // Provenance may differ, and so may which snapshots were listed before a kill.
    const auto skipped = [](const std::string& n) {
        return n.rfind("provenance/", 0) == 0 || n.rfind("snapshots/", 0) == 0;
    };
    only.erase(std::remove_if(only.begin(), only.end(), skipped), only.end());
    if (!only.empty())
        return Difference{0.0, fmt::format("{} /{}: is in one of the two only", files.name, only.front())};
    std::copy_if(names_a.begin(), names_a.end(), std::back_inserter(common),
                 [&](const std::string& n) { return !skipped(n); });
    return std::nullopt;
}

std::optional<Difference> series_difference(const Pair& files) {
    std::vector<std::string> sets;
    if (auto found = name_difference(files, sets)) return found;
    std::optional<Difference> first;
    for (const std::string& set : sets) {
        const std::string times = set.substr(0, set.rfind('/')) + "/time";
        const std::vector<double> a = files.a.doubles(times), b = files.b.doubles(times);
        const auto time_of = [&](std::size_t row) {
            const std::vector<double>& longer = a.size() >= b.size() ? a : b;
            return longer.empty() ? 0.0 : longer[std::min(row, longer.size() - 1)];
        };
        auto found = dataset_difference(files, set, time_of);
        if (found && (!first || found->time < first->time)) first = std::move(found);
    }
    return first;
}

/// All datasets of two files that hold one moment.
std::optional<Difference> state_difference(const Pair& files) {
    const std::int64_t step_a = files.a.integer("/", "step"), step_b = files.b.integer("/", "step");
    const double time = files.a.number("/", "time");
    if (step_a != step_b) return Difference{time, fmt::format("{}: step {} against {}", files.name, step_a, step_b)};
    std::vector<std::string> sets;
    if (auto found = name_difference(files, sets)) return found;
    for (const std::string& set : sets)
        if (auto found = dataset_difference(files, set, [time](std::size_t) { return time; })) return found;
    return std::nullopt;
}

std::set<std::string> snapshot_files(const std::string& folder) {
    std::set<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder + "/snapshots", error), end; !error && entry != end;
         entry.increment(error))
        if (entry->path().extension() == ".h5") names.insert("snapshots/" + entry->path().filename().string());
    return names;
}

/// "x.h5: is in A only"
std::optional<std::string> presence_difference(const std::string& a, const std::string& b, const std::string& name) {
    const bool in_a = fs::exists(a + "/" + name), in_b = fs::exists(b + "/" + name);
    if (in_a == in_b) return std::nullopt;
    return fmt::format("{}: is in {} only", name, in_a ? a : b);
}

} // namespace

Comparison difference(const std::string& a, const std::string& b) {
    for (const std::string& folder : {a, b})
        if (!fs::exists(folder + "/run.json")) throw InputError(fmt::format("{}: there is no plumb result", folder));
    std::set<std::string> snapshots = snapshot_files(a);
    snapshots.merge(snapshot_files(b));
    std::vector<std::string> names{"series.h5"};
    names.insert(names.end(), snapshots.begin(), snapshots.end());
    names.emplace_back("checkpoint.h5");
    std::size_t compared = 0;
    for (const std::string& name : names) {
        if (auto missing = presence_difference(a, b, name)) return {false, *missing};
        const std::string first = fmt::format("{}/{}", a, name), second = fmt::format("{}/{}", b, name);
        if (!fs::exists(first)) continue;
        const Pair files{name, Hdf5Reader(first), Hdf5Reader(second)};
        const auto found = name == "series.h5" ? series_difference(files) : state_difference(files);
        if (found) return {false, found->text};
        ++compared;
    }
    return {true, fmt::format("identical in {} files", compared)};
}

} // namespace plumb
