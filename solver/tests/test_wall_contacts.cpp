// Grains on walls: forces, memory, moving walls.
#include "dem/wall_contacts.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr std::string_view sticky = "law = \"linear_spring\"\nstiffness = 1e4\ndamping = 0.02\nfriction = 10.0\n"
                                    "tangential_stiffness = 4e3\ntangential_damping = 0.0\nrolling = \"none\"\n";
constexpr std::string_view smooth = "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 1.0\nfriction = 0.0\n";
constexpr double radius = 5e-4;

GrainSystem on_floor(std::string_view contact, const Vec3& wall_velocity = Vec3::Zero()) {
    return system_of(box(Vec3::Constant(0.02)), contact, {group_of("glass")},
                     {plane("floor", Vec3(0, 0, 1e-3), Vec3(0, 0, 1), wall_velocity)});
}

const WallContact& only_contact(const GrainSystem& s) {
    static const WallContact none{};
    const auto& contacts = s.wall_contacts.contacts;
    if (contacts.size() != 1 || contacts[0].size() != 1) {
        ADD_FAILURE() << "not exactly one contact";
        return none;
    }
    return contacts[0][0];
}

} // namespace

// Normal force and friction by hand at the start: overlap 1e-6, a wall of infinite mass, spin and velocity together.
TEST(WallContacts, ForcesByHand) {
    GrainSystem s = on_floor("law = \"linear_spring_coulomb\"\nstiffness = 1e4\ndamping = 0.02\nfriction = 0.3\n"
                             "rolling = \"none\"\n");
    const double o = 1e-6, d = radius - o;
    add(s, radius, Vec3(5e-3, 5e-3, 1e-3 + d), Vec3(0.2, 0.0, -0.1), Vec3(0.0, 50.0, 0.0));
    start(s);
    const WallContact& c = only_contact(s);
    const double fn = 1e4 * o + 0.02 * 0.1;
    // slip = v - omega x (d n): 0.2 - 50 d in x, about 0.175; sliding friction against it
    EXPECT_NEAR(c.overlap, o, 1e-15);
    EXPECT_LT((c.force - Vec3(-0.3 * fn, 0.0, fn)).norm(), 1e-12);
    EXPECT_LT((c.torque - Vec3(0.0, 0.3 * fn * d, 0.0)).norm(), 1e-15); // (-d ez) x (-F ex) = +d F ey
    EXPECT_LT((s.grains.a[0] - c.force / s.grains.mass[0]).norm(), 1e-9);
    EXPECT_LT((contact_forces(s)[0] - c.force).norm(), 1e-18);
}

// Restitution and mass of a wall contact: e = exp(-pi) needs c = sqrt(2 k m) with m the grain's own mass.
TEST(WallContacts, TheWallIsInfinitelyHeavy) {
    for (const std::string_view law : {"linear_spring", "linear_spring_coulomb"}) {
        GrainSystem s = on_floor(fmt::format("law = \"{}\"\nstiffness = 1e4\nrestitution = {:.17e}\nfriction = 0.0\n",
                                             law, std::exp(-std::numbers::pi)));
        add(s, radius, Vec3(5e-3, 5e-3, 1e-3 + radius), Vec3(0.0, 0.0, -0.1));
        s.grains.x[0].z() -= 1e-12;
        start(s);
        const double c = std::sqrt(2.0 * 1e4 * s.grains.mass[0]);
        EXPECT_NEAR(only_contact(s).force.z(), 0.1 * c + 1e4 * 1e-12, 1e-9 * 0.1 * c) << law;
    }
}

