// Walls, free surfaces and open sides of the smoothed particles: mirror points, interpolated states, what the fluid
// feels.
#include "scene_bench.hpp"
#include "schemes/simulation.hpp"
#include "sph/interpolation.hpp"
#include "sph/wall_particles.hpp"

#include "fluid_fixtures.hpp"

#include <fmt/format.h>

#include <set>

using namespace plumb;
using namespace plumb::fixture;

namespace {

/// A box of 1 m x 0.8 m, spacing 0.05 m, h = 0.075 m; `more` holds the tables of walls and open sides.
std::string scene_text(const std::string& more, const std::string& fluid = "",
                       const std::string& periodic = "[true, false]", const std::string& initial = "\"rest\"",
                       const std::string& gravity = "[0.0, 0.0]") {
    return fmt::format(
        "[domain]\nsize = [1.0, 0.8]\nperiodic = {}\ngravity = {}\n"
        "[fluid]\nmethod = \"sph\"\ndensity = 1000.0\nviscosity = 10.0\nspacing = 0.05\nsmoothing = 1.5\n"
        "kernel = \"wendland_c2\"\nequation_of_state = \"linear\"\nsound_speed = 20.0\npressure = \"full\"\n"
        "viscous_term = \"morris\"\noperators = \"plain\"\narrange = \"lattice\"\ninitial = {}\n{}\n"
        "[time]\nend = 1e-2\noutput_interval = 1e-3\nintegrator = \"damped_midpoint\"\nstep = 1e-4\n{}",
        periodic, gravity, initial, fluid, more);
}

std::string plane(const char* name, double y, const char* slip = "no_slip", const char* velocity = "[0.0, 0.0]") {
    return fmt::format(
        "[[wall]]\nname = \"{}\"\nshape = \"plane\"\npoint = [0.0, {}]\nnormal = [0.0, {}]\nslip = \"{}\"\n"
        "velocity = {}\n",
        name, y, y > 0.4 ? -1.0 : 1.0, slip, velocity);
}

std::string channel(const char* slip = "no_slip", const char* velocity = "[0.0, 0.0]") {
    return plane("floor", 0.0, slip) + plane("roof", 0.8, slip, velocity);
}

void expect_refused(const std::string& text, std::initializer_list<std::string_view> parts) {
    expect_error([&] { Bench bench(text); }, parts);
}

Vec3 at(const VectorField& field, std::size_t k) { return {field[0][k], field[1][k], 0.0}; }

/// Starts the scene again with velocities u(x) and pressures p(x) of all particles.
template <class U, class P> void restart(SphFluid& f, U&& u, P&& p) {
    for (std::size_t k = 0; k < f.slots(); ++k) {
        const Vec3 v = u(at(f.x, k));
        for (std::size_t c = 0; c < 2; ++c) f.v[c][k] = v[static_cast<Eigen::Index>(c)];
        f.rho[k] = density_of_pressure(f, p(at(f.x, k)));
    }
    start(f);
}

FluidRecord record_of_boundary(const SphFluid& f, std::size_t k) {
    return f.clusters.records[static_cast<std::size_t>(f.clusters.record_of_passive[k])];
}

} // namespace

// A wall lattice that is shifted, too thin, doubled, or mirrored about the particles instead of the surface.
TEST(SphWalls, PlanesContinueTheLattice) {
    Bench bench(scene_text(channel()));
    const SphFluid& f = bench.fluid();
    const auto layers = static_cast<std::size_t>(std::ceil((f.clusters.reach + f.clusters.skin) / 0.05 - 0.5));
    EXPECT_EQ(f.particles, 320U);
    EXPECT_EQ(f.boundary.size(), 2 * 20 * layers);
    std::set<std::pair<long, long>> places;
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        const Vec3 x = at(f.boundary.x, k), m = at(f.boundary.mirror, k);
        const double surface = x[1] < 0.0 ? 0.0 : 0.8;
        EXPECT_NEAR(m[0], x[0], 1e-14);
        EXPECT_NEAR(m[1] + x[1], 2.0 * surface, 1e-14);
        EXPECT_TRUE(x[1] < 0.0 || x[1] > 0.8);
        places.emplace(std::lround(x[0] / 0.05 - 0.5), std::lround(x[1] / 0.05 - 0.5));
        EXPECT_NEAR(x[0] / 0.05 - 0.5, std::round(x[0] / 0.05 - 0.5), 1e-9);
    }
    EXPECT_EQ(places.size(), f.boundary.size());
}

