#include "alhazen/renderers/core/visible_batch.h"

namespace alhazen {

void VisibleBatch::trace(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                         RayMask mask) {
    const std::span<Hit> out = hits.first(rays.size());
    if (scene_.has_motion) {
        scene_.aggregate->closest_batch_at(rays, times_, out, {stats_, mask}, coherence);
    } else {
        scene_.aggregate->closest_batch(rays, out, {stats_, mask}, coherence);
    }
}

void VisibleBatch::trace_chosen(std::span<const Ray> rays, Coherence coherence, RayMask mask) {
    if (chosen_.empty()) return;
    if (chosen_.size() == rays.size()) return trace(rays, hits_, coherence, mask);
    chosen_rays_.clear();
    for (const std::size_t i : chosen_) chosen_rays_.push_back(rays[i]);
    chosen_hits_.resize(chosen_.size());
    if (scene_.has_motion) {
        chosen_times_.clear();
        for (const std::size_t i : chosen_) chosen_times_.push_back(times_[i]);
        times_.swap(chosen_times_);
    }
    trace(chosen_rays_, chosen_hits_, coherence, mask);
    if (scene_.has_motion) times_.swap(chosen_times_);
    for (std::size_t n = 0; n < chosen_.size(); ++n) hits_[chosen_[n]] = chosen_hits_[n];
}

}  // namespace alhazen
