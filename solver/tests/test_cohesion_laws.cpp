// The liquid bridge between two grains as a law: hand-worked values, its work, its keys; and which pairs have one.
#include "dem/cohesion_laws.hpp"

#include "grain_fixtures.hpp"
#include "schemes/stable_step.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr std::string_view spring = "law = \"linear_spring\"\nstiffness = 1e3\nrestitution = 1.0\nfriction = 0.0\n";

std::string wet(std::string_view keys) {
    return std::string(spring) + fmt::format("cohesion = {{law = \"liquid_bridge\", {}}}\n", keys);
}
LiquidBridge bridge_of(std::string_view keys) { return std::get<LiquidBridge>(contact_of(wet(keys)).cohesion); }

/// gamma = 0.07 N/m, theta = 0.5 rad, V = 1e-12 m3.
LiquidBridge water() { return bridge_of("surface_tension = 0.07, contact_angle = 0.5, volume = 1e-12"); }

double pull(const LiquidBridge& law, double s, double volume, double inverse_radius) {
    return LiquidBridge::attraction(law.parameters, s, volume, inverse_radius);
}
bool holds(const LiquidBridge& law, double s, double volume) { return LiquidBridge::holds(law.parameters, s, volume); }

} // namespace

// 2 pi R gamma cos(theta) at contact; a factor 1 + 1.05 + 2.5 where s^2 = V/R. R is 1 mm for two grains of 1 mm, 1.5 mm
// for 1 and 3 mm, 2 mm for 1 mm on a wall.
TEST(LiquidBridge, ForceByHand) {
    const LiquidBridge law = water();
    const double at_contact = 3.8598097e-4, root = 3.1622777e-5; // sqrt(1e-12/1e-3)
    EXPECT_NEAR(pull(law, 0.0, 1e-12, 2e3), at_contact, 1e-11);
    EXPECT_NEAR(pull(law, root, 1e-12, 2e3), at_contact / 4.55, 1e-11);
    EXPECT_NEAR(pull(law, 2.0 * root, 1e-12, 2e3), at_contact / 13.1, 1e-11); // 1 + 2.1 + 10
    EXPECT_NEAR(pull(law, 0.0, 1e-12, 1e3 + 1e3 / 3.0), 1.5 * at_contact, 1e-11);
    EXPECT_NEAR(pull(law, 0.0, 1e-12, 1e3), 2.0 * at_contact, 1e-11);
    EXPECT_NEAR(pull(law, root / std::sqrt(2.0), 1e-12, 1e3), 2.0 * at_contact / 4.55, 1e-11);
}

// (1 + 0.5/2) 1e-4 m, whatever the radii.
TEST(LiquidBridge, RuptureByHand) {
    const LiquidBridge law = water();
    EXPECT_NEAR(law.rupture_distance(1e-12), 1.25e-4, 1e-17);
    EXPECT_TRUE(holds(law, 1.25e-4 * (1.0 - 1e-12), 1e-12));
    EXPECT_FALSE(holds(law, 1.25e-4 * (1.0 + 1e-12), 1e-12));
    EXPECT_FALSE(holds(law, 1e-9, 0.0)); // without liquid there is none
}

// An inverse tangent with a wrong argument, a lost factor: against Simpson's rule, from several separations.
TEST(LiquidBridge, WorkIsTheIntegralOfTheForce) {
    const LiquidBridge law = water();
    for (const double inverse_radius : {2e3, 1e3, 7.5e3})
        for (const double from : {0.0, 2e-5, 1.1e-4}) {
            const int n = 20000;
            const double h = (1.25e-4 - from) / n;
            double sum = 0.0;
            for (int k = 0; k <= n; ++k)
                sum += (k == 0 || k == n ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0)) *
                       pull(law, from + k * h, 1e-12, inverse_radius);
            EXPECT_NEAR(law.work_to_rupture(from, 1e-12, inverse_radius), sum * h / 3.0, 1e-12 * sum * h);
        }
    EXPECT_NEAR(law.work_to_rupture(1.25e-4, 1e-12, 2e3), 0.0, 1e-20);
}