// Corners mirrored in one wall only; cylinders mirrored through the axis; the wrong side.
TEST(SphWalls, MirrorPointsOfCornersAndCylinders) {
    Bench corner(scene_text("[[wall]]\nname = \"tank\"\nshape = \"box\"\nlower = [0.0, 0.0]\nupper = [1.0, 0.8]\n"
                            "slip = \"no_slip\"\n",
                            "", "[false, false]"));
    const BoundaryParticles& b = corner.fluid().boundary;
    std::size_t corners = 0;
    for (std::size_t k = 0; k < b.size(); ++k) {
        const Vec3 x = at(b.x, k), m = at(b.mirror, k);
        EXPECT_TRUE(m[0] > 0.0 && m[0] < 1.0 && m[1] > 0.0 && m[1] < 0.8);
        if (!(x[0] < 0.0 && x[1] < 0.0)) continue;
        ++corners;
        EXPECT_LT((m + x).norm(), 1e-14);                                        // reflected in both faces
        EXPECT_EQ(b.rule[k].turn, Eigen::Matrix3d(Eigen::Matrix3d::Identity())); // odd twice is even
    }
    EXPECT_GT(corners, 0U);
    Bench round(scene_text("[[wall]]\nname = \"post\"\nshape = \"cylinder\"\npoint = [0.5, 0.4]\nradius = 0.2\n"
                           "side = \"outside\"\nslip = \"free_slip\"\n",
                           "", "[true, true]"));
    const SphFluid& f = round.fluid();
    const Vec3 axis(0.5, 0.4, 0.0);
    for (std::size_t k = 0; k < f.boundary.size(); ++k) {
        const Vec3 x = at(f.boundary.x, k) - axis, m = at(f.boundary.mirror, k) - axis;
        EXPECT_LT(x.norm(), 0.2);
        EXPECT_NEAR(x.norm() + m.norm(), 0.4, 1e-13);
        EXPECT_LT((x.normalized() - m.normalized()).norm(), 1e-9);
        const Vec3 n = m.normalized();
        EXPECT_LT((f.boundary.rule[k].turn * n + n).norm(), 1e-12); // the normal part turns round, the rest stays
    }
    for (std::size_t k = 0; k < f.slots(); ++k) EXPECT_GE((at(f.x, k) - axis).norm(), 0.2);
}

// Least squares that are exact for constants only, forget the slope of the weights, or wrap nothing.
TEST(SphWalls, InterpolationIsExactForLinearFields) {
    for (const int d : {2, 3}) {
        SphFluid f = empty_fluid(box_of_dimensions(d, Vec3(1.2, 1.2, 1.2), {true, true, false}), WendlandC2{}, 1.5);
        f.equation_of_state = LinearState{};
        put_lattice(f, {12, 12, 12}, 0.2, 3);
        const Vec3 slope(3.0, -2.0, 1.5);
        const auto value = [&](const Vec3& x) { return 7.0 + slope.dot(x); };
        for (std::size_t k = 0; k < f.slots(); ++k) f.rho[k] = density_of_pressure(f, 1e4 * value(entry(f, f.x, k)));
        for (std::size_t k = 0; k < f.slots(); ++k) f.v[0][k] = value(entry(f, f.x, k));
        append_boundary_particle(f.boundary, d,
                                 {Vec3(0.6, 0.6, d == 3 ? -0.05 : 0.0),
                                  Vec3(0.61, 0.57, d == 3 ? 0.6 : 0.0),
                                  Vec3::Zero(),
                                  Vec3::Zero(),
                                  -1,
                                  {},
                                  {}});
        append_boundary_particle(f.boundary, d,
                                 {Vec3(0.6, 0.6, d == 3 ? -0.15 : 0.0),
                                  Vec3(0.55, 0.7, d == 3 ? 0.02 : 0.0),
                                  Vec3::Zero(),
                                  Vec3::Zero(),
                                  -1,
                                  {},
                                  {}}); // in 3-D at the edge of the fluid
        start(f);
        for (std::size_t k = 0; k < 2; ++k) {
            const FluidRecord r = record_of_boundary(f, k);
            EXPECT_NEAR(r.u, value(entry(f, f.boundary.mirror, k)), 1e-10);
            EXPECT_NEAR(pressure_of(f, r), 1e4 * value(entry(f, f.boundary.mirror, k)), 1e-5);
        }
    }
}

