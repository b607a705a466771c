// The viscosity of a fluid full of grains: the law, and the friction it adds.
#include "coupling/suspension_viscosity.hpp"

#include "coupled_fixtures.hpp"

#include "schemes/advance_fluid.hpp"

#include <gtest/gtest.h>

using namespace plumb;
using namespace plumb::fixture;
using Bench = CoupledBench;

namespace {
const std::string krieger = "{law = \"krieger_dougherty\", packing = 0.63, greatest = 10.0}";
}

TEST(SuspensionViscosity, TendsToEinsteinsAndStopsAtTheGreatest) {
    Bench bench(Keys{{"coupling.suspension_viscosity", krieger}});
    const auto& law = std::get<KriegerDougherty>(bench.simulation.coupling->viscosity);
    EXPECT_NEAR((law(1.0 - 1e-4) - 1.0) / 1e-4, 2.5, 1e-3); // 1 + 5/2 phi
    EXPECT_NEAR(law(0.8), std::pow(1.0 - 0.2 / 0.63, -1.575), 1e-12);
    EXPECT_EQ(law(0.38), 10.0);
    EXPECT_EQ(law(0.2), 10.0); // beyond the pole
}

// In a uniform suspension the excess is that of a fluid of the effective viscosity: a lost factor of two, of the mass
// or of the kernel would show.
TEST(SuspensionViscosity, UniformSuspensionIsAFluidOfThatViscosity) {
    const double ratio = std::pow(1.0 - 0.2 / 0.63, -1.575);
    Bench thin, thick(Keys{{"fluid.viscosity", fmt::format("{:.17g}", 8.9e-4 * ratio)}});
    for (Bench* bench : {&thin, &thick}) {
        stir(*bench);
        start(bench->fluid());
        for (double& eps : bench->fluid().eps) eps = 0.8;
    }
    Table table(toml::parse("packing = 0.63\ngreatest = 10.0"), "coupling.suspension_viscosity", "scene.toml");
    const KriegerDougherty law(table);
    EXPECT_EQ(add_suspension_viscosity(thin.fluid(), thin.simulation.coupling->weights, law), 0);
    const SphFluid &a = thin.fluid(), &b = thick.fluid();
    double greatest = 0.0;
    for (std::size_t k = 0; k < a.slots(); ++k) greatest = std::max(greatest, std::abs(b.a[0][k]));
    for (std::size_t k = 0; k < a.slots(); ++k)
        for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(a.a[c][k], b.a[c][k], 1e-11 * greatest);
}

TEST(SuspensionViscosity, KeepsMomentumAndBits) {
    expect_momentum_and_bits({{"coupling.suspension_viscosity", krieger}});
}

TEST(SuspensionViscosity, BadScenesAreInputErrors) {
    const auto refused = [](const Keys& keys, std::initializer_list<std::string_view> parts) {
        expect_error([&] { Bench bench(keys); }, parts);
    };
    refused({{"coupling.suspension_viscosity", "\"krieger_dougherty\""}},
            {"coupling.suspension_viscosity.packing: missing"});
    refused({{"coupling.suspension_viscosity", krieger}, {"fluid.viscous_term", "\"monaghan_gingold\""}},
            {"coupling.suspension_viscosity", "morris"});
}

// The step is chosen for the greatest viscosity that the law may give.
TEST(SuspensionViscosity, RulesTheStep) {
    const auto step = [](const std::string& greatest) {
        const std::string law = "{law = \"krieger_dougherty\", packing = 0.63, greatest = " + greatest + "}";
        return Bench(Keys{{"coupling.suspension_viscosity", law}, {"time.step", "\"auto\""}}).simulation.timing.dt;
    };
    EXPECT_NEAR(step("1e4") / step("1e3"), 0.1, 1e-2);
}
