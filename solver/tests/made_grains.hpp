// Grains as a scene would make them, for tests.
#pragma once

#include "core/errors.hpp"
#include "dem/arrange.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace plumb {

inline bool always(std::int32_t /*a*/, std::int32_t /*b*/) { return true; }

inline Domain box(const Vec3& size, bool periodic) {
    Domain domain;
    domain.size = size;
    domain.periodic = {periodic, periodic, periodic};
    return domain;
}

struct Made {
    Grains grains;
    std::vector<GrainGroup> groups;
};

/// Grains of the [grains] tables in `text`, with walls of its [[wall]] tables; every key must be used.
inline Made made(const std::string& text, const Domain& domain, const PairTouches& pair_touches = always,
                 const std::string& file = ::testing::TempDir() + "scene.toml") {
    const auto toml = toml::parse(text);
    Table scene(toml, "", file);
    auto walls = scene.tables("wall"), grains = scene.tables("grains");
    const std::vector<WallBody> bodies = make_walls(walls);
    Made result;
    add_grains(result.grains, result.groups, grains, domain, bodies);
    check_start(result.grains, result.groups, grains, domain, bodies, pair_touches);
    scene.finish();
    return result;
}

inline std::string fault(const std::string& text, const Domain& domain) {
    try {
        made(text, domain);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no error";
}

inline void expect_fault(const std::string& text, const Domain& domain, const std::string& part) {
    const std::string message = fault(text, domain);
    EXPECT_NE(message.find(part), std::string::npos) << "message: " << message << "\nexpected: " << part;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

} // namespace plumb