// Not at contact, where it is 1.05 f sqrt(R/V), but a little farther out: found by trying.
TEST(LiquidBridge, GreatestSlope) {
    const LiquidBridge law = water();
    const double h = 1e-9;
    double greatest = 0.0;
    for (double s = 0.0; s < 1.2e-4; s += 1e-8)
        greatest = std::max(greatest, (pull(law, s, 1e-12, 2e3) - pull(law, s + h, 1e-12, 2e3)) / h);
    EXPECT_NEAR(law.greatest_slope(1e-12, 2e3), greatest, 1e-6 * greatest);
    EXPECT_GT(greatest, 1.05 * 3.8598097e-4 / 3.1622777e-5);
}

// A lane that sees another's numbers.
TEST(LiquidBridge, LanesAreTheScalarFormula) {
    const LiquidBridge law = water();
    const auto& p = law.parameters;
    const LiquidBridge::Parameters<Pack> packed{broadcast<Pack>(p.tension), broadcast<Pack>(p.rupture_cubed),
                                                broadcast<Pack>(p.volume), broadcast<Pack>(p.volume_per_cube)};
    Pack s, volume, inverse_radius;
    for (int k = 0; k < 8; ++k) s[k] = 2e-5 * k, volume[k] = 1e-13 * (k + 1), inverse_radius[k] = 1e3 * (k + 1);
    const Pack f = LiquidBridge::attraction(packed, s, volume, inverse_radius);
    const PackMask held = LiquidBridge::holds(packed, s, volume);
    for (int k = 0; k < 8; ++k) {
        const double one = pull(law, s[k], volume[k], inverse_radius[k]);
        EXPECT_NEAR(f[k], one, 1e-15 * one);
        EXPECT_EQ(held[k] != 0, holds(law, s[k], volume[k]));
    }
}

// The diameter is that of the smaller grain.
TEST(LiquidBridge, VolumeOverTheDiameterCubed) {
    const LiquidBridge law =
        bridge_of("surface_tension = 0.07, contact_angle = 0.0, volume = {times_diameter_cubed = 1e-3}");
    EXPECT_NEAR(LiquidBridge::formed_volume(law.parameters, 5e-4), 1e-12, 1e-27);
    EXPECT_EQ(LiquidBridge::formed_volume(water().parameters, 5e-4), 1e-12);
}

TEST(LiquidBridge, KeysAreChecked) {
    const auto bad = [](std::string_view keys, std::initializer_list<std::string_view> parts) {
        SCOPED_TRACE(keys);
        expect_error([&] { bridge_of(keys); }, parts);
    };
    bad("contact_angle = 0.0, volume = 1e-12", {"contact.cohesion.surface_tension", "missing"});
    bad("surface_tension = -0.07, contact_angle = 0.0, volume = 1e-12", {"surface_tension", "-0.07", "(0, inf)"});
    bad("surface_tension = 0.07, volume = 1e-12", {"contact_angle", "missing"});
    bad("surface_tension = 0.07, contact_angle = -0.1, volume = 1e-12", {"contact_angle", "-0.1", "[0, 1.57"});
    bad("surface_tension = 0.07, contact_angle = 1.5708, volume = 1e-12", {"contact_angle", "1.5708"});
    bad("surface_tension = 0.07, contact_angle = 90, volume = 1e-12", {"contact_angle", "90"}); // degrees
    bad("surface_tension = 0.07, contact_angle = 0.0", {"volume", "missing"});
    bad("surface_tension = 0.07, contact_angle = 0.0, volume = -1e-12", {"volume", "-1e-12"});
    bad("surface_tension = 0.07, contact_angle = 0.0, volume = {times_diameter_cubed = 0.0126}",
        {"volume.times_diameter_cubed", "0.0126", "0.0125"});
    bad("surface_tension = 0.07, contact_angle = 0.0, volume = 1e-12, viscosity = 1e-3", {"viscosity", "unknown"});
    expect_error([] { contact_of(std::string(spring) + "cohesion = \"glue\"\n"); },
                 {"cohesion", "glue", "liquid_bridge", "none"});
    expect_error(
        [] {
            contact_of("law = \"none\"\ncohesion = {law = \"liquid_bridge\", surface_tension = 0.07, contact_angle = "
                       "0.0, volume = 1e-12}\n");
        },
        {"contact.cohesion", "none"});
}

