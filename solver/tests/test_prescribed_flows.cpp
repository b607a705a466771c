// Prescribed velocity fields and porosities. Each test says which mistake it would catch.
#include "core/prescribed_porosity.hpp"
#include "coupling/prescribed_flows.hpp"

#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

using namespace plumb;

namespace {

Table table(std::string_view text) { return Table(toml::parse(text), "fluid.flow", "scene.toml"); }
PrescribedFlow flow(std::string_view text) { return make_family<PrescribedFlow>(table(text)); }
PrescribedPorosity porosity(std::string_view text) { return make_family<PrescribedPorosity>(table(text)); }

const std::vector<std::string_view> every_flow{
    "law = 'rest'",
    "law = 'uniform'\nvelocity = [1.0, -2.0, 0.5]",
    "law = 'shear'\nrate = 3.0\nvelocity_axis = 'x'\ngradient_axis = 'z'\norigin = 0.25",
    "law = 'parabolic'\npeak = 2.0\nvelocity_axis = 'y'\ngradient_axis = 'x'\nlower = -1.0\nupper = 3.0",
    "law = 'oscillating'\namplitude = [0.0, 0.3, -0.1]\nfrequency = 2.5",
};

} // namespace

// Wrong axis, origin, peak or phase.
TEST(PrescribedFlows, ValuesByHand) {
    const Vec3 x(1.0, 2.0, 0.75);
    EXPECT_EQ(flow_at(flow(every_flow[0]), x, 1.0).u, Vec3(0, 0, 0));
    EXPECT_EQ(flow_at(flow(every_flow[1]), x, 1.0).u, Vec3(1.0, -2.0, 0.5));
    EXPECT_EQ(flow_at(flow(every_flow[2]), x, 1.0).u, Vec3(1.5, 0.0, 0.0));                // 3 (0.75 - 0.25)
    EXPECT_EQ(flow_at(flow(every_flow[3]), x, 1.0).u, Vec3(0.0, 2.0, 0.0));                // the middle is at x = 1
    EXPECT_NEAR(flow_at(flow(every_flow[3]), Vec3(0.0, 0.0, 0.0), 1.0).u.y(), 1.5, 1e-15); // 8 x 1 x 3/16
    EXPECT_NEAR(flow_at(flow(every_flow[3]), Vec3(3.0, 0.0, 0.0), 1.0).u.y(), 0.0, 1e-15);
    EXPECT_NEAR(flow_at(flow(every_flow[4]), x, 0.1).u.y(), 0.3, 1e-15); // a quarter of the period 0.4 s
    EXPECT_EQ(flow_at(flow(every_flow[4]), x, 0.0).u.norm(), 0.0);
}

// A transposed or wrong gradient, a missing 2 pi: against central differences of the velocity itself.
TEST(PrescribedFlows, GradientAndAccelerationAreDerivativesOfTheVelocity) {
    const Vec3 x(0.4, 0.7, 1.3);
    const double t = 0.13, h = 1e-5;
    for (const std::string_view text : every_flow) {
        const PrescribedFlow law = flow(text);
        const FlowPoint here = flow_at(law, x, t);
        Eigen::Matrix3d gradient;
        for (Eigen::Index j = 0; j < 3; ++j)
            gradient.col(j) =
                (flow_at(law, x + h * Vec3::Unit(j), t).u - flow_at(law, x - h * Vec3::Unit(j), t).u) / (2 * h);
        const Vec3 rate = (flow_at(law, x, t + h).u - flow_at(law, x, t - h).u) / (2 * h);
        EXPECT_NEAR((here.gradient - gradient).norm(), 0.0, 1e-8) << text;
        EXPECT_NEAR((here.acceleration - (rate + gradient * here.u)).norm(), 0.0, 1e-7) << text;
        EXPECT_NEAR(here.gradient.trace(), 0.0, 1e-15) << text; // incompressible
    }
}

