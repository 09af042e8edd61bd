// TBB is started by the first call with several tasks and several threads: loading and starting it
// takes longer than rendering a small picture. Arenas are kept and used again: TBB frees one only
// when a worker next looks for work, and until then every new one lengthens the list it looks
// through.

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/parallel/thread_start.h"

namespace alhazen {

namespace {

struct Arena {
    explicit Arena(int most) : threads(most), tasks(most) {}
    int threads;
    tbb::task_arena tasks;  ///< starts TBB when it is entered
};

/// The arenas that no limit uses.
class ArenaPool {
  public:
    /// Never destroyed: limits may outlive static objects.
    static ArenaPool& instance() {
        static auto* const pool = new ArenaPool;
        return *pool;
    }

    [[nodiscard]] std::unique_ptr<Arena> take(int threads) {
        {
            const std::lock_guard lock(mutex_);
            const auto found = std::find_if(free_.begin(), free_.end(), [&](const auto& arena) {
                return arena->threads == threads;
            });
            if (found != free_.end()) {
                std::unique_ptr<Arena> arena = std::move(*found);
                free_.erase(found);
                return arena;
            }
        }
        return std::make_unique<Arena>(threads);
    }
    void give_back(std::unique_ptr<Arena> arena) {
        const std::lock_guard lock(mutex_);
        if (free_.size() < kMostFree) free_.push_back(std::move(arena));
    }

  private:
    static constexpr std::size_t kMostFree = 64;

    ArenaPool() { free_.reserve(kMostFree); }

    std::mutex mutex_;
    std::vector<std::unique_ptr<Arena>> free_;
};

/// Sets the arena that the calls of a thread will enter, for the lifetime of the object.
class Ahead {
  public:
    explicit Ahead(Arena* arena) : before_(current_) { current_ = arena; }
    ~Ahead() { current_ = before_; }
    Ahead(const Ahead&) = delete;
    Ahead& operator=(const Ahead&) = delete;

    /// The arena of the calling thread; null if it is entered, or if there is no limit.
    [[nodiscard]] static Arena* current() { return current_; }

  private:
    Arena* before_;
    static inline constinit thread_local Arena* current_ = nullptr;
};

/// True if calls of this thread are limited to one thread.
bool is_alone() {
    return Ahead::current() != nullptr && Ahead::current()->threads == 1;
}

template <class Work>
void run_in_arena(const Work& work) {
    Arena* const arena = Ahead::current();
    if (arena == nullptr) return work();
    arena->tasks.execute([&, flag = Interruptible::current()] {
        const Interruptible inherited(flag);
        const Ahead entered(nullptr);
        work();
    });
}

/// Throws if an exception of another task has ended the group of the calling task: then a call of
/// TBB returns without having run all of its tasks. The exception is dropped, for the group throws
/// the first one.
void end_with_group() {
    if (tbb::is_current_task_group_canceling()) throw Interrupted();
}

/// TBB uses at most the cores of the machine, and prints a warning to stderr when asked for more.
int most_threads(int wanted) {
    if (wanted <= available_cores()) return wanted;
    const std::size_t most =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(wanted, static_cast<int>(most));
}

}  // namespace

struct ThreadLimit::Impl {
    explicit Impl(int threads) : arena(ArenaPool::instance().take(threads)) {}
    ~Impl() { ArenaPool::instance().give_back(std::move(arena)); }
    std::unique_ptr<Arena> arena;
};

ThreadLimit::ThreadLimit(int threads)
    : threads_(most_threads(threads > 0 ? threads : available_cores())),
      impl_(new Impl(threads_)) {}

ThreadLimit::~ThreadLimit() {
    delete impl_;
}

void ThreadLimit::run(const std::function<void()>& work) {
    const Ahead ahead(impl_->arena.get());
    work();
}

void run_while_threads_start(int threads, const std::function<void()>& work) {
    threads = most_threads(threads > 0 ? threads : available_cores());
    if (threads == 1) return work();
    std::unique_ptr<Arena> arena = ArenaPool::instance().take(threads);
    {
        std::jthread starter;
        try {
            starter = std::jthread([&tasks = arena->tasks, threads] {
                tasks.execute([threads] {
                    tbb::parallel_for(
                        0, threads, [](int) {}, tbb::simple_partitioner());
                });
            });
        } catch (const std::system_error&) {
            // The first parallel call starts what the system still grants.
        }
        work();
    }
    ArenaPool::instance().give_back(std::move(arena));
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    interruption_point();
    if (count <= grain) return body(0, count);
    // Tasks are whole chunks, so the ranges are the same for every thread count and backend.
    const std::size_t chunks = (count - 1) / grain + 1;
    const auto run_chunks = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i != end; ++i) {
            body(i * grain, std::min(count, (i + 1) * grain));
        }
    };
    if (is_alone()) {
        for (std::size_t i = 0; i != chunks; ++i) {
            interruption_point();
            run_chunks(i, i + 1);
        }
        return;
    }
    run_in_arena([&] {
        tbb::parallel_for(
            tbb::blocked_range<std::size_t>(0, chunks),
            [&, flag = Interruptible::current()](const tbb::blocked_range<std::size_t>& range) {
                const Interruptible inherited(flag);
                interruption_point();
                run_chunks(range.begin(), range.end());
            },
            tbb::simple_partitioner());
        end_with_group();
    });
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
    const auto inheriting = [flag = Interruptible::current()](const std::function<void()>& work) {
        return [flag, &work] {
            const Interruptible inherited(flag);
            interruption_point();
            work();
        };
    };
    if (is_alone()) {
        inheriting(a)();
        inheriting(b)();
        return;
    }
    run_in_arena([&] {
        tbb::parallel_invoke(inheriting(a), inheriting(b));
        end_with_group();
    });
}

}  // namespace alhazen
