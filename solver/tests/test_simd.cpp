// Packs of eight doubles against the scalar formula, lane by lane and bit by bit.
#include "core/simd.hpp"

#include "grain_fixtures.hpp"

#include <limits>

using namespace plumb;
using namespace plumb::fixture;

namespace {

Pack random_pack(Random& random) {
    Pack p{};
    for (int k = 0; k < 8; ++k) p[k] = random.normal() * std::pow(10.0, random.uniform(-9.0, 9.0));
    return p;
}
double lane(const Space<Pack>& s, int component, int k) {
    return component == 0 ? s.x[k] : component == 1 ? s.y[k] : s.z[k];
}
Space<double> lane(const Space<Pack>& s, int k) { return {s.x[k], s.y[k], s.z[k]}; }

} // namespace

// One wrong index among the 64: every entry is its own number.
TEST(Simd, TransposeMovesEveryEntry) {
    Pack r[8];
    for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 8; ++c) r[k][c] = 10 * k + c;
    transpose(r);
    for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 8; ++c) EXPECT_EQ(r[c][k], 10 * k + c);
    transpose(r); // an involution
    for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 8; ++c) EXPECT_EQ(r[k][c], 10 * k + c);
}

// An approximate square root, or one that shuffles lanes; special values included.
TEST(Simd, SquareRootHasTheBitsOfTheScalarOne) {
    Random random(3);
    for (int repeat = 0; repeat < 1000; ++repeat) {
        Pack x = random_pack(random);
        for (int k = 0; k < 8; ++k) x[k] = std::abs(x[k]);
        x[repeat % 8] = repeat % 3 == 0 ? 0.0 : repeat % 3 == 1 ? std::numeric_limits<double>::denorm_min() : 1e308;
        const Pack root = square_root(x);
        for (int k = 0; k < 8; ++k) {
            const double own = std::sqrt(x[k]), packed = root[k];
            ASSERT_TRUE(same_bits(&own, &packed, 1));
        }
    }
    EXPECT_EQ(square_root(std::numeric_limits<double>::infinity()), std::numeric_limits<double>::infinity());
}

// Arms of select swapped, or a NaN of the arm not chosen leaking through arithmetic blending.
TEST(Simd, SelectTakesTheChosenArmOnly) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Pack a{1, 2, 3, 4, 5, 6, 7, 8}, b{nan, nan, nan, nan, -5, -6, -7, -8};
    const PackMask mask{-1, -1, -1, -1, 0, 0, 0, 0};
    const Pack s = select(mask, a, b);
    for (int k = 0; k < 8; ++k) EXPECT_EQ(s[k], k < 4 ? k + 1 : -(k + 1));
    EXPECT_EQ(select(true, 1.0, nan), 1.0);
    EXPECT_EQ(select(false, nan, 2.0), 2.0);
    const Space<Pack> v = select<Pack>(mask, {a, a, a}, {b, b, b});
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 8; ++k) EXPECT_EQ(lane(v, c, k), s[k]);
}

// larger and smaller swapped; any() that looks at some lanes only.
TEST(Simd, ComparisonsAndAny) {
    const Pack a{1, -2, 3, -4, 5, 0, 7, -8}, b{2, -3, 3, 4, -5, 1, 7, 8};
    for (int k = 0; k < 8; ++k) {
        EXPECT_EQ(larger(a, b)[k], std::max(a[k], b[k]));
        EXPECT_EQ(smaller(a, b)[k], std::min(a[k], b[k]));
        PackMask mask{};
        EXPECT_FALSE(any(mask));
        mask[k] = -1;
        EXPECT_TRUE(any(mask));
    }
    EXPECT_EQ(larger(2.0, 3.0), 3.0);
    EXPECT_EQ(smaller(2.0, 3.0), 2.0);
    EXPECT_TRUE(any(true));
    EXPECT_FALSE(any(false));
}

// Sign or component of a vector product; packs must agree with scalars and scalars with Eigen.
TEST(Simd, VectorsOfSpace) {
    Random random(5);
    const Space<Pack> a{random_pack(random), random_pack(random), random_pack(random)};
    const Space<Pack> b{random_pack(random), random_pack(random), random_pack(random)};
    const Space<double> z = cross(Space<double>{1, 0, 0}, Space<double>{0, 1, 0});
    EXPECT_EQ(z.x, 0.0);
    EXPECT_EQ(z.y, 0.0);
    EXPECT_EQ(z.z, 1.0);
    for (int k = 0; k < 8; ++k) {
        const Space<double> p = lane(a, k), q = lane(b, k);
        const Vec3 e = Vec3(p.x, p.y, p.z).cross(Vec3(q.x, q.y, q.z));
        const Space<double> c = cross(p, q);
        EXPECT_NEAR(c.x, e.x(), 1e-15 * (std::abs(p.y * q.z) + std::abs(p.z * q.y)));
        EXPECT_NEAR(c.y, e.y(), 1e-15 * (std::abs(p.z * q.x) + std::abs(p.x * q.z)));
        EXPECT_NEAR(c.z, e.z(), 1e-15 * (std::abs(p.x * q.y) + std::abs(p.y * q.x)));
        const double packed = dot(a, b)[k], own = dot(p, q);
        EXPECT_NEAR(packed, own, 1e-15 * (std::abs(p.x * q.x) + std::abs(p.y * q.y) + std::abs(p.z * q.z)));
        EXPECT_EQ((a + b).x[k], p.x + q.x);
        EXPECT_EQ((a - b).z[k], p.z - q.z);
    }
}
