#pragma once
/// Parallel tasks: a facade over oneTBB, or over std::jthread for builds without TBB
/// (ThreadSanitizer, minimal builds; CMake option ALHAZEN_PARALLEL=tbb|jthread).
///
/// Conventions: results never depend on the number of threads or the order of execution;
/// floating-point values are never reduced in order of completion. An exception thrown by a task is
/// rethrown to the caller once. Tasks inherit the caller's Interruptible and are not begun once an
/// interruption is requested.

#include <cstddef>
#include <functional>

namespace alhazen {

/// Number of cores that this process may use (affinity and cgroup limits included), at least 1.
[[nodiscard]] int available_cores();

/// Limits parallel calls made inside `run` to `threads` threads, for the life of the object.
class ThreadLimit {
  public:
    /// `threads` 0: all available cores.
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

    /// The limit; TBB lowers it to the cores of the machine.
    [[nodiscard]] int threads() const { return threads_; }
    void run(const std::function<void()>& work);

  private:
    int threads_;
    struct Impl;
    Impl* impl_;
};

/// Calls body(begin, end) for disjoint ranges that cover [0, count), each of at most `grain` items.
/// Precondition: grain >= 1.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Runs both functions, possibly at the same time, and returns when both are done.
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b);

}  // namespace alhazen
