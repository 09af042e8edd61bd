/// The traversal kernel of the wide BVH: one ray, the children of a node at a time, compiled once
/// per instruction set and width of the nodes.
///
/// Source: Wald, Benthin and Boulos, "Getting Rid of Packets", RT 2008.
/// Differs: slab test with all slack in the ray's constants (`SlabRay`); separate code for one and
/// two children hit; the next child by a jump that can be foreseen (`child_of`).
/// Conventions: included once per target (see simd/lanes-inl.h). `Leaf` has `bool visit(NodeRef,
/// stats)`, which returns true to stop, and `float s_max`, the parameter up to which hits are
/// searched; boxes that begin exactly there are visited.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_TRAVERSE_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <cstdint>
#include <utility>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/slab_ray-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The children whose boxes the ray meets. `entry`: its parameter where it enters each.
template <std::size_t W>
HWY_INLINE LaneMask<float, W> intersect_children(const WideNodeOf<W>& node, const SlabRay& ray,
                                                 float s_max, Lanes<float, W>& entry) {
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
    const F exit =
        smaller_by_bits(smaller_by_bits(far[0], far[1]), smaller_by_bits(far[2], F(s_max)));
    return entry <= exit;
}

/// A subtree to visit, and the parameter where the ray enters it, in one word: an entry is moved
/// right after it was stored, and a load of two stores would wait for both.
class StackEntry {
  public:
    StackEntry() = default;
    /// Precondition: `entry` is not negative.
    HWY_INLINE StackEntry(float entry, NodeRef ref)
        : bits_(std::uint64_t{std::bit_cast<std::uint32_t>(entry)} << 32 | ref.bits()) {}

    /// Compared as integers: the entry is not negative, and neither is a NaN.
    [[nodiscard]] HWY_INLINE bool is_beyond(float s_max) const {
        return static_cast<std::int32_t>(bits_ >> 32) > std::bit_cast<std::int32_t>(s_max);
    }
    [[nodiscard]] HWY_INLINE NodeRef ref() const {
        return NodeRef::from_bits(static_cast<std::uint32_t>(bits_));
    }
    /// The order of numbers that are not negative is that of their bits.
    [[nodiscard]] HWY_INLINE bool is_nearer_than(const StackEntry& other) const {
        return bits_ < (other.bits_ & ~std::uint64_t{0xFFFFFFFFu});
    }

  private:
    std::uint64_t bits_;
};

/// The child of a slot. `follows`: by a jump to the load of each slot. A processor that foresees
/// the jump, because the rays before took it, fetches the child before the boxes are tested; one
/// that does not loses the time of a branch.
template <std::size_t W>
HWY_INLINE NodeRef child_of(const WideNodeOf<W>& node, std::size_t slot, bool follows) {
    if constexpr (W == 8) {
        if (follows) {
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

/// Pushes the children that are hit, but for the nearest, the nearer later; returns the slot of the
/// nearest. Of two that are entered at the same parameter the one of the higher slot is nearer.
/// Precondition: at least two are hit.
template <std::size_t W>
HWY_INLINE std::size_t push_but_nearest(const WideNodeOf<W>& node, std::uint32_t hit,
                                        const float* entry, StackEntry* stack,
                                        std::size_t& height) {
    const std::size_t base = height;
    auto nearest = static_cast<std::size_t>(std::countr_zero(hit));
    hit &= hit - 1;
    auto other = static_cast<std::size_t>(std::countr_zero(hit));
    if (entry[other] <= entry[nearest]) std::swap(nearest, other);
    stack[height++] = {entry[other], node.child[other]};
    for (hit &= hit - 1; hit != 0; hit &= hit - 1) {
        const auto slot = static_cast<std::size_t>(std::countr_zero(hit));
        if (entry[slot] <= entry[nearest]) {
            stack[height++] = {entry[nearest], node.child[nearest]};
            nearest = slot;
            continue;
        }
        const StackEntry child{entry[slot], node.child[slot]};
        std::size_t place = height++;
        while (place > base && stack[place - 1].is_nearer_than(child)) {
            stack[place] = stack[place - 1];
            --place;
        }
        stack[place] = child;
    }
    return nearest;
}

/// Visits the leaves that the ray meets, nearest first if `kOrdered`, else in the order of slots,
/// until `leaf.visit` returns true; returns whether it did. `follows`: the ray probably
/// takes the way of the one before it.
template <bool kOrdered, std::size_t W, class Leaf, class Stats>
HWY_INLINE bool traverse(const WideNodeOf<W>* nodes, NodeRef root, const SlabRay& ray, bool follows,
                         Leaf& leaf, Stats stats) {
    StackEntry stack[kTraversalStackSize<W>];
    std::size_t height = 0;
    NodeRef ref = root;
    while (true) {
        if (ref.is_leaf()) {
            if (leaf.visit(ref, stats)) return true;
        } else {
            const WideNodeOf<W>& node = nodes[ref.index()];
            // Their line is read when the planes have been tested.
            hwy::Prefetch(&node.child);
            stats.nodes(1);
            stats.boxes(node.child_count());
            Lanes<float, W> entries;
            std::uint32_t hit = bits_of(intersect_children(node, ray, leaf.s_max, entries));
            if (hit != 0) {
                const auto first = static_cast<std::size_t>(std::countr_zero(hit));
                hit &= hit - 1;
                if (hit == 0) {
                    ref = child_of(node, first, follows);
                    continue;
                }
                HWY_ALIGN float entry[W];
                store_lanes(entries, entry);
                const auto second = static_cast<std::size_t>(std::countr_zero(hit));
                hit &= hit - 1;
                if (hit == 0) {
                    const bool swap = kOrdered && entry[second] < entry[first];
                    const std::size_t later = swap ? first : second;
                    stack[height++] = {entry[later], node.child[later]};
                    ref = child_of(node, swap ? second : first, follows);
                    continue;
                }
                if constexpr (kOrdered) {
                    hit |= 1u << first | 1u << second;
                    ref =
                        child_of(node, push_but_nearest(node, hit, entry, stack, height), follows);
                } else {
                    hit |= 1u << second;
                    for (; hit != 0; hit &= ~(0x80000000u >> std::countl_zero(hit))) {
                        const auto slot = static_cast<std::size_t>(31 - std::countl_zero(hit));
                        stack[height++] = {entry[slot], node.child[slot]};
                    }
                    ref = child_of(node, first, follows);
                }
                continue;
            }
        }
        do {
            if (height == 0) return false;
            --height;
        } while (stack[height].is_beyond(leaf.s_max));
        ref = stack[height].ref();
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
