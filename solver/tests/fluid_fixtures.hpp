// Small fluids and helpers shared by the tests of the smoothed particles.
#pragma once

#include "core/parallel.hpp"
#include "grain_fixtures.hpp"
#include "sph/fluid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <variant>

namespace plumb::fixture {

/// The types of a variant as a list for TYPED_TEST_SUITE.
template <class V> struct TypesOf;
template <class... T> struct TypesOf<std::variant<T...>> { using type = testing::Types<T...>; };

/// Calls body(law) with a default-made law of every type of the variant.
template <class V, std::size_t k = 0, class Body> void for_each_law(Body&& body) {
    if constexpr (k < std::variant_size_v<V>) {
        body(std::variant_alternative_t<k, V>{});
        for_each_law<V, k + 1>(body);
    }
}

/// Integral of g over [a, b]: Gauss's rule of five points on `panels` panels.
template <class G> double integral(G&& g, double a, double b, int panels) {
    constexpr double near = 0.5384693101056831, far = 0.9061798459386640;
    constexpr double w0 = 0.5688888888888889, w1 = 0.4786286704993665, w2 = 0.2369268850561891;
    const double half = 0.5 * (b - a) / panels;
    double sum = 0.0;
    for (int k = 0; k < panels; ++k) {
        const double middle = a + (2 * k + 1) * half;
        sum += w0 * g(middle) + w1 * (g(middle - near * half) + g(middle + near * half)) +
               w2 * (g(middle - far * half) + g(middle + far * half));
    }
    return half * sum;
}

/// Sets the number of threads while it lives.
class Threads {
public:
    explicit Threads(int n) : before_(thread_count()) { set_threads(n); }
    ~Threads() { set_threads(before_); }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

private:
    int before_;
};

inline Domain box_of_dimensions(int dimensions, Vec3 size, std::array<bool, 3> periodic) {
    if (dimensions == 2) size[2] = 0.0, periodic[2] = false;
    Domain domain = box(size, periodic);
    domain.dimensions = dimensions;
    return domain;
}

/// A fluid without particles: spacing 0.1 m, 1000 kg/m3, c = 20 m/s, no viscosity, no extras.
inline SphFluid empty_fluid(const Domain& domain, const Kernel& kernel, double smoothing) {
    SphFluid f;
    f.dimensions = domain.dimensions;
    f.domain = domain;
    f.density = 1000.0;
    f.spacing = 0.1;
    f.h = smoothing * f.spacing;
    f.sound_speed = 20.0;
    f.mass = f.density * std::pow(f.spacing, f.dimensions);
    f.kernel = kernel;
    f.clusters.reach = support(kernel) * f.h;
    f.clusters.skin = 0.15 * f.spacing;
    return f;
}

/// Appends one particle at rest or in motion; ids count up.
inline void put(SphFluid& f, const Vec3& x, const Vec3& v, double rho) {
    for (int c = 0; c < f.dimensions; ++c) {
        const auto k = static_cast<std::size_t>(c);
        f.x[k].push_back(x[c]), f.v[k].push_back(v[c]);
        f.a[k].push_back(0.0), f.x_listed[k].push_back(x[c]);
    }
    f.rho.push_back(rho), f.drho.push_back(0.0);
    f.id.push_back(f.next_id++);
    ++f.particles;
}

/// Fills a box of n spacings with a lattice jittered by up to `jitter` spacings.
inline void put_lattice(SphFluid& f, std::array<int, 3> n, double jitter, std::int64_t seed) {
    Random random(seed);
    for (int c = 0; c < (f.dimensions == 3 ? n[2] : 1); ++c)
        for (int b = 0; b < n[1]; ++b)
            for (int a = 0; a < n[0]; ++a) {
                const Vec3 moved = random_vector(random, -jitter, jitter);
                put(f, f.spacing * (Vec3(a, b, c) + Vec3::Constant(0.5) + moved), Vec3::Zero(), f.density);
            }
}

/// Random velocities up to `speed` and densities within `share` of rho_0.
inline void stir(SphFluid& f, double speed, double share, std::int64_t seed) {
    Random random(seed);
    for (std::size_t k = 0; k < f.slots(); ++k) {
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
            f.v[c][k] = random.uniform(-speed, speed);
        f.rho[k] = f.density * (1.0 + random.uniform(-share, share));
    }
}

/// Entry of a vector field; z is 0 in the plane.
inline Vec3 entry(const SphFluid& f, const VectorField& field, std::size_t k) {
    Vec3 value = Vec3::Zero();
    for (int c = 0; c < f.dimensions; ++c) value[c] = field[static_cast<std::size_t>(c)][k];
    return value;
}

/// Slot of the particle `id`.
inline std::vector<std::size_t> slots_by_id(const SphFluid& f) {
    const std::vector<std::int32_t> slots = ordered_slots(f);
    return {slots.begin(), slots.end()};
}

/// Same positions, velocities, densities and rates of every particle, bit for bit, whatever the slots.
inline void expect_same_bits(const SphFluid& a, const SphFluid& b) {
    const std::vector<std::size_t> in_a = slots_by_id(a), in_b = slots_by_id(b);
    ASSERT_EQ(in_a.size(), in_b.size());
    std::size_t different = 0;
    for (std::size_t id = 0; id < in_a.size(); ++id) {
        bool same =
            same_bits(&a.rho[in_a[id]], &b.rho[in_b[id]], 1) && same_bits(&a.drho[in_a[id]], &b.drho[in_b[id]], 1);
        for (const auto field : {&SphFluid::x, &SphFluid::v, &SphFluid::a})
            same = same && same_bits(entry(a, a.*field, in_a[id]), entry(b, b.*field, in_b[id]));
        different += same ? 0U : 1U;
    }
    EXPECT_EQ(different, 0U) << "of " << in_a.size() << " particles differ";
}

} // namespace plumb::fixture
