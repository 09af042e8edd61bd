#include "interruptible.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include "alhazen/base/interruption.h"
#include "alhazen/parallel/parallel.h"

namespace py = pybind11;

namespace alhazen::python {

namespace {

constexpr std::size_t kFirstBlock = 16, kLargestBlock = std::size_t{1} << 22;
constexpr std::size_t kLargestGrain = 1024;                // items of a task
constexpr double kShortBlock = 0.0125, kLongBlock = 0.05;  // seconds
constexpr std::chrono::milliseconds kTick{20};

void throw_on_signal() {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Keeps the latest report for the thread that may call Python.
class LatestProgress final : public ProgressSink {
  public:
    void update(std::string_view phase, std::size_t done, std::size_t total) override {
        const std::lock_guard lock(mutex_);
        phase_ = phase;
        done_ = done;
        total_ = total;
        changed_ = true;
    }
    /// Calls callback(phase, done, total) if there is a new report.
    void tell(const py::object& callback) {
        std::string phase;
        std::size_t done = 0, total = 0;
        {
            const std::lock_guard lock(mutex_);
            if (!changed_) return;
            changed_ = false;
            phase = phase_;
            done = done_;
            total = total_;
        }
        callback(phase, done, total);
    }

  private:
    std::mutex mutex_;
    std::string phase_;
    std::size_t done_ = 0, total_ = 0;
    bool changed_ = false;
};

}  // namespace

void run_in_blocks(std::size_t count, int threads,
                   const std::function<void(std::size_t begin, std::size_t end)>& work) {
    using Clock = std::chrono::steady_clock;
    const py::gil_scoped_release released;
    ThreadLimit limit(threads);
    std::size_t block = kFirstBlock;
    for (std::size_t begin = 0; begin < count;) {
        const std::size_t end = std::min(count, begin + block);
        const std::size_t grain = std::clamp<std::size_t>((end - begin) / 8, 1, kLargestGrain);
        const auto start = Clock::now();
        limit.run([&] {
            parallel_for(end - begin, grain,
                         [&](std::size_t a, std::size_t b) { work(begin + a, begin + b); });
        });
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        begin = end;
        if (seconds < kShortBlock) block = std::min(2 * block, kLargestBlock);
        if (seconds > kLongBlock) block = std::max<std::size_t>(block / 2, 2);
        const py::gil_scoped_acquire held;
        throw_on_signal();
    }
}

void run_watched(StopFlag& stop, const py::object& progress,
                 const std::function<void(ProgressSink& sink)>& work) {
    LatestProgress latest;
    std::exception_ptr failure;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false;
    std::thread worker([&] {
        try {
            work(latest);
        } catch (...) {
            failure = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        done = true;
        ended.notify_one();
    });
    std::exception_ptr wish;  // from a signal or the callback
    {
        const py::gil_scoped_release released;
        std::unique_lock lock(mutex);
        while (!ended.wait_for(lock, kTick, [&] { return done; })) {
            if (wish) continue;
            lock.unlock();
            try {
                const py::gil_scoped_acquire held;
                throw_on_signal();
                if (!progress.is_none()) latest.tell(progress);
            } catch (...) {
                wish = std::current_exception();
                stop.request();
            }
            lock.lock();
        }
        lock.unlock();
        worker.join();
    }
    if (wish) std::rethrow_exception(wish);
    if (failure) std::rethrow_exception(failure);
    if (!progress.is_none()) latest.tell(progress);
}

void run_interruptible(const std::function<void()>& work) {
    StopFlag stop;
    run_watched(stop, py::none(), [&](ProgressSink&) {
        const Interruptible ends(&stop);
        work();
    });
}

}  // namespace alhazen::python
