// Surface tension of the smoothed particles: depth below a surface, curvature, what the force does and what it leaves
// alone.
#include "sph_scene_fixtures.hpp"

#include "schemes/advance_fluid.hpp"

using namespace plumb;
using namespace plumb::fixture;
using namespace plumb::fixture::sph_scene;

namespace {

constexpr double tension = 0.07;

std::string drop_text(const std::string& fill, const Keys& fluid_changes = {}, const std::string& size = "[2.0, 2.0]",
                      const std::string& periodic = "[false, false]") {
    Keys fluid{{"free_surface", "true"},
               {"smoothing", "2.0"},
               {"surface", "{law = \"continuum_surface_force\", tension = 0.07}"},
               {"fill", fill}};
    for (const auto& [key, value] : fluid_changes) fluid[key] = value;
    Keys domain{{"size", size}, {"periodic", periodic}};
    domain["gravity"] = size.find(',') == size.rfind(',') ? "[0.0, 0.0]" : "[0.0, 0.0, 0.0]";
    return scene_text(2, fluid, domain);
}

std::string disc(const std::string& x, const std::string& y) {
    return "{law = \"ellipsoid\", centre = [" + x + ", " + y + "], semi_axes = [0.6, 0.6]}";
}

/// A fluid under surface tension, of particles at the places, one lattice cell of room each, at rest.
SphFluid tense_fluid(int dimensions, const std::vector<Vec3>& places, const Kernel& kernel) {
    SphFluid f = empty_fluid(box_of_dimensions(dimensions, Vec3::Constant(20.0), {false, false, false}), kernel, 2.0);
    f.free_surface = true;
    Table law =
        Table(toml::table{{"law", "continuum_surface_force"}, {"tension", tension}}, "fluid.surface", "scene.toml");
    f.surface.law = make_family<SurfaceLaw>(law);
    f.surface.profile = colour_profile(kernel, dimensions);
    for (const Vec3& x : places) put(f, x, Vec3::Zero(), f.density);
    start(f);
    return f;
}

/// Rings of particles, evenly spaced along each, that share out a disc of `rings` spacings.
std::vector<Vec3> ring_places(int rings, double spacing, const Vec3& centre) {
    std::vector<Vec3> places;
    for (int ring = 0; ring < rings; ++ring) {
        const double r = (ring + 0.5) * spacing;
        const int count = std::max(1, static_cast<int>(std::lround(2.0 * pi * (ring + 0.5))));
        for (int k = 0; k < count; ++k) {
            const double angle = 2.0 * pi * (k + 0.37 * ring) / count;
            places.push_back(centre + r * Vec3(std::cos(angle), std::sin(angle), 0.0));
        }
    }
    return places;
}

/// Shells of particles along spirals that share out a ball of `shells` spacings.
std::vector<Vec3> shell_places(int shells, double spacing, const Vec3& centre) {
    std::vector<Vec3> places;
    for (int shell = 0; shell < shells; ++shell) {
        const double low = shell, high = shell + 1;
        const double r = (shell + 0.5) * spacing;
        const int count =
            std::max(1, static_cast<int>(std::lround(4.0 / 3.0 * pi * (high * high * high - low * low * low))));
        for (int k = 0; k < count; ++k) {
            const double z = 1.0 - (2.0 * k + 1.0) / count, across = std::sqrt(1.0 - z * z);
            const double angle = k * pi * (3.0 - std::sqrt(5.0)) + shell;
            places.push_back(centre + r * Vec3(across * std::cos(angle), across * std::sin(angle), z));
        }
    }
    return places;
}

/// Greatest difference of the mean curvature from `expected` over it, of particles less than h below the surface.
double worst_curvature(const SphFluid& f, const Vec3& centre, double radius, double expected) {
    double worst = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k)
        if ((entry(f, f.x, k) - centre).norm() > radius - f.h)
            worst = std::max(worst, std::abs(f.surface.mean[k] / expected - 1.0));
    return worst;
}

/// Acceleration of surface tension alone: with it less without.
std::vector<Vec3> tension_alone(SphFluid f) {
    std::vector<Vec3> with, alone;
    for (const std::size_t k : slots_by_id(f)) with.push_back(entry(f, f.a, k));
    f.surface.law = NoSurfaceTension{};
    evaluate_terms(f);
    const std::vector<std::size_t> slots = slots_by_id(f);
    for (std::size_t id = 0; id < slots.size(); ++id) alone.push_back(with[id] - entry(f, f.a, slots[id]));
    return alone;
}

} // namespace

