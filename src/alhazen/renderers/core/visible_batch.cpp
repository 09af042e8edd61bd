#include "alhazen/renderers/core/visible_batch.h"

namespace alhazen {

void VisibleBatch::trace(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence,
                         RayMask mask) {
    scene_.aggregate->closest_batch(rays, hits.first(rays.size()), {stats_, mask}, coherence);
}

void VisibleBatch::trace_chosen(std::span<const Ray> rays, Coherence coherence, RayMask mask) {
    if (chosen_.empty()) return;
    if (chosen_.size() == rays.size()) return trace(rays, hits_, coherence, mask);
    chosen_rays_.clear();
    for (const std::size_t i : chosen_) chosen_rays_.push_back(rays[i]);
    chosen_hits_.resize(chosen_.size());
    trace(chosen_rays_, chosen_hits_, coherence, mask);
    for (std::size_t n = 0; n < chosen_.size(); ++n) hits_[chosen_[n]] = chosen_hits_[n];
}

}  // namespace alhazen
