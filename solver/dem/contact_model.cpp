#include "dem/contact_model.hpp"

#include "core/errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>

namespace plumb {

namespace {

/// Bitwise equality of two laws of one type: their parameters are plain numbers.
template <class Law> bool same(const Law& a, const Law& b) {
    // Different bits of equal numbers (0 and -0) only cost the shorter way.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(&a.parameters, &b.parameters, sizeof a.parameters) == 0;
}

template <class Variant> bool same_law(const Variant& a, const Variant& b) {
    return a.index() == b.index() && std::visit(
                                         [&](const auto& law) {
                                             using Law = std::decay_t<decltype(law)>;
                                             return same(law, std::get<Law>(b));
                                         },
                                         a);
}

/// Collects the laws of all pairs, which must be of one type, into the table for that type.
template <class Pairs, class Variant>
Pairs table_of(const std::vector<const Variant*>& laws, std::int32_t materials, const std::string& file) {
    return std::visit(
        [&](const auto& first) -> Pairs {
            using Law = std::decay_t<decltype(first)>;
            PairLaws<Law> pairs;
            pairs.materials = materials;
            for (const Variant* law : laws) {
                if (!std::holds_alternative<Law>(*law))
                    throw InputError(fmt::format("{}: contact: all contacts of a scene must use one law, found both "
                                                 "\"{}\" and \"{}\"",
                                                 file, Law::name, law_name(*law)));
                pairs.laws.push_back(std::get<Law>(*law));
                pairs.uniform = pairs.uniform && same(pairs.laws.back(), pairs.laws.front());
            }
            return pairs;
        },
        *laws.front());
}

/// Dry pairs among wet ones are bridges without liquid.
decltype(ContactModel::cohesion) cohesion_of(const std::vector<const CohesionLaw*>& laws, std::int32_t materials) {
    if (std::all_of(laws.begin(), laws.end(),
                    [](const CohesionLaw* law) { return std::holds_alternative<NoCohesion>(*law); }))
        return PairLaws<NoCohesion>{materials, std::vector<NoCohesion>(laws.size()), true};
    PairLaws<LiquidBridge> pairs;
    pairs.materials = materials;
    for (const CohesionLaw* law : laws) {
        const auto* bridge = std::get_if<LiquidBridge>(law);
        pairs.laws.push_back(bridge != nullptr ? *bridge : LiquidBridge());
        pairs.uniform = pairs.uniform && same(pairs.laws.back(), pairs.laws.front());
    }
    return pairs;
}

} // namespace

double cohesion_reach(const ContactModel& model, double largest) {
    double reach = 0.0;
    if (const auto* bridges = liquid_bridges(model))
        for (const LiquidBridge& law : bridges->laws)
            reach = std::max(reach, law.rupture_distance(LiquidBridge::formed_volume(law.parameters, largest)));
    return reach;
}

MaterialContact read_contact(Table table) {
    ContactLaw contact = make_family<ContactLaw>(table);
    // Without friction nothing can roll; with it, whether rolling is resisted is a choice of the scene.
    const bool frictional = std::visit([](const auto& law) { return law.parameters.friction > 0.0; }, contact);
    RollingLaw rolling = NoRolling{};
    if (frictional || table.has("rolling")) rolling = make_family<RollingLaw>(table.law("rolling"));
    CohesionLaw cohesion = NoCohesion{};
    if (table.has("cohesion")) cohesion = make_family<CohesionLaw>(table.law("cohesion"));
    if (std::holds_alternative<NoContact>(contact) && !std::holds_alternative<NoCohesion>(cohesion))
        table.fail("cohesion", "bridges form where grains touch, and the contact law \"none\" lets none touch");
    return {contact, rolling, cohesion};
}

ContactModel contact_model(const std::vector<std::string>& names,
                           const std::vector<std::optional<MaterialContact>>& own, std::size_t groups,
                           const std::vector<PairContact>& pairs, const std::string& file) {
    const std::size_t n = names.size();
    std::map<std::pair<std::string, std::string>, const MaterialContact*> given;
    for (const PairContact& pair : pairs) {
        for (const std::string& name : {pair.a, pair.b})
            if (std::find(names.begin(), names.end(), name) == names.end())
                throw InputError(fmt::format("{}: contact.between: there is no \"{}\"", file, name));
        if (given.count({pair.a, pair.b}))
            throw InputError(
                fmt::format("{}: contact.between: \"{}\" and \"{}\" are given twice", file, pair.a, pair.b));
        given[{pair.a, pair.b}] = given[{pair.b, pair.a}] = &pair.laws;
    }
    std::vector<const ContactLaw*> contact;
    std::vector<const RollingLaw*> rolling;
    std::vector<const CohesionLaw*> cohesion;
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = 0; b < n; ++b) {
            const MaterialContact* laws = nullptr;
            const auto pair = given.find({names[a], names[b]});
            if (pair != given.end())
                laws = pair->second;
            else if (a >= groups || b >= groups) { // with a wall: its own table, else that of the grains
                const std::size_t wall = std::max(a, b), other = std::min(a, b);
                laws = own[wall] ? &*own[wall] : (own[other] ? &*own[other] : &*own.front());
            } else if (a == b ||
                       (same_law(own[a]->contact, own[b]->contact) && same_law(own[a]->rolling, own[b]->rolling) &&
                        same_law(own[a]->cohesion, own[b]->cohesion)))
                laws = &*own[a];
            else
                throw InputError(fmt::format("{}: contact: \"{}\" and \"{}\" differ; give [[contact]] between = "
                                             "[\"{}\", \"{}\"]",
                                             file, names[a], names[b], names[a], names[b]));
            contact.push_back(&laws->contact);
            rolling.push_back(&laws->rolling);
            cohesion.push_back(&laws->cohesion);
        }
    using ContactPairs = decltype(ContactModel::contact);
    using RollingPairs = decltype(ContactModel::rolling);
    const auto materials = static_cast<std::int32_t>(n);
    return {table_of<ContactPairs>(contact, materials, file), table_of<RollingPairs>(rolling, materials, file),
            cohesion_of(cohesion, materials)};
}

} // namespace plumb