// A profile that is not normalised, or a depth that is not its inverse. By hand, of Wendland's C2 kernel: the steepest
// slope is the kernel's integral over a line through its middle, 7/(3 pi), over a plane 3/4.
TEST(SphSurface, ColourBelowAFlatSurface) {
    EXPECT_NEAR(colour_profile(WendlandC2{}, 2).steepest, 7.0 / (3.0 * pi), 2e-3);
    EXPECT_NEAR(colour_profile(WendlandC2{}, 3).steepest, 0.75, 2e-3);
    for_each_law<Kernel>([](const auto& kernel) {
        for (const int d : {2, 3}) {
            const ColourProfile profile = colour_profile(kernel, d);
            EXPECT_NEAR(profile.colour.front(), 0.5, 1e-3);
            EXPECT_NEAR(profile.colour.back(), 1.0, 1e-12);
            EXPECT_NEAR(profile.depth(0.5), 0.0, 2e-3);
            EXPECT_NEAR(profile.depth(1.0), kernel.support, 1e-12);
            EXPECT_EQ(profile.depth(1.5), kernel.support);
            for (const double c : {0.6, 0.8, 0.95}) {
                const double s = profile.depth(c);
                EXPECT_GT(s, 0.0);
                EXPECT_EQ(profile.depth(1.0 - c), -s);
                // the share beyond the plane, in slices: the integral of W over planes deeper than s
                const auto plane = [&](double x) {
                    return kernel.sigma(d) * integral(
                                                 [&](double y) {
                                                     const double w = kernel.w(std::hypot(x, y));
                                                     return d == 2 ? 2.0 * w : 2.0 * pi * y * w;
                                                 },
                                                 0.0, kernel.support, 40);
                };
                EXPECT_NEAR(1.0 - integral(plane, s, kernel.support, 40), c, 1e-3);
            }
        }
    });
}

// A curvature with a wrong factor, of the depth instead of the surface, or of half the directions.
TEST(SphSurface, CurvatureOfCircleAndSphere) {
    for_each_law<Kernel>([](const auto& kernel) {
        const Vec3 centre(10.0, 10.0, 0.0);
        const SphFluid f = tense_fluid(2, ring_places(20, 0.1, centre), kernel);
        EXPECT_LT(worst_curvature(f, centre, 2.0, 1.0 / 2.0), 0.02) << kernel.name;
    });
    const Vec3 centre = Vec3::Constant(10.0);
    const SphFluid ball = tense_fluid(3, shell_places(10, 0.1, centre), WendlandC2{});
    EXPECT_LT(worst_curvature(ball, centre, 1.0, 2.0 / 1.0), 0.06);
}

// A force on flat surfaces: all normals are one, whatever the layers below.
TEST(SphSurface, FlatSurfacesAreLeftAlone) {
    Bench bench(
        drop_text("{law = \"box\", lower = [0.0, 0.5], upper = [2.0, 1.5]}", {}, "[2.0, 2.0]", "[true, false]"));
    for (const Vec3& a : tension_alone(bench.fluid())) EXPECT_LT(a.norm(), 1e-12);
}

// Laplace's pressure is not what holds a drop: under the even pressure tension/R the particles of rings stay at rest,
// but for what the curvature is off.
TEST(SphSurface, EvenPressureHoldsADrop) {
    const Vec3 centre(10.0, 10.0, 0.0);
    SphFluid f = tense_fluid(2, ring_places(20, 0.1, centre), WendlandC2{});
    const double laplace = tension / 2.0;
    for (double& rho : f.rho) rho = density_of_pressure(f, laplace);
    start(f);
    double moved = 0.0, pushed = 0.0;
    for (std::size_t k = 0; k < f.slots(); ++k) moved = std::max(moved, entry(f, f.a, k).norm());
    for (const Vec3& a : tension_alone(f)) pushed = std::max(pushed, a.norm());
    EXPECT_LT(moved, 0.05 * pushed);
}

// A force that knows a direction of space, a place, or the order of the particles; and one that is not tension's first
// power.
TEST(SphSurface, TurnsMovesAndScales) {
    const Vec3 centre(10.0, 10.0, 0.0), shift(0.37, -1.13, 0.0);
    std::vector<Vec3> places = ring_places(8, 0.1, centre), turned, moved;
    for (Vec3& x : places) x = centre + Vec3(1.2 * (x[0] - 10.0), x[1] - 10.0 + 0.2 * std::sin(3.0 * x[0]), 0.0);
    for (const Vec3& x : places) {
        turned.push_back(centre + Vec3(10.0 - x[1], x[0] - 10.0, 0.0));
        moved.push_back(x + shift);
    }
    SphFluid f = tense_fluid(2, places, WendlandC2{});
    const std::vector<Vec3> a = tension_alone(f), of_turned = tension_alone(tense_fluid(2, turned, WendlandC2{})),
                            of_moved = tension_alone(tense_fluid(2, moved, WendlandC2{}));
    double greatest = 0.0;
    for (const Vec3& v : a) greatest = std::max(greatest, v.norm());
    ASSERT_GT(greatest, 0.0);
    std::get<ContinuumSurfaceForce>(f.surface.law).tension *= 3.0;
    start(f);
    const std::vector<Vec3> thrice = tension_alone(f);
    for (std::size_t id = 0; id < a.size(); ++id) {
        EXPECT_LT((of_turned[id] - Vec3(-a[id][1], a[id][0], 0.0)).norm(), 1e-9 * greatest);
        EXPECT_LT((of_moved[id] - a[id]).norm(), 1e-9 * greatest);
        EXPECT_LT((thrice[id] - 3.0 * a[id]).norm(), 1e-12 * greatest);
    }
}

