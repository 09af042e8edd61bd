#include "alhazen/laboratory/ray_stream.h"

#include <algorithm>

#include "alhazen/sampling/random.h"

namespace alhazen {
namespace {

/// Single queries are grouped up to this number.
constexpr std::size_t kMostTogether = 512;

RayKind kind_of(RayMask mask) {
    for (std::size_t k = 0; k < kRayKindCount; ++k) {
        if (mask == mask_of(static_cast<RayKind>(k))) return static_cast<RayKind>(k);
    }
    return RayKind::Eye;
}

}  // namespace

std::array<std::uint64_t, kRayKindCount> RayStream::by_kind() const {
    std::array<std::uint64_t, kRayKindCount> counts{};
    for (const RayBatch& batch : batches) {
        counts[static_cast<std::size_t>(batch.kind)] += batch.count;
    }
    return counts;
}

void RayStream::thin_out() {
    share *= 0.5;
    std::size_t kept_batches = 0, kept_rays = 0;
    for (RayBatch batch : batches) {
        if (batch.lot >= share) continue;
        std::copy_n(rays.begin() + static_cast<std::ptrdiff_t>(batch.first), batch.count,
                    rays.begin() + static_cast<std::ptrdiff_t>(kept_rays));
        batch.first = kept_rays;
        kept_rays += batch.count;
        batches[kept_batches++] = batch;
    }
    rays.resize(kept_rays);
    batches.resize(kept_batches);
}

void RayRecorder::record(std::span<const Ray> rays, RayQuestion question, RayMask mask,
                         Coherence coherence) const {
    if (rays.empty()) return;
    // Groups of single queries are kept or dropped like batches.
    const std::uint64_t number = asked_so_far_++ / (rays.size() == 1 ? kMostTogether : 1);
    const double lot = random_at(1, number, rays.size() == 1, 0);
    if (lot >= stream_.share) return;
    const RayKind kind = kind_of(mask);
    const std::size_t first = stream_.rays.size();
    stream_.rays.insert(stream_.rays.end(), rays.begin(), rays.end());
    if (rays.size() == 1 && !stream_.batches.empty()) {
        RayBatch& last = stream_.batches.back();
        if (last.kind == kind && last.question == question && last.coherence == coherence &&
            last.lot == lot && question == RayQuestion::Shadowed) {
            ++last.count;
            return;
        }
    }
    stream_.batches.push_back({first, rays.size(), kind, question, coherence, lot});
    while (stream_.rays.size() > stream_.most && stream_.batches.size() > 1) stream_.thin_out();
}

bool RayRecorder::closest(const Ray& ray, Hit& hit, RayQuery query) const {
    record({&ray, 1}, RayQuestion::Closest, query.mask, Coherence::Any);
    return asked_.closest(ray, hit, query);
}

bool RayRecorder::occluded(const Ray& ray, RayQuery query) const {
    record({&ray, 1}, RayQuestion::Occluded, query.mask, Coherence::Any);
    return asked_.occluded(ray, query);
}

void RayRecorder::all_hits(const Ray& ray, std::vector<Hit>& hits, RayQuery query) const {
    asked_.all_hits(ray, hits, query);
}

bool RayRecorder::shadowed(const Ray& ray, std::vector<Hit>& crossings, RayQuery query) const {
    record({&ray, 1}, RayQuestion::Shadowed, query.mask, Coherence::Any);
    return asked_.shadowed(ray, crossings, query);
}

void RayRecorder::complete(const Ray& ray, double t, PrimitiveId primitive,
                           Surface& surface) const {
    asked_.complete(ray, t, primitive, surface);
}

void RayRecorder::closest_batch(std::span<const Ray> rays, std::span<Hit> hits, RayQuery query,
                                Coherence coherence) const {
    record(rays, RayQuestion::Closest, query.mask, coherence);
    asked_.closest_batch(rays, hits, query, coherence);
}

void RayRecorder::occluded_batch(std::span<const Ray> rays, std::span<bool> occluded,
                                 RayQuery query, Coherence coherence) const {
    record(rays, RayQuestion::Occluded, query.mask, coherence);
    asked_.occluded_batch(rays, occluded, query, coherence);
}

}  // namespace alhazen
