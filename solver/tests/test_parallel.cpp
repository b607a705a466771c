// Loops over threads: every index once, fixed sums, faults as in a serial loop.
#include "core/parallel.hpp"

#include "grain_fixtures.hpp"

#include <atomic>
#include <stdexcept>

using namespace plumb;
using namespace plumb::fixture;

namespace {

/// Restores the number of threads.
struct Threads {
    int before = thread_count();
    ~Threads() { set_threads(before); }
};

constexpr std::size_t sizes[] = {0, 1, 511, 512, 513, 1024, 5000};

} // namespace

// A chunk that is skipped, done twice, or one index too long.
TEST(Parallel, EveryIndexIsVisitedOnce) {
    const Threads restore;
    for (int threads = 1; threads <= 4; ++threads) {
        set_threads(threads);
        for (const std::size_t n : sizes) {
            std::vector<int> visits(n + 8, 0);
            parallel_for(n, [&](std::size_t i) { ++visits[i]; });
            for (std::size_t i = 0; i < visits.size(); ++i) ASSERT_EQ(visits[i], i < n ? 1 : 0) << n << " " << i;
        }
    }
}

// Chunks that depend on the number of threads: their ends are part of the contract of chunked sums.
TEST(Parallel, ChunksDoNotDependOnThreads) {
    const Threads restore;
    for (int threads = 1; threads <= 4; ++threads) {
        set_threads(threads);
        std::vector<std::size_t> end_of(10, 0);
        parallel_chunks(
            95, [&](std::size_t begin, std::size_t end) { end_of[begin / 10] = end; }, 10);
        for (std::size_t c = 0; c < 10; ++c) EXPECT_EQ(end_of[c], std::min<std::size_t>(95, 10 * c + 10));
    }
}

// A sum whose order follows the threads: terms of very different size make any change of order visible.
TEST(Parallel, OrderedSumHasTheSameBitsForAnyThreadCount) {
    const Threads restore;
    Random random(1);
    std::vector<double> terms(10007);
    for (double& t : terms) t = random.normal() * std::pow(10.0, random.uniform(-12.0, 12.0));
    const auto sum = [&] { return ordered_sum(terms.size(), 0.0, [&](std::size_t i) { return terms[i]; }); };
    set_threads(1);
    const double one = sum();
    for (int threads = 2; threads <= 4; ++threads) {
        set_threads(threads);
        for (int repeat = 0; repeat < 20; ++repeat) {
            const double many = sum();
            ASSERT_TRUE(same_bits(&one, &many, 1)) << threads;
        }
    }
}

// `zero` added once per chunk, terms lost at chunk ends: whole numbers must add up exactly.
TEST(Parallel, OrderedSumIsExactForWholeNumbers) {
    const Threads restore;
    set_threads(3);
    for (const std::size_t n : sizes) {
        const double sum = ordered_sum(n, 0.0, [](std::size_t i) { return static_cast<double>(i); });
        EXPECT_EQ(sum, n == 0 ? 0.0 : 0.5 * static_cast<double>(n) * static_cast<double>(n - 1));
    }
    const Vec3 zero = Vec3::Zero();
    EXPECT_EQ(ordered_sum(600, zero, [](std::size_t) { return Vec3(1.0, 2.0, 3.0); }), Vec3(600.0, 1200.0, 1800.0));
}

// An exception that is lost in a worker, ends the program, or is not the first of a serial loop.
TEST(Parallel, TheFaultOfTheLowestChunkIsRethrown) {
    const Threads restore;
    for (int threads = 1; threads <= 4; ++threads) {
        set_threads(threads);
        for (int repeat = 0; repeat < 10; ++repeat) {
            try {
                parallel_for(20 * parallel_chunk, [&](std::size_t i) {
                    if (i == 3 * parallel_chunk + 7 || i == 3 * parallel_chunk + 9 || i == 17 * parallel_chunk)
                        throw std::runtime_error(std::to_string(i));
                });
                ADD_FAILURE() << "nothing was thrown";
            } catch (const std::runtime_error& error) {
                EXPECT_EQ(error.what(), std::to_string(3 * parallel_chunk + 7));
            }
        }
    }
}

// Zero or negative numbers of threads are one thread.
TEST(Parallel, AtLeastOneThread) {
    const Threads restore;
    set_threads(0);
    EXPECT_EQ(thread_count(), 1);
    set_threads(-3);
    EXPECT_EQ(thread_count(), 1);
}
