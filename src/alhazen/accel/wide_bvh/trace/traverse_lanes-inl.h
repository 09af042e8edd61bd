/// Traversal of the wide BVH by a packet of rays in lanes (lane_packet-inl.h): each child's box
/// against the frustum first, then against all rays at once. Where few rays are left in a subtree,
/// each goes on alone.
///
/// Source: Benthin, Wald, Woop, Ernst and Mark, "Combining Single and Packet-Ray Tracing for
/// Arbitrary Ray Distributions on the Intel MIC Architecture", TVCG 18(9), 2012.
/// Differs: a subtree on the stack knows its rays.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_LANES_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_LANES_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_LANES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/accel/wide_bvh/trace/stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// How far the rays of packets go together.
struct LaneWork {
    std::uint32_t together = 0;  ///< visits of nodes and leaves, each counted for all of its rays
    std::uint32_t alone = 0;     ///< times that a ray goes on alone
};

/// Subtrees yet to visit, and the rays that meet them: apart, for an entry that was just stored by
/// parts would be waited for as a whole.
struct LaneStack {
    static constexpr std::size_t kSize = kTraversalStackSize<8>;
    float entry[kSize];
    NodeRef ref[kSize];
    std::uint32_t lanes[kSize];
};

/// A subtree and the rays that meet it; without rays it is none.
struct MetSubtree {
    NodeRef ref = NodeRef::node(0);
    std::uint32_t lanes = 0;
    float entry = 0;
};

/// Finds the nearest child that rays meet, or slot 0, and puts the others on the stack, the next on
/// top; returns the new height. All of them are fetched.
template <bool kOrdered>
HWY_INLINE std::size_t push_met(const WideNode& node, const LanePacket& packet, std::uint32_t lanes,
                                LaneStack& stack, std::size_t height,
                                const PrefetchTable& prefetch_table, MetSubtree& nearest) {
    Floats entries;
    std::uint32_t hit = packet.intersect_boxes(node.planes, entries);
    if (hit == 0) return height;
    HWY_ALIGN float entry[WideNode::kWidth];
    store_lanes(entries, entry);
    const LaneSlabs slabs(packet);
    const std::size_t base = height;
    while (hit != 0) {
        const auto slot = static_cast<std::size_t>(31 - std::countl_zero(hit));
        hit &= ~(1u << slot);
        const std::uint32_t met = lanes & slabs.meet(node, slot, packet);
        if (met == 0) continue;
        prefetch_table.prefetch(node.child[slot].bits());
        MetSubtree other{node.child[slot], met, entry[slot]};
        if (nearest.lanes == 0) {
            nearest = other;
            continue;
        }
        std::size_t place = height++;
        if (!kOrdered || other.entry <= nearest.entry) {
            std::swap(nearest, other);
        } else {
            for (; place > base && stack.entry[place - 1] < other.entry; --place) {
                stack.entry[place] = stack.entry[place - 1];
                stack.ref[place] = stack.ref[place - 1];
                stack.lanes[place] = stack.lanes[place - 1];
            }
        }
        stack.entry[place] = other.entry;
        stack.ref[place] = other.ref;
        stack.lanes[place] = other.lanes;
    }
    return height;
}

/// Visits the leaves that rays of `lanes` meet, nearest first if `Leaf::kOrdered`, else from slot 0
/// on. `leaf.visit(ref, lanes, stats)` may limit rays, `leaf.go_alone(ref, lanes, stats)` takes
/// fewer than `least_lanes` of them through a subtree one by one, and `leaf.wanting(entry)` says
/// which go as far as that. `work` is counted for any hit only.
template <class Leaf, class Stats>
HWY_INLINE void traverse_lanes(const WideNode* nodes, NodeRef root,
                               const PrefetchTable& prefetch_table, const LanePacket& packet,
                               std::uint32_t lanes, int least_lanes, Leaf& leaf, LaneWork& work,
                               Stats stats) {
    LaneStack stack;
    std::size_t height = 0;
    NodeRef ref = root;
    while (true) {
        const int count = std::popcount(lanes);
        if constexpr (!Leaf::kOrdered) {
            (count < least_lanes ? work.alone : work.together) += static_cast<std::uint32_t>(count);
        }
        if (count < least_lanes) {
            leaf.go_alone(ref, lanes, stats);
        } else if (ref.is_leaf()) {
            leaf.visit(ref, lanes, stats);
        } else {
            const WideNode& node = nodes[ref.index()];
            stats.nodes(1);
            stats.boxes(node.child_count());
            MetSubtree nearest;
            height = push_met<Leaf::kOrdered>(node, packet, lanes, stack, height, prefetch_table,
                                              nearest);
            if (nearest.lanes != 0) {
                lanes = nearest.lanes;
                ref = nearest.ref;
                continue;
            }
        }
        do {
            if (height == 0) return;
            --height;
            lanes = stack.lanes[height] & leaf.wanting(stack.entry[height]);
        } while (lanes == 0);
        ref = stack.ref[height];
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
