#pragma once
/// Progress of a phase whose units are finished by several threads.

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

#include "alhazen/base/progress.h"

namespace alhazen {

class SharedProgress {
  public:
    /// `sink` may be null.
    SharedProgress(ProgressSink* sink, std::string phase, std::size_t total)
        : sink_(sink), phase_(std::move(phase)), total_(total) {
        add(0);
    }
    void add(std::size_t units) {
        if (sink_ == nullptr) return;
        const std::lock_guard lock(mutex_);
        done_ += units;
        sink_->update(phase_, done_, total_);
    }

  private:
    ProgressSink* sink_;
    std::string phase_;
    std::size_t total_, done_ = 0;
    std::mutex mutex_;
};

}  // namespace alhazen
