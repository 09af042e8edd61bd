/// The traversal kernel of the wide BVH: one ray, the children of a node at a time, compiled once
/// per instruction set and width of the nodes.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008.
/// Differs: all slack of the slab test is in the ray's constants (`SlabRay`); the nearest child in
/// lanes, but for one and two hit apart; the next by a jump that can be foreseen (`child_of`).
/// Conventions: included once per target (see simd/lanes-inl.h). `Leaf` has `bool visit(NodeRef,
/// stats)`, which returns true to stop, and `float s_max`, the parameter up to which hits are
/// searched; boxes that begin exactly there are visited. Any-hit queries leave it as it is. Others
/// may have `void visit_within(NodeRef, Lanes<float, W>& s_max, stats)` for nodes of W children,
/// which lowers the parameter in every lane of `s_max`, too.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <cstdint>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/node_stack-inl.h"
#include "alhazen/accel/wide_bvh/trace/slab_ray-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Where the ray enters and leaves the boxes of the children: it meets those that it enters first.
template <std::size_t W>
HWY_INLINE void cross_children(const WideNodeOf<W>& node, const SlabRay& ray,
                               const Lanes<float, W>& s_max, Lanes<float, W>& entry,
                               Lanes<float, W>& exit) {
    using F = Lanes<float, W>;
    const float* planes = node.planes[0];
    F near[3], far[3];
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const F reciprocal(ray.reciprocal[k]);
        near[k] = mul_add(load_lanes<W>(planes + W / 4 * ray.near.row[k]), reciprocal,
                          F(ray.near_offset[k]));
        far[k] = mul_add(load_lanes<W>(planes + W / 4 * ray.near.far_row(k)), reciprocal,
                         F(ray.far_offset[k]));
    }
    // larger_by_bits is exact, as s_min is not negative.
    entry = larger_by_bits(larger_by_bits(near[0], near[1]), larger_by_bits(near[2], F(ray.s_min)));
    exit = smaller_by_bits(smaller_by_bits(far[0], far[1]), smaller_by_bits(far[2], s_max));
}

/// The children whose boxes the ray meets. `entry`: its parameter where it enters each.
template <std::size_t W>
HWY_INLINE LaneMask<float, W> intersect_children(const WideNodeOf<W>& node, const SlabRay& ray,
                                                 const Lanes<float, W>& s_max,
                                                 Lanes<float, W>& entry) {
    Lanes<float, W> exit;
    cross_children(node, ray, s_max, entry, exit);
    return entry <= exit;
}

/// The same for a ray that has just been prepared, whose rows are not in memory yet: loads would
/// wait for their stores.
template <std::size_t W>
HWY_INLINE LaneMask<float, W> intersect_children(const WideNodeOf<W>& node, const SlabLanes& ray,
                                                 Lanes<float, W>& entry) {
    using F = Lanes<float, W>;
    const float* planes = node.planes[0];
    F near[3], far[3];
    const auto meet = [&]<std::size_t k>(std::integral_constant<std::size_t, k>) HWY_ATTR {
        const F reciprocal = spread<k, W>(ray.reciprocal);
        near[k] = mul_add(load_lanes<W>(planes + W / 4 * ray.near.row[k]), reciprocal,
                          spread<k, W>(ray.near_offset));
        far[k] = mul_add(load_lanes<W>(planes + W / 4 * ray.near.far_row(k)), reciprocal,
                         spread<k, W>(ray.far_offset));
    };
    meet(std::integral_constant<std::size_t, 0>());
    meet(std::integral_constant<std::size_t, 1>());
    meet(std::integral_constant<std::size_t, 2>());
    entry = larger_by_bits(larger_by_bits(near[0], near[1]),
                           larger_by_bits(near[2], spread<0, W>(ray.range)));
    const F exit = smaller_by_bits(smaller_by_bits(far[0], far[1]),
                                   smaller_by_bits(far[2], spread<1, W>(ray.range)));
    return entry <= exit;
}

/// What a ray shares with the one before it: nothing, about the origin, or the direction as well.
enum class Follows { Nothing, Origin, Way };

/// The child of a slot. `jumps`: by a jump to the load of each slot. A processor that foresees
/// the jump, because the rays before took it, fetches the child before the boxes are tested; one
/// that does not loses the time of a branch.
template <std::size_t W>
HWY_INLINE NodeRef child_of(const WideNodeOf<W>& node, std::size_t slot, bool jumps) {
    if constexpr (W == 8) {
        if (jumps) {
            switch (slot) {
                case 0:
                    return node.child[0];
                case 1:
                    return node.child[1];
                case 2:
                    return node.child[2];
                case 3:
                    return node.child[3];
                case 4:
                    return node.child[4];
                case 5:
                    return node.child[5];
                case 6:
                    return node.child[6];
                default:
                    return node.child[7];
            }
        }
    }
    return node.child[slot];
}

/// Fetches a child, or the first block of a leaf.
template <std::size_t W, class Leaf>
HWY_INLINE void fetch_child(const WideNodeOf<W>* nodes, NodeRef child, const Leaf& leaf) {
    if (child.is_leaf()) return leaf.fetch(child);
    const auto* node = reinterpret_cast<const char*>(nodes + child.index());
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < sizeof(*nodes); i += 64) hwy::Prefetch(node + i);
}

