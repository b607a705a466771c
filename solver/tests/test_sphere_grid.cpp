#include "dem/sphere_grid.hpp"

#include "core/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace plumb {
namespace {

TEST(SphereGrid, FindsEveryOverlapThatAllPairsFind) {
    Random random(11);
    for (const bool periodic : {false, true})
        for (int trial = 0; trial < 20; ++trial) {
            const Domain domain = Domain{Vec3(1.0, 0.3, 2.0), {periodic, periodic, periodic}, Vec3::Zero()};
            const double cell = random.uniform(0.01, 0.5);
            SphereGrid grid(domain, Vec3(0.2, 0.1, 0.0), Vec3(0.8, 0.2, 1.0), cell,
                            60); // spheres lie beyond it as well
            std::vector<Vec3> x;
            std::vector<double> r;
            for (int i = 0; i < 60; ++i) {
                const double px = random.uniform(0.0, 1.0), py = random.uniform(0.0, 0.3);
                x.emplace_back(px, py, random.uniform(0.0, 2.0));
                r.push_back(i % 20 == 0 ? 0.14 : random.uniform(0.005, 0.05)); // a few large ones
                std::vector<bool> found(x.size(), false);
                const auto k = static_cast<std::size_t>(i);
                const auto overlap = [&](std::size_t j) {
                    return domain.minimum_image(x[k] - x[j]).norm() < r[k] + r[j];
                };
                grid.any_near(x[k], r[k], [&](std::int32_t j) {
                    found[static_cast<std::size_t>(j)] = overlap(static_cast<std::size_t>(j));
                    return false;
                });
                for (std::size_t j = 0; j < k; ++j) EXPECT_EQ(found[j], overlap(j));
                grid.insert(i, x[k], r[k]);
            }
        }
}

} // namespace
} // namespace plumb
