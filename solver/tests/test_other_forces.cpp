// Forces besides drag: hand-worked values, directions, limits. Each test says which mistake it would catch.
#include "coupling/other_forces.hpp"

#include "core/errors.hpp"

#include <gtest/gtest.h>

#include <numbers>

using namespace plumb;
using std::numbers::pi;

namespace {

const Vec3 no_gravity = Vec3::Zero();

/// Water in shear u_x = rate z, with a grain of 100 um that moves slower than the fluid by `lag` along x.
LocalFluid sheared(double rate) {
    LocalFluid fluid;
    fluid.density = 1000.0;
    fluid.viscosity = 1e-3;
    fluid.u = Vec3(0.5, 0.0, 0.0);
    fluid.gradient(0, 2) = rate; // du_x/dz
    return fluid;
}
LocalGrain lagging(double lag) { return {1e-4, Vec3(0.5 - lag, 0.0, 0.0)}; }

} // namespace

// Index order or sign of the curl: u = (0, 0, b x) has curl (0, -b, 0); rigid rotation W z has curl 2 W.
TEST(OtherForces, Vorticity) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    gradient(2, 0) = 3.0; // du_z/dx
    EXPECT_EQ(vorticity(gradient), Vec3(0.0, -3.0, 0.0));
    gradient.setZero();
    gradient(0, 1) = -2.0; // u = (-W y, W x, 0)
    gradient(1, 0) = 2.0;
    EXPECT_EQ(vorticity(gradient), Vec3(0.0, 0.0, 4.0));
}

// Sign or volume of buoyancy: a neutrally dense grain has no net weight. 1 mm sphere in water: 5.2360e-10 m3 x 9810.
TEST(OtherForces, BuoyancyBalancesTheWeightOfTheDisplacedFluid) {
    const Vec3 g(0.0, 0.0, -9.81);
    const Vec3 force = Buoyancy{}(sheared(0.0), {1e-3, Vec3::Zero()}, g);
    EXPECT_NEAR(force.z(), 5.13651e-6, 1e-11);
    EXPECT_EQ(force.x(), 0.0);
    EXPECT_NEAR((force + 1000.0 * sphere_volume(1e-3) * g).norm(), 0.0, 1e-20);
}

// A share of a force that the fluid loses although it does not exert it, or keeps although it does: buoyancy is the
// hydrostatic pressure's, V G a mean gradient's, and the rest of all forces the fluid's.
TEST(OtherForces, WhatComesFromOutside) {
    const Vec3 g(0.0, 0.0, -9.81), mean(3.0, 0.0, -700.0);
    LocalFluid fluid = sheared(20.0);
    fluid.acceleration = Vec3(1.0, -2.0, 3.0);
    fluid.stress = fluid.density * fluid.acceleration;
    const LocalGrain grain = lagging(0.1);
    const auto share = [&](const OtherForce& law) { return force_from_outside(law, fluid, grain, g, mean); };
    EXPECT_EQ(share(Buoyancy{}), force_on_grain(Buoyancy{}, fluid, grain, g));
    LocalFluid driven = fluid;
    driven.stress -= mean;
    const Vec3 by_gradient = PressureGradient{}(driven, grain, g) - PressureGradient{}(fluid, grain, g);
    EXPECT_LT((share(PressureGradient{}) - by_gradient).norm(), 1e-12 * by_gradient.norm());
    for (const OtherForce& law : {OtherForce{VirtualMass{}}, OtherForce{SaffmanMei{}}, OtherForce{LiAhmadi{}}})
        EXPECT_EQ(share(law), Vec3(0.0, 0.0, 0.0)) << law_name(law);
}

