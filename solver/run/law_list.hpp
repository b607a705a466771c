// All families of laws, for `plumb laws`.
#pragma once

#include "core/laws.hpp"

#include <string>
#include <vector>

namespace plumb {

struct LawFamily {
    std::string name; // where it stands in a scene: "coupling.drag"
    std::vector<LawEntry> laws;
};

/// Every family in the order of the scene's tables.
std::vector<LawFamily> law_families();

/// The families as text for reading, or as JSON: an object of families, each a list of {name, formula, range, source}.
std::string law_list(bool json);

} // namespace plumb
