// The step of the smoothed particles: its order, what stops it, and runs that go on elsewhere.
#include "schemes/advance_fluid.hpp"

#include "fluid_fixtures.hpp"

#include <algorithm>
#include <limits>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array<bool, 3> everywhere{true, true, true};

void set_viscosity(SphFluid& f, double mu) {
    f.viscosity = mu;
    f.viscous_term = mu > 0.0 ? ViscousTerm(MonaghanGingold(term_scales(f))) : ViscousTerm(Inviscid{});
}

/// Taylor's vortex on a lattice of 14 x 14, at 2 m/s; c = 20 m/s. In space it does not depend on z.
SphFluid vortex(int dimensions = 2) {
    SphFluid f = empty_fluid(box_of_dimensions(dimensions, Vec3(1.4, 1.4, 0.8), everywhere), WendlandC4{}, 1.5);
    put_lattice(f, {14, 14, 8}, 0.0, 1);
    const double k = 2.0 * pi / 1.4;
    for (std::size_t a = 0; a < f.slots(); ++a) {
        f.v[0][a] = -2.0 * std::cos(k * f.x[0][a]) * std::sin(k * f.x[1][a]);
        f.v[1][a] = 2.0 * std::sin(k * f.x[0][a]) * std::cos(k * f.x[1][a]);
    }
    set_viscosity(f, 10.0);
    return f;
}

void set_shifting(SphFluid& f) {
    f.shifting = 4.0 * f.h * 2.0; // A h U
}

/// Advances by `steps` steps; returns how often the lists were renewed.
int run(SphFluid& f, double dt, std::int64_t steps, std::int64_t first = 1) {
    int renewed = 0;
    for (std::int64_t step = first; step < first + steps; ++step) {
        const VectorField before = f.x_listed;
        advance_fluid(f, dt, step);
        renewed += f.x_listed != before ? 1 : 0;
    }
    return renewed;
}

/// Largest difference of a field between two runs of the same particles, across periodic sides too.
double apart(const SphFluid& a, const SphFluid& b, VectorField SphFluid::*field) {
    const std::vector<std::size_t> in_a = slots_by_id(a), in_b = slots_by_id(b);
    double most = 0.0;
    for (std::size_t id = 0; id < in_a.size(); ++id) {
        Vec3 difference = entry(a, a.*field, in_a[id]) - entry(b, b.*field, in_b[id]);
        if (field == &SphFluid::x) difference = a.domain.minimum_image(difference);
        most = std::max(most, difference.norm());
    }
    return most;
}
double densities_apart(const SphFluid& a, const SphFluid& b) {
    const std::vector<std::size_t> in_a = slots_by_id(a), in_b = slots_by_id(b);
    double most = 0.0;
    for (std::size_t id = 0; id < in_a.size(); ++id) most = std::max(most, std::abs(a.rho[in_a[id]] - b.rho[in_b[id]]));
    return most;
}

/// A fluid as a resumed run has it: the models of a fresh one, fields by id, lists restored.
SphFluid resumed(const SphFluid& saved) {
    SphFluid f = saved;
    f.clusters = {};
    f.clusters.reach = saved.clusters.reach, f.clusters.skin = saved.clusters.skin;
    const std::vector<std::size_t> slot = slots_by_id(saved);
    const auto by_id = [&](Field<double>& field, const Field<double>& from) {
        field.resize(slot.size());
        for (std::size_t id = 0; id < slot.size(); ++id) field[id] = from[slot[id]];
    };
    for (const auto field : {&SphFluid::x, &SphFluid::v, &SphFluid::a, &SphFluid::x_listed})
        for (std::size_t c = 0; c < static_cast<std::size_t>(f.dimensions); ++c)
            by_id((f.*field)[c], (saved.*field)[c]);
    by_id(f.rho, saved.rho), by_id(f.drho, saved.drho);
    f.id.resize(slot.size());
    std::iota(f.id.begin(), f.id.end(), 0);
    restore_lists(f);
    return f;
}

/// The Diverged that f() throws; a failure of the test when it throws none.
template <class F> Diverged fault_of(F&& f) {
    try {
        f();
    } catch (const Diverged& fault) {
        return fault;
    }
    ADD_FAILURE() << "no Diverged was thrown";
    return {-1, 0.0, "", -1, 0.0, ""};
}

constexpr double step_length = 1e-3; // about 0.13 h/c

} // namespace

// The step is not the one described: a lone particle under gravity, two steps by hand. Its own rates are the same at
// all times, so v grows by dt g and x by dt (v_old + v_new)/2.
TEST(SphStep, LoneParticleFallsByHand) {
    for (const int d : {2, 3}) {
        SphFluid f = empty_fluid(box_of_dimensions(d, Vec3::Constant(1.0), {}), WendlandC2{}, 1.5);
        f.body_force = d == 2 ? Vec3(1.0, -9.0, 0.0) : Vec3(1.0, 2.0, -9.0);
        const Vec3 x = d == 2 ? Vec3(0.4, 0.5, 0.0) : Vec3(0.4, 0.5, 0.6);
        const Vec3 v = d == 2 ? Vec3(3.0, 2.0, 0.0) : Vec3(3.0, 2.0, 1.0);
        put(f, x, v, f.density);
        start(f);
        EXPECT_LT((entry(f, f.a, 0) - f.body_force).norm(), 1e-15);
        constexpr double dt = 0.01;
        run(f, dt, 2);
        EXPECT_LT((entry(f, f.v, 0) - (v + 2.0 * dt * f.body_force)).norm(), 1e-14);
        EXPECT_LT((entry(f, f.x, 0) - (x + 2.0 * dt * v + 2.0 * dt * dt * f.body_force)).norm(), 1e-14);
        EXPECT_EQ(f.rho[0], f.density);
    }
}

