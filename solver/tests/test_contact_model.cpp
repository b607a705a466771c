// Which law acts between which materials, and what the contact tables may say.
#include "dem/contact_model.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

std::string spring(double stiffness) {
    return fmt::format("law = \"linear_spring\"\nstiffness = {}\nrestitution = 0.9\nfriction = 0.0\n", stiffness);
}
constexpr std::string_view hertz =
    "law = \"hertz_mindlin\"\nyoung = 1e8\npoisson = 0.25\nrestitution = 0.9\nfriction = 0.0\n";
constexpr std::string_view rolling_spring = "law = \"linear_spring\"\nstiffness = 1e4\nrestitution = 0.9\n"
                                            "friction = 0.0\nrolling = {law = \"constant_torque\", friction = 0.1}\n";

using Own = std::vector<std::optional<MaterialContact>>;

Own own_of(std::initializer_list<std::string> texts) {
    Own own;
    for (const std::string& text : texts)
        text.empty() ? own.emplace_back(std::nullopt) : own.emplace_back(contact_of(text));
    return own;
}
double stiffness(const ContactModel& m, std::int32_t a, std::int32_t b) {
    return std::get<PairLaws<LinearSpring>>(m.contact).of(a, b).parameters.stiffness;
}

} // namespace

// Groups of equal tables need no [[contact]], and the fast path of one law must be taken.
TEST(ContactModel, EqualTablesAreOneLaw) {
    const ContactModel m = contact_model({"a", "b"}, own_of({spring(1e4), spring(1e4)}), 2, {}, "scene.toml");
    EXPECT_TRUE(std::get<PairLaws<LinearSpring>>(m.contact).uniform);
    EXPECT_TRUE(std::get<PairLaws<NoRolling>>(m.rolling).uniform);
    EXPECT_FALSE(contactless(m));
}

// A hidden mixing rule: unlike groups without a [[contact]] are an error that says what to write.
TEST(ContactModel, UnlikeGroupsNeedAContact) {
    expect_error(
        [] {
            contact_model({"a", "b"}, own_of({spring(1e4), spring(2e4)}), 2, {}, "scene.toml");
        },
        {"scene.toml", "contact", "\"a\"", "\"b\"", "between"});
    expect_error(
        [] {
            contact_model({"a", "b"}, own_of({spring(1e4), std::string(rolling_spring)}), 2, {}, "s.toml");
        },
        {"s.toml", "contact"});
}

// A pair that holds in one order only, or that replaces the groups' own laws.
TEST(ContactModel, AContactHoldsBothWays) {
    for (const auto& [first, second] : {std::pair{"a", "b"}, std::pair{"b", "a"}}) {
        const ContactModel m = contact_model({"a", "b"}, own_of({spring(1e4), spring(2e4)}), 2,
                                             {{first, second, contact_of(spring(7e4))}}, "scene.toml");
        EXPECT_FALSE(std::get<PairLaws<LinearSpring>>(m.contact).uniform);
        EXPECT_EQ(stiffness(m, 0, 0), 1e4);
        EXPECT_EQ(stiffness(m, 1, 1), 2e4);
        EXPECT_EQ(stiffness(m, 0, 1), 7e4);
        EXPECT_EQ(stiffness(m, 1, 0), 7e4);
    }
}

// A wall as_grains must take the law of the grain that touches it, not that of the first group.
TEST(ContactModel, WallsTouchAsGrainsDo) {
    const ContactModel m = contact_model({"a", "b", "floor"}, own_of({spring(1e4), spring(2e4), ""}), 2,
                                         {{"a", "b", contact_of(spring(7e4))}}, "scene.toml");
    EXPECT_EQ(stiffness(m, 0, 2), 1e4);
    EXPECT_EQ(stiffness(m, 1, 2), 2e4);
    EXPECT_EQ(stiffness(m, 2, 1), 2e4);
}

// A wall with its own table uses it for every grain, unless a [[contact]] says otherwise.
TEST(ContactModel, AWallsOwnTableAndAContactOverIt) {
    const Own own = own_of({spring(1e4), spring(1e4), spring(5e4)});
    const ContactModel m = contact_model({"a", "b", "floor"}, own, 2, {}, "scene.toml");
    EXPECT_EQ(stiffness(m, 0, 2), 5e4);
    EXPECT_EQ(stiffness(m, 2, 1), 5e4);
    EXPECT_EQ(stiffness(m, 0, 1), 1e4);
    const ContactModel given =
        contact_model({"a", "b", "floor"}, own, 2, {{"floor", "b", contact_of(spring(9e4))}}, "s");
    EXPECT_EQ(stiffness(given, 0, 2), 5e4);
    EXPECT_EQ(stiffness(given, 1, 2), 9e4);
}

