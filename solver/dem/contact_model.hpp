// Contact, rolling and cohesion laws of every pair of materials. Each group of grains and each wall is a material;
// unlike pairs are given by [[contact]] tables, never by a mixing rule.
#pragma once

#include "dem/cohesion_laws.hpp"
#include "dem/contact_laws.hpp"
#include "dem/rolling_laws.hpp"

#include <optional>
#include <string>
#include <vector>

namespace plumb {

/// Parameters of one law for all pairs of materials: entry a * materials + b. `uniform` if all entries are the same.
template <class Law> struct PairLaws {
    std::int32_t materials = 0;
    std::vector<Law> laws;
    bool uniform = true;
    const Law& of(std::int32_t a, std::int32_t b) const {
        return laws[static_cast<std::size_t>(a) * static_cast<std::size_t>(materials) + static_cast<std::size_t>(b)];
    }
};

namespace detail {
template <class Variant> struct PairVariant;
template <class... Laws> struct PairVariant<std::variant<Laws...>> { using type = std::variant<PairLaws<Laws>...>; };
} // namespace detail

struct ContactModel {
    detail::PairVariant<ContactLaw>::type contact;
    detail::PairVariant<RollingLaw>::type rolling;
    detail::PairVariant<CohesionLaw>::type cohesion;
};

/// True when grains pass through each other.
inline bool contactless(const ContactModel& m) { return std::holds_alternative<PairLaws<NoContact>>(m.contact); }

/// The liquid bridges of a scene; nullptr when all its grains are dry.
inline const PairLaws<LiquidBridge>* liquid_bridges(const ContactModel& m) {
    return std::get_if<PairLaws<LiquidBridge>>(&m.cohesion);
}

/// Greatest rupture distance of any bridge between grains of radii up to `largest` [m]; 0 in a dry scene.
double cohesion_reach(const ContactModel& model, double largest);

/// One contact table as read from a scene.
struct MaterialContact {
    ContactLaw contact;
    RollingLaw rolling;
    CohesionLaw cohesion = NoCohesion{};
};
MaterialContact read_contact(Table table);

/// A [[contact]] table: the pair of material names and its laws.
struct PairContact {
    std::string a, b;
    MaterialContact laws;
};

/// Fills the table of pairs. `names` and `own` list the materials: groups first, then walls. A wall without a table of
/// its own ("as_grains") touches every grain as that grain touches its like; a wall with one uses it for all grains,
/// unless a
/// [[contact]] says otherwise. InputError if two unlike groups have no [[contact]], or if laws are mixed; but some
/// pairs may be dry where others are held by bridges.
ContactModel contact_model(const std::vector<std::string>& names,
                           const std::vector<std::optional<MaterialContact>>& own, std::size_t groups,
                           const std::vector<PairContact>& pairs, const std::string& file);

} // namespace plumb