// A wall's velocity that enters once instead of twice, or a sign: Couette's profile is steady to round-off on a
// lattice.
TEST(SphWalls, CouetteProfileFeelsNoForce) {
    Bench bench(scene_text(channel("no_slip", "[2.0, 0.0]")));
    SphFluid& f = bench.fluid();
    restart(
        f, [](const Vec3& x) { return Vec3(2.5 * x[1], 0.0, 0.0); }, [](const Vec3&) { return 0.0; });
    for (std::size_t k = 0; k < f.slots(); ++k) EXPECT_LT(at(f.a, k).norm(), 1e-10);
    for (std::size_t k = 0; k < f.boundary.size(); ++k)
        EXPECT_NEAR(record_of_boundary(f, k).u, 2.5 * f.boundary.x[1][k], 1e-12);
    EXPECT_EQ(f.boundary.fastest, 0.0); // a wall that slides along itself stays
}

// A free-slip wall that sticks, or a no-slip wall that slips.
TEST(SphWalls, SlipAndNoSlip) {
    const auto stream = [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); };
    const auto none = [](const Vec3&) { return 0.0; };
    Bench slips(scene_text(channel("free_slip"))), sticks(scene_text(channel("no_slip")));
    restart(slips.fluid(), stream, none);
    restart(sticks.fluid(), stream, none);
    double slowed = 0.0;
    for (std::size_t k = 0; k < slips.fluid().slots(); ++k) {
        EXPECT_LT(at(slips.fluid().a, k).norm(), 1e-10);
        slowed = std::min(slowed, sticks.fluid().a[0][k]);
    }
    EXPECT_LT(slowed, -0.1);
}

// A moving lid beside a wall at rest that looks like a source: the fluid at rest in the corner stays at its density.
TEST(SphWalls, LidCornersAreNoSources) {
    const std::string sides = "[[wall]]\nname = \"left\"\nshape = \"plane\"\npoint = [0.0, 0.0]\nnormal = [1.0, 0.0]\n"
                              "slip = \"no_slip\"\n[[wall]]\nname = \"right\"\nshape = \"plane\"\npoint = [1.0, 0.0]\n"
                              "normal = [-1.0, 0.0]\nslip = \"no_slip\"\n";
    Bench bench(scene_text(channel("no_slip", "[2.0, 0.0]") + sides, "", "[false, false]"));
    const SphFluid& f = bench.fluid();
    double dragged = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k) {
        EXPECT_LT(std::abs(f.drho[k]), 1e-9);
        dragged = std::max(dragged, f.a[0][k]);
    }
    EXPECT_GT(dragged, 1.0); // the lid's friction is still there
}

// A mean that is taken over copies too, or once: stirred in a closed box, the mean density stays to round-off.
TEST(SphWalls, ClosedBoxKeepsItsMeanDensity) {
    Bench bench(scene_text(channel("no_slip", "[2.0, 0.0]"), "keep_mean_density = true\ndensity_diffusion = 0.1"));
    advance(bench.simulation, 300);
    double mean = 0.0;
    for (const std::int32_t k : ordered_slots(bench.fluid())) mean += bench.fluid().rho[static_cast<std::size_t>(k)];
    EXPECT_NEAR(mean / 320.0, 1000.0, 1e-9);
    expect_refused(scene_text(channel(), "keep_mean_density = true\nfree_surface = true"),
                   {"fluid.keep_mean_density", "closed"});
}

// Pressure at a wall that is not continued against the weight: the column's lowest layer would fall.
TEST(SphWalls, WallHoldsAgainstGravity) {
    Bench bench(scene_text(channel(), "", "[true, false]", "{law = \"hydrostatic\", surface = 0.8}", "[0.0, -10.0]"));
    SphFluid& f = bench.fluid();
    restart(
        f, [](const Vec3&) { return Vec3(Vec3::Zero()); }, [](const Vec3& x) { return 1e4 * (0.8 - x[1]); });
    for (std::size_t k = 0; k < f.boundary.size(); ++k)
        EXPECT_NEAR(pressure_of(f, record_of_boundary(f, k)), 1e4 * (0.8 - f.boundary.x[1][k]), 1e-6);
    for (std::size_t k = 0; k < f.slots(); ++k)
        EXPECT_LT(at(f.a, k).norm(), 1.0); // of 10: lattice sums, on a lattice of rho_0 where rho is up to 2 % higher
}

