#include "alhazen/parallel/parallel.h"
#include "alhazen/parallel/thread_start.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

TEST(Parallel, AtLeastOneCoreIsAvailable) {
    EXPECT_GE(available_cores(), 1);
}

TEST(Parallel, RangesCoverEveryItemOnceAndHoldAtMostGrainItems) {
    for (const std::size_t count : {0, 1, 2, 7, 64, 1000, 100003}) {
        for (const std::size_t grain : {1, 3, 64, 200000}) {
            std::vector<std::atomic<int>> seen(count);
            std::atomic<bool> too_large{false};
            parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
                if (end - begin > grain || begin >= end) too_large = true;
                for (std::size_t i = begin; i < end; ++i) ++seen[i];
            });
            EXPECT_FALSE(too_large) << count << " by " << grain;
            for (std::size_t i = 0; i < count; ++i) {
                ASSERT_EQ(seen[i], 1) << "item " << i << " of " << count << " by " << grain;
            }
        }
    }
}

TEST(Parallel, RangesDoNotDependOnTheNumberOfThreads) {
    const auto ranges = [](int threads) {
        std::mutex mutex;
        std::set<std::pair<std::size_t, std::size_t>> found;
        ThreadLimit(threads).run([&] {
            parallel_for(1001, 10, [&](std::size_t begin, std::size_t end) {
                const std::lock_guard lock(mutex);
                found.emplace(begin, end);
            });
        });
        return found;
    };
    EXPECT_EQ(ranges(1), ranges(2));
    EXPECT_EQ(ranges(1), ranges(5));
}

TEST(Parallel, InvokeRunsBoth) {
    std::atomic<int> sum{0};
    parallel_invoke([&] { sum += 1; }, [&] { sum += 2; });
    EXPECT_EQ(sum, 3);
}

/// The most memory that the process has had so far, in bytes.
std::size_t most_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

TEST(Parallel, ACallThatReturnsHasRunAllItsTasksAlsoBesideOneThatThrows) {
    std::atomic<int> incomplete{0};
    for (int round = 0; round < 2000; ++round) {
        std::atomic<bool> begun{false};
        const auto nested = [&] {
            begun = true;
            for (int i = 0; i < 20; ++i) {
                std::atomic<int> ran{0};
                parallel_invoke([&] { ++ran; }, [&] { ++ran; });
                if (ran != 2) ++incomplete;
                ran = 0;
                parallel_for(4, 1, [&](std::size_t, std::size_t) { ++ran; });
                if (ran != 4) ++incomplete;
            }
        };
        const auto fails = [&] {
            for (int i = 0; i < 1000 && !begun; ++i) std::this_thread::yield();
            throw std::runtime_error("one of them");
        };
        EXPECT_THROW(ThreadLimit(2).run([&] { parallel_invoke(nested, fails); }),
                     std::runtime_error);
    }
    EXPECT_EQ(incomplete, 0);
}

TEST(Parallel, LimitsMadeAgainAndAgainTakeNoMemory) {
    const auto limits = [](int count) {
        for (int i = 0; i < count; ++i) {
            std::atomic<int> sum{0};
            ThreadLimit(2).run([&] { parallel_for(4, 1, [&](auto, auto) { ++sum; }); });
            ASSERT_EQ(sum, 4);
        }
    };
    limits(10);
    const std::size_t before = most_memory();
    limits(3000);
    // An arena takes 7 KB.
    EXPECT_LT(most_memory(), before + (4 << 20));
}

TEST(Parallel, LimitsInUseAreApart) {
    ThreadLimit(2).run([] {
        std::atomic<int> sum{0};
        parallel_for(8, 1, [&](auto, auto) {
            ThreadLimit(2).run([&] { parallel_for(8, 1, [&](auto, auto) { ++sum; }); });
        });
        EXPECT_EQ(sum, 64);
    });
    std::vector<std::jthread> threads;
    std::atomic<int> sum{0};
    for (int i = 0; i < 8; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 20; ++k) {
                ThreadLimit(2).run([&] { parallel_for(8, 1, [&](auto, auto) { ++sum; }); });
            }
        });
    }
    threads.clear();
    EXPECT_EQ(sum, 8 * 20 * 8);
}

/// Counts the threads inside a region and their maximum.
class Crowd {
  public:
    void visit() {
        const int now = ++inside_;
        int most = most_;
        while (now > most && !most_.compare_exchange_weak(most, now)) {
        }
        std::this_thread::sleep_for(std::chrono::microseconds(200));
        --inside_;
    }
    [[nodiscard]] int most() const { return most_; }

  private:
    std::atomic<int> inside_{0}, most_{0};
};

TEST(Parallel, ALimitIsNotExceededByNestedCalls) {
    for (const int threads : {1, 2, 3}) {
        Crowd crowd;
        ThreadLimit limit(threads);
        EXPECT_LE(limit.threads(), threads);
        limit.run([&] {
            parallel_for(16, 1, [&](std::size_t, std::size_t) {
                parallel_for(4, 1, [&](std::size_t, std::size_t) { crowd.visit(); });
            });
        });
        EXPECT_LE(crowd.most(), threads);
    }
}

