// Small scenes and helpers shared by the tests of the grain engine.
#pragma once

#include "core/errors.hpp"
#include "core/random.hpp"
#include "dem/advance_grains.hpp"
#include "dem/grain_system.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <initializer_list>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb::fixture {

/// A table of the file "scene.toml" from its text.
inline Table table_of(std::string_view text, std::string path = "") {
    return {toml::parse(text), std::move(path), "scene.toml"};
}

/// The text of the InputError that f() throws; a failure of the test and "" when it throws none.
template <class F> std::string message_of(F&& f) {
    try {
        f();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return "";
}

/// f() must throw an InputError of one line whose text has all `parts`.
template <class F> void expect_error(F&& f, std::initializer_list<std::string_view> parts) {
    const std::string message = message_of(std::forward<F>(f));
    for (const std::string_view part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << "\"" << part << "\" is not in: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message.substr(0, 60);
}

/// A contact table from its text; every key must be read.
inline MaterialContact contact_of(std::string_view text) {
    Table table = table_of(text, "grains.contact");
    MaterialContact made = read_contact(table);
    table.finish();
    return made;
}

template <class Law> Law law_of(std::string_view text) { return std::get<Law>(contact_of(text).contact); }
template <class Law> Law rolling_of(std::string_view text) {
    Table table = table_of(text, "grains.contact.rolling");
    Law made(table);
    table.finish();
    return made;
}

inline Domain box(const Vec3& size, std::array<bool, 3> periodic = {false, false, false},
                  const Vec3& gravity = Vec3::Zero()) {
    Domain domain;
    domain.size = size;
    domain.periodic = periodic;
    domain.gravity = gravity;
    return domain;
}

inline GrainGroup group_of(std::string name, double density = 2500.0, bool rotation = true,
                           Motion motion = Motion::free) {
    GrainGroup group;
    group.name = std::move(name);
    group.density = density;
    group.rotation = rotation;
    group.motion = motion;
    return group;
}

/// A system without grains: groups of one material, walls that touch as grains do.
inline GrainSystem system_of(const Domain& domain, std::string_view contact,
                             std::vector<GrainGroup> groups = {group_of("glass")}, std::vector<WallBody> walls = {}) {
    GrainSystem system;
    system.domain = domain;
    std::vector<std::string> names;
    std::vector<std::optional<MaterialContact>> own;
    for (const GrainGroup& group : groups) {
        names.push_back(group.name);
        own.emplace_back(contact_of(contact));
    }
    for (WallBody& wall : walls) {
        wall.material = static_cast<std::int32_t>(names.size());
        names.push_back(wall.name);
        own.emplace_back(std::nullopt);
    }
    system.contact = contact_model(names, own, groups.size(), {}, "scene.toml");
    system.groups = std::move(groups);
    system.walls = std::move(walls);
    return system;
}

inline void add(GrainSystem& system, double radius, const Vec3& x, const Vec3& v = Vec3::Zero(),
                const Vec3& omega = Vec3::Zero(), std::int32_t group = 0) {
    add_grain(system.grains, system.groups, group, radius, x, v, omega);
}

/// A plane through `point`; `normal` into the domain.
inline WallBody plane(std::string name, const Vec3& point, const Vec3& normal, const Vec3& velocity = Vec3::Zero()) {
    Table table = table_of("point = [0, 0, 0]\nnormal = [0, 0, 1]");
    Plane shape(table);
    shape.point = point;
    shape.normal = normal.normalized();
    return WallBody{std::move(name), shape, velocity};
}

/// Place in the present order of the grain `id`.
inline std::size_t place(const Grains& grains, std::int32_t id) {
    return static_cast<std::size_t>(positions_of_ids(grains)[static_cast<std::size_t>(id)]);
}

inline Vec3 random_vector(Random& random, double lower, double upper) {
    const double x = random.uniform(lower, upper), y = random.uniform(lower, upper);
    return {x, y, random.uniform(lower, upper)};
}

/// Grains of radii in [least, largest] anywhere in the box (overlaps allowed), with random motion up to `speed`.
inline void add_cloud(GrainSystem& system, int count, double least, double largest, double speed, double spin,
                      std::int64_t seed) {
    Random random(seed);
    for (int k = 0; k < count; ++k) {
        const double radius = random.uniform(least, largest);
        const Vec3 x = random_vector(random, 0.0, 1.0).cwiseProduct(system.domain.size);
        const Vec3 v = random_vector(random, -speed, speed);
        const Vec3 omega = random_vector(random, -spin, spin);
        add(system, radius, x, v, omega,
            static_cast<std::int32_t>(k) % static_cast<std::int32_t>(system.groups.size()));
    }
}

/// Grains on a cubic lattice that fills the box, shifted by up to `jitter` of the spacing: moderate overlaps only.
inline void add_jittered_lattice(GrainSystem& system, int per_side, double least, double largest, double jitter,
                                 double speed, double spin, std::int64_t seed) {
    Random random(seed);
    const Vec3 spacing = system.domain.size / per_side;
    for (int a = 0; a < per_side; ++a)
        for (int b = 0; b < per_side; ++b)
            for (int c = 0; c < per_side; ++c) {
                const Vec3 x = (Vec3(a, b, c) + Vec3::Constant(0.5) + random_vector(random, -jitter, jitter))
                                   .cwiseProduct(spacing);
                const double radius = random.uniform(least, largest);
                const Vec3 v = random_vector(random, -speed, speed);
                add(system, radius, x, v, random_vector(random, -spin, spin),
                    static_cast<std::int32_t>(system.grains.size() % system.groups.size()));
            }
}

inline Vec3 momentum(const Grains& g) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < g.size(); ++k) sum += g.mass[k] * g.v[k];
    return sum;
}
/// About the origin; for boxes without periodic sides.
inline Vec3 angular_momentum(const Grains& g) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < g.size(); ++k)
        sum += g.mass[k] * g.x[k].cross(g.v[k]) + sphere_inertia(g.mass[k], 2.0 * g.radius[k]) * g.omega[k];
    return sum;
}
inline double kinetic_energy(const Grains& g) {
    double sum = 0.0;
    for (std::size_t k = 0; k < g.size(); ++k)
        sum += 0.5 * g.mass[k] * g.v[k].squaredNorm() +
               0.5 * sphere_inertia(g.mass[k], 2.0 * g.radius[k]) * g.omega[k].squaredNorm();
    return sum;
}

inline bool same_bits(const double* a, const double* b, std::size_t n) {
    return std::memcmp(a, b, n * sizeof(double)) == 0;
}
inline bool same_bits(const Vec3& a, const Vec3& b) { return same_bits(a.data(), b.data(), 3); }

/// Same order, positions, velocities, accelerations and spins, bit for bit.
inline void expect_same_bits(const Grains& a, const Grains& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.id, b.id);
    std::size_t different = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        different += same_bits(a.x[k], b.x[k]) && same_bits(a.v[k], b.v[k]) && same_bits(a.a[k], b.a[k]) &&
                             same_bits(a.omega[k], b.omega[k]) && same_bits(a.alpha[k], b.alpha[k]) &&
                             same_bits(a.turns[k], b.turns[k])
                         ? 0U
                         : 1U;
    EXPECT_EQ(different, 0U) << "of " << a.size() << " grains differ";
}

/// Slope of log(error) against log(step), from two runs.
inline double order_of(double coarse_error, double fine_error, double ratio) {
    return std::log(coarse_error / fine_error) / std::log(ratio);
}

} // namespace plumb::fixture
