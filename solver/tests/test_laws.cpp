// The one factory of laws: names, tables, errors.
#include "core/laws.hpp"

#include "grain_fixtures.hpp"

using namespace plumb;
using namespace plumb::fixture;

namespace {

struct Nothing {
    static constexpr std::string_view name = "nothing";
    static constexpr LawInfo info{"0", "any", "-"};
};
struct Scaled {
    static constexpr std::string_view name = "scaled";
    static constexpr LawInfo info{"s x", "s > 0", "definition"};
    double scale;
    explicit Scaled(Table& table) : scale(table.number("scale", positive)) {}
};
using Family = std::variant<Nothing, Scaled>;

} // namespace

// The factory builds the neighbour of the named law, or its keys are not read from the same table.
TEST(Laws, TheNamedLawIsBuiltFromItsTable) {
    Table t = table_of("a = \"nothing\"\nb = {law = \"scaled\", scale = 2.0}");
    EXPECT_EQ(law_name(make_family<Family>(t.law("a"))), "nothing");
    const Family made = make_family<Family>(t.law("b"));
    EXPECT_EQ(law_name(made), "scaled");
    EXPECT_EQ(std::get<Scaled>(made).scale, 2.0);
    EXPECT_NO_THROW(t.finish());
}

// An unknown name that falls back to some law, or whose message does not list what is known.
TEST(Laws, UnknownNamesListTheKnownOnes) {
    Table t = table_of("a = \"Scaled\"\nb = {law = 3}\nc = \"scaled\"\nd = {law = \"nothing\", scale = 1.0}");
    expect_error([&] { make_family<Family>(t.law("a")); },
                 {"scene.toml: a", "\"Scaled\"", "\"nothing\"", "\"scaled\""});
    expect_error([&] { make_family<Family>(t.law("b")); }, {"b.law", "3", "not a string"});
    expect_error([&] { make_family<Family>(t.law("c")); }, {"c.scale", "missing"});
    make_family<Family>(t.law("d")); // takes no key: the left one must be found
    expect_error([&] { t.finish(); }, {"d.scale", "unknown"});
}

// Entries out of the order of the variant or under a wrong name would mislabel the printed list.
TEST(Laws, EntriesFollowTheVariant) {
    const std::vector<LawEntry> entries = law_entries<Family>();
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[0].name, "nothing");
    EXPECT_EQ(entries[1].name, "scaled");
    EXPECT_EQ(entries[1].info.formula, "s x");
}

// Contact and rolling laws promise formula, range and source to `plumb laws`.
TEST(Laws, ContactLawsDescribeThemselves) {
    for (const auto& entries : {law_entries<ContactLaw>(), law_entries<RollingLaw>()})
        for (const LawEntry& entry : entries) {
            EXPECT_FALSE(entry.info.formula.empty()) << entry.name;
            EXPECT_FALSE(entry.info.range.empty()) << entry.name;
            EXPECT_FALSE(entry.info.source.empty()) << entry.name;
        }
}
