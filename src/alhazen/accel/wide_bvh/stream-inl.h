/// The stream kernel of the wide BVH: any rays, several of them interleaved, so that one ray's
/// arithmetic hides the latency of the others' memory and branches.
///
/// Source: Kocberber, Falsafi and Grot, "Asynchronous Memory Access Chaining", PVLDB 9(4), 2015
/// (slots refilled one by one); Fuetterling, Lojewski, Pfreundt, Hamann and Ebert, "Accelerated
/// Single Ray Tracing for Wide Vector Units", HPG 2017 (children sorted by the octant of the ray
/// and compressed onto the stack).
/// Differs: the order of an octant is that of the centers of the boxes along its diagonal.
/// Conventions: included once per target (see simd/lanes-inl.h).
///
/// `Query`: `visit(NodeRef, stats)` tests a leaf, true to stop, as for NodeRef::none();
/// `finish_step(stats)` after the last, again and again until it is true; `prefetch(NodeRef)` a
/// leaf; `slabs` and `in_group`, the ray; `s_max`, how far it still needs to go. `Source`:
/// `start(void* place)` makes the query of the next ray there, null when there is none;
/// `release(query)`, when it is done.

#if defined(ALHAZEN_WIDE_BVH_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_WIDE_BVH_STREAM_INL_H_
#undef ALHAZEN_WIDE_BVH_STREAM_INL_H_
#else
#define ALHAZEN_WIDE_BVH_STREAM_INL_H_
#endif

#include <hwy/cache_control.h>

#include "alhazen/accel/wide_bvh/traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Rays on their way at a time.
inline constexpr std::size_t kStreamSlots = 8;

/// Subtrees yet to visit, entries and references apart so that both are stored by lanes. Its height
/// is kept outside: in a register.
struct StreamStack {
    static constexpr std::size_t kSize = kTraversalStackSize + kWideNodeWidth;
    float entry[kSize];
    std::uint32_t child[kSize];

    /// Puts the children that are hit on top, the farthest first by the order of the octant.
    template <std::size_t kRegisters = kParts<float>>
    [[nodiscard]] HWY_INLINE std::size_t push(std::size_t height, const WideNode& node,
                                              const Floats& entries, const LaneMask<float>& hit,
                                              std::uint32_t octant) {
        if constexpr (kRegisters == 1) {
            return push_lanes(height, node, entries, hit, octant);
        } else {
            HWY_ALIGN float near[kWideNodeWidth];
            store_lanes(entries, near);
            const std::uint32_t bits = bits_of(hit);
            std::uint32_t order = node.order[octant];
            for (std::size_t i = 0; i < kWideNodeWidth; ++i, order >>= 3) {
                const std::uint32_t slot = order & 7;
                entry[height] = near[slot];
                child[height] = node.child[slot].bits();
                height += bits >> slot & 1;
            }
            return height;
        }
    }

  private:
    template <class = void>
    HWY_INLINE std::size_t push_lanes(std::size_t height, const WideNode& node,
                                      const Floats& entries, const LaneMask<float>& hit,
                                      std::uint32_t octant) {
        const LaneTag<float> d;
        const hn::RebindToSigned<LaneTag<float>> di;
        const hn::RebindToUnsigned<LaneTag<float>> du;
        HWY_ALIGN static constexpr std::uint32_t kShifts[kWideNodeWidth] = {0,  3,  6,  9,
                                                                            12, 15, 18, 21};
        const auto slots = hn::And(hn::Shr(hn::Set(du, node.order[octant]), hn::Load(du, kShifts)),
                                   hn::Set(du, 7));
        const auto order = hn::IndicesFromVec(d, hn::BitCast(di, slots));
        const auto missed = hn::Set(d, std::numeric_limits<float>::infinity());
        const auto near =
            hn::TableLookupLanes(hn::IfThenElse(hit.part[0], entries.part[0], missed), order);
        const auto refs =
            hn::TableLookupLanes(hn::Load(d, reinterpret_cast<const float*>(node.child)), order);
        const auto mask = hn::Lt(near, missed);
        hn::StoreU(hn::Compress(near, mask), d, entry + height);
        hn::StoreU(hn::Compress(refs, mask), d, reinterpret_cast<float*>(child + height));
        return height + hn::CountTrue(d, mask);
    }
};

template <class Query>
struct StreamSlot {
    Query* query;
    NodeRef ref;
    std::uint32_t octant;
    std::size_t height;
    alignas(64) std::byte place[sizeof(Query)];
    StreamStack stack;
};

/// One node or leaf of one ray; false when the ray is done.
template <class Query, class Stats>
HWY_INLINE bool advance(StreamSlot<Query>& slot, const WideNode* nodes, Stats stats) {
    Query& query = *slot.query;
    StreamStack& stack = slot.stack;
    std::size_t height = slot.height;
    if (slot.ref.is_leaf()) {
        if (query.visit(slot.ref, stats)) return false;
    } else {
        const WideNode& node = nodes[slot.ref.index()];
        stats.nodes(1);
        stats.boxes(node.child_count());
        Floats entries;
        const LaneMask<float> hit =
            meet_children(node, query.slabs, query.in_group, query.s_max, entries);
        height = stack.push(height, node, entries, hit, slot.octant);
    }
    do {
        if (height == 0) return false;
        --height;
    } while (stack.entry[height] > query.s_max);
    slot.height = height;
    slot.ref = NodeRef::from_bits(stack.child[height]);
    if (slot.ref.is_leaf()) {
        query.prefetch(slot.ref);
    } else {
        const auto* lines = reinterpret_cast<const char*>(&nodes[slot.ref.index()]);
        HWY_UNROLL(4)
        for (int i = 0; i < 4; ++i) hwy::Prefetch(lines + 64 * i);
    }
    return true;
}

/// Takes every ray of `source` through the tree.
template <class Query, class Source, class Stats>
HWY_INLINE void traverse_stream(const WideNode* nodes, NodeRef root, Source& source, Stats stats) {
    StreamSlot<Query> slots[kStreamSlots];
    StreamSlot<Query>* active[kStreamSlots];
    const auto start = [&](StreamSlot<Query>& slot) HWY_ATTR {
        slot.query = source.start(slot.place);
        if (slot.query == nullptr) return false;
        slot.octant = slot.query->slabs.octant[slot.query->in_group];
        slot.height = 0;
        slot.ref = root;
        return true;
    };
    std::size_t count = 0;
    while (count < kStreamSlots && start(slots[count])) {
        active[count] = &slots[count];
        ++count;
    }
    while (count > 0) {
        for (std::size_t i = 0; i < count; ++i) {
            StreamSlot<Query>& slot = *active[i];
            if (advance(slot, nodes, stats)) continue;
            if (!slot.query->finish_step(stats)) {
                slot.ref = NodeRef::none();
                slot.height = 0;
            } else {
                source.release(*slot.query);
                if (!start(slot)) active[i--] = active[--count];
            }
        }
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
