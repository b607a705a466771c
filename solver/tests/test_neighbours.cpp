// The neighbour list against a search over all pairs, and what it remembers.
#include "dem/neighbours.hpp"

#include "grain_fixtures.hpp"

#include <algorithm>
#include <map>
#include <set>

using namespace plumb;
using namespace plumb::fixture;

namespace {

using IdPair = std::pair<std::int32_t, std::int32_t>;
constexpr double skin = 0.01;

IdPair sorted(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

std::set<IdPair> listed(const Neighbours& list, const Grains& g) {
    std::set<IdPair> pairs;
    for (std::size_t p = 0; p < list.count; ++p) {
        const auto pair = sorted(g.id[static_cast<std::size_t>(list.i[p])], g.id[static_cast<std::size_t>(list.j[p])]);
        EXPECT_TRUE(pairs.insert(pair).second) << "listed twice: " << pair.first << " " << pair.second;
    }
    return pairs;
}

/// All pairs whose nearest images are nearer than radii plus skin, by a double loop.
std::set<IdPair> brute_force(const Grains& g, const Domain& domain, const std::vector<GrainGroup>& groups) {
    std::set<IdPair> pairs;
    for (std::size_t a = 0; a < g.size(); ++a)
        for (std::size_t b = a + 1; b < g.size(); ++b) {
            const Motion ma = groups[static_cast<std::size_t>(g.group[a])].motion;
            const Motion mb = groups[static_cast<std::size_t>(g.group[b])].motion;
            if (ma == Motion::fixed && mb == Motion::fixed) continue;
            if (ma == Motion::block && g.group[a] == g.group[b]) continue;
            const double reach = g.radius[a] + g.radius[b] + skin;
            if (domain.minimum_image(g.x[a] - g.x[b]).norm() < reach) pairs.insert(sorted(g.id[a], g.id[b]));
        }
    return pairs;
}

/// Order, ranges, padding and crossing flags of a list.
void expect_sound(const Neighbours& list, const Grains& g, const Domain& domain) {
    const auto n = static_cast<std::int32_t>(g.size());
    ASSERT_EQ(list.i.size(), list.j.size());
    ASSERT_EQ(list.padded() % 8, 0U);
    ASSERT_EQ(list.padded(), (list.count + 7) / 8 * 8);
    ASSERT_EQ(list.own.size(), g.size() + 1);
    ASSERT_EQ(list.incoming_begin.size(), g.size() + 1);
    ASSERT_EQ(list.incoming.size(), list.count);
    std::vector<bool> seen(list.count, false);
    for (std::size_t p = 0; p < list.padded(); ++p) {
        if (p >= list.count) {
            EXPECT_EQ(list.i[p], n);
            EXPECT_EQ(list.j[p], n);
            continue;
        }
        ASSERT_LT(list.i[p], list.j[p]);
        if (p > 0) {
            ASSERT_LE(list.i[p - 1], list.i[p]);
        }
        ASSERT_GE(static_cast<std::int32_t>(p), list.own[static_cast<std::size_t>(list.i[p])]);
        ASSERT_LT(static_cast<std::int32_t>(p), list.own[static_cast<std::size_t>(list.i[p]) + 1]);
    }
    for (std::size_t k = 0; k < g.size(); ++k)
        for (auto q = list.incoming_begin[k]; q < list.incoming_begin[k + 1]; ++q) {
            const auto p = static_cast<std::size_t>(list.incoming[static_cast<std::size_t>(q)]);
            ASSERT_EQ(list.j[p], static_cast<std::int32_t>(k));
            ASSERT_FALSE(seen[p]);
            seen[p] = true;
        }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](bool s) { return s; }));
    for (std::size_t block = 0; block < list.crosses.size(); ++block) {
        bool crosses = false;
        for (std::size_t p = 8 * block; p < std::min(list.count, 8 * block + 8); ++p) {
            const Vec3 dx = g.x[static_cast<std::size_t>(list.i[p])] - g.x[static_cast<std::size_t>(list.j[p])];
            crosses = crosses || (dx - domain.minimum_image(dx)).norm() > 1e-12;
        }
        EXPECT_EQ(list.crosses[block] != 0, crosses);
    }
}

GrainSystem cloud(const Domain& domain, int count, double least, double largest, std::int64_t seed,
                  double outside = 0.0) {
    GrainSystem system;
    system.domain = domain;
    system.groups = {group_of("glass")};
    system.neighbours.skin = skin;
    system.neighbours.history = 3;
    Random random(seed);
    for (int k = 0; k < count; ++k) {
        Vec3 x;
        for (Eigen::Index c = 0; c < 3; ++c) x[c] = random.uniform(-outside, 1.0 + outside) * domain.size[c];
        add(system, random.uniform(least, largest), x);
    }
    return system;
}

void expect_all_pairs(GrainSystem& s) {
    rebuild(s.neighbours, s.grains, s.groups, s.domain, {});
    EXPECT_EQ(listed(s.neighbours, s.grains), brute_force(s.grains, s.domain, s.groups));
    expect_sound(s.neighbours, s.grains, s.domain);
}

} // namespace

