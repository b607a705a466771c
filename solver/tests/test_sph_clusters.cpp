// Clusters of smoothed particles and their neighbour lists against a search over all pairs.
#include "sph/clusters.hpp"

#include "fluid_fixtures.hpp"

#include <algorithm>

using namespace plumb;
using namespace plumb::fixture;

namespace {

constexpr double spacing = 0.1, reach = 0.26, skin = 0.015;

/// Particles to be clustered; slot k has the id id[k].
struct Cloud {
    Domain domain;
    int dimensions = 3;
    VectorField x;
    std::vector<std::int32_t> id;
    VectorField passive{};

    std::size_t size() const { return id.size(); }
    Vec3 at(std::size_t k) const {
        Vec3 place = Vec3::Zero();
        for (int c = 0; c < dimensions; ++c) place[c] = x[static_cast<std::size_t>(c)][k];
        return place;
    }
    void put(const Vec3& place) {
        for (int c = 0; c < dimensions; ++c) x[static_cast<std::size_t>(c)].push_back(place[c]);
        id.push_back(static_cast<std::int32_t>(id.size()));
    }
};

struct Built {
    FluidClusters clusters;
    ClusterOrder order;
};

Built build(const Cloud& cloud) {
    Built built;
    built.clusters.reach = reach, built.clusters.skin = skin;
    built.order = rebuild(built.clusters, {cloud.x, cloud.id, cloud.passive}, cloud.domain, spacing);
    return built;
}

enum class Kind { lattice, jittered, random, clumped };
const std::array kinds{Kind::lattice, Kind::jittered, Kind::random, Kind::clumped};

/// `per_axis` particles per axis in the box; along open sides random ones may lie outside.
Cloud cloud_of(Kind kind, const Domain& domain, int per_axis, std::int64_t seed) {
    Cloud cloud{domain, domain.dimensions, {}, {}};
    Random random(seed);
    const auto total = static_cast<int>(std::pow(per_axis, domain.dimensions));
    for (int k = 0; k < total; ++k) {
        const Vec3 cell(k % per_axis, k / per_axis % per_axis, k / (per_axis * per_axis));
        const double jitter = kind == Kind::jittered ? 0.4 : 0.0;
        Vec3 place = (cell + Vec3::Constant(0.5) + random_vector(random, -jitter, jitter)) / per_axis;
        if (kind == Kind::random || kind == Kind::clumped) {
            place = random_vector(random, 0.0, 1.0);
            if (kind == Kind::clumped && k % 4 != 0) place = 0.3 * place + Vec3::Constant(0.75); // around a corner
            for (Eigen::Index c = 0; c < 3; ++c)
                place[c] = domain.periodic[static_cast<std::size_t>(c)] ? place[c] - std::floor(place[c])
                                                                        : 1.4 * place[c] - 0.2;
        }
        cloud.put(place.cwiseProduct(domain.size));
    }
    return cloud;
}

/// Every combination of periodic sides.
std::vector<std::array<bool, 3>> all_sides(int dimensions) {
    std::vector<std::array<bool, 3>> sides;
    for (int bits = 0; bits < (1 << dimensions); ++bits)
        sides.push_back({(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0});
    return sides;
}

/// Each particle once; copies after the particle they copy, with its record.
void expect_sound_order(const Built& built, std::size_t particles) {
    const auto& [clusters, order] = built;
    ASSERT_EQ(order.from.size(), pack_width * clusters.count);
    ASSERT_EQ(order.copy.size(), order.from.size());
    ASSERT_EQ(clusters.record_of.size(), order.from.size());
    std::vector<int> seen(particles, 0);
    for (std::size_t k = 0; k < order.from.size(); ++k) {
        if (order.copy[k] == 0) {
            ++seen[static_cast<std::size_t>(order.from[k])];
            continue;
        }
        ASSERT_NE(k % pack_width, 0U) << "a cluster of copies only";
        EXPECT_EQ(order.from[k], order.from[k - 1]) << "slot " << k;
        EXPECT_EQ(clusters.record_of[k], clusters.record_of[k - 1]) << "slot " << k;
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

/// Puts every particle's position and, as volume, its slot in the cloud into its record; then makes the images.
void fill_records(Built& built, const Cloud& cloud) {
    for (std::size_t k = 0; k < built.order.from.size(); ++k) {
        const auto slot = static_cast<std::size_t>(built.order.from[k]);
        const Vec3 x = cloud.at(slot);
        built.clusters.records[static_cast<std::size_t>(built.clusters.record_of[k])] = {
            x[0], x[1], x[2], 1.0, 2.0, 3.0, 4.0, static_cast<double>(slot)};
    }
    update_images(built.clusters, cloud.domain);
}

/// Records are particles or images shifted by whole sides along periodic axes, all other numbers alike.
void expect_sound_records(const Built& built, const Cloud& cloud) {
    const FluidClusters& clusters = built.clusters;
    ASSERT_EQ(clusters.image_of.size(), clusters.records.size());
    ASSERT_EQ(clusters.image_shift.size(), clusters.records.size());
    std::vector<int> own(cloud.size(), 0);
    for (std::size_t r = 0; r < clusters.records.size(); ++r) {
        const FluidRecord& record = clusters.records[r];
        const auto source = static_cast<std::size_t>(clusters.image_of[r]);
        ASSERT_EQ(static_cast<std::size_t>(clusters.image_of[source]), source) << "an image of an image";
        EXPECT_EQ(record.volume, clusters.records[source].volume);
        EXPECT_TRUE(record.pressure == 1.0 && record.u == 2.0 && record.v == 3.0 && record.w == 4.0);
        const auto slot = static_cast<std::size_t>(record.volume);
        if (source == r) ++own[slot];
        const int code = clusters.image_shift[r];
        const Vec3 sides(code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1);
        EXPECT_EQ(sides == Vec3::Zero(), source == r);
        for (Eigen::Index c = 0; c < 3; ++c)
            EXPECT_TRUE(sides[c] == 0.0 || cloud.domain.periodic[static_cast<std::size_t>(c)]) << "axis " << c;
        const Vec3 expected = cloud.at(slot) + sides.cwiseProduct(cloud.domain.size);
        EXPECT_EQ(Vec3(record.x, record.y, record.z), expected);
    }
    EXPECT_TRUE(std::all_of(own.begin(), own.end(), [](int n) { return n == 1; }));
}

/// Whoever is nearer to a particle than reach and skin is in the list of its cluster exactly once, and nobody else.
void expect_all_pairs(const Built& built, const Cloud& cloud) {
    const FluidClusters& clusters = built.clusters;
    const double far_sq = (reach + skin) * (reach + skin);
    std::size_t wrong = 0;
    std::vector<int> found(cloud.size());
    for (std::size_t k = 0; k < built.order.from.size(); ++k) {
        const Vec3 x = cloud.at(static_cast<std::size_t>(built.order.from[k]));
        std::fill(found.begin(), found.end(), 0);
        for (const std::int32_t r : clusters.near(k / pack_width)) {
            const FluidRecord& b = clusters.records[static_cast<std::size_t>(r)];
            if ((x - Vec3(b.x, b.y, b.z)).squaredNorm() < far_sq) ++found[static_cast<std::size_t>(b.volume)];
        }
        for (std::size_t b = 0; b < cloud.size(); ++b) {
            const double apart_sq = cloud.domain.minimum_image(x - cloud.at(b)).squaredNorm();
            if (std::abs(apart_sq - far_sq) < 1e-12) continue; // undecided by rounding
            wrong += found[b] == (apart_sq < far_sq ? 1 : 0) ? 0U : 1U;
        }
    }
    EXPECT_EQ(wrong, 0U) << "pairs missing or met twice";
}

/// Lists ascend, hence hold no record twice, and name records only.
void expect_sound_lists(const FluidClusters& clusters) {
    for (std::size_t c = 0; c < clusters.count; ++c) {
        std::int32_t before = -1;
        for (const std::int32_t r : clusters.near(c)) {
            ASSERT_LT(before, r);
            ASSERT_LT(static_cast<std::size_t>(r), clusters.records.size());
            before = r;
        }
    }
}

void expect_sound(const Cloud& cloud) {
    Built built = build(cloud);
    expect_sound_order(built, cloud.size());
    expect_sound_lists(built.clusters);
    if (testing::Test::HasFatalFailure()) return;
    fill_records(built, cloud);
    expect_sound_records(built, cloud);
    expect_all_pairs(built, cloud);
}

/// Same order by id, same lists and records.
void expect_same(const Built& a, const Cloud& in_a, const Built& b, const Cloud& in_b) {
    ASSERT_EQ(a.order.from.size(), b.order.from.size());
    EXPECT_EQ(a.order.copy, b.order.copy);
    for (std::size_t k = 0; k < a.order.from.size(); ++k)
        ASSERT_EQ(in_a.id[static_cast<std::size_t>(a.order.from[k])],
                  in_b.id[static_cast<std::size_t>(b.order.from[k])]);
    ASSERT_EQ(a.clusters.count, b.clusters.count);
    for (std::size_t c = 0; c < a.clusters.count; ++c) {
        const auto near_a = a.clusters.near(c), near_b = b.clusters.near(c);
        ASSERT_TRUE(std::equal(near_a.begin(), near_a.end(), near_b.begin(), near_b.end())) << "list " << c;
    }
    EXPECT_EQ(a.clusters.record_of, b.clusters.record_of);
    EXPECT_EQ(a.clusters.image_of, b.clusters.image_of);
    EXPECT_EQ(a.clusters.image_shift, b.clusters.image_shift);
}

/// The same particles in other slots.
Cloud shuffled(const Cloud& cloud, std::int64_t seed) {
    std::vector<std::size_t> order(cloud.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random random(seed);
    for (std::size_t k = order.size(); k > 1; --k)
        std::swap(order[k - 1], order[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
    Cloud other{cloud.domain, cloud.dimensions, {}, {}};
    for (const std::size_t k : order) other.put(cloud.at(k)), other.id.back() = cloud.id[k];
    return other;
}

constexpr double least_side = 2.0 * (reach + skin) * 1.0001;

} // namespace

// A pair lost or met twice at a side, at a corner, in the bins along a column or in the outermost columns; images
// shifted the wrong way. Boxes as short as they may be, where images meet both sides of a cluster.
TEST(SphClusters, ListsHoldEveryPairOnceInTheShortestBoxes) {
    for (const int d : {2, 3})
        for (const auto& sides : all_sides(d))
            for (const Kind kind : kinds) {
                SCOPED_TRACE(testing::Message() << d << " dimensions, periodic " << sides[0] << sides[1] << sides[2]
                                                << ", kind " << static_cast<int>(kind));
                expect_sound(
                    cloud_of(kind, box_of_dimensions(d, Vec3::Constant(least_side), sides), d == 2 ? 9 : 6, 1));
            }
}

// The same in boxes of several reaches, of other widths along each axis: grid indices of one axis used for another.
TEST(SphClusters, ListsHoldEveryPairOnceInLongerBoxes) {
    for (const int d : {2, 3})
        for (const auto& sides : all_sides(d))
            for (const Kind kind : kinds) {
                SCOPED_TRACE(testing::Message() << d << " dimensions, periodic " << sides[0] << sides[1] << sides[2]
                                                << ", kind " << static_cast<int>(kind));
                const Vec3 size = d == 2 ? Vec3(2.3, 1.1, 0.0) : Vec3(1.3, 0.6, 0.93);
                expect_sound(cloud_of(kind, box_of_dimensions(d, size, sides), d == 2 ? 21 : 9, 2));
            }
}

// Columns without particles, one cluster for all, particles exactly at sides and in the same place.
TEST(SphClusters, FewParticles) {
    for (const int d : {2, 3}) {
        const Domain domain = box_of_dimensions(d, Vec3(0.9, 0.8, 0.7), {true, true, true});
        Cloud cloud{domain, d, {}, {}};
        for (const Vec3& x : {Vec3(0.0, 0.0, 0.0), Vec3(0.2, 0.79999, 0.0), Vec3(0.2, 0.79999, 0.0),
                              Vec3(0.89999, 0.0, 0.69999), Vec3(0.45, 0.4, 0.35)}) {
            cloud.put(d == 3 ? x : Vec3(x[0], x[1], 0.0));
            SCOPED_TRACE(testing::Message() << cloud.size() << " particles, " << d << " dimensions");
            expect_sound(cloud);
        }
    }
}

// Bins along a column that stretch with the farthest particle: memory without end, or neighbours far out lost.
TEST(SphClusters, ParticlesFarOutsideAnOpenBox) {
    for (const int d : {2, 3}) {
        Cloud cloud = cloud_of(Kind::random, box_of_dimensions(d, Vec3::Constant(0.8), {}), 6, 3);
        for (int k = 0; k < 20; ++k) {
            Vec3 x(0.05 * k, 1e5 + 0.04 * k, d == 3 ? -1e5 + 0.01 * k : 0.0);
            if (k % 2 != 0) x[0] -= 1e6;
            cloud.put(x);
        }
        SCOPED_TRACE(d);
        expect_sound(cloud);
    }
}

// A sort that leaves ties to the order of slots: a resumed run, whose slots are others, would sum in another order.
TEST(SphClusters, DoNotDependOnTheOrderOfSlots) {
    for (const int d : {2, 3})
        for (const Kind kind : kinds) {
            const Cloud cloud =
                cloud_of(kind, box_of_dimensions(d, Vec3(0.9, 0.7, 0.8), {true, false, true}), d == 2 ? 20 : 8, 4);
            const Cloud other = shuffled(cloud, 5);
            SCOPED_TRACE(testing::Message() << d << " dimensions, kind " << static_cast<int>(kind));
            expect_same(build(cloud), cloud, build(other), other);
        }
}

// Copies from an earlier build taken for particles.
TEST(SphClusters, SlotsOfCopiesAreLeftOut) {
    const Cloud cloud = cloud_of(Kind::random, box_of_dimensions(3, Vec3::Constant(0.8), {true, true, true}), 6, 6);
    Cloud padded = cloud;
    for (std::size_t k = 0; k < 30; ++k) padded.put(cloud.at(3 * k)), padded.id.back() = -1;
    expect_same(build(cloud), cloud, build(padded), padded);
}

// Lists put together in the order in which threads finish.
TEST(SphClusters, DoNotDependOnTheNumberOfThreads) {
    for (const int d : {2, 3}) {
        const Cloud cloud = cloud_of(Kind::jittered, box_of_dimensions(d, Vec3(1.6, 1.5, 1.4), {true, true, false}),
                                     d == 2 ? 60 : 15, 7);
        Built serial;
        {
            const Threads one(1);
            serial = build(cloud);
        }
        for (const int n : {2, 3, 4}) {
            const Threads several(n);
            SCOPED_TRACE(n);
            expect_same(serial, cloud, build(cloud), cloud);
        }
    }
}

// A box so short that a particle meets two images of another: only one would be found, silently.
TEST(SphClusters, ShortPeriodicSideIsAnInputError) {
    const double short_side = 2.0 * (reach + skin) * 0.9999;
    for (const int d : {2, 3})
        for (Eigen::Index c = 0; c < d; ++c) {
            Vec3 size = Vec3::Constant(1.0);
            size[c] = short_side;
            std::array<bool, 3> sides{true, true, true};
            const Cloud cloud = cloud_of(Kind::random, box_of_dimensions(d, size, sides), 3, 8);
            expect_error([&] { build(cloud); },
                         {"domain.size", std::string("along periodic ") + axis_names[static_cast<std::size_t>(c)]});
            sides[static_cast<std::size_t>(c)] = false;
            expect_sound(cloud_of(Kind::random, box_of_dimensions(d, size, sides), 4, 8)); // an open one may be short
        }
}
