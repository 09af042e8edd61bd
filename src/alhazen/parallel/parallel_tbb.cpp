#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"

namespace alhazen {

struct ThreadLimit::Impl {
    explicit Impl(int threads) : arena(threads) {}
    tbb::task_arena arena;
};

ThreadLimit::ThreadLimit(int threads) {
    // TBB uses at most the cores of the machine, and prints a warning to stderr when asked for
    // more.
    const std::size_t most =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    threads_ = std::min(threads > 0 ? threads : available_cores(), static_cast<int>(most));
    impl_ = new Impl(threads_);
}

ThreadLimit::~ThreadLimit() {
    delete impl_;
}

void ThreadLimit::run(const std::function<void()>& work) {
    impl_->arena.execute([flag = Interruptible::current(), &work] {
        const Interruptible inherited(flag);
        work();
    });
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    interruption_point();
    if (count <= grain) return body(0, count);
    // Tasks are whole chunks, so the ranges are the same for every thread count and backend.
    const std::size_t chunks = (count - 1) / grain + 1;
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks),
        [&, flag = Interruptible::current()](const tbb::blocked_range<std::size_t>& range) {
            const Interruptible inherited(flag);
            interruption_point();
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
                body(i * grain, std::min(count, (i + 1) * grain));
            }
        },
        tbb::simple_partitioner());
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
    const auto inheriting = [flag = Interruptible::current()](const std::function<void()>& work) {
        return [flag, &work] {
            const Interruptible inherited(flag);
            interruption_point();
            work();
        };
    };
    tbb::parallel_invoke(inheriting(a), inheriting(b));
}

}  // namespace alhazen
