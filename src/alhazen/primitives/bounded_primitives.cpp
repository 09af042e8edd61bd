#include "alhazen/primitives/bounded_primitives.h"

#include "alhazen/parallel/parallel.h"

namespace alhazen {
namespace {

bool within_reach(const Box3& box) {
    const double reach = BoundedPrimitives::kReach;
    // False for NaN.
    return max_component(abs(box.lo)) <= reach && max_component(abs(box.hi)) <= reach &&
           is_finite(box.lo) && is_finite(box.hi);
}

}  // namespace

BoundedPrimitives::BoundedPrimitives(const PrimitiveTable& table) : table_(table) {
    // Usually all are bounded: then no list is made.
    constexpr std::size_t kGrain = 16384;
    struct Share {
        Box3 box;
        bool bounded = true;
    };
    std::vector<Share> parts((table.size() + kGrain - 1) / kGrain);
    parallel_for(table.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        Share part;
        for (std::size_t i = begin; i < end; ++i) {
            const Box3 box = table.box(i);
            part.box.include(box);
            part.bounded = part.bounded && box != Box3{} && within_reach(box);
        }
        parts[begin / kGrain] = part;
    });
    identity_ = true;
    for (const Share& part : parts) {
        all_.include(part.box);
        identity_ = identity_ && part.bounded;
    }
    if (identity_) return;
    for (std::size_t i = 0; i < table.size(); ++i) {
        const Box3 box = table.box(i);
        // An empty box (an instance of nothing) cannot be hit.
        if (box == Box3{}) continue;
        if (within_reach(box)) {
            bounded_.push_back(static_cast<std::uint32_t>(i));
        } else {
            unbounded_.push_back(PrimitiveId{static_cast<std::uint32_t>(i)});
        }
    }
}

}  // namespace alhazen
