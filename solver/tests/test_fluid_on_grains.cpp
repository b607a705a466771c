// Grains in a given fluid: exact solutions, the balance of momentum, and Basset's force by direct quadrature.
#include "schemes/fluid_on_grains.hpp"

#include "core/sphere.hpp"
#include "grain_fixtures.hpp"

#include <numbers>

using namespace plumb;
using namespace plumb::fixture;

namespace {

using std::numbers::pi;

constexpr double density = 1000.0, viscosity = 1e-3, radius = 5e-5, d = 2.0 * radius;
constexpr double drag = 3.0 * pi * viscosity * d; // Stokes [kg/s]

FluidOnGrains fluid_of(std::string_view coupling, std::string_view flow = "\"rest\"") {
    Table f =
        table_of(fmt::format("method = \"prescribed\"\ndensity = 1000.0\nviscosity = 1e-3\nflow = {}", flow), "fluid");
    Table c = table_of(fmt::format("direction = \"one_way\"\n{}", coupling), "coupling");
    FluidOnGrains made = read_fluid_on_grains(f, c);
    f.finish();
    c.finish();
    return made;
}
std::string stokes(std::string_view forces = "[]", std::string_view exchange = "exponential") {
    return fmt::format("drag = \"stokes\"\nforces = {}\nexchange = \"{}\"\n", forces, exchange);
}

/// The order of calls of the scheme.
void advance_with(FluidOnGrains& fluid, GrainSystem& s, int steps, double dt) {
    set_inertia(fluid, s, dt);
    for (int k = 0; k < steps; ++k) {
        start(s, dt, &fluid.forcing);
        update_forcing(fluid, s, dt);
        advance_grains(s, 1, dt, &fluid.forcing);
        complete_fluid_forces(fluid, s, dt);
    }
}

GrainSystem one_grain(const Vec3& gravity, const Vec3& v = Vec3::Zero(), Motion motion = Motion::free) {
    GrainSystem s =
        system_of(box(Vec3::Constant(1.0), {}, gravity), "law = \"none\"", {group_of("glass", 2500.0, true, motion)});
    add(s, radius, Vec3(0.5, 0.5, 0.5), v);
    return s;
}

/// Velocity at time t of a Stokes sphere of inertia m under the constant force w with Basset's force of coefficient k:
/// trapezoidal rule, the history integrated directly over all past steps for a piecewise linear slip. `v0` is given to
/// the grain at t = 0; its share k v0/sqrt(t) is integrated exactly.
double by_quadrature(double m, double w, double k, double v0, double t, int steps) {
    const double dt = t / steps;
    std::vector<double> dv;
    double v = v0, before = 0.0; // history force at the start of the step, without the jump's
    for (int n = 1; n <= steps; ++n) {
        double past = 0.0;
        for (std::size_t q = 0; q < dv.size(); ++q)
            past += dv[q] / dt * 2.0 *
                    (std::sqrt(dt * (n - static_cast<double>(q))) - std::sqrt(dt * (n - 1.0 - static_cast<double>(q))));
        const double own = 2.0 / std::sqrt(dt); // of this step's dv
        const double jump = 2.0 * k * v0 * (std::sqrt(dt * n) - std::sqrt(dt * (n - 1.0)));
        const double change =
            (dt * (w - drag * v) - jump - 0.5 * dt * k * (before + past)) / (m + 0.5 * dt * (drag + k * own));
        before = past + own * change;
        dv.push_back(change);
        v += change;
    }
    return v;
}

} // namespace

// The exponential exchange is exact for Stokes drag at any step: a rate, drive or weight taken wrongly shows at once.
TEST(FluidOnGrains, StokesSettlingIsExactAtAnyStep) {
    const Vec3 g(0.0, 0.0, -9.81);
    const double m = 2500.0 * sphere_volume(d), displaced = density * sphere_volume(d), tau = m / drag;
    const double terminal = -9.81 * (m - displaced) / drag;
    for (const double z : {0.01, 0.3, 1.0, 20.0, 1e4}) {
        GrainSystem s = one_grain(g);
        FluidOnGrains fluid = fluid_of(stokes("[\"buoyancy\"]"));
        const int steps = 10;
        advance_with(fluid, s, steps, z * tau);
        const double t = steps * z * tau;
        EXPECT_NEAR(s.grains.v[0].z(), -terminal * std::expm1(-t / tau), 1e-12 * std::abs(terminal)) << z;
        const double x = terminal * (t + tau * std::expm1(-t / tau));
        EXPECT_NEAR(s.grains.x[0].z() - 0.5, x, 1e-12 * std::abs(x) + 1e-15) << z;
        EXPECT_EQ(s.grains.v[0].x(), 0.0);
    }
}

