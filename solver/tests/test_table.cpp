// The strict reader of tables: every kind of value, every kind of error and what its message names.
#include "core/table.hpp"

#include "grain_fixtures.hpp"

#include <limits>

using namespace plumb;
using namespace plumb::fixture;

// A reader that swaps components, drops a type or forgets that a whole number is a number too.
TEST(Table, ReadsEveryKindOfValue) {
    Table t = table_of(R"(
        number = 2.5
        whole = 3
        truth = true
        word = "glass"
        words = ["a", "b"]
        position = [1, 2.5, -3]
        sides = [true, false, true]
        corners = [[0, 0, 0], [1.0, 2, 3]]
        [sub]
        deep = 1e-3
    )");
    EXPECT_EQ(t.number("number"), 2.5);
    EXPECT_EQ(t.number("whole"), 3.0);
    EXPECT_EQ(t.integer("whole"), 3);
    EXPECT_TRUE(t.flag("truth"));
    EXPECT_EQ(t.text("word"), "glass");
    EXPECT_EQ(t.choice("word", {"sand", "glass"}), "glass");
    EXPECT_EQ(t.texts("words"), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(t.vector("position"), Vec3(1.0, 2.5, -3.0));
    EXPECT_EQ(t.flags("sides"), (std::array<bool, 3>{true, false, true}));
    ASSERT_EQ(t.points("corners").size(), 2U);
    EXPECT_EQ(t.points("corners")[1], Vec3(1.0, 2.0, 3.0));
    Table sub = t.table("sub");
    EXPECT_EQ(sub.number("deep"), 1e-3);
    EXPECT_EQ(sub.path(), "sub");
    EXPECT_NO_THROW(t.finish());
}

// Tables that are looked at in two places: a key read in either counts, one read in neither is still found.
TEST(Table, TablesTakenTwiceShareWhatWasRead) {
    Table t = table_of("[[probe]]\nname = \"a\"\ninterval = 2.0\n[[probe]]\nname = \"b\"\nwrong = 1\n");
    EXPECT_EQ(t.tables("probe")[0].number("interval"), 2.0);
    for (Table& probe : t.tables("probe")) probe.text("name");
    expect_error([&] { t.finish(); }, {"probe[1].wrong"});
}

// A default that replaces a given value, or a default that is range-checked as if it were given.
TEST(Table, DefaultsApplyOnlyToAbsentKeys) {
    Table t = table_of("given = 0.5\nword = \"x\"");
    EXPECT_EQ(t.number_or("given", 7.0), 0.5);
    EXPECT_EQ(t.number_or("absent", -7.0, positive), -7.0);
    EXPECT_EQ(t.text_or("word", "y"), "x");
    EXPECT_EQ(t.text_or("absent", "y"), "y");
    EXPECT_TRUE(t.tables("absent").empty());
    EXPECT_FALSE(t.has("absent"));
    EXPECT_EQ(t.type("absent"), toml::node_type::none);
    expect_error([&] { t.number_or("given", 1.0, Range{1.0, 2.0}); }, {"given", "0.5", "[1, 2]"});
}

// A message that does not say which file, which key or what was expected of a missing key.
TEST(Table, MissingKeysAreNamed) {
    Table t = table_of("", "grains");
    expect_error([&] { t.number("density", positive); }, {"scene.toml", "grains.density", "missing", "(0, inf)"});
    expect_error([&] { t.integer("count"); }, {"grains.count", "missing", "whole number"});
    expect_error([&] { t.flag("rotation"); }, {"grains.rotation", "missing", "true or false"});
    expect_error([&] { t.text("name"); }, {"grains.name", "missing", "string"});
    expect_error([&] { t.choice("motion", {"free", "fixed"}); }, {"grains.motion", "missing"});
    expect_error([&] { t.texts("forces"); }, {"grains.forces", "missing", "strings"});
    expect_error([&] { t.vector("position"); }, {"grains.position", "missing", "three numbers"});
    expect_error([&] { t.flags("periodic"); }, {"grains.periodic", "missing"});
    expect_error([&] { t.points("points"); }, {"grains.points", "missing", "points"});
    expect_error([&] { t.table("contact"); }, {"grains.contact", "missing", "table"});
    expect_error([&] { t.law("drag"); }, {"grains.drag", "missing", "law"});
}

// A conversion where an error is due: strings to numbers, numbers to truth, fractions to counts.
TEST(Table, WrongTypesAreErrorsThatShowTheValue) {
    Table t = table_of(R"(
        word = "seven"
        number = 1.5
        truth = true
        list = [1, 2]
        mixed = [1, "b", 3]
        sub = {a = 1}
        date = 2020-01-01
    )");
    expect_error([&] { t.number("word"); }, {"scene.toml: word", "seven", "not a number"});
    expect_error([&] { t.number("truth"); }, {"true", "not a number"});
    expect_error([&] { t.number("sub"); }, {"sub", "table", "not a number"});
    expect_error([&] { t.number("date"); }, {"2020-01-01", "not a number"});
    expect_error([&] { t.integer("number"); }, {"number", "1.5", "not a whole number"});
    expect_error([&] { t.flag("number"); }, {"1.5", "not true or false"});
    expect_error([&] { t.text("number"); }, {"1.5", "not a string"});
    expect_error([&] { t.vector("number"); }, {"number", "three numbers"});
    expect_error([&] { t.vector("list"); }, {"list", "three numbers"});
    expect_error([&] { t.vector("mixed"); }, {"mixed", "b", "not a number"});
    expect_error([&] { t.texts("mixed"); }, {"mixed", "1", "not a string"});
    expect_error([&] { t.flags("mixed"); }, {"mixed", "true or false"});
    expect_error([&] { t.points("list"); }, {"list", "three numbers"});
    expect_error([&] { t.table("word"); }, {"seven", "not a table"});
    expect_error([&] { t.law("number"); }, {"1.5", "law"});
    expect_error([&] { t.tables("number"); }, {"number", "table"});
    expect_error([&] { t.tables("list"); }, {"list", "table"});
    expect_error([&] { t.choice("word", {"one", "two"}); }, {"seven", "\"one\"", "\"two\""});
}

// 1.0 for a count is a slip of the pen that must not pass silently; bounds of integers belong to the range.
TEST(Table, IntegersAreNotFloats) {
    Table t = table_of("float = 3.0\nwhole = 5");
    expect_error([&] { t.integer("float"); }, {"float", "3.0", "not a whole number"});
    EXPECT_EQ(t.integer("whole", 5, 5), 5);
    expect_error([&] { t.integer("whole", 6, 9); }, {"whole", "5", "[6, 9]"});
    expect_error([&] { t.integer("whole", 1, 4); }, {"whole", "5", "[1, 4]"});
}

// NaN and infinity pass every comparison written the wrong way round.
TEST(Table, NonFiniteNumbersAreErrors) {
    Table t = table_of("a = nan\nb = inf\nc = -inf\nv = [0, nan, 0]\np = [[0, 0, inf]]");
    for (const char* key : {"a", "b", "c"}) {
        expect_error([&] { t.number(key); }, {key, "not finite"});
        expect_error([&] { t.number(key, positive); }, {key, "not finite"});
    }
    expect_error([&] { t.vector("v"); }, {"v", "nan", "not finite"});
    expect_error([&] { t.points("p"); }, {"p", "inf", "not finite"});
}

// Off-by-one at the ends of a range: open ends exclude the end, closed ends include it.
TEST(Table, RangesKeepTheirEnds) {
    Table t = table_of("zero = 0.0\none = 1.0\nless = -1e-300\nmore = 1.0000001\nvector = [0.5, -1.0, 0.5]");
    EXPECT_EQ(t.number("zero", non_negative), 0.0);
    EXPECT_EQ(t.number("zero", fraction), 0.0);
    EXPECT_EQ(t.number("one", positive_fraction), 1.0);
    expect_error([&] { t.number("zero", positive); }, {"zero", "0", "(0, inf)"});
    expect_error([&] { t.number("zero", positive_fraction); }, {"zero", "(0, 1]"});
    expect_error([&] { t.number("less", non_negative); }, {"less", "-1e-300", "[0, inf)"});
    expect_error([&] { t.number("more", fraction); }, {"more", "1.0000001", "[0, 1]"});
    expect_error([&] { t.number("one", Range{0.0, 1.0, false, true}); }, {"one", "[0, 1)"});
    expect_error([&] { t.vector("vector", fraction); }, {"vector", "-1", "[0, 1]"});
    EXPECT_EQ(any_number.text(), "(-inf, inf)");
}

// A whole number beyond 2^53 is no exact double; reading it as a number must not crash or return garbage.
TEST(Table, WholeNumbersBeyondDoublePrecision) {
    Table t = table_of("large = 9007199254740993\nhuge = 9223372036854775807");
    EXPECT_EQ(t.integer("huge"), std::numeric_limits<std::int64_t>::max());
    for (const auto& [key, value] :
         {std::pair{"large", 9007199254740993.0}, std::pair{"huge", 9223372036854775807.0}}) {
        try {
            EXPECT_NEAR(t.number(key), value, 1e-15 * value) << key;
        } catch (const InputError&) { // a refusal would be as good
        }
    }
}

// An unknown key that stays unnoticed, at any depth: the plain table, a sub-table, an entry of an array, a law.
TEST(Table, UnreadKeysAreErrorsAtAnyDepth) {
    {
        Table t = table_of("known = 1\ntypo = 2");
        t.number("known");
        expect_error([&] { t.finish(); }, {"scene.toml: typo", "2", "unknown"});
    }
    {
        Table t = table_of("[a.b]\nknown = 1\ntypo = [1, 2]");
        Table a = t.table("a");
        Table b = a.table("b");
        b.number("known");
        expect_error([&] { t.finish(); }, {"scene.toml: a.b.typo", "unknown"});
    }
}

// An entry of an array of tables that nobody checks, or is named without its index.
TEST(Table, UnreadKeysOfArraysOfTablesNameTheEntry) {
    Table t = table_of("[[wall]]\nname = \"left\"\n[[wall]]\nname = \"right\"\nspeed = 3");
    std::vector<Table> walls = t.tables("wall");
    ASSERT_EQ(walls.size(), 2U);
    EXPECT_EQ(walls[0].text("name"), "left");
    EXPECT_EQ(walls[1].text("name"), "right");
    expect_error([&] { t.finish(); }, {"wall[1].speed", "3", "unknown"});
    walls[1].number("speed");
    EXPECT_NO_THROW(t.finish());
}

// A table that nobody opened is unread as a whole, although its keys were never looked at.
TEST(Table, UnreadTablesAreErrors) {
    Table t = table_of("[grains]\nradius = 1\n[[probe]]\nname = \"a\"");
    t.table("grains").number("radius");
    expect_error([&] { t.finish(); }, {"probe", "unknown"});
}

// Copies of a table that do not share what was read: make_family takes its table by value.
TEST(Table, CopiesShareWhatWasRead) {
    Table t = table_of("a = 1");
    Table copy = t;
    copy.number("a");
    EXPECT_NO_THROW(t.finish());
}

// One table for several: `[grains]` and `[[grains]]` must both be a list, with paths that can be found in the file.
TEST(Table, OneTableIsAListOfOne) {
    Table one = table_of("[grains]\nradius = 1.0");
    std::vector<Table> list = one.tables("grains");
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].path(), "grains");
    EXPECT_EQ(list[0].number("radius"), 1.0);
    EXPECT_NO_THROW(one.finish());
}

