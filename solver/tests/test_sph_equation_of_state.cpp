// Equations of state: each is its own inverse's inverse and has the speed of sound it is given.
#include "core/equation_of_state.hpp"

#include "fluid_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double rho_0 = 870.0, c = 35.0;

template <class Law> class SphState : public testing::Test {
protected:
    Law law;
};
using Laws = TypesOf<EquationOfState>::type;
TYPED_TEST_SUITE(SphState, Laws);

} // namespace

// density() that inverts another law than pressure(): an initial pressure would start a wave of its own.
TYPED_TEST(SphState, DensityUndoesPressure) {
    for (double rho = 0.6 * rho_0; rho < 1.5 * rho_0; rho += 0.037 * rho_0) {
        const double p = this->law.pressure(rho, rho_0, c);
        EXPECT_NEAR(this->law.density(p, rho_0, c), rho, 1e-12 * rho_0) << rho;
    }
    for (double p = -0.1; p < 0.3; p += 0.023) { // in rho_0 c^2
        const double pressure = p * rho_0 * c * c;
        EXPECT_NEAR(this->law.pressure(this->law.density(pressure, rho_0, c), rho_0, c), pressure,
                    1e-12 * rho_0 * c * c);
    }
}

// A stiffness off by a factor (gamma forgotten in B, c not squared): sound would travel at another speed.
TYPED_TEST(SphState, SlopeAtRestIsTheSoundSpeedSquared) {
    const double step = 1e-5 * rho_0;
    const double slope =
        (this->law.pressure(rho_0 + step, rho_0, c) - this->law.pressure(rho_0 - step, rho_0, c)) / (2.0 * step);
    EXPECT_NEAR(slope, c * c, 1e-7 * c * c);
}

// A background pressure at rho_0: a lattice at rest in an open box would burst.
TYPED_TEST(SphState, NoPressureAtTheDensityOfRest) {
    EXPECT_EQ(this->law.pressure(rho_0, rho_0, c), 0.0);
    EXPECT_EQ(this->law.density(0.0, rho_0, c), rho_0);
}

// A law that is not monotonic: two densities of one pressure.
TYPED_TEST(SphState, PressureRisesWithDensity) {
    double before = this->law.pressure(0.5 * rho_0, rho_0, c);
    for (double rho = 0.52 * rho_0; rho < 1.5 * rho_0; rho += 0.02 * rho_0) {
        const double now = this->law.pressure(rho, rho_0, c);
        EXPECT_GT(now, before) << rho;
        before = now;
    }
}

// The exponent of Tait's law: p(1.1 rho_0) = (1.1^7 - 1)/7 rho_0 c^2, 1.1^7 = 1.9487171.
TEST(SphStates, TaitHasItsExponent) {
    EXPECT_NEAR(Tait{}.pressure(1.1 * rho_0, rho_0, c), 0.9487171 / 7.0 * rho_0 * c * c, 1e-9 * rho_0 * c * c);
}

// Pressure of a fluid at rest: its derivative by g times depth is the density.
TEST(SphEquationOfState, HydrostaticPressureHasTheSlopeOfDensity) {
    for_each_law<EquationOfState>([](auto law) {
        const double rest = 1000.0, speed = 20.0, potential = 9.0, e = 1e-4;
        const double slope = (law.hydrostatic_pressure(potential + e, rest, speed) -
                              law.hydrostatic_pressure(potential - e, rest, speed)) /
                             (2.0 * e);
        EXPECT_NEAR(slope, law.density(law.hydrostatic_pressure(potential, rest, speed), rest, speed), 1e-4);
        EXPECT_EQ(law.hydrostatic_pressure(0.0, rest, speed), 0.0);
    });
}
