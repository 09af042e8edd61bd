/// Traversal of the wide BVH by a frustum packet (packet-inl.h).
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_PACKET_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/accel/wide_bvh/trace/stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A subtree, and the groups of rays that may meet it.
struct PacketEntry {
    float entry;
    NodeRef ref;
    std::uint32_t groups;
};

/// Pushes the children that groups of a packet meet; returns the new height. On top is the nearest
/// if `kOrdered`, else slot 0.
template <bool kOrdered>
HWY_INLINE std::size_t push_met(const WideNode& node, const RayPacket& packet, std::uint32_t groups,
                                PacketEntry* stack, std::size_t height) {
    Floats entries;
    std::uint32_t hit = packet.intersect_children(node, entries);
    HWY_ALIGN float entry[WideNode::kWidth];
    store_lanes(entries, entry);
    const std::size_t base = height;
    while (hit != 0) {
        const auto slot = static_cast<std::size_t>(31 - std::countl_zero(hit));
        hit &= ~(1u << slot);
        const std::uint32_t met =
            groups & packet.intersect_groups(&node.planes[0][slot], WideNode::kWidth);
        if (met == 0) continue;
        std::size_t place = height++;
        if constexpr (kOrdered) {
            while (place > base && stack[place - 1].entry < entry[slot]) {
                stack[place] = stack[place - 1];
                --place;
            }
        }
        stack[place] = {entry[slot], node.child[slot], met};
    }
    return height;
}

/// Visits the leaves that groups of the packet meet, nearest first if `kOrdered`, else in the order
/// of slots. `leaf.visit(ref, groups, stats)` may shrink the packet, and returns true to stop.
/// Returns false if `leaf.work`, to which each node adds 2, exceeds `max_work`.
template <bool kOrdered, class Leaf, class Stats>
HWY_INLINE bool traverse_packet(const WideNode* nodes, NodeRef root,
                                const PrefetchTable& prefetch_table, const RayPacket& packet,
                                Leaf& leaf, std::uint32_t max_work, Stats stats) {
    PacketEntry stack[kTraversalStackSize<8>];
    std::size_t height = 1;
    stack[0] = {-std::numeric_limits<float>::infinity(), root, packet.all_groups()};
    while (height > 0) {
        const PacketEntry top = stack[--height];
        const std::uint32_t groups = top.groups & packet.reaching(top.entry);
        if (groups == 0) continue;
        if (top.ref.is_leaf()) {
            if (leaf.visit(top.ref, groups, stats)) return true;
            continue;
        }
        leaf.work += 2;
        if (leaf.work > max_work) return false;
        const WideNode& node = nodes[top.ref.index()];
        stats.nodes(1);
        stats.boxes(node.child_count());
        height = push_met<kOrdered>(node, packet, groups, stack, height);
        // Prefetches the next two.
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
