#include "alhazen/base/interruption.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "alhazen/accel/accelerator_names.h"
#include "alhazen/aggregates/accelerator_table.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/session/generators/field.h"
#include "alhazen/session/load.h"

namespace alhazen::ALHAZEN_TEST_FILE {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// How much slower than usual this machine may be.
double slowdown() {
    const char* const text = std::getenv("ALHAZEN_TEST_SLOWDOWN");
    return text != nullptr ? std::atof(text) : 1.0;
}

/// Seconds from a stop request, made `delay` after the work began, to its end; none if the work
/// ended before the request.
template <class Work>
std::optional<double> seconds_to_end(std::chrono::milliseconds delay, const Work& work) {
    StopFlag flag;
    std::atomic<Clock::time_point> asked{};
    std::jthread other([&] {
        std::this_thread::sleep_for(delay);
        asked = Clock::now();
        flag.request();
    });
    try {
        const Interruptible ends(&flag);
        work();
    } catch (const Interrupted&) {
        const Clock::time_point ended = Clock::now();
        other.join();
        return Seconds(ended - asked.load()).count();
    }
    return std::nullopt;
}

TEST(Interruption, WithoutAScopeNothingIsThrown) {
    EXPECT_EQ(Interruptible::current(), nullptr);
    EXPECT_NO_THROW(interruption_point());
}

TEST(Interruption, AScopeThrowsOnceItsFlagIsRequestedAndEndsWithItself) {
    StopFlag outer, inner;
    {
        const Interruptible a(&outer);
        {
            const Interruptible b(&inner);
            outer.request();
            EXPECT_NO_THROW(interruption_point());
            inner.request();
            EXPECT_THROW(interruption_point(), Interrupted);
        }
        EXPECT_THROW(interruption_point(), Interrupted);
    }
    EXPECT_NO_THROW(interruption_point());
}

TEST(Interruption, HelpersOfParallelCallsInheritTheScope) {
    StopFlag flag;
    std::atomic<int> without{0}, tasks{0};
    const Interruptible ends(&flag);
    ThreadLimit(4).run([&] {
        parallel_for(64, 1, [&](std::size_t, std::size_t) {
            without += Interruptible::current() != &flag;
            parallel_invoke([&] { without += Interruptible::current() != &flag; },
                            [&] { without += Interruptible::current() != &flag; });
        });
        EXPECT_EQ(without, 0);
        EXPECT_THROW(parallel_for(1000, 1,
                                  [&](std::size_t, std::size_t) {
                                      if (++tasks == 10) flag.request();
                                  }),
                     Interrupted);
        EXPECT_LT(tasks, 1000);
        EXPECT_THROW(parallel_for(1, 1, [](std::size_t, std::size_t) {}), Interrupted);
    });
}

TEST(Interruption, EveryAcceleratorStopsBuildingWithinATenthOfASecond) {
    const SceneDescription field_of_triangles = field(150000);
    for (const AcceleratorEntry& entry : accelerator_table()) {
        LoadOptions options;
        options.with_aggregate = false;
        LoadedScene loaded = load(field_of_triangles, {}, options);
        options.compile.accelerator = entry.name;
        for (const int delay : {2, 20, 100, 300}) {
            double least = 1e9;
            int tries = 0;
            // The best of several tries, because other programs may run.
            for (; tries < 5 && least > 0.1; ++tries) {
                const std::optional<double> seconds =
                    seconds_to_end(std::chrono::milliseconds(delay), [&] {
                        loaded.scene.aggregate = nullptr;
                        build_aggregate(loaded, options);
                    });
                if (!seconds) break;
                least = std::min(least, *seconds);
            }
            if (tries == 0 || least > 1e8) break;
            EXPECT_LT(least, 0.1 * slowdown()) << entry.name << ", asked after " << delay << " ms";
        }
    }
}

}  // namespace
}  // namespace alhazen::ALHAZEN_TEST_FILE
