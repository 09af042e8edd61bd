#pragma once
/// Compact storage of first hits, each with as many bytes as its path needs.
///
/// Threads: `set` for different rays may be called from many threads.

#include <mutex>
#include <vector>

#include "alhazen/geometry/hit.h"

namespace alhazen {

class HitStore {
  public:
    void resize(std::size_t count) { hits_.resize(count); }

    void set(std::size_t ray, const Hit& hit) {
        StoredHit& stored = hits_[ray];
        stored.crossing = hit;
        stored.primitive = hit.primitive;
        if (hit.path.empty()) return;
        const std::lock_guard lock(mutex_);
        stored.path = paths_.size();
        stored.instances = static_cast<std::uint32_t>(hit.path.size());
        paths_.insert(paths_.end(), hit.path.begin(), hit.path.end());
    }
    [[nodiscard]] Hit get(std::size_t ray) const {
        const StoredHit& stored = hits_[ray];
        Hit hit;
        static_cast<ShapeHit&>(hit) = stored.crossing;
        hit.primitive = stored.primitive;
        for (std::uint32_t i = 0; i < stored.instances; ++i) {
            hit.path.push_back(paths_[stored.path + i]);
        }
        return hit;
    }

  private:
    struct StoredHit {
        ShapeHit crossing;
        PrimitiveId primitive = kNoPrimitive;
        std::uint32_t instances = 0;
        std::size_t path = 0;  ///< index of its first instance in `paths_`
    };
    std::vector<StoredHit> hits_;
    std::mutex mutex_;
    std::vector<PrimitiveId> paths_;
};

}  // namespace alhazen
