#include "dem/start_laws.hpp"

#include "tests/made_grains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace plumb {
namespace {

TEST(Diameters, FollowTheirLaws) {
    const auto diameters = [](const std::string& law) {
        const Grains grains =
            made("[grains]\ndensity = 2.0\ndiameter = " + law +
                     "\noverlap = 'allow'\narrange = {law = 'lattice', kind = 'cubic', spacing = 0.05, lower = "
                     "[0, 0, 0], upper = [1, 1, 1]}",
                 box({1.0, 1.0, 1.0}, false))
                .grains;
        std::vector<double> d;
        for (const double r : grains.radius) d.push_back(2.0 * r);
        for (std::size_t i = 0; i < d.size(); ++i)
            EXPECT_DOUBLE_EQ(grains.mass[i], 2.0 * std::numbers::pi / 6.0 * d[i] * d[i] * d[i]);
        return d;
    };
    const auto moments = [](const std::vector<double>& d) {
        double mean = 0.0, square = 0.0;
        for (const double each : d) mean += each, square += each * each;
        mean /= static_cast<double>(d.size());
        return std::pair{mean, std::sqrt(square / static_cast<double>(d.size()) - mean * mean)};
    };
    const auto uniform = diameters("{law = 'uniform', minimum = 1e-3, maximum = 3e-3, seed = 1}"); // 8000 draws
    EXPECT_NEAR(moments(uniform).first, 2e-3, 4.0 * 5.8e-4 / std::sqrt(8000.0));
    EXPECT_NEAR(moments(uniform).second, 2e-3 / std::sqrt(12.0), 2e-5);
    const auto normal =
        diameters("{law = 'normal', mean = 2e-3, deviation = 3e-4, minimum = 1.7e-3, maximum = 2.3e-3, seed = 1}");
    EXPECT_NEAR(moments(normal).first, 2e-3, 1e-5);
    // Cut at one deviation: variance 1 - 2 phi(1) / (2 Phi(1) - 1) = 0.2911 of the whole.
    EXPECT_NEAR(moments(normal).second, 3e-4 * std::sqrt(0.2911), 5e-6);
    EXPECT_GE(*std::min_element(normal.begin(), normal.end()), 1.7e-3);
    EXPECT_LE(*std::max_element(normal.begin(), normal.end()), 2.3e-3);
    EXPECT_EQ(diameters("{law = 'equal', value = 1e-3}"), diameters("1e-3"));
}

TEST(Diameters, RefuseNonsense) {
    const Domain domain = box({1.0, 1.0, 1.0}, false);
    const auto with = [](const std::string& law) {
        return "[grains]\ndensity = 1.0\narrange = {law = 'single', position = [0, 0, 0]}\ndiameter = " + law;
    };
    expect_fault(with("0.0"), domain, "grains.diameter");
    expect_fault(with("-1e-3"), domain, "grains.diameter");
    expect_fault(with("nan"), domain, "not finite");
    expect_fault(with("'uniform'"), domain, "missing");
    expect_fault(with("{law = 'uniform', minimum = 2.0, maximum = 1.0, seed = 1}"), domain, "not above minimum");
    expect_fault(with("{law = 'normal', mean = 3.0, deviation = 0.1, minimum = 1.0, maximum = 2.0, seed = 1}"), domain,
                 "outside [minimum, maximum]");
    expect_fault(with("{law = 'normal', mean = 1.5, deviation = 2.0, minimum = 1.0, maximum = 2.0, seed = 1}"), domain,
                 "use the law \"uniform\"");
    expect_fault(with("'file'"), domain, "needs the arrangement");
}

TEST(Velocities, FollowTheirLaws) {
    const auto velocities = [](const std::string& law) {
        return made("[grains]\ndensity = 2.0\ndiameter = {law = 'uniform', minimum = 1e-3, maximum = 2e-3, seed = "
                    "5}\nvelocity = " +
                        law +
                        "\nangular_velocity = [1, 2, 3]\narrange = {law = 'lattice', kind = 'cubic', spacing = 0.05, "
                        "lower = [0, "
                        "0, 0], upper = [1, 1, 1]}",
                    box({1.0, 1.0, 1.0}, false))
            .grains;
    };
    const Grains same = velocities("[1, 2, -3]");
    EXPECT_EQ(same.v[17], Vec3(1, 2, -3));
    EXPECT_EQ(same.omega[17], Vec3(1, 2, 3));
    const Grains uniform = velocities("{law = 'uniform_random', speed = 0.5, seed = 5}");
    const Grains maxwell = velocities("{law = 'maxwell', speed = 0.5, seed = 5}");
    Vec3 momentum = Vec3::Zero(), scale = Vec3::Zero();
    double uniform_sq = 0.0, maxwell_sq = 0.0, fourth = 0.0;
    for (std::size_t i = 0; i < 8000; ++i) {
        EXPECT_LE(uniform.v[i].cwiseAbs().maxCoeff(), 0.5);
        uniform_sq += uniform.v[i].squaredNorm() / 24000.0;
        maxwell_sq += maxwell.v[i].squaredNorm() / 24000.0;
        fourth += maxwell.v[i].array().square().square().sum() / 24000.0;
        momentum += maxwell.mass[i] * maxwell.v[i];
        scale += maxwell.mass[i] * maxwell.v[i].cwiseAbs();
    }
    EXPECT_NEAR(uniform_sq, 0.25 / 3.0, 0.02 * 0.25 / 3.0);
    EXPECT_NEAR(maxwell_sq, 0.25, 0.04 * 0.25); // four standard errors, sqrt(2/24000)
    EXPECT_NEAR(fourth / (maxwell_sq * maxwell_sq), 3.0, 0.15);
    for (Eigen::Index c = 0; c < 3; ++c) EXPECT_LE(std::abs(momentum[c]), 1e-15 * scale[c]);
}

TEST(Streams, OfDifferentPurposeAreIndependent) {
    Random a = random_stream(1, Stream::diameters), b = random_stream(1, Stream::velocities),
           c = random_stream(2, Stream::diameters);
    double ab = 0.0, ac = 0.0;
    for (int i = 0; i < 10000; ++i) {
        const double x = a.uniform(-1.0, 1.0);
        ab += 3.0 * x * b.uniform(-1.0, 1.0) / 10000.0;
        ac += 3.0 * x * c.uniform(-1.0, 1.0) / 10000.0;
    }
    EXPECT_LT(std::abs(ab), 0.04);
    EXPECT_LT(std::abs(ac), 0.04);
}

} // namespace
} // namespace plumb