// Rates taken at one end of the step, or predictions of the wrong length: the first order only. Three step lengths.
TEST(SphStep, IsOfSecondOrder) {
    const Threads one(1); // steps this short do not gain from more
    std::array<SphFluid, 3> runs{vortex(), vortex(), vortex()};
    for (std::size_t k = 0; k < runs.size(); ++k) {
        start(runs[k]);
        run(runs[k], step_length / static_cast<double>(1 << k), 24 << k);
    }
    for (const auto field : {&SphFluid::x, &SphFluid::v})
        EXPECT_NEAR(order_of(apart(runs[0], runs[1], field), apart(runs[1], runs[2], field), 2.0), 2.0, 0.15);
    EXPECT_NEAR(order_of(densities_apart(runs[0], runs[1]), densities_apart(runs[1], runs[2]), 2.0), 2.0, 0.15);
}

// Lists renewed too late lose pairs, fields left behind by the new order mix up particles: a run that renews in many
// steps must agree with one that hardly does.
TEST(SphStep, RenewedListsChangeRoundingOnly) {
    const Threads one(1); // steps this short do not gain from more
    for (const int d : {2, 3}) {
        SphFluid often = vortex(d), seldom = vortex(d);
        often.clusters.skin = 0.02 * often.spacing;
        seldom.clusters.skin = 0.9 * seldom.spacing;
        start(often), start(seldom);
        const int steps = d == 2 ? 80 : 30;
        EXPECT_GT(run(often, step_length, steps), steps / 2);
        EXPECT_LT(run(seldom, step_length, steps), steps / 8);
        EXPECT_EQ(often.particles, d == 2 ? 196U : 1568U);
        EXPECT_LT(apart(often, seldom, &SphFluid::x), 1e-12);
        EXPECT_LT(apart(often, seldom, &SphFluid::v), 1e-10);
        EXPECT_LT(densities_apart(often, seldom), 1e-9 * often.density);
    }
}

// Wrapping that moves a particle by less than a side, images that lag behind, or pressure at rest: fluid carried
// around the box keeps its shape.
TEST(SphStep, UniformFlowIsCarriedAlong) {
    const Threads one(1); // steps this short do not gain from more
    for (const int d : {2, 3}) {
        SphFluid f = empty_fluid(box_of_dimensions(d, Vec3(0.8, 0.9, 0.7), everywhere), WendlandC2{}, 1.5);
        put_lattice(f, {8, 9, 7}, 0.2, 3);
        const Vec3 u = d == 2 ? Vec3(7.0, -5.0, 0.0) : Vec3(7.0, -5.0, 3.0);
        for (std::size_t k = 0; k < f.slots(); ++k)
            for (int c = 0; c < d; ++c) f.v[static_cast<std::size_t>(c)][k] = u[c];
        set_viscosity(f, 3.0);
        start(f);
        const SphFluid before = f;
        constexpr int steps = 300; // twice around along x
        EXPECT_GT(run(f, step_length, steps), 50);
        const std::vector<std::size_t> now = slots_by_id(f), then = slots_by_id(before);
        for (std::size_t id = 0; id < now.size(); ++id) {
            ASSERT_EQ(f.rho[now[id]], f.density);
            ASSERT_EQ(entry(f, f.v, now[id]), u);
            const Vec3 moved = entry(f, f.x, now[id]) - entry(before, before.x, then[id]) - steps * step_length * u;
            ASSERT_LT(f.domain.minimum_image(moved).norm(), 1e-12) << "particle " << id;
        }
    }
}

// Something the step needs that a checkpoint does not hold (rates, lists, their order): a resumed run would part from
// the run that was never interrupted. Saved at several moments between renewals, also when particles were just renewed.
TEST(SphStep, ResumedRunHasTheSameBits) {
    for (const bool shifting : {false, true}) {
        SphFluid whole = vortex(shifting ? 2 : 3);
        if (shifting) set_shifting(whole);
        start(whole);
        for (std::int64_t step = 1; step <= 12; ++step) {
            advance_fluid(whole, step_length, step);
            if (step % 3 != 0) continue;
            SphFluid again = resumed(whole), on = whole;
            expect_same_bits(on, again);
            EXPECT_EQ(on.id, again.id);
            EXPECT_GT(run(on, step_length, 8, step + 1), 0);
            run(again, step_length, 8, step + 1);
            EXPECT_EQ(on.id, again.id);
            expect_same_bits(on, again);
        }
    }
}

