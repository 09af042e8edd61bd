/// Traversal of the wide BVH by a packet of rays (packet-inl.h).
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_
#endif

#include <algorithm>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/accel/wide_bvh/trace/stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Visits the leaves that the packet intersects, nearest first: `leaf.visit(ref, nearest, stats)`
/// may shrink the packet, and returns true to stop. False when it gave up: after `max_work` nodes,
/// a visited leaf counting as two per block.
template <class Leaf, class Stats>
HWY_INLINE bool traverse_packet(const WideNode* nodes, NodeRef root,
                                const PrefetchTable& prefetch_table, const RayPacket& packet,
                                Leaf& leaf, std::uint32_t max_work, Stats stats) {
    std::uint32_t work = 0;
    StackEntry stack[kTraversalStackSize<8>];
    std::size_t height = 1;
    stack[0] = {-std::numeric_limits<float>::infinity(), root};
    while (height > 0) {
        const StackEntry top = stack[--height];
        if (top.entry > packet.k_max) continue;
        if (top.ref.is_leaf()) {
            if (leaf.visit(top.ref, top.entry, stats)) return true;
            work += 2 * top.ref.count();
            continue;
        }
        if (++work > max_work) return false;
        const WideNode& node = nodes[top.ref.index()];
        stats.nodes(1);
        stats.boxes(node.child_count());
        Floats entries;
        const std::uint32_t hit = packet.meet_children(node, entries);
        HWY_ALIGN float entry[WideNode::kWidth];
        store_lanes(entries, entry);
        height = push_sorted(node, hit, entry, stack, height);
        // The next two.
        const std::size_t soon = std::min<std::size_t>(height, 2);
        for (std::size_t i = height - soon; i < height; ++i)
            prefetch_table.prefetch(stack[i].ref.bits());
    }
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
