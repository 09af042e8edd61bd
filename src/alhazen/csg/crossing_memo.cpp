#include "alhazen/csg/crossing_memo.h"

#include <algorithm>
#include <atomic>

namespace alhazen {

std::uint64_t CrossingMemo::number_of_solid() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

void CrossingMemo::keep(const Key& key, std::span<const ShapeHit> hits) {
    if (hits.size() > kMostHits) return;
    if (places_.empty()) places_.resize(kPlaces);
    Place& place = places_[index(key)];
    place.key = key;
    place.count = hits.size();
    std::copy(hits.begin(), hits.end(), place.hits.begin());
}

}  // namespace alhazen
