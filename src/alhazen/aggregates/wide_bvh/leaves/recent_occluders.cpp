#include "alhazen/aggregates/wide_bvh/leaves/recent_occluders.h"

#include <limits>

namespace alhazen {

RecentOccluders::RecentOccluders() : block_{} {
    for (std::size_t lane = 0; lane < kBlockWidth; ++lane) {
        for (auto& half : block_.half) half[lane] = -std::numeric_limits<float>::infinity();
        block_.inset[lane] = BoxBlock::kNotFlat;
        block_.ids[lane] = BlockId::none();
    }
}

void RecentOccluders::add(const BoxBlock& block, std::size_t lane) {
    for (; (kept_ >> next_ & 1) != 0; next_ = (next_ + 1) % kBlockWidth) kept_ &= ~(1u << next_);
    const std::size_t to = next_;
    next_ = (next_ + 1) % kBlockWidth;
    for (std::size_t k = 0; k < 3; ++k) {
        block_.center[k][to] = block.center[k][lane];
        block_.half[k][to] = block.half[k][lane];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            block_.direction[k][axis][to] = block.direction[k][axis][lane];
        }
    }
    block_.radius[to] = block.radius[lane];
    block_.inset[to] = block.inset[lane];
    block_.ids[to] = block.ids[lane];
}

}  // namespace alhazen