/// Fetches the child that the ray enters first of a node that it visits later: two ways through the
/// tree wait for memory at the same time. The node has been fetched.
template <std::size_t W, class Leaf>
HWY_INLINE void fetch_beyond(const WideNodeOf<W>* nodes, NodeRef later, const SlabRay& ray,
                             const Leaf& leaf) {
    if (later.is_leaf()) return;
    const WideNodeOf<W>& node = nodes[later.index()];
    Lanes<float, W> entries;
    const std::uint32_t hit =
        bits_of(intersect_children(node, ray, Lanes<float, W>(leaf.s_max), entries));
    if (hit != 0) fetch_child(nodes, node.child[std::countr_zero(hit)], leaf);
}

/// The child to visit next of those that the ray meets (`met`, bits `hit`, not none); the others go
/// onto the stack. Nearest first if `kOrdered`, else in the order of slots, without entries.
/// `kFar`: see traverse_from.
template <bool kOrdered, bool kFar, std::size_t W, class Leaf>
HWY_INLINE NodeRef next_child(const WideNodeOf<W>* nodes, const WideNodeOf<W>& node,
                              NodeStack<W>& stack, std::size_t& height,
                              const Lanes<float, W>& entries, const LaneMask<float, W>& met,
                              std::uint32_t hit, std::uint32_t octant, Follows follows,
                              const Leaf& leaf) {
    const bool jumps = follows != Follows::Nothing;
    const auto first = static_cast<std::size_t>(std::countr_zero(hit));
    std::uint32_t rest = hit & (hit - 1);
    if constexpr (!kOrdered) {
        if (follows != Follows::Way) {
            stack.push_at_once(height, node, rest);
        } else if (rest != 0) {
            stack.push_one_by_one(height, node, rest);
        }
        return child_of(node, first, jumps);
    }
    if (rest == 0) return child_of(node, first, jumps);
    const auto second = static_cast<std::size_t>(std::countr_zero(rest));
    rest &= rest - 1;
    // One is visited as soon as it is known which, the other later.
    if constexpr (requires { leaf.fetch(NodeRef()); }) {
        fetch_child(nodes, node.child[first], leaf);
        fetch_child(nodes, node.child[second], leaf);
        if constexpr (kFar) {
            for (std::uint32_t others = rest; others != 0; others &= others - 1) {
                fetch_child(nodes, node.child[std::countr_zero(others)], leaf);
            }
        }
    }
    if (rest != 0) {
        const std::size_t nearest = stack.push_but_nearest(height, node, entries, met, hit, octant);
        return child_of(node, nearest, jumps);
    }
    HWY_ALIGN float entry[W];
    store_lanes(entries, entry);
    // Without a jump: nobody foresees which of two is nearer.
    const auto swap = static_cast<std::size_t>(is_nearer<W>(entry[second], entry[first]));
    const std::size_t both = (first ^ second) & (std::size_t{0} - swap);
    const std::size_t farther = second ^ both;
    stack.entry[height] = entry[farther];
    stack.child[height++] = node.child[farther].bits();
    return child_of(node, first ^ both, jumps);
}

/// Visits the leaves that the ray meets in the subtrees of `ref` and of the stack, nearest first if
/// `kOrdered`, else in the order of slots, until `leaf.visit` returns true; returns whether it did.
/// `kFar`: its way lies beyond the caches, so that more of it is fetched.
template <bool kOrdered, bool kFar = false, std::size_t W, class Leaf, class Stats>
HWY_INLINE bool traverse_from(const WideNodeOf<W>* nodes, NodeRef ref, NodeStack<W>& stack,
                              std::size_t height, const SlabRay& ray, Follows follows, Leaf& leaf,
                              Stats stats) {
    // In a register: boxes wait for it, and leaves lower it.
    Lanes<float, W> s_max(leaf.s_max);
    while (true) {
        if (ref.is_leaf()) {
            if constexpr (requires { leaf.visit_within(ref, s_max, stats); }) {
                leaf.visit_within(ref, s_max, stats);
            } else {
                if (leaf.visit(ref, stats)) return true;
                s_max = Lanes<float, W>(leaf.s_max);
            }
        } else {
            const WideNodeOf<W>& node = nodes[ref.index()];
            // Their line is read when the planes have been tested.
            hwy::Prefetch(&node.child);
            stats.nodes(1);
            stats.boxes(node.child_count());
            Lanes<float, W> entries;
            const LaneMask<float, W> met = intersect_children(node, ray, s_max, entries);
            const std::uint32_t hit = bits_of(met);
            if (hit != 0) {
                ref = next_child<kOrdered, kFar>(nodes, node, stack, height, entries, met, hit,
                                                 ray.near.octant, follows, leaf);
                if constexpr (kFar) {
                    if ((hit & (hit - 1)) != 0) {
                        fetch_beyond(nodes, NodeRef::from_bits(stack.child[height - 1]), ray, leaf);
                    }
                }
                continue;
            }
        }
        // Compared as integers: the entry is not negative, and neither is a NaN.
        do {
            if (height == 0) return false;
            --height;
            if constexpr (!kOrdered) break;
        } while (std::bit_cast<std::int32_t>(stack.entry[height]) >
                 std::bit_cast<std::int32_t>(first_lane(s_max)));
        ref = NodeRef::from_bits(stack.child[height]);
    }
}

/// `traverse_from` the root of the tree.
template <bool kOrdered, std::size_t W, class Leaf, class Stats>
HWY_INLINE bool traverse(const WideNodeOf<W>* nodes, NodeRef root, const SlabRay& ray,
                         Follows follows, Leaf& leaf, Stats stats) {
    NodeStack<W> stack;
    return traverse_from<kOrdered>(nodes, root, stack, 0, ray, follows, leaf, stats);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