// Passive particles in the neighbourhood of mirror points, or missed images across a periodic side.
TEST(SphWalls, MirrorListsAgainstAllPairs) {
    Bench bench(scene_text(channel()));
    const SphFluid& f = bench.fluid();
    const BoundaryParticles& b = f.boundary;
    const double reach = (1.0 - 1e-9) * f.clusters.reach; // neighbours on the lattice lie at the reach itself
    for (std::size_t g = 0; g < b.member.size() / pack_width; ++g) {
        const auto near = b.near_mirror.near(g);
        const std::set<std::int32_t> listed(near.begin(), near.end());
        for (const std::int32_t r : listed) EXPECT_EQ(f.clusters.passive[static_cast<std::size_t>(r)], 0);
        for (std::size_t lane = 0; lane < pack_width; ++lane) {
            const auto k = static_cast<std::size_t>(b.member[pack_width * g + lane]);
            std::size_t close = 0, found = 0;
            for (std::size_t s = 0; s < f.slots(); ++s)
                if (f.id[s] >= 0 && f.domain.minimum_image(at(f.x, s) - at(b.mirror, k)).norm() < reach) ++close;
            for (const std::int32_t r : listed) {
                const FluidRecord& record = f.clusters.records[static_cast<std::size_t>(r)];
                if ((Vec3(record.x, record.y, 0.0) - at(b.mirror, k)).norm() < reach) ++found;
            }
            EXPECT_EQ(found, close);
        }
    }
}

// A moving wall whose particles stay behind, or lists that are kept too long.
TEST(SphWalls, PistonMovesItsParticles) {
    Bench bench(scene_text(channel("free_slip", "[0.0, -1.0]")));
    SphFluid& f = bench.fluid();
    const double before = f.boundary.x[1].back(), mirror = f.boundary.mirror[1].back();
    advance(bench.simulation, 100);
    EXPECT_NEAR(f.boundary.x[1].back(), before - 0.01, 1e-12);
    EXPECT_NEAR(f.boundary.mirror[1].back(), mirror - 0.01, 1e-12);
    EXPECT_LE(f.boundary.travelled, 0.5 * f.clusters.skin + 1.0 * 1e-4);
    double highest = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k) highest = std::max(highest, pressure(f, f.rho[k]));
    EXPECT_GT(highest, 1000.0); // compressed: rho c U = 2e4 Pa behind the sound it sends out
}

// Lone particles that pass through a wall; one deep behind it in a full box that goes unnoticed.
TEST(SphWalls, ParticlesBehindWallsAreStopped) {
    Bench lone(scene_text(channel(),
                          "free_surface = true\nfill = {law = \"box\", lower = [0.0, 0.7], upper = [0.05, 0.8]}",
                          "[true, false]", "\"rest\"", "[0.0, -10.0]"));
    SphFluid& drop = lone.fluid();
    EXPECT_EQ(drop.particles, 2U);
    restart(
        drop, [](const Vec3&) { return Vec3(0.0, -5.0, 0.0); }, [](const Vec3&) { return 0.0; });
    advance(lone.simulation, 3000);
    for (std::size_t k = 0; k < drop.slots(); ++k) EXPECT_GT(drop.x[1][k], -0.01);
    EXPECT_GT(drop.put_back, 0);
    Bench drawn_in(scene_text(channel())); // beside a void, say
    SphFluid& fluid = drawn_in.fluid();
    fluid.x[1][0] = -0.6 * fluid.spacing;
    fluid.v[1][0] = -1.0;
    advance(drawn_in.simulation, 1);
    EXPECT_EQ(fluid.put_back, 1);
    for (std::size_t k = 0; k < fluid.slots(); ++k) EXPECT_GT(fluid.x[1][k], -0.1 * fluid.spacing);
    Bench full(scene_text(channel()));
    full.fluid().x[1][0] = -0.06;
    full.fluid().v[1][0] = -19.0;
    EXPECT_THROW(advance(full.simulation, 3), Diverged);
}

