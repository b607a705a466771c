// The box: nearest images and wrapping.
#include "core/domain.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

// Images along an open axis, or a wrong side: against the best of all 27 images.
TEST(Domain, MinimumImageIsTheNearestOfAllImages) {
    Random random(1);
    for (const auto periodic :
         {std::array{true, true, true}, std::array{true, false, true}, std::array{false, false, false}}) {
        const Domain domain = box(Vec3(1.0, 2.0, 0.5), periodic);
        for (int repeat = 0; repeat < 2000; ++repeat) {
            const Vec3 dx = random_vector(random, -1.0, 1.0).cwiseProduct(domain.size);
            Vec3 best = dx;
            for (int a = -1; a <= 1; ++a)
                for (int b = -1; b <= 1; ++b)
                    for (int c = -1; c <= 1; ++c) {
                        const Vec3 image = dx + Vec3(periodic[0] ? a : 0, periodic[1] ? b : 0, periodic[2] ? c : 0)
                                                    .cwiseProduct(domain.size);
                        if (image.norm() < best.norm()) best = image;
                    }
            ASSERT_LT((domain.minimum_image(dx) - best).norm(), 1e-15);
        }
    }
}

// A wrong number of turns, or a change along an open axis.
TEST(Domain, WrappedMovesByWholeBoxesAlongPeriodicAxesOnly) {
    const Domain domain = box(Vec3(1.0, 2.0, 4.0), {true, true, false});
    EXPECT_EQ(domain.wrapped(Vec3(0.25, 0.5, 9.0)), Vec3(0.25, 0.5, 9.0));
    EXPECT_EQ(domain.wrapped(Vec3(-0.25, 2.5, -9.0)), Vec3(0.75, 0.5, -9.0));
    EXPECT_EQ(domain.wrapped(Vec3(3.25, -3.5, 4.0)), Vec3(0.25, 0.5, 4.0));
    EXPECT_EQ(domain.wrapped(Vec3(1.0, 2.0, 4.0)), Vec3(0.0, 0.0, 4.0)); // the far side is the near side
    EXPECT_EQ(domain.wrapped(Vec3(-1e-300, 0.0, 0.0)), Vec3(0.0, 0.0, 0.0));
}

// Rounding that leaves a position outside the box, or a second wrapping that moves it again: the neighbour list of a
// resumed run is built from wrapped positions and must not change them.
TEST(Domain, WrappedLiesInTheBoxAndIsAFixedPoint) {
    Random random(2);
    std::size_t outside = 0, moved = 0;
    for (int repeat = 0; repeat < 200000; ++repeat) {
        const double size = random.uniform(1e-4, 1e-1);
        const Domain domain = box(Vec3::Constant(size), {true, true, true});
        const double turns = std::floor(random.uniform(-6.0, 7.0));
        double x = turns * size; // the hard cases are next to a multiple of the size
        for (int k = static_cast<int>(random.uniform(0.0, 3.0)); k > 0; --k) x = std::nextafter(x, -1.0);
        const Vec3 once = domain.wrapped(Vec3::Constant(x));
        if (!(once.x() >= 0.0 && once.x() < size)) ++outside;
        if (!same_bits(once, domain.wrapped(once))) ++moved;
    }
    EXPECT_EQ(outside, 0U);
    EXPECT_EQ(moved, 0U);
}