// Wet grains, a dry wall, and a group that is dry but for what a [[contact]] says.
TEST(LiquidBridge, SomePairsMayBeDry) {
    const std::string keys = "surface_tension = 0.07, contact_angle = 0.0, volume = 8e-12";
    const ContactModel m =
        contact_model({"a", "b", "floor"}, {contact_of(wet(keys)), contact_of(spring), contact_of(spring)}, 2,
                      {{"b", "a", contact_of(wet(keys))}}, "scene.toml");
    const auto* bridges = liquid_bridges(m);
    ASSERT_NE(bridges, nullptr);
    EXPECT_FALSE(bridges->uniform);
    const auto volume = [&](std::int32_t a, std::int32_t b) {
        return LiquidBridge::formed_volume(bridges->of(a, b).parameters, 1e-3);
    };
    EXPECT_EQ(volume(0, 0), 8e-12);
    EXPECT_EQ(volume(0, 1), 8e-12);
    EXPECT_EQ(volume(1, 0), 8e-12);
    EXPECT_EQ(volume(1, 1), 0.0);
    EXPECT_EQ(volume(0, 2), 0.0);
    EXPECT_NEAR(cohesion_reach(m, 1e-3), 2e-4, 1e-18);
    const ContactModel dry = contact_model({"a"}, {contact_of(spring)}, 1, {}, "scene.toml");
    EXPECT_EQ(liquid_bridges(dry), nullptr);
    EXPECT_EQ(cohesion_reach(dry, 1e-3), 0.0);
    expect_error(
        [&] {
            contact_model({"a", "b"}, {contact_of(wet(keys)), contact_of(spring)}, 2, {}, "scene.toml");
        },
        {"\"a\" and \"b\" differ"});
}

// pi sqrt(m*/slope)/20 beside the limit of the contact, and only where there are bridges.
TEST(LiquidBridge, StepLimitByHand) {
    GrainSystem s =
        system_of(box(Vec3::Constant(0.02)), wet("surface_tension = 0.07, contact_angle = 0.5, volume = 1e-12"));
    add(s, 1e-3, Vec3::Constant(5e-3));
    add(s, 2e-3, Vec3::Constant(15e-3));
    const std::vector<StepLimit> limits = grain_limits(s);
    ASSERT_EQ(limits.size(), 2U);
    EXPECT_EQ(limits[1].name, "bridge");
    const double mass = 0.5 * s.grains.mass[0]; // of two of the smaller grains
    // (1.05 + 5 s^)/(1 + 1.05 s^ + 2.5 s^^2)^2 = 1.2236576 at s^ = 0.1344319, times f/sqrt(V/R)
    const double slope = 1.2236576 * 3.8598097e-4 / 3.1622777e-5;
    EXPECT_NEAR(limits[1].seconds, std::numbers::pi * std::sqrt(mass / slope) / 20.0, 1e-6 * limits[1].seconds);
}

// 1e-10 m3 is 0.1 R^3 for R = 1 mm: smaller grains have too much of it, a wall's reduced radius is twice as large.
TEST(LiquidBridge, TooMuchLiquidIsRefused) {
    const auto with = [](double radius) {
        GrainSystem s =
            system_of(box(Vec3::Constant(0.02)), wet("surface_tension = 0.07, contact_angle = 0.0, volume = 1e-10"));
        add(s, radius, Vec3::Constant(5e-3));
        return s;
    };
    EXPECT_NO_THROW(check_bridges(with(1.0001e-3), "scene.toml"));
    expect_error([&] { check_bridges(with(0.999e-3), "scene.toml"); }, {"scene.toml", "cohesion.volume", "R^3", "0.1"});
}