// -u . grad u for Du/Dt, or a missing factor: a grain of fluid feels exactly the fluid's acceleration, with virtual
// mass too.
TEST(OtherForces, AGrainOfFluidFollowsTheFluid) {
    LocalFluid fluid = sheared(0.0);
    fluid.acceleration = Vec3(1.0, -2.0, 3.0);
    fluid.stress = fluid.density * fluid.acceleration;
    const LocalGrain grain{1e-3, Vec3::Zero()};
    const double mass = 1000.0 * sphere_volume(1e-3), added = added_mass(VirtualMass{}, 1000.0, 1e-3);
    EXPECT_NEAR(added / mass, 0.5, 1e-15);
    const Vec3 force = PressureGradient{}(fluid, grain, no_gravity) + VirtualMass{}(fluid, grain, no_gravity);
    EXPECT_NEAR((force / (mass + added) - fluid.acceleration).norm(), 0.0, 1e-14);
    EXPECT_EQ(added_mass(Buoyancy{}, 1000.0, 1e-3), 0.0);
    // and none where the fluid does not accelerate, whatever its stress: that of a flow through held grains
    LocalFluid steady = fluid;
    steady.acceleration.setZero();
    EXPECT_EQ((VirtualMass{}(steady, grain, no_gravity)), Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(added_mass(SaffmanMei{}, 1000.0, 1e-3), 0.0);
}

// The sign of lift: a grain that lags moves to the faster side (+z), one that leads to the slower side, whatever the
// axes.
TEST(OtherForces, LiftPointsToTheFasterSideOfALaggingGrain) {
    for (const OtherForce& law : {OtherForce{SaffmanMei{}}, OtherForce{LiAhmadi{}}}) {
        EXPECT_GT(force_on_grain(law, sheared(100.0), lagging(1e-3), no_gravity).z(), 0.0);
        EXPECT_LT(force_on_grain(law, sheared(100.0), lagging(-1e-3), no_gravity).z(), 0.0);
        EXPECT_LT(force_on_grain(law, sheared(-100.0), lagging(1e-3), no_gravity).z(), 0.0);
    }
}

// Wrong constant or power: 1.615 mu d^2 |u-v| sqrt(G/nu) = 1.615 x 1e-3 x 1e-8 x 1e-3 x 1e4 = 1.615e-10 N at G = 100
// /s.
TEST(OtherForces, SaffmanLiftByHand) {
    // d_xz = d_zx = G/2 and (d_lk d_kl)^(1/4) = sqrt(G) 2^(-1/4): (pi/3) 2.594 2^(1/4)/2 = 1.6153.
    EXPECT_NEAR(LiAhmadi{}(sheared(100.0), lagging(1e-3), no_gravity).z(), 1.615e-10, 1e-13);
    // Re = 0.1 and alpha = 100 x 1e-4/(2 x 1e-3) = 5: C = (1 - 0.741033) 0.990050 + 0.741033 = 0.997423
    EXPECT_NEAR(SaffmanMei{}(sheared(100.0), lagging(1e-3), no_gravity).z(), 0.997423 * 1.615e-10, 1e-15);
}

// A constant in place of sqrt(nu/|shear|): four times the shear is twice the lift; four times the viscosity twice as
// well.
TEST(OtherForces, LiftGrowsWithTheRootOfShearAndViscosity) {
    const double one = LiAhmadi{}(sheared(100.0), lagging(1e-3), no_gravity).z();
    EXPECT_NEAR(LiAhmadi{}(sheared(400.0), lagging(1e-3), no_gravity).z() / one, 2.0, 1e-12);
    LocalFluid thick = sheared(100.0);
    thick.viscosity *= 4.0;
    EXPECT_NEAR(LiAhmadi{}(thick, lagging(1e-3), no_gravity).z() / one, 2.0, 1e-12);
}

// Mei's factor: limits, both branches by hand, and the step of the source at Re = 40.
TEST(OtherForces, MeiFactor) {
    EXPECT_NEAR(SaffmanMei::finite_re_factor(0.0, 0.2), 1.0, 1e-15);
    EXPECT_NEAR(SaffmanMei::finite_re_factor(10.0, 0.25), 0.472622, 1e-6); // 0.8343 x 0.367879 + 0.1657
    EXPECT_NEAR(SaffmanMei::finite_re_factor(100.0, 0.25), 0.262, 1e-12);  // 0.0524 x 5
    const double low = SaffmanMei::finite_re_factor(40.0, 0.25), high = SaffmanMei::finite_re_factor(40.0 + 1e-9, 0.25);
    EXPECT_NEAR(low - high, (1.0 - 0.1657) * std::exp(-4.0), 1e-4); // 0.3314 is 0.0524 sqrt(40)
}

// 0/0: no slip, no shear, and the approach to them.
TEST(OtherForces, NoSlipOrNoShearMakesNoLift) {
    for (const OtherForce& law : {OtherForce{SaffmanMei{}}, OtherForce{LiAhmadi{}}}) {
        EXPECT_EQ(force_on_grain(law, sheared(100.0), lagging(0.0), no_gravity), Vec3(0, 0, 0));
        EXPECT_EQ(force_on_grain(law, sheared(0.0), lagging(1e-3), no_gravity), Vec3(0, 0, 0));
        const double tiny = force_on_grain(law, sheared(100.0), lagging(1e-14), no_gravity).z(); // 0.5 - 1e-14 rounds
        EXPECT_NEAR(tiny, 1.615e-21, 1e-23);
    }
}

// A scalar product in place of the cross product, or a force that is not a vector: turning fluid and grain together
// turns the force with them.
TEST(OtherForces, LiftTurnsWithTheFrame) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
    LocalFluid fluid = sheared(100.0);
    const LocalGrain grain{1e-4, Vec3(0.49, 0.02, -0.01)};
    LocalFluid turned = fluid;
    turned.u = turn * fluid.u;
    turned.gradient = turn * fluid.gradient * turn.transpose();
    for (const OtherForce& law : {OtherForce{SaffmanMei{}}, OtherForce{LiAhmadi{}}}) {
        const Vec3 force = force_on_grain(law, fluid, grain, no_gravity);
        const Vec3 again = force_on_grain(law, turned, {grain.diameter, turn * grain.velocity}, no_gravity);
        EXPECT_NEAR((again - turn * force).norm() / force.norm(), 0.0, 1e-12);
    }
    const Vec3 lift = SaffmanMei{}(fluid, grain, no_gravity);
    EXPECT_NEAR(lift.dot(fluid.u - grain.velocity), 0.0, 1e-12 * lift.norm()); // lift does no work on the slip
}

// The antisymmetric part counted in d_ij: a rigid rotation deforms nothing.
TEST(OtherForces, LiAhmadiIgnoresRotation) {
    LocalFluid fluid = sheared(0.0);
    fluid.gradient(0, 1) = -2.0;
    fluid.gradient(1, 0) = 2.0;
    EXPECT_EQ(LiAhmadi{}(fluid, lagging(1e-3), no_gravity), Vec3(0, 0, 0));
}

// Names of the scene.
TEST(OtherForces, FamilyByName) {
    for (const char* name : {"buoyancy", "pressure_gradient", "virtual_mass", "saffman_mei", "li_ahmadi"})
        EXPECT_EQ(law_name(make_family<OtherForce>(Table(toml::table{{"law", name}}, "coupling.forces", "scene.toml"))),
                  name);
    EXPECT_THROW(make_family<OtherForce>(Table(toml::table{{"law", "lift"}}, "coupling.forces", "scene.toml")),
                 InputError);
}