// Keys of walls that are missing, misspelt or of the wrong dimension.
TEST(SphWalls, BadWallsAreInputErrors) {
    const std::string head = "[[wall]]\nname = \"w\"\nshape = \"plane\"\n";
    expect_refused(scene_text(head + "point = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"), {"wall[0].slip: missing"});
    expect_refused(scene_text(head + "point = [0.0, 0.0]\nnormal = [0.0, 1.0]\nslip = \"a bit\"\n"),
                   {"wall[0].slip", "a bit"});
    expect_refused(scene_text(head + "point = [0.0, 0.0, 0.0]\nnormal = [0.0, 1.0]\nslip = \"no_slip\"\n"),
                   {"wall[0].point", "3 numbers"});
    expect_refused(scene_text(head + "point = [0.0, 0.9]\nnormal = [0.0, 1.0]\nslip = \"no_slip\"\n"),
                   {"fluid.arrange", "no place"});
    expect_refused(scene_text(channel() + "[[inlet]]\nname = \"i\"\npoint = [0.0, 0.4]\nnormal = [1.0, 0.0]\n"
                                          "averaging_time = 1.0\nprofile = {law = \"uniform\", speed = 1.0}\n"),
                   {"inlet[0].normal", "periodic"});
}

namespace {

std::string open_channel() {
    return scene_text(channel() +
                          "[[inlet]]\nname = \"in\"\npoint = [0.0, 0.4]\nnormal = [1.0, 0.0]\naveraging_time = 0.1\n"
                          "profile = {law = \"parabolic\", mean_speed = 1.0, radius = 0.4}\n"
                          "[[outlet]]\nname = \"out\"\npoint = [1.0, 0.4]\nnormal = [-1.0, 0.0]\n"
                          "averaging_time = 0.1\npressure = 0.0\n",
                      "", "[false, false]", "{law = \"channel\", mean_speed = 1.0, centre = 0.4, half_width = 0.4}");
}

} // namespace

// Particles lost or doubled at open sides: the number stays, ids are new and unique, what came in went out.
TEST(SphOpenSides, FlowThroughKeepsTheNumber) {
    Bench bench(open_channel());
    SphFluid& f = bench.fluid();
    const std::size_t begun = f.particles;
    advance(bench.simulation, 3000); // 0.3 s, 0.3 of the box
    EXPECT_NEAR(static_cast<double>(f.particles), static_cast<double>(begun), 0.04 * static_cast<double>(begun));
    EXPECT_GT(f.next_id, static_cast<std::int32_t>(begun) + 60);
    std::set<std::int32_t> ids;
    for (const std::int32_t k : ordered_slots(f)) {
        const auto s = static_cast<std::size_t>(k);
        ids.insert(f.id[s]);
        EXPECT_GT(f.x[0][s], -0.02);
        EXPECT_LT(f.x[0][s], 1.02);
        EXPECT_NEAR(f.v[0][s], 1.5 * (1.0 - std::pow(f.x[1][s] / 0.4 - 1.0, 2)), 0.12);
    }
    EXPECT_EQ(ids.size(), f.particles);
}

// Threads that share a mean or a counter; a resumed state that forgets boundary particles is tested in
// test_checkpoint.cpp.
TEST(SphOpenSides, SameBitsForAnyNumberOfThreads) {
    Bench one(open_channel()), two(open_channel()), four(open_channel());
    const auto run = [](Bench& bench, int n) {
        const Threads threads(n);
        advance(bench.simulation, 500);
    };
    run(one, 1), run(two, 2), run(four, 4);
    expect_same_bits(one.fluid(), two.fluid());
    expect_same_bits(one.fluid(), four.fluid());
}

// A fill that is shifted or inverted, and a surface that is a sine.
TEST(SphWalls, FillsCutTheBox) {
    Bench part(
        scene_text(channel(), "free_surface = true\nfill = {law = \"box\", lower = [0.0, 0.0], upper = [0.5, 0.4]}"));
    EXPECT_EQ(part.fluid().particles, 80U);
    Bench wave(scene_text(channel(),
                          "free_surface = true\n"
                          "fill = {law = \"wave\", axis = \"y\", depth = 0.4, amplitude = 0.1, wave_length = 1.0}"));
    const SphFluid& f = wave.fluid();
    for (std::size_t k = 0; k < f.slots(); ++k)
        EXPECT_LE(f.x[1][k], 0.4 + 0.1 * std::cos(2.0 * std::numbers::pi * f.x[0][k]));
    EXPECT_EQ(f.particles, 160U); // the wave has no volume of its own
    expect_refused(scene_text(channel(), "fill = {law = \"box\", lower = [0.0, 0.9], upper = [0.5, 1.0]}"),
                   {"fluid.arrange", "no place"});
}
