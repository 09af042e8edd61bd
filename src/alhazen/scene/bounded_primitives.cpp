#include "alhazen/scene/bounded_primitives.h"

namespace alhazen {
namespace {

bool within_reach(const Box3& box) {
    const double reach = BoundedPrimitives::kReach;
    // NaN is not within reach.
    return max_component(abs(box.lo)) <= reach && max_component(abs(box.hi)) <= reach &&
           is_finite(box.lo) && is_finite(box.hi);
}

}  // namespace

BoundedPrimitives::BoundedPrimitives(const PrimitiveTable& table) : table_(table) {
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Box3 box = table.box(i);
        all_.include(box);
        // An empty box (an instance of nothing) cannot be hit.
        if (box == Box3{}) continue;
        if (within_reach(box)) {
            bounded_.push_back(static_cast<std::uint32_t>(i));
        } else {
            unbounded_.push_back(PrimitiveId{static_cast<std::uint32_t>(i)});
        }
    }
    identity_ = bounded_.size() == table.size();
    if (identity_) bounded_ = {};
}

}  // namespace alhazen