// Relaxation towards a moving fluid, with the added mass of half the displaced fluid in the relaxation time.
TEST(FluidOnGrains, AddedMassSlowsTheRelaxation) {
    const double m = (2500.0 + 0.5 * density) * sphere_volume(d), tau = m / drag;
    GrainSystem s = one_grain(Vec3::Zero(), Vec3(0.02, 0.0, 0.0));
    FluidOnGrains fluid = fluid_of(stokes("[\"virtual_mass\"]"), "{law = \"uniform\", velocity = [0.1, -0.05, 0.0]}");
    advance_with(fluid, s, 7, 0.2 * tau);
    const double left = std::exp(-1.4);
    EXPECT_LT((s.grains.v[0] - Vec3(0.1 - 0.08 * left, -0.05 * (1.0 - left), 0.0)).norm(), 1e-14);
    EXPECT_NEAR(1.0 / s.grains.mobility[0], m, 1e-12 * m);
}

// A neutrally dense grain in resting fluid stays; twice as dense as the fluid it falls with half of gravity at first.
TEST(FluidOnGrains, Buoyancy) {
    for (const double ratio : {1.0, 2.0}) {
        GrainSystem s = system_of(box(Vec3::Constant(1.0), {}, Vec3(0, 0, -9.81)), "law = \"none\"",
                                  {group_of("g", ratio * density)});
        add(s, radius, Vec3(0.5, 0.5, 0.5));
        FluidOnGrains fluid = fluid_of("drag = \"none\"\nforces = [\"buoyancy\"]\nexchange = \"exponential\"\n");
        advance_with(fluid, s, 10, 1e-4);
        EXPECT_NEAR(s.grains.v[0].z(), -9.81 * (1.0 - 1.0 / ratio) * 1e-3, 1e-16) << ratio;
    }
}

// A block of unlike grains has the sum of the weights, of the drags and of the masses.
TEST(FluidOnGrains, BlocksShareDragAndInertia) {
    const Vec3 g(0.0, 0.0, -9.81);
    for (const std::string_view forces : {"[]", "[\"virtual_mass\"]"}) {
        GrainSystem s =
            system_of(box(Vec3::Constant(1.0), {}, g), "law = \"none\"", {group_of("b", 2500.0, true, Motion::block)});
        add(s, radius, Vec3(0.5, 0.5, 0.5));
        add(s, 2.0 * radius, Vec3(0.501, 0.5, 0.5));
        FluidOnGrains fluid = fluid_of(stokes(forces));
        const double mass = 9.0 * 2500.0 * sphere_volume(d),
                     inertia = mass + (forces == "[]" ? 0.0 : 4.5 * density * sphere_volume(d));
        const double tau = inertia / (3.0 * drag), terminal = -9.81 * mass / (3.0 * drag);
        advance_with(fluid, s, 5, 0.4 * tau);
        for (std::size_t k = 0; k < 2; ++k)
            EXPECT_NEAR(s.grains.v[k].z(), -terminal * std::expm1(-2.0), 1e-12 * std::abs(terminal)) << forces;
    }
}

// A fixed grain feels the fluid, and stays where it is.
TEST(FluidOnGrains, FixedGrainsFeelTheDrag) {
    GrainSystem s = one_grain(Vec3(0, 0, -9.81), Vec3(0.01, 0.0, 0.0), Motion::fixed);
    FluidOnGrains fluid =
        fluid_of(stokes("[\"buoyancy\", \"virtual_mass\"]"), "{law = \"uniform\", velocity = [0.1, 0.0, 0.0]}");
    advance_with(fluid, s, 3, 1e-3);
    EXPECT_EQ(s.grains.v[0], Vec3(0.01, 0.0, 0.0));
    EXPECT_LT((fluid.last_drag[0] - Vec3(0.09 * drag, 0.0, 0.0)).norm(), 1e-12 * drag);
    const Vec3 lift(0.0, 0.0, density * sphere_volume(d) * 9.81);
    EXPECT_LT((fluid.last_fluid_force[0] - fluid.last_drag[0] - lift).norm(), 1e-12 * lift.norm());
}