// Keys not read, not required, or impossible values accepted.
TEST(PrescribedFlows, BadTables) {
    EXPECT_THROW(flow("law = 'shear'\nrate = 3.0\nvelocity_axis = 'x'\ngradient_axis = 'x'\norigin = 0.0"), InputError);
    EXPECT_THROW(flow("law = 'shear'\nrate = 3.0\nvelocity_axis = 'x'\ngradient_axis = 'w'\norigin = 0.0"), InputError);
    EXPECT_THROW(flow("law = 'shear'\nrate = 3.0\nvelocity_axis = 'x'\ngradient_axis = 'z'"), InputError);
    EXPECT_THROW(
        flow("law = 'parabolic'\npeak = 2.0\nvelocity_axis = 'y'\ngradient_axis = 'x'\nlower = 1.0\nupper = 1.0"),
        InputError);
    EXPECT_THROW(flow("law = 'oscillating'\namplitude = [0.0, 0.3, -0.1]\nfrequency = 0.0"), InputError);
    EXPECT_THROW(flow("law = 'couette'"), InputError);
    Table extra = table("law = 'uniform'\nvelocity = [1.0, -2.0, 0.5]\nspeed = 1.0");
    make_family<PrescribedFlow>(extra);
    EXPECT_THROW(extra.finish(), InputError);
}

// Ends swapped, the wrong axis, values beyond the box outside (0, 1].
TEST(PrescribedPorosity, ValuesByHand) {
    Domain domain;
    domain.size = Vec3(2.0, 4.0, 1.0);
    EXPECT_EQ(porosity_at(porosity("law = 'uniform'\nvalue = 0.4"), Vec3(1, 1, 1), domain), 0.4);
    const PrescribedPorosity linear = porosity("law = 'linear'\naxis = 'y'\nlower = 0.4\nupper = 0.9");
    EXPECT_EQ(porosity_at(linear, Vec3(1.0, 0.0, 0.0), domain), 0.4);
    EXPECT_EQ(porosity_at(linear, Vec3(1.0, 4.0, 0.0), domain), 0.9);
    EXPECT_NEAR(porosity_at(linear, Vec3(1.0, 1.0, 0.0), domain), 0.525, 1e-15);
    EXPECT_EQ(porosity_at(linear, Vec3(1.0, 9.0, 0.0), domain), 0.9);
    EXPECT_EQ(porosity_at(linear, Vec3(1.0, -9.0, 0.0), domain), 0.4);
}

TEST(MediumPorosity, WaveByHand) {
    const auto wave =
        make_family<MediumPorosity>(table("law = 'wave'\nmean = 0.6\namplitude = 0.2\nwaves = [1, -2]\nperiod = 4.0"));
    const Vec3 size(2.0, 8.0, 0.0);
    EXPECT_NEAR(porosity_at(wave, Vec3(0.5, 0.0, 0.0), 0.0, size), 0.8, 1e-15); // a quarter of a wave
    EXPECT_NEAR(porosity_at(wave, Vec3(0.0, 1.0, 0.0), 0.0, size), 0.4, 1e-15);
    EXPECT_NEAR(porosity_at(wave, Vec3(0.5, 0.0, 0.0), 2.0, size), 0.4, 1e-15); // half a period later
    EXPECT_FALSE(is_steady(wave));
    EXPECT_THROW(
        make_family<MediumPorosity>(table("law = 'wave'\nmean = 0.6\namplitude = 0.5\nwaves = [1, 0]\nperiod = 4.0")),
        InputError);
    EXPECT_THROW(
        make_family<MediumPorosity>(table("law = 'wave'\nmean = 0.6\namplitude = 0.1\nwaves = [0.5, 0]\nperiod = 4.0")),
        InputError);
}

TEST(PrescribedPorosity, BadTables) {
    EXPECT_THROW(porosity("law = 'uniform'\nvalue = 0.0"), InputError);
    EXPECT_THROW(porosity("law = 'uniform'\nvalue = 1.1"), InputError);
    EXPECT_THROW(porosity("law = 'linear'\naxis = 'y'\nlower = 0.4"), InputError);
}

// The bound of the speed that the step limit reckons with: never exceeded, and reached.
TEST(PrescribedFlows, FastestSpeedIsTheBoundOfTheBox) {
    const Vec3 size(2.0, 3.0, 4.0);
    for (const std::string_view text : every_flow) {
        const PrescribedFlow law = flow(text);
        double fastest = 0.0;
        for (int a = 0; a <= 20; ++a)
            for (int c = 0; c <= 20; ++c)
                for (int q = 0; q <= 40; ++q)
                    fastest = std::max(fastest, flow_at(law, Vec3(0.1 * a, 0.0, 0.2 * c), 0.01 * q).u.norm());
        EXPECT_NEAR(fastest_speed(law, size), fastest, 1e-12) << text;
    }
}
