// A law is a small struct, a family of laws is a std::variant, and this is the only factory.
//
// What a law must have:
//     static constexpr std::string_view name    its name in a scene
//     static constexpr LawInfo info             formula, range of validity and source, printed by `plumb laws`
//     a constructor from its Table (which reads exactly the keys it needs), or a default constructor if it needs none
//     a pure operator()
#pragma once

#include "core/table.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace plumb {

struct LawInfo {
    std::string_view formula;
    std::string_view range;
    std::string_view source;
};

struct LawEntry {
    std::string name;
    LawInfo info;
};

namespace detail {
template <class Law> Law make_law(Table& table) {
    if constexpr (std::is_constructible_v<Law, Table&>)
        return Law(table);
    else
        return Law{};
}
} // namespace detail

/// Names, formulas and ranges of a family, in the order of the variant.
template <class Family, std::size_t... I> std::vector<LawEntry> law_entries(std::index_sequence<I...> /*members*/) {
    return {LawEntry{std::string(std::variant_alternative_t<I, Family>::name),
                     std::variant_alternative_t<I, Family>::info}...};
}
template <class Family> std::vector<LawEntry> law_entries() {
    return law_entries<Family>(std::make_index_sequence<std::variant_size_v<Family>>{});
}

/// The law of `Family` that `table` names at `key`, built from that table. InputError for an unknown name.
template <class Family, std::size_t... I>
Family make_family(Table& table, std::string_view key, std::index_sequence<I...> /*members*/) {
    const std::string name = table.text(key);
    std::optional<Family> made;
    const auto attempt = [&]<class Law>(std::type_identity<Law> /*type*/) {
        if (!made && name == Law::name) made.emplace(detail::make_law<Law>(table));
    };
    (attempt(std::type_identity<std::variant_alternative_t<I, Family>>{}), ...);
    if (!made) {
        std::string known;
        ((known += fmt::format("{}\"{}\"", I == 0 ? "" : ", ", std::variant_alternative_t<I, Family>::name)), ...);
        table.fail(key, fmt::format("\"{}\" is not one of {}", name, known));
    }
    return *std::move(made);
}
template <class Family> Family make_family(Table table, std::string_view key = "law") {
    return make_family<Family>(table, key, std::make_index_sequence<std::variant_size_v<Family>>{});
}

/// Name of the law a variant holds.
template <class Family> std::string law_name(const Family& family) {
    return std::visit([](const auto& law) { return std::string(std::decay_t<decltype(law)>::name); }, family);
}

} // namespace plumb
