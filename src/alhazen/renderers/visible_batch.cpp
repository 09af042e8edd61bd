#include "alhazen/renderers/visible_batch.h"

namespace alhazen {

std::span<const Hit> VisibleBatch::closest(std::span<const Ray> rays, Coherence coherence) {
    // Hits are large: those that are there are used again.
    if (hits_.size() < rays.size()) hits_.resize(rays.size());
    const std::span<Hit> hits = std::span(hits_).first(rays.size());
    scene_.aggregate->closest_batch(rays, hits, stats_, coherence);
    return hits;
}

}  // namespace alhazen