// The reported force must be the one that moved the grain: m dv/dt = contacts + m g + fluid in every step, with added
// mass, nonlinear drag and history, for grains that touch (contacts act with the weight phi2 of their change).
TEST(FluidOnGrains, TheReportedForceClosesTheMomentumBalance) {
    const std::string forces = "[\"buoyancy\", \"pressure_gradient\", \"virtual_mass\", \"basset\", \"saffman_mei\"]";
    FluidOnGrains fluid =
        fluid_of("drag = \"schiller_naumann\"\nexchange = \"exponential\"\nbasset = {law = \"exponentials\", "
                 "count = 12, window = 0.1}\nforces = " +
                     forces,
                 "{law = \"oscillating\", amplitude = [0.3, 0.1, 0.2], frequency = 200.0}");
    GrainSystem s = system_of(box(Vec3::Constant(2e-3), {true, true, true}, Vec3(0, 0, -9.81)),
                              "law = \"linear_spring\"\nstiffness = 10.0\nrestitution = 0.7\nfriction = 0.0\n");
    add(s, radius, Vec3(1e-3, 1e-3, 1e-3), Vec3(0.02, 0.0, 0.0));
    add(s, radius, Vec3(1e-3 + 1.98 * radius, 1e-3, 1e-3), Vec3(-0.02, 0.01, 0.0));
    const double dt = 2e-6;
    const Vec3 g = s.domain.gravity;
    advance_with(fluid, s, 1, dt);
    for (int k = 0; k < 4; ++k) {
        std::vector<Vec3> v(2), contact(2);
        for (std::int32_t id = 0; id < 2; ++id) v[static_cast<std::size_t>(id)] = s.grains.v[place(s.grains, id)];
        for (std::int32_t id = 0; id < 2; ++id)
            contact[static_cast<std::size_t>(id)] = contact_forces(s)[place(s.grains, id)];
        EXPECT_GT(contact[0].norm(), 0.0);
        advance_with(fluid, s, 1, dt);
        for (std::int32_t id = 0; id < 2; ++id) {
            const std::size_t at = place(s.grains, id), n = static_cast<std::size_t>(id);
            const double m = s.grains.mass[at];
            const Vec3 acting = contact[n] + fluid.forcing.phi2[at] * (contact_forces(s)[at] - contact[n]);
            const Vec3 rest = m / dt * (s.grains.v[at] - v[n]) - acting - m * g - fluid.last_fluid_force[n];
            EXPECT_LT(rest.norm(), 1e-10 * acting.norm()) << k;
        }
    }
}

// Basset's force against its defining integral over all past steps, from rest under gravity; without it the answer
// would be tens of per cent off.
TEST(FluidOnGrains, BassetAgreesWithDirectQuadrature) {
    const Vec3 g(0.0, 0.0, -9.81);
    const double m = 2500.0 * sphere_volume(d), w = -9.81 * m, tau = m / drag, t = tau;
    const double k = 1.5 * d * d * std::sqrt(pi * density * viscosity); // (3/2) d^2 sqrt(pi rho mu)
    const double exact = by_quadrature(m, w, k, 0.0, t, 3000);
    const auto v_after = [&](int steps) {
        GrainSystem s = one_grain(g);
        FluidOnGrains fluid =
            fluid_of(stokes("[\"basset\"]") +
                     fmt::format("basset = {{law = \"exponentials\", count = 30, window = {}}}", 2.0 * t));
        advance_with(fluid, s, steps, t / steps);
        return s.grains.v[0].z();
    };
    EXPECT_GT(std::abs(by_quadrature(m, w, 0.0, 0.0, t, 3000) / exact - 1.0), 0.1);
    EXPECT_NEAR(v_after(400), exact, 2e-3 * std::abs(exact));
    EXPECT_LT(std::abs(v_after(400) - exact), 0.5 * std::abs(v_after(100) - exact) + 1e-5 * std::abs(exact));
}