// A step whose sums depend on the number of threads.
TEST(SphStep, SameBitsForAnyNumberOfThreads) {
    SphFluid serial = vortex(3);
    {
        const Threads one(1);
        start(serial), run(serial, step_length, 12);
    }
    for (const int n : {2, 4}) {
        const Threads several(n);
        SphFluid parallel = vortex(3);
        start(parallel), run(parallel, step_length, 12);
        EXPECT_EQ(parallel.id, serial.id);
        expect_same_bits(parallel, serial);
    }
}

// A NaN that goes unnoticed, or is noticed in a later step than it came up.
TEST(SphStep, NumbersThatAreNoneStopTheRun) {
    for (const int d : {2, 3})
        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
            for (const int what : {0, 1, 2}) {
                SCOPED_TRACE(testing::Message() << d << " dimensions, " << bad << " in field " << what);
                SphFluid f = vortex(d);
                start(f);
                run(f, step_length, 2);
                Field<double>& field = what == 0 ? f.x[0] : what == 1 ? f.v[1] : f.rho;
                field[17] = bad;
                const Diverged fault = fault_of([&] { advance_fluid(f, step_length, 3); });
                EXPECT_EQ(fault.step, 3);
                EXPECT_NEAR(fault.time, 3.0 * step_length, 1e-15);
                EXPECT_GE(fault.index, 0);
            }
}

// Speeds beyond sound pass unseen, or the message names another particle.
TEST(SphStep, SpeedAboveSoundStopsTheRun) {
    SphFluid f = empty_fluid(box_of_dimensions(2, Vec3(1.0, 1.0, 0.0), {}), WendlandC2{}, 1.5);
    for (int k = 0; k < 5; ++k) // out of each other's reach
        put(f, Vec3(0.5 * k, 0.0, 0.0), Vec3(k == 3 ? 0.9 * f.sound_speed : 1.0, 0.0, 0.0), f.density);
    f.body_force = Vec3(30.0, 0.0, 0.0);
    start(f);
    constexpr double dt = 0.02; // 18 + 0.6 n m/s: above 20 m/s in the fourth step
    run(f, dt, 3);
    const Diverged fault = fault_of([&] { advance_fluid(f, dt, 4); });
    EXPECT_EQ(fault.step, 4);
    EXPECT_NEAR(fault.time, 0.08, 1e-15);
    EXPECT_EQ(fault.field, "fluid velocity");
    EXPECT_EQ(fault.index, 3);
    EXPECT_NEAR(fault.value, 20.4, 1e-12);
    EXPECT_NE(fault.likely_limit.find("speed of sound"), std::string::npos);
}

// Densities that run away while speeds stay low: an expanding cloud whose density falls below half.
TEST(SphStep, DensityChangedByHalfStopsTheRun) {
    for (const double factor : {0.45, 1.55}) {
        SphFluid f = empty_fluid(box_of_dimensions(3, Vec3::Constant(1.0), {}), WendlandC2{}, 1.5);
        for (int k = 0; k < 3; ++k) put(f, Vec3(0.5 * k, 0.0, 0.0), Vec3::Zero(), f.density);
        start(f);
        f.rho[static_cast<std::size_t>(ordered_slots(f)[1])] *= factor;
        const Diverged fault = fault_of([&] { advance_fluid(f, step_length, 1); });
        EXPECT_EQ(fault.field, "fluid density");
        EXPECT_EQ(fault.index, 1);
        EXPECT_NEAR(fault.value, factor * f.density, 1e-9);
    }
}

// A shift of another length or direction than down the concentration, unbounded where particles are far apart from
// order, or without the change of v and rho that goes with the new place.
TEST(SphStep, ShiftIsAddedToTheStep) {
    for (const int d : {2, 3})
        for (const double strength : {1.0, 1e5}) { // the second one runs into the bound of a tenth of the spacing
            SphFluid plain = empty_fluid(box_of_dimensions(d, Vec3(0.8, 0.9, 0.7), everywhere), WendlandC2{}, 1.5);
            put_lattice(plain, {8, 9, 7}, 0.3, 3);
            stir(plain, 0.1, 1e-3, 4);
            SphFluid shifted = plain;
            set_shifting(shifted);
            shifted.shifting *= strength;
            start(plain), start(shifted);
            run(plain, step_length, 1), run(shifted, step_length, 1);
            for (std::size_t k = 0; k < plain.slots(); ++k) {
                ASSERT_EQ(plain.id[k], shifted.id[k]);
                const Vec3 spread = entry(shifted, shifted.spread, k);
                const double factor = std::min(shifted.shifting * step_length, 0.1 * shifted.spacing / spread.norm());
                const Vec3 dx = entry(shifted, shifted.x, k) - entry(plain, plain.x, k);
                const Vec3 dv = entry(shifted, shifted.v, k) - entry(plain, plain.v, k);
                ASSERT_LT((dx - factor * spread).norm(), 1e-13);
                ASSERT_LT((dv - factor * entry(shifted, shifted.dv_spread, k)).norm(), 1e-13);
                ASSERT_NEAR(shifted.rho[k] - plain.rho[k], factor * shifted.drho_spread[k], 1e-10);
            }
        }
}