// Images that are forgotten: a drop that is moved across a periodic corner goes on like one in the middle.
TEST(SphSurface, AcrossPeriodicSides) {
    const auto ran = [](double shift) {
        Bench bench(drop_text(disc("1.0", "1.0"), {}, "[2.0, 2.0]", "[true, true]"));
        for (std::size_t c = 0; c < 2; ++c)
            for (double& x : bench.fluid().x[c]) x += shift;
        start(bench.fluid());
        for (std::int64_t step = 1; step <= 20; ++step) advance_fluid(bench.fluid(), 1e-4, step);
        std::vector<double> speed;
        for (const std::size_t k : slots_by_id(bench.fluid()))
            speed.push_back(entry(bench.fluid(), bench.fluid().v, k).norm());
        std::sort(speed.begin(), speed.end());
        return speed;
    };
    const std::vector<double> middle = ran(0.0), corner = ran(1.0);
    ASSERT_EQ(middle.size(), corner.size());
    ASSERT_GT(middle.back(), 0.0);
    for (std::size_t k = 0; k < middle.size(); ++k) EXPECT_NEAR(corner[k], middle[k], 1e-8 * middle.back());
}

// Threads, the sorting, or a law that is absent change bits.
TEST(SphSurface, SameBits) {
    const auto ran = [](int threads, const Keys& keys) {
        const Threads number(threads);
        Bench bench(drop_text("{law = \"box\", lower = [0.4, 0.4], upper = [1.6, 1.6]}", keys));
        for (std::int64_t step = 1; step <= 30; ++step) advance_fluid(bench.fluid(), 1e-4, step);
        return bench.fluid();
    };
    expect_same_bits(ran(1, {}), ran(3, {}));
    expect_same_bits(ran(1, {{"surface", ""}}), ran(1, {{"surface", "\"none\""}}));
}

// A limit that is not that of the shortest capillary wave, or there without a surface; scenes that cannot be meant.
TEST(SphSurface, Scenes) {
    const auto limit = [](const std::string& text) {
        Bench bench(text);
        for (const StepLimit& l : bench.simulation.timing.limits)
            if (l.name == "capillary") return l.seconds;
        return 0.0;
    };
    EXPECT_NEAR(limit(drop_text(disc("1.0", "1.0"))), 0.25 * std::sqrt(1000.0 * 1e-3 / (2.0 * pi * tension)), 1e-9);
    EXPECT_EQ(limit(drop_text(disc("1.0", "1.0"), {{"surface", "\"none\""}})), 0.0);
    expect_refused(drop_text(disc("1.0", "1.0"), {{"free_surface", ""}, {"fill", ""}}),
                   {"fluid.surface", "free_surface"});
    expect_refused(drop_text(disc("1.0", "1.0"), {{"operators", "\"variable_h\""}}), {"fluid.surface", "plain"});
    expect_refused(drop_text(disc("1.0", "1.0"), {{"surface", "{law = \"continuum_surface_force\", tension = -1.0}"}}),
                   {"fluid.surface.tension", "-1"});
    expect_refused(drop_text(disc("1.0", "1.0"), {{"surface", "\"soap\""}}), {"fluid.surface", "soap", "none"});
    const std::string floor = "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
                              "slip = \"free_slip\"\n";
    const std::string tense = drop_text(disc("1.0", "1.0")), slack = drop_text(disc("1.0", "1.0"), {{"surface", ""}});
    expect_refused(tense + floor, {"fluid.surface", "a wall without contact_angle"});
    expect_refused(slack + floor + "contact_angle = 1.57\n", {"fluid.surface", "a wall has a contact_angle"});
    expect_refused(tense + floor + "contact_angle = 90.0\n", {"contact_angle", "90"});
}

// An ellipse that is a circle, or one about another middle.
TEST(SphSurface, FillsAnEllipsoid) {
    Bench bench(drop_text("{law = \"ellipsoid\", centre = [1.0, 0.8], semi_axes = [0.8, 0.4]}"));
    const SphFluid& f = bench.fluid();
    EXPECT_NEAR(static_cast<double>(f.particles) * 0.05 * 0.05, pi * 0.8 * 0.4, 0.02);
    for (std::size_t k = 0; k < f.slots(); ++k)
        EXPECT_LE(std::pow((f.x[0][k] - 1.0) / 0.8, 2) + std::pow((f.x[1][k] - 0.8) / 0.4, 2), 1.0);
}
