#pragma once
/// Progress reports of long computations, and a flag that stops computations.

#include <atomic>
#include <cstddef>
#include <string_view>

namespace alhazen {

/// Receives progress. Called from worker threads, one call at a time.
class ProgressSink {
  public:
    virtual ~ProgressSink() = default;
    /// Reports that `done` of `total` units of the phase ("load", "build", "render", "write") are
    /// finished.
    virtual void update(std::string_view phase, std::size_t done, std::size_t total) = 0;
};

/// A flag that may be set from anywhere (a signal handler included); work checks it between units.
class StopFlag {
  public:
    void request() noexcept { requested_.store(true, std::memory_order_relaxed); }
    [[nodiscard]] bool requested() const noexcept {
        return requested_.load(std::memory_order_relaxed);
    }

  private:
    std::atomic<bool> requested_{false};
    static_assert(std::atomic<bool>::is_always_lock_free, "must be safe in a signal handler");
};

}  // namespace alhazen