// Two laws in one scene: the sweep over pairs knows one only.
TEST(ContactModel, LawsOfTwoKindsCannotBeMixed) {
    expect_error(
        [] {
            contact_model({"a", "floor"}, own_of({spring(1e4), std::string(hertz)}), 1, {}, "scene.toml");
        },
        {"scene.toml", "linear_spring", "hertz_mindlin"});
    expect_error(
        [] {
            contact_model({"a", "floor"}, own_of({spring(1e4), std::string(rolling_spring)}), 1, {}, "s.toml");
        },
        {"s.toml", "none", "constant_torque"});
}

// Names that do not exist and pairs given twice (in either order) pass silently.
TEST(ContactModel, PairsAreChecked) {
    const Own own = own_of({spring(1e4), spring(1e4)});
    expect_error(
        [&] {
            contact_model({"a", "b"}, own, 2, {{"a", "c", contact_of(spring(1))}}, "scene.toml");
        },
        {"scene.toml", "contact.between", "\"c\""});
    expect_error(
        [&] {
            contact_model({"a", "b"}, own, 2, {{"a", "b", contact_of(spring(1))}, {"b", "a", contact_of(spring(2))}},
                          "scene.toml");
        },
        {"contact.between", "twice"});
}

// contactless() must be true for the law "none" only.
TEST(ContactModel, NoContact) {
    const ContactModel m = contact_model({"a"}, own_of({"law = \"none\""}), 1, {}, "scene.toml");
    EXPECT_TRUE(contactless(m));
}

// Every bad parameter of a contact table, by key and range.
TEST(ContactModel, ParameterErrors) {
    const auto bad = [](std::string_view text, std::initializer_list<std::string_view> parts) {
        SCOPED_TRACE(text);
        expect_error([&] { contact_of(text); }, parts);
    };
    const std::string head = "law = \"linear_spring\"\n";
    bad("stiffness = 1.0", {"contact.law", "missing"});
    bad("law = \"spring\"", {"contact.law", "spring", "linear_spring", "hertz_mindlin", "none"});
    bad(head + "restitution = 0.9\nfriction = 0.0", {"contact.stiffness", "missing"});
    bad(head + "stiffness = 0.0\nrestitution = 0.9\nfriction = 0.0", {"contact.stiffness", "(0, inf)"});
    bad(head + "stiffness = nan\nrestitution = 0.9\nfriction = 0.0", {"contact.stiffness", "not finite"});
    bad(head + "stiffness = 1.0\nfriction = 0.0", {"restitution", "damping"});
    bad(head + "stiffness = 1.0\nrestitution = 0.9\ndamping = 0.1\nfriction = 0.0", {"restitution", "damping"});
    bad(head + "stiffness = 1.0\nrestitution = 0.0\nfriction = 0.0", {"contact.restitution", "(0, 1]"});
    bad(head + "stiffness = 1.0\nrestitution = 1.01\nfriction = 0.0", {"contact.restitution", "1.01", "(0, 1]"});
    bad(head + "stiffness = 1.0\ndamping = -1.0\nfriction = 0.0", {"contact.damping", "-1"});
    bad(head + "stiffness = 1.0\nrestitution = 0.9", {"contact.friction", "missing"});
    bad(head + "stiffness = 1.0\nrestitution = 0.9\nfriction = -0.1", {"contact.friction", "-0.1"});
    bad(head + "stiffness = 1.0\nrestitution = 0.9\nfriction = 0.5\nrolling = \"none\"",
        {"contact.tangential_stiffness", "missing"});
    bad(head + "stiffness = 1.0\nrestitution = 0.9\nfriction = 0.5\nrolling = \"none\"\ntangential_stiffness = 1.0",
        {"contact.tangential_damping", "missing"});
    bad("law = \"linear_spring_coulomb\"\nstiffness = 1.0\nrestitution = 0.9\nfriction = 0.0\ntangential_damping = 1.0",
        {"contact.tangential_damping", "unknown"});
    const std::string hertzian = "law = \"hertz_mindlin\"\nrestitution = 0.9\nfriction = 0.0\n";
    bad(hertzian + "young = -1.0\npoisson = 0.2", {"contact.young", "-1"});
    bad(hertzian + "young = 1.0\npoisson = 0.51", {"contact.poisson", "0.51"});
    bad(hertzian + "young = 1.0\npoisson = -1.0", {"contact.poisson", "-1"});
    bad(hertzian + "young = 1.0", {"contact.poisson", "missing"});
    bad("law = \"none\"\nstiffness = 1.0", {"contact.stiffness", "unknown"});
}

// Friction zero makes the tangential keys and rolling optional; they may still be given.
TEST(ContactModel, FrictionlessTablesMayBeShort) {
    EXPECT_NO_THROW(contact_of(spring(1e4)));
    EXPECT_NO_THROW(
        contact_of(spring(1e4) + "tangential_stiffness = 1.0\ntangential_damping = 0.0\nrolling = \"none\""));
}

// A hidden default: with friction, the scene must say whether rolling is resisted.
TEST(ContactModel, FrictionRequiresTheRollingKey) {
    expect_error(
        [] { contact_of("law = \"linear_spring_coulomb\"\nstiffness = 1.0\nrestitution = 0.9\nfriction = 0.5"); },
        {"contact.rolling", "missing"});
}
