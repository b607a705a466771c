#include "dem/start_laws.hpp"

#include <fmt/format.h>

namespace plumb {

namespace {

/// One step of the generator SplitMix64 (Steele, Lea & Flood 2014, OOPSLA, Fig. 16; constants of variant 13 of
/// Stafford).
std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

} // namespace

Random random_stream(std::int64_t seed, Stream purpose, std::int64_t first, std::int64_t second) {
    std::uint64_t key = mixed(static_cast<std::uint64_t>(seed));
    key = mixed(key ^ static_cast<std::uint64_t>(purpose));
    key = mixed(key ^ static_cast<std::uint64_t>(first));
    return Random(static_cast<std::int64_t>(mixed(key ^ static_cast<std::uint64_t>(second))));
}

EqualDiameters::EqualDiameters(Table& table) : value(table.number("value", positive)) {}

UniformDiameters::UniformDiameters(Table& table)
    : minimum(table.number("minimum", positive)), maximum(table.number("maximum", positive)),
      seed(table.integer("seed")) {
    if (!(minimum < maximum)) table.fail("maximum", fmt::format("{} is not above minimum, {}", maximum, minimum));
}

NormalDiameters::NormalDiameters(Table& table)
    : mean(table.number("mean", positive)), deviation(table.number("deviation", positive)),
      minimum(table.number("minimum", positive)), maximum(table.number("maximum", positive)),
      seed(table.integer("seed")) {
    if (!(minimum < maximum)) table.fail("maximum", fmt::format("{} is not above minimum, {}", maximum, minimum));
    if (mean < minimum || mean > maximum)
        table.fail("mean", fmt::format("{} is outside [minimum, maximum], [{}, {}]", mean, minimum, maximum));
    // Otherwise the law is uniform in all but name, and nearly every draw is thrown away.
    if (deviation > maximum - minimum)
        table.fail("deviation", fmt::format("{} exceeds maximum - minimum, {}; use the law \"uniform\"", deviation,
                                            maximum - minimum));
}

DiameterLaw make_diameters(Table& owner) {
    const toml::node_type type = owner.type("diameter");
    if (type == toml::node_type::table || type == toml::node_type::string)
        return make_family<DiameterLaw>(owner.law("diameter"));
    return EqualDiameters(owner.number("diameter", positive));
}

UniformRandomVelocity::UniformRandomVelocity(Table& table)
    : speed(table.number("speed", non_negative)), seed(table.integer("seed")) {}

MaxwellVelocity::MaxwellVelocity(Table& table)
    : speed(table.number("speed", non_negative)), seed(table.integer("seed")) {}

VelocityLaw make_velocity(Table& owner) {
    if (!owner.has("velocity")) return EqualVelocity(Vec3::Zero());
    const toml::node_type type = owner.type("velocity");
    if (type == toml::node_type::table || type == toml::node_type::string)
        return make_family<VelocityLaw>(owner.law("velocity"));
    return EqualVelocity(owner.vector("velocity"));
}

} // namespace plumb
