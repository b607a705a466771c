// The manufactured flow among a moving porosity against differences of its own fields.
#include "core/scene.hpp"
#include "grid/grid_sources.hpp"

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char* law = R"(
[source]
law = "manufactured_medium"
speed = 1.3
porosity = {law = "wave", mean = 0.65, amplitude = 0.1, waves = [2, 1], period = 0.7}
resistance = {law = "ergun", diameter = 0.6}
)";

struct ManufacturedMediumTest : testing::Test {
    Scene scene = scene_from_text(law, "scene.toml", "/");
    Table table = scene.root.table("source");
    ManufacturedMediumSource source{table};
    const Vec3 size = Vec3(2.0, 2.0, 0.0);
    const double rho = 3.0, mu = 0.05, t = 0.23, h = 1e-4;
    const Vec3 x = Vec3(0.83, 1.37, 0.0);
    const std::array<Vec3, 2> along{Vec3(h, 0.0, 0.0), Vec3(0.0, h, 0.0)};

    ManufacturedMedium::State at(const Vec3& place, double time) const {
        return source.flow.at(place, time, size, rho);
    }
    double eps(const Vec3& place, double time) const { return source.flow.porosity(place, time, size); }
};

TEST_F(ManufacturedMediumTest, KeepsMass) {
    EXPECT_EQ(at(x, t).eps, eps(x, t));
    double sum = (eps(x, t + h) - eps(x, t - h)) / (2.0 * h);
    const double rate = sum;
    for (std::size_t d = 0; d < 2; ++d) {
        const auto k = static_cast<Eigen::Index>(d);
        const auto flux = [&](const Vec3& place) { return eps(place, t) * at(place, t).u[k]; };
        sum += (flux(x + along[d]) - flux(x - along[d])) / (2.0 * h);
    }
    EXPECT_NEAR(sum, 0.0, 1e-6 * std::abs(rate));
}

TEST_F(ManufacturedMediumTest, SourceBalancesMomentum) {
    const ManufacturedMedium::State here = at(x, t);
    Vec3 acceleration = (at(x, t + h).u - at(x, t - h).u) / (2.0 * h), force = Vec3::Zero();
    for (std::size_t d = 0; d < 2; ++d) {
        const auto k = static_cast<Eigen::Index>(d);
        const ManufacturedMedium::State up = at(x + along[d], t), down = at(x - along[d], t);
        acceleration += here.u[k] * (up.u - down.u) / (2.0 * h);
        force[k] -= (up.p - down.p) / (2.0 * h);
        force += mu / here.eps *
                 (eps(x + 0.5 * along[d], t) * (up.u - here.u) - eps(x - 0.5 * along[d], t) * (here.u - down.u)) /
                 (h * h);
    }
    // Ergun by hand, per volume of fluid
    const double phi = 1.0 - here.eps, d = 0.6;
    const double beta = 150.0 * mu * phi * phi / (here.eps * d * d) + 1.75 * rho * phi * here.u.norm() / d;
    force -= beta / here.eps * here.u;
    const FluidNumbers numbers{size, rho, 0.0, mu, Vec3::Zero(), LinearState{}};
    const Vec3 s = source(x, t, numbers);
    EXPECT_LT((acceleration - force / rho - s).norm(), 1e-5 * s.norm());
}

} // namespace
} // namespace plumb