// A law by name is a law without keys; a law by table keeps its keys, which are checked like all others.
TEST(Table, LawsByNameOrTable) {
    Table t = table_of("short = \"stokes\"\nlong = {law = \"uniform\", value = 0.4}\nwrong = {value = 1.0}");
    EXPECT_EQ(t.law("short").text("law"), "stokes");
    Table law = t.law("long");
    EXPECT_EQ(law.text("law"), "uniform");
    expect_error([&] { law.number("speed"); }, {"long.speed", "missing"});
    Table wrong = t.law("wrong");
    expect_error([&] { wrong.text("law"); }, {"wrong.law", "missing"});
    expect_error([&] { t.finish(); }, {"long.value", "unknown"}); // (and wrong.value)
}

// A message over several lines: the value shown is a long array, a string with a line break, a nested table.
TEST(Table, MessagesAreOneLineWhateverTheValue) {
    std::string list = "[";
    for (int k = 0; k < 60; ++k) list += "1234.5678, ";
    Table t = table_of("list = " + list +
                       "]\nword = \"two\\nlines\"\nnested = [{a = 1, b = [1, 2]}, {c = {d = 1}}]\n"
                       "\"odd\\nkey\" = 1");
    expect_error([&] { t.number("list"); }, {"list", "not a number"});
    expect_error([&] { t.number("nested"); }, {"nested", "not a number"});
    expect_error([&] { t.number("word"); }, {"word", "not a number"});
    expect_error([&] { t.choice("word", {"one"}); }, {"word", "two"});
    t.has("list");
    EXPECT_EQ(message_of([&] { t.finish(); }).find('\n'), std::string::npos);
}
