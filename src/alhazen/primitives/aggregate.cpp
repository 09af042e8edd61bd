#include "alhazen/primitives/aggregate.h"

#include <algorithm>

namespace alhazen {

namespace {

/// Number of rays of columns that are converted at a time.
constexpr std::size_t kConvertedRays = 256;

/// Calls trace(rays, first) for all rays, in parts.
template <class Trace>
void convert(const RayColumns& columns, Trace&& trace) {
    std::vector<Ray> rays(std::min(kConvertedRays, columns.size()));
    for (std::size_t first = 0; first < columns.size(); first += rays.size()) {
        rays.resize(std::min(rays.size(), columns.size() - first));
        for (std::size_t i = 0; i < rays.size(); ++i) rays[i] = columns.ray(first + i);
        trace(std::span<const Ray>(rays), first);
    }
}

}  // namespace

BoundingSphere Aggregate::sphere() const {
    return bounding_sphere(box());
}

void Aggregate::closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                              Coherence) const {
    for (std::size_t i = 0; i < rays.size(); ++i) (void)closest(rays[i], hits[i], query);
}

void Aggregate::occluded_batch(std::span<const Ray> rays, std::span<bool> result, RayQuery query,
                               Coherence) const {
    for (std::size_t i = 0; i < rays.size(); ++i) result[i] = occluded(rays[i], query);
}

void Aggregate::closest_columns(const RayColumns& columns, const HitColumns& results,
                                RayQuery query, Coherence coherence) const {
    std::vector<Hit> hits;
    convert(columns, [&](std::span<const Ray> rays, std::size_t first) {
        hits.resize(rays.size());
        closest_batch(rays, hits, query, coherence);
        for (std::size_t i = 0; i < hits.size(); ++i) results.set(first + i, hits[i]);
    });
}

void Aggregate::occluded_columns(const RayColumns& columns, std::span<bool> result, RayQuery query,
                                 Coherence coherence) const {
    convert(columns, [&](std::span<const Ray> rays, std::size_t first) {
        occluded_batch(rays, result.subspan(first, rays.size()), query, coherence);
    });
}

void Aggregate::closest_batch_at(std::span<const Ray> rays, std::span<const float>,
                                 std::span<Hit> hits, RayQuery query, Coherence coherence) const {
    closest_batch(rays, hits, query, coherence);
}

void Aggregate::occluded_batch_at(std::span<const Ray> rays, std::span<const float>,
                                  std::span<bool> result, RayQuery query,
                                  Coherence coherence) const {
    occluded_batch(rays, result, query, coherence);
}

void Aggregate::complete(const Ray&, double, PrimitiveId, Surface&) const {}

bool hit_less(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    // Compares outermost ids first: paths are stored innermost first.
    std::size_t i = a.path.size();
    std::size_t j = b.path.size();
    while (i > 0 && j > 0) {
        --i;
        --j;
        if (a.path[i] != b.path[j]) return a.path[i] < b.path[j];
    }
    // One path ended: its next id is the primitive itself.
    const PrimitiveId pa = i > 0 ? a.path[i - 1] : a.primitive;
    const PrimitiveId pb = j > 0 ? b.path[j - 1] : b.primitive;
    // Crossings of one primitive at one t keep the primitive's order.
    return pa < pb;
}

void sort_appended(std::vector<Hit>& hits, std::size_t before) {
    constexpr std::size_t kFew = 16;
    if (hits.size() - before > kFew) {
        std::stable_sort(hits.begin() + static_cast<std::ptrdiff_t>(before), hits.end(), hit_less);
        return;
    }
    for (std::size_t i = before + 1; i < hits.size(); ++i) {
        if (!hit_less(hits[i], hits[i - 1])) continue;
        const Hit moved = hits[i];
        std::size_t place = i;
        do {
            hits[place] = hits[place - 1];
        } while (--place > before && hit_less(moved, hits[place - 1]));
        hits[place] = moved;
    }
}

}  // namespace alhazen
