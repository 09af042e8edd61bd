// Each parallel call takes as many helper threads as are free in its pool, at most one per chunk,
// and the calling thread works too. A nested call that finds no free helper runs on its own thread,
// so no call ever waits for a thread.

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"
#include "alhazen/parallel/thread_start.h"

namespace alhazen {

namespace {

/// The number of threads that a call tree may still start.
class Pool {
  public:
    explicit Pool(int threads) : free_helpers_(threads - 1) {}

    /// Takes up to `wanted` helpers and returns their number; the caller must give them back.
    int take(int wanted) {
        int available = free_helpers_.load();
        int taken = 0;
        do {
            taken = std::min(wanted, available);
            if (taken <= 0) return 0;
        } while (!free_helpers_.compare_exchange_weak(available, available - taken));
        return taken;
    }
    void give_back(int taken) { free_helpers_.fetch_add(taken); }

    /// The pool of the calling thread; helpers inherit their caller's.
    static Pool& current() {
        static Pool everything(available_cores());
        return local() != nullptr ? *local() : everything;
    }
    static Pool*& local() {
        thread_local Pool* pool = nullptr;
        return pool;
    }

  private:
    std::atomic<int> free_helpers_;
};

/// Keeps the first of the exceptions that several threads throw.
class FirstError {
  public:
    template <class Work>
    void guard(const Work& work) {
        try {
            work();
        } catch (...) {
            const std::lock_guard lock(mutex_);
            if (error_ == nullptr) error_ = std::current_exception();
            failed_.store(true, std::memory_order_relaxed);
        }
    }
    [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_relaxed); }
    void rethrow() const {
        if (error_ != nullptr) std::rethrow_exception(error_);
    }

  private:
    std::mutex mutex_;
    std::exception_ptr error_;
    std::atomic<bool> failed_{false};
};

/// Runs `work` on the calling thread and on up to `helpers` others, and waits for all.
template <class Work>
void run_with_helpers(Pool& pool, int helpers, const Work& work) {
    const int taken = pool.take(helpers);
    {
        std::vector<std::jthread> threads;
        try {
            threads.reserve(static_cast<std::size_t>(taken));
            for (int i = 0; i < taken; ++i) {
                threads.emplace_back([&pool, &work, flag = Interruptible::current()] {
                    const Interruptible inherited(flag);
                    Pool::local() = &pool;
                    work();
                });
            }
        } catch (const std::system_error&) {
            // The system starts no more threads: the running ones and the calling one do the work.
        }
        work();
    }
    pool.give_back(taken);
}

}  // namespace

struct ThreadLimit::Impl {
    Pool pool;
};

ThreadLimit::ThreadLimit(int threads)
    : threads_(threads > 0 ? threads : available_cores()), impl_(new Impl{Pool(threads_)}) {}

ThreadLimit::~ThreadLimit() {
    delete impl_;
}

void ThreadLimit::run(const std::function<void()>& work) {
    struct Restore {
        Pool* before;
        ~Restore() { Pool::local() = before; }
    } const restore{Pool::local()};
    Pool::local() = &impl_->pool;
    work();
}

void run_while_threads_start(int, const std::function<void()>& work) {
    work();  // each call starts its own
}

void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
    if (count == 0) return;
    grain = std::max<std::size_t>(grain, 1);
    interruption_point();
    if (count <= grain) return body(0, count);
    const std::size_t chunks = (count - 1) / grain + 1;
    std::atomic<std::size_t> next{0};
    FirstError error;
    const auto work = [&] {
        error.guard([&] {
            for (std::size_t i = next++; i < chunks && !error.failed(); i = next++) {
                interruption_point();
                body(i * grain, std::min(count, (i + 1) * grain));
            }
        });
    };
    const int helpers = static_cast<int>(std::min<std::size_t>(chunks - 1, 1024));
    run_with_helpers(Pool::current(), helpers, work);
    error.rethrow();
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
    parallel_for(2, 1, [&](std::size_t i, std::size_t) { i == 0 ? a() : b(); });
}

}  // namespace alhazen