// A neighbouring cell left out, a shift with the wrong sign: all mixes of periodic and open sides, boxes of two, three
// and more cells along each axis, sizes 1:5.
TEST(Neighbours, AllPairsOfPolydisperseGrains) {
    for (int sides = 0; sides < 8; ++sides)
        for (const Vec3& size :
             {Vec3(1.0, 1.0, 1.0), Vec3(0.45, 0.7, 1.3), Vec3(0.7, 0.45, 0.45), Vec3(0.67, 0.9, 2.0)}) {
            SCOPED_TRACE(fmt::format("sides {} size {} {} {}", sides, size.x(), size.y(), size.z()));
            GrainSystem s =
                cloud(box(size, {(sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0}), 300, 0.02, 0.1, sides);
            expect_all_pairs(s);
        }
}

// Narrow boxes: pairs listed twice when the neighbours on both sides are the same cell, or not at all. One cell can
// occur along open axes only, a periodic box has at least two.
TEST(Neighbours, NarrowBoxes) {
    for (int sides = 0; sides < 8; ++sides)
        for (const double x : {0.1, 0.43, 0.64, 0.85})
            for (const double y : {0.05, 0.43, 0.64}) {
                const std::array periodic{(sides & 1) != 0 && x > 0.42, (sides & 2) != 0 && y > 0.42, (sides & 4) != 0};
                SCOPED_TRACE(fmt::format("sides {} x {} y {}", sides, x, y));
                GrainSystem s = cloud(box(Vec3(x, y, 0.43), periodic), 60, 0.02, 0.1, sides + 10);
                expect_all_pairs(s);
            }
}

// Grains that left an open box must still find each other; along periodic axes they come back, and the turns are
// counted so that their path stays known.
TEST(Neighbours, GrainsOutsideTheBox) {
    for (int sides = 0; sides < 8; ++sides) {
        SCOPED_TRACE(sides);
        GrainSystem s = cloud(box(Vec3(0.6, 0.8, 0.7), {(sides & 1) != 0, (sides & 2) != 0, (sides & 4) != 0}), 400,
                              0.02, 0.1, sides, 2.0);
        const std::vector<Vec3> before = s.grains.x;
        expect_all_pairs(s);
        for (std::size_t k = 0; k < s.grains.size(); ++k) {
            const Vec3 x = unwrapped(s.grains, s.domain, k);
            ASSERT_LT((x - before[static_cast<std::size_t>(s.grains.id[k])]).norm(), 1e-14);
            ASSERT_EQ(s.grains.x[k], s.grains.x_listed[k]);
            for (Eigen::Index c = 0; c < 3; ++c)
                if (s.domain.periodic[static_cast<std::size_t>(c)]) {
                    ASSERT_GE(s.grains.x[k][c], 0.0);
                    ASSERT_LT(s.grains.x[k][c], s.domain.size[c]);
                } else {
                    ASSERT_EQ(s.grains.turns[k][c], 0.0);
                }
        }
    }
}

// A dense lattice of many cells, and a nearly empty box whose cells are widened.
TEST(Neighbours, DenseAndEmptyBoxes) {
    GrainSystem dense = cloud(box(Vec3(1.0, 1.0, 1.0), {true, true, true}), 1500, 0.04, 0.045, 3);
    expect_all_pairs(dense);
    GrainSystem few = cloud(box(Vec3(1.0, 3.0, 2.0), {true, false, true}), 7, 0.001, 0.002, 4);
    expect_all_pairs(few);
    GrainSystem none = cloud(box(Vec3(1.0, 1.0, 1.0), {true, true, true}), 0, 0.1, 0.1, 5);
    rebuild(none.neighbours, none.grains, none.groups, none.domain, {});
    EXPECT_EQ(none.neighbours.count, 0U);
}

// A pair exactly as far apart as the reach, and one a hair nearer; a pair across a corner.
TEST(Neighbours, TheReachIsRadiiPlusSkin) {
    GrainSystem s = cloud(box(Vec3(2.0, 2.0, 2.0), {true, true, true}), 0, 0.1, 0.1, 6);
    add(s, 0.125, Vec3(1.0, 1.0, 1.0));
    add(s, 0.0625, Vec3(1.0 + 0.1875 + skin * (1.0 - 1e-9), 1.0, 1.0));
    add(s, 0.0625, Vec3(1.0, 1.0 + 0.1875 + skin * (1.0 + 1e-9), 1.0));
    add(s, 0.1, Vec3(0.05, 0.05, 0.05));
    add(s, 0.1, Vec3(1.95, 1.95, 1.95));
    rebuild(s.neighbours, s.grains, s.groups, s.domain, {});
    EXPECT_EQ(listed(s.neighbours, s.grains), (std::set<IdPair>{{0, 1}, {3, 4}}));
}

// Fixed grains among themselves and grains of one block never touch; all other pairs do.
TEST(Neighbours, FixedAndBlockPairsAreLeftOut) {
    GrainSystem s = cloud(box(Vec3(0.8, 0.8, 0.8), {true, false, true}), 0, 0.1, 0.1, 7);
    s.groups = {group_of("free"), group_of("floor", 2500.0, true, Motion::fixed),
                group_of("lid", 2500.0, true, Motion::block), group_of("piston", 2500.0, true, Motion::block),
                group_of("rough", 2500.0, true, Motion::fixed)};
    add_cloud(s, 300, 0.03, 0.1, 0.0, 0.0, 8);
    expect_all_pairs(s);
}

// A list that depends on the order in which the grains happen to lie in memory: a resumed run would differ.
TEST(Neighbours, TheListIsAFunctionOfPositionsAndIds) {
    GrainSystem a = cloud(box(Vec3(1.0, 0.7, 1.2), {true, true, false}), 500, 0.02, 0.08, 9, 0.2);
    GrainSystem b = a;
    std::vector<std::int32_t> order(b.grains.size());
    std::iota(order.begin(), order.end(), 0);
    Random random(10);
    for (std::size_t k = order.size() - 1; k > 0; --k)
        std::swap(order[k], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
    reorder(b.grains, order);
    const Grains shuffled = b.grains;
    const std::vector<std::int32_t> moved = rebuild(b.neighbours, b.grains, b.groups, b.domain, {});
    rebuild(a.neighbours, a.grains, a.groups, a.domain, {});
    expect_same_bits(a.grains, b.grains);
    EXPECT_EQ(a.grains.radius, b.grains.radius);
    EXPECT_EQ(a.neighbours.i, b.neighbours.i);
    EXPECT_EQ(a.neighbours.j, b.neighbours.j);
    EXPECT_EQ(a.neighbours.own, b.neighbours.own);
    EXPECT_EQ(a.neighbours.incoming, b.neighbours.incoming);
    EXPECT_EQ(a.neighbours.crosses, b.neighbours.crosses);
    for (std::size_t k = 0; k < moved.size(); ++k) // the order returned says what moved where
        EXPECT_EQ(b.grains.id[k], shuffled.id[static_cast<std::size_t>(moved[k])]);
    Grains again = a.grains;
    rebuild(a.neighbours, a.grains, a.groups, a.domain, {}); // a second time: nothing moves
    EXPECT_EQ(again.id, a.grains.id);
}

// A spring forgotten, given to another pair, or kept with its sign although the order of its grains has turned round.
TEST(Neighbours, MemorySurvivesARebuild) {
    for (const int history : {3, 6}) {
        GrainSystem s = cloud(box(Vec3(1.0, 1.0, 1.0), {true, false, true}), 400, 0.03, 0.08, 11);
        s.neighbours.history = history;
        rebuild(s.neighbours, s.grains, s.groups, s.domain, {});
        Random random(12);
        std::map<IdPair, std::vector<double>> want; // as seen from the smaller id
        std::size_t flipped = 0, kept = 0;
        for (std::size_t p = 0; p < s.neighbours.count; ++p) {
            const std::int32_t a = s.grains.id[static_cast<std::size_t>(s.neighbours.i[p])];
            const std::int32_t b = s.grains.id[static_cast<std::size_t>(s.neighbours.j[p])];
            if (p % 3 == 0) continue; // not all pairs touch
            for (int h = 0; h < history; ++h) {
                s.neighbours.remembered(p, h) = random.normal();
                want[sorted(a, b)].push_back((a < b ? 1.0 : -1.0) * s.neighbours.remembered(p, h));
            }
        }
        const auto memory = remembered_contacts(s.neighbours, s.grains);
        EXPECT_EQ(memory.size(), want.size());
        std::map<IdPair, bool> before;
        for (std::size_t p = 0; p < s.neighbours.count; ++p) {
            const std::int32_t a = s.grains.id[static_cast<std::size_t>(s.neighbours.i[p])];
            const std::int32_t b = s.grains.id[static_cast<std::size_t>(s.neighbours.j[p])];
            before[sorted(a, b)] = a < b;
        }
        for (Vec3& x : s.grains.x) x += Vec3(0.13, 0.0, 0.31) + random_vector(random, -1e-3, 1e-3); // other cells
        rebuild(s.neighbours, s.grains, s.groups, s.domain, memory);
        for (std::size_t p = 0; p < s.neighbours.count; ++p) {
            const std::int32_t a = s.grains.id[static_cast<std::size_t>(s.neighbours.i[p])];
            const std::int32_t b = s.grains.id[static_cast<std::size_t>(s.neighbours.j[p])];
            const auto found = want.find(sorted(a, b));
            for (int h = 0; h < history; ++h) {
                const double value =
                    found == want.end() ? 0.0 : (a < b ? 1.0 : -1.0) * found->second[static_cast<std::size_t>(h)];
                ASSERT_EQ(s.neighbours.remembered(p, h), value);
            }
            if (found != want.end()) ++kept, flipped += before[sorted(a, b)] != (a < b) ? 1U : 0U;
        }
        EXPECT_GT(kept, want.size() / 2);
        EXPECT_GT(flipped, 20U); // the case that matters did occur
    }
}
