#include "alhazen/aggregates/wide_bvh/wide_bvh_kernels.h"

#include <hwy/cache_control.h>

namespace alhazen {

void WideBvhScene::find_largest_leaf() {
    constexpr float kShare = 0.9f;
    const WideBvh& tree = layout->tree;
    if (tree.empty || tree.root.is_leaf() || layout->is_indexed()) return;
    with_nodes(tree, [&](const auto& nodes) {
        const auto& root = nodes[tree.root.index()];
        FloatBox all;
        const std::uint32_t count = root.child_count();
        for (std::uint32_t i = 0; i < count; ++i) all.include(root.box(i));
        for (std::uint32_t i = 0; i < count; ++i) {
            const NodeRef child = root.child[i];
            if (!child.is_leaf() || static_cast<LeafType>(child.kind()) != LeafType::Triangles ||
                !(root.box(i).weight() >= kShare * all.weight())) {
                continue;
            }
            largest_leaf = child.bits();
            largest_leaf_slot = 1u << i;
            return;
        }
    });
}

void WideBvhScene::expect_indices(PrimitiveId id) const {
    const std::uint32_t triangle = static_cast<std::uint32_t>(id) - table->first(kTriangleKind);
    hwy::Prefetch(table->triangle_corners(triangle));
}

WideBvhKernelPair wide_bvh_kernels(std::uint32_t width, Precision precision) {
    const WideBvhKernelPair exact{wide_bvh_kernels_8(), wide_bvh_kernels_8_counting()};
    if (precision == Precision::Robust) {
        if (width == 4) return {wide_bvh_kernels_4(), wide_bvh_kernels_4_counting()};
        if (width == 16) return {wide_bvh_kernels_16(), wide_bvh_kernels_16_counting()};
        return exact;
    }
    WideBvhKernelPair fast{wide_bvh_kernels_fast(), wide_bvh_kernels_fast_counting()};
    fast.plain.all_hits = exact.plain.all_hits;
    fast.plain.shadowed = exact.plain.shadowed;
    fast.counting.all_hits = exact.counting.all_hits;
    fast.counting.shadowed = exact.counting.shadowed;
    return fast;
}

}  // namespace alhazen