// A grain thrown into resting fluid: the jump of its slip gives the singular force K v0/sqrt(t), whose impulse over the
// first step, 2 K v0 sqrt(dt), must not be lost.
TEST(FluidOnGrains, BassetOfASuddenStart) {
    const double m = 2500.0 * sphere_volume(d), tau = m / drag, t = tau, v0 = 0.01;
    const double k = 1.5 * d * d * std::sqrt(pi * density * viscosity);
    const double exact = by_quadrature(m, 0.0, k, v0, t, 3000);
    const auto error = [&](int steps) {
        GrainSystem s = one_grain(Vec3::Zero(), Vec3(v0, 0.0, 0.0));
        FluidOnGrains fluid =
            fluid_of(stokes("[\"basset\"]") +
                     fmt::format("basset = {{law = \"exponentials\", count = 30, window = {}}}", 2.0 * t));
        advance_with(fluid, s, steps, t / steps);
        return std::abs(s.grains.v[0].x() / exact - 1.0);
    };
    EXPECT_LT(error(400), 0.01);
    EXPECT_GT(order_of(error(100), error(1600), 16.0), 0.8);
}

// Grains that enter a fluid in which others move already: forcing and history must grow with them, and the others must
// not notice (independent grains).
TEST(FluidOnGrains, GrainsAddedLater) {
    const std::string coupling =
        stokes("[\"virtual_mass\", \"basset\"]") + "basset = {law = \"exponentials\", count = 12, window = 1.0}";
    const auto run = [&](bool injects) {
        GrainSystem s = system_of(box(Vec3::Constant(0.01), {true, true, true}, Vec3(0, 0, -9.81)),
                                  "law = \"linear_spring\"\nstiffness = 10.0\nrestitution = 0.9\nfriction = 0.0\n");
        for (int k = 0; k < 40; ++k) add(s, radius, Vec3(2e-4 * (k * 7 % 40) + 1e-4, 2e-3, 2e-3));
        FluidOnGrains fluid = fluid_of(coupling);
        advance_with(fluid, s, 5, 1e-5);
        if (injects)
            for (int k = 0; k < 40; ++k) add(s, radius, Vec3(2e-4 * k + 1.5e-4, 6e-3, 6e-3), Vec3(0.0, 0.0, -0.01));
        advance_with(fluid, s, 5, 1e-5);
        std::vector<double> v;
        for (std::int32_t id = 0; id < 40; ++id) v.push_back(s.grains.v[place(s.grains, id)].z());
        return v;
    };
    const std::vector<double> alone = run(false), together = run(true);
    for (std::size_t k = 0; k < alone.size(); ++k) ASSERT_NEAR(together[k], alone[k], 1e-12 * std::abs(alone[k])) << k;
}

// What the tables may not say.
TEST(FluidOnGrains, BadTables) {
    expect_error([] { fluid_of(stokes("[\"lift\"]")); }, {"coupling.forces", "lift", "buoyancy", "virtual_mass"});
    expect_error([] { fluid_of(stokes("[\"buoyancy\", \"buoyancy\"]")); }, {"coupling.forces", "buoyancy"});
    expect_error([] { fluid_of(stokes("[\"basset\"]")); }, {"coupling.basset", "missing"});
    expect_error([] { fluid_of(stokes() + "basset = {law = \"exponentials\", count = 12, window = 1.0}"); },
                 {"coupling.basset", "unknown"});
    expect_error([] { fluid_of("drag = \"stokes\"\nexchange = \"exponential\""); }, {"coupling.forces", "missing"});
    expect_error([] { fluid_of("drag = \"stokes\"\nforces = []"); }, {"coupling.exchange", "missing"});
    expect_error([] { fluid_of("forces = []\nexchange = \"implicit\""); }, {"coupling.drag", "missing"});
    expect_error([] { fluid_of(stokes() + "porosity = {law = \"uniform\", value = 0.0}"); },
                 {"coupling.porosity.value", "(0, 1]"});
    expect_error([] { fluid_of(stokes(), "\"vortex\""); }, {"fluid.flow", "vortex", "rest"});
}
// "basset" is a force like the others and belongs to the list of known ones.
TEST(FluidOnGrains, AnUnknownForceListsBassetToo) {
    expect_error([] { fluid_of(stokes("[\"lift\"]")); }, {"basset"});
}