TEST(Parallel, TwoThreadsReallyRunAtOnce) {
    if (ThreadLimit(2).threads() < 2) GTEST_SKIP() << "one core";
    // Each side waits for the other; on one thread this would never end, hence a time limit.
    std::atomic<int> arrived{0};
    const auto meet = [&] {
        ++arrived;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (arrived < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    };
    ThreadLimit(2).run([&] { parallel_invoke(meet, meet); });
    EXPECT_EQ(arrived, 2);
}

TEST(Parallel, ALimitOfOneStaysOnTheCallingThread) {
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<std::size_t> begun;
    ThreadLimit(1).run([&] {
        parallel_for(100, 7, [&](std::size_t begin, std::size_t) {
            EXPECT_EQ(std::this_thread::get_id(), caller);
            begun.push_back(begin);
        });
        parallel_invoke([&] { EXPECT_EQ(std::this_thread::get_id(), caller); },
                        [&] { EXPECT_EQ(std::this_thread::get_id(), caller); });
    });
    ASSERT_EQ(begun.size(), 15u);
    EXPECT_TRUE(std::is_sorted(begun.begin(), begun.end()));
}

TEST(Parallel, ALimitWithinALimitOfOneHasItsOwnThreads) {
    if (ThreadLimit(2).threads() < 2) GTEST_SKIP() << "one core";
    std::atomic<int> arrived{0};
    const auto meet = [&] {
        ++arrived;
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
        while (arrived < 2 && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    };
    ThreadLimit(1).run([&] {
        ThreadLimit(2).run([&] { parallel_invoke(meet, meet); });
        EXPECT_EQ(arrived, 2);
        const std::thread::id caller = std::this_thread::get_id();
        parallel_for(
            8, 1, [&](std::size_t, std::size_t) { EXPECT_EQ(std::this_thread::get_id(), caller); });
    });
}

TEST(Parallel, WorkWhileThreadsStartRunsOnceOnTheCallingThread) {
    for (const int threads : {0, 1, 2, 5}) {
        int runs = 0;
        std::thread::id on;
        run_while_threads_start(threads, [&] {
            ++runs;
            on = std::this_thread::get_id();
            std::atomic<int> sum{0};
            ThreadLimit(threads).run([&] {
                parallel_for(100, 1, [&](std::size_t begin, std::size_t) { sum += int(begin); });
            });
            EXPECT_EQ(sum, 4950);
        });
        EXPECT_EQ(runs, 1);
        EXPECT_EQ(on, std::this_thread::get_id());
        EXPECT_THROW(run_while_threads_start(threads, [] { throw std::runtime_error("none"); }),
                     std::runtime_error);
    }
}

TEST(Parallel, ZeroMeansAllAvailableCores) {
    EXPECT_EQ(ThreadLimit(0).threads(), available_cores());
    EXPECT_EQ(ThreadLimit(-3).threads(), available_cores());
}

TEST(Parallel, AnExceptionReachesTheCallerOnceAndThePoolStaysUsable) {
    ThreadLimit limit(4);
    for (int round = 0; round < 50; ++round) {
        int caught = 0;
        limit.run([&] {
            try {
                parallel_for(64, 1, [&](std::size_t begin, std::size_t) {
                    if (begin % 3 == 0) throw std::runtime_error("item");
                });
            } catch (const std::runtime_error& error) {
                ++caught;
                EXPECT_STREQ(error.what(), "item");
            }
        });
        ASSERT_EQ(caught, 1);
    }
    EXPECT_THROW(limit.run([] { parallel_invoke([] { throw 1; }, [] {}); }), int);
    EXPECT_THROW(limit.run([] { throw std::logic_error("work"); }), std::logic_error);
    std::atomic<int> sum{0};
    limit.run([&] { parallel_for(100, 1, [&](std::size_t, std::size_t) { ++sum; }); });
    EXPECT_EQ(sum, 100);
}

int recursive_sum(int depth) {
    if (depth == 0) return 1;
    int a = 0, b = 0;
    parallel_invoke([&] { a = recursive_sum(depth - 1); }, [&] { b = recursive_sum(depth - 1); });
    return a + b;
}

TEST(Parallel, DeeplyNestedCallsDoNotDeadlock) {
    for (const int threads : {1, 2, 4}) {
        int sum = 0;
        ThreadLimit(threads).run([&] { sum = recursive_sum(10); });
        EXPECT_EQ(sum, 1024);
    }
}

TEST(Parallel, LimitsMayBeNested) {
    std::atomic<int> sum{0};
    ThreadLimit(2).run([&] {
        parallel_for(4, 1, [&](std::size_t, std::size_t) {
            ThreadLimit(3).run(
                [&] { parallel_for(8, 1, [&](std::size_t, std::size_t) { ++sum; }); });
        });
    });
    EXPECT_EQ(sum, 32);
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