// A spring that loses its memory in a rebuild (caused by another, fast grain) or is renewed in every step: the stretch
// is the way slid, whatever happens elsewhere.
TEST(WallContacts, MemorySurvivesStepsAndRebuilds) {
    GrainSystem s = on_floor(sticky);
    s.groups.push_back(group_of("pusher", 2500.0, false, Motion::fixed));
    s.contact =
        contact_model({"glass", "pusher", "floor"}, {contact_of(sticky), contact_of(sticky), std::nullopt}, 2, {}, "s");
    s.walls[0].material = 2;
    add(s, radius, Vec3(8e-3, 5e-3, 1e-3 + radius - 1e-6));
    s.domain.gravity.z() = -1e4 * 1e-6 / s.grains.mass[0]; // a weight that keeps this overlap; friction 10 holds it
    add(s, radius, Vec3(2e-3, 15e-3, 10e-3), Vec3(5.0, 0.0, 0.0), Vec3::Zero(), 1); // flies by, rebuilds the list often
    s.grains.v[0] = Vec3(1e-3, 0.0, 0.0);
    const double dt = 1e-6;
    start(s);
    double slid = 0.0, listed = s.listed_time;
    int rebuilds = 0;
    for (int k = 0; k < 60; ++k) {
        const std::size_t at = place(s.grains, 0);
        const Vec3 before = s.grains.v[at] + s.grains.omega[at].cross(Vec3(0, 0, -(s.grains.x[at].z() - 1e-3)));
        advance_grains(s, 1, dt);
        const std::size_t now = place(s.grains, 0);
        const Vec3 after = s.grains.v[now] + s.grains.omega[now].cross(Vec3(0, 0, -(s.grains.x[now].z() - 1e-3)));
        slid += 0.5 * dt * (before.x() + after.x());
        rebuilds += s.listed_time != listed ? 1 : 0;
        listed = s.listed_time;
        // to half a step of the first slip, which is the start's business
        ASSERT_NEAR(only_contact(s).force.x(), -4e3 * slid, 0.6 * 4e3 * dt * 1e-3 + 0.02 * std::abs(4e3 * slid)) << k;
    }
    EXPECT_GT(rebuilds, 5);
}

// A spring of an ended contact that is found again when the grain comes back.
TEST(WallContacts, ALostContactForgets) {
    GrainSystem s = on_floor(sticky);
    add(s, radius, Vec3(5e-3, 5e-3, 1e-3 + radius - 1e-7), Vec3(1e-2, 0.0, 0.0));
    start(s);
    const Grains& g = s.grains;
    for (int k = 0; k < 10; ++k) advance_grains(s, 1, 1e-7);
    EXPECT_NE(only_contact(s).stretch[0], 0.0);
    s.grains.v[0].z() = 1.0;
    advance_grains(s, 20, 1e-7);
    EXPECT_TRUE(all_wall_contacts(s.wall_contacts).empty());
    EXPECT_EQ(contact_forces(s)[0], Vec3(0.0, 0.0, 0.0));
    EXPECT_GT(g.x[0].z(), 1e-3 + radius);
}

// A wall that moves by itself: in its frame a grain bounces as from a wall at rest, also when the way of the wall is
// many skins long. Elastic reflection: v' = 2 V - v.
TEST(WallContacts, AMovingWallReflects) {
    for (const double speed : {0.05, 0.5, -0.02}) {
        GrainSystem s = on_floor(smooth, Vec3(0.0, 0.0, speed));
        add(s, radius, Vec3(5e-3, 5e-3, 4e-3), Vec3(0.1, 0.0, -0.3));
        const double dt = 1e-6;
        // gap 2.5 mm, closing speed 0.3 + V; the contact lasts pi sqrt(m/k)
        const double time = (3e-3 - radius) / (0.3 + speed) + 4.0 * std::sqrt(s.grains.mass[0] / 1e4);
        advance_grains(s, static_cast<std::int64_t>(time / dt), dt);
        EXPECT_NEAR(s.grains.v[0].z(), 2.0 * speed + 0.3, 1e-3) << speed;
        EXPECT_EQ(s.grains.v[0].x(), 0.1);
        EXPECT_GT(s.grains.x[0].z() - (1e-3 + speed * s.time), radius);
    }
}

// A list of near grains that only the motion of grains renews: the wall comes to a grain at rest and strikes it.
TEST(WallContacts, AWallReachesAGrainAtRest) {
    GrainSystem s = on_floor(smooth, Vec3(0.0, 0.0, 0.5));
    add(s, radius, Vec3(5e-3, 5e-3, 4e-3));
    const double time = (3e-3 - radius) / 0.5 + 4.0 * std::sqrt(s.grains.mass[0] / 1e4);
    advance_grains(s, static_cast<std::int64_t>(time / 1e-6), 1e-6);
    EXPECT_NEAR(s.grains.v[0].z(), 1.0, 1e-3);
}

