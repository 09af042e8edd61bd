#pragma once
/// Traces many single rays in parallel batches, with a pool of reused RayAnswers.

#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "alhazen/parallel/parallel.h"
#include "alhazen/renderers/antialias/single_rays.h"

namespace alhazen {

class AnswerPool {
  public:
    /// Both must outlive the pool.
    AnswerPool(const SingleRayRenderer& renderer, const RenderJob& job)
        : renderer_(renderer), job_(job) {}

    /// Traces the rays of a round. Calls batch(answers, first, count, counters) for the rays 0 to
    /// `total`, at most RayAnswers::kRaysAtOnce at a time, from many threads; few rays are split
    /// into smaller batches, to occupy all threads. Returns early after a stop.
    template <class Batch>
    void trace(std::size_t total, Batch&& batch) {
        constexpr std::size_t kFewest = 32, kPieces = 16;
        const std::size_t most = std::clamp(total / kPieces, kFewest, RayAnswers::kRaysAtOnce);
        const std::size_t batches = (total + most - 1) / most;
        std::size_t done = 0;  // guarded by the mutex
        parallel_for(batches, 1, [&](std::size_t begin, std::size_t end) {
            std::unique_ptr<RayAnswers> own = take();
            RayCounters counters;
            for (std::size_t b = begin; b < end && !job_.stop_requested(); ++b) {
                batch(*own, b * most, std::min(most, total - b * most), counters);
            }
            const std::lock_guard lock(mutex_);
            idle_.push_back(std::move(own));
            counters_ += counters;
            done += end - begin;
            if (job_.control.progress != nullptr) {
                job_.control.progress->update("render", done, batches);
            }
        });
    }

    /// Counts of all traced rays.
    [[nodiscard]] const RayCounters& counters() const { return counters_; }

  private:
    [[nodiscard]] std::unique_ptr<RayAnswers> take() {
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                std::unique_ptr<RayAnswers> taken = std::move(idle_.back());
                idle_.pop_back();
                return taken;
            }
        }
        return renderer_.answers(job_);
    }

    const SingleRayRenderer& renderer_;
    const RenderJob& job_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<RayAnswers>> idle_;
    RayCounters counters_;
};

}  // namespace alhazen