// A belt: the wall drags a grain that does not slide along with it (friction against the velocity of the wall).
TEST(WallContacts, AWallMovingInItsPlaneDrags) {
    GrainSystem s = on_floor(sticky, Vec3(0.3, 0.0, 0.0));
    s.groups[0].rotation = false;
    s.domain.gravity = Vec3(0, 0, -10.0);
    add(s, radius, Vec3(5e-3, 5e-3, 1e-3 + radius - s.groups[0].density * sphere_volume(2 * radius) * 10.0 / 1e4));
    start(s);
    EXPECT_GE(contact_forces(s)[0].x(), 0.0);
    advance_grains(s, 20, 1e-6);
    EXPECT_GT(s.grains.v[0].x(), 0.0);
    EXPECT_GT(contact_forces(s)[0].x(), 0.0);
}

// Two walls at once, elements of a box told apart: a grain in the corner of a box touches three faces.
TEST(WallContacts, ACornerIsThreeContacts) {
    GrainSystem s = system_of(box(Vec3::Constant(0.02)), smooth);
    Table table = table_of("lower = [0.0, 0.0, 0.0]\nupper = [0.02, 0.02, 0.02]");
    s = system_of(s.domain, smooth, {group_of("glass")}, {WallBody{"box", Box(table)}});
    add(s, radius, Vec3(radius - 1e-6, radius - 2e-6, radius - 3e-6));
    start(s);
    EXPECT_EQ(all_wall_contacts(s.wall_contacts).size(), 3U);
    EXPECT_LT((contact_forces(s)[0] - 1e4 * Vec3(1e-6, 2e-6, 3e-6)).norm(), 1e-14);
}

// Sorting of the contacts by grain, for checkpoints that do not depend on the cells.
TEST(WallContacts, ListedByGrain) {
    GrainSystem s = on_floor(smooth);
    Random random(3);
    for (int k = 0; k < 30; ++k)
        add(s, radius, Vec3(0.6e-3 * (k * 7 % 30) + 1e-3, random.uniform(1e-3, 19e-3), 1e-3 + radius - 1e-6));
    start(s);
    const auto all = all_wall_contacts(s.wall_contacts);
    ASSERT_EQ(all.size(), 30U);
    for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k].grain, static_cast<std::int32_t>(k));
}

// Infinite mass on both sides: a fixed grain that touches a wall feels nothing and stays where it is, with every law
// (1/m* = 0 gives infinite damping times no velocity).
TEST(WallContacts, AFixedGrainMayTouchAWall) {
    for (const char* law : {"law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 0.9\nfriction = 0.0\n",
                            "law = \"linear_spring_coulomb\"\nstiffness = 1e4\nrestitution = 1.0\nfriction = 0.0\n",
                            "law = \"hertz_mindlin\"\nyoung = 1e8\npoisson = 0.25\nrestitution = 0.9\nfriction = 0.0\n",
                            "law = \"linear_spring\"\nstiffness = 1e4\ndamping = 0.1\nfriction = 0.0\n"}) {
        SCOPED_TRACE(law);
        GrainSystem s = system_of(box(Vec3::Constant(0.02)), law, {group_of("floor", 2500.0, false, Motion::fixed)},
                                  {plane("floor_plane", Vec3(0, 0, 1e-3), Vec3(0, 0, 1))});
        const Vec3 x(5e-3, 5e-3, 1e-3 + radius - 1e-6);
        add(s, radius, x);
        EXPECT_NO_THROW(advance_grains(s, 3, 1e-6));
        EXPECT_EQ(s.grains.x[0], x);
        EXPECT_EQ(s.grains.v[0], Vec3(0.0, 0.0, 0.0));
        EXPECT_TRUE(contact_forces(s)[0].allFinite());
    }
}
