/// Rays interleaved, so that the arithmetic of one hides the latency of memory and branches of the
/// others: their slots, the prefetching of what they need next, and a step of a ray in its turn.
/// Batches of arbitrary rays: sorted_stream-inl.h.
///
/// Source: Kocberber, Falsafi and Grot, "Asynchronous Memory Access Chaining", PVLDB 9(4), 2015
/// (slots refilled one by one); Fuetterling, Lojewski, Pfreundt, Hamann and Ebert, "Accelerated
/// Single Ray Tracing for Wide Vector Units", HPG 2017 (children sorted by the octant of the ray
/// and compressed onto the stack).
/// Differs: the order of an octant is that of the centers of the boxes along its diagonal; any-hit
/// queries have one order for all octants (collapse.h).
/// Conventions: included once per target (see simd/lanes-inl.h).
///
/// `Query` has `visit(NodeRef, stats)`, which tests a leaf and returns true to stop, as for
/// NodeRef::none(); `slabs`, the ray; and `s_max`, the parameter up to which hits are searched.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_STREAM_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_STREAM_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_STREAM_INL_H_
#endif

#include <hwy/cache_control.h>

#include <new>

#include "alhazen/accel/wide_bvh/build/build_types.h"
#include "alhazen/accel/wide_bvh/trace/traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Number of rays in flight: of those that leave a packet, and of a batch.
inline constexpr std::size_t kStreamSlots = 8, kBatchSlots = 32;

/// Computes the address of a node or a leaf without a branch.
class PrefetchTable {
  public:
    /// Leaf i of kind k is at leaves[k] + i * sizes[k].
    template <std::size_t W>
    HWY_INLINE PrefetchTable(const WideNodeOf<W>* nodes, const void* const (&leaves)[kLeafKinds],
                             const std::size_t (&sizes)[kLeafKinds]) {
        for (std::size_t i = 0; i < 8; ++i) {
            place_[i] = {nodes, sizeof(WideNodeOf<W>), ~0u, W > 8 ? std::size_t{256} : 0};
            // NodeRef::none() has nothing to prefetch.
            place_[8 + i] = {nodes, 0, 0, 0};
        }
        for (std::size_t i = 0; i < kLeafKinds; ++i) {
            place_[8 + i] = {leaves[i], sizes[i], NodeRef::kMaxOffset,
                             sizes[i] > 256 ? std::size_t{256} : 0};
        }
    }
    /// Prefetches five cache lines, or all if there are fewer.
    HWY_INLINE void prefetch(std::uint32_t ref) const {
        const Place& place = place_[ref >> 28];
        const char* lines = static_cast<const char*>(place.base) + (ref & place.mask) * place.size;
        hwy::Prefetch(lines);
        hwy::Prefetch(lines + 64);
        hwy::Prefetch(lines + 128);
        hwy::Prefetch(lines + 192);
        hwy::Prefetch(lines + place.fifth);
    }

  private:
    struct Place {
        const void* base;
        std::size_t size;
        std::uint32_t mask;
        std::size_t fifth;
    };
    Place place_[16];
};

/// A ray in flight.
template <class Query, std::size_t W>
struct StreamRay {
    alignas(64) std::byte place[sizeof(Query)];
    std::size_t height;
    NodeStack<W> stack;

    [[nodiscard]] HWY_INLINE Query& query() {
        return *std::launder(reinterpret_cast<Query*>(place));
    }
    /// Places the root on the stack.
    HWY_INLINE void begin(NodeRef root) {
        stack.clear();
        stack.entry[1] = -std::numeric_limits<float>::infinity();
        stack.child[1] = root.bits();
        height = 2;
    }
    /// Leaves the sentinel on the stack.
    HWY_INLINE void stop() { height = 1; }
};
/// Padded so that the first lines of neighbouring slots are spread over the sets of the first cache
/// (64 on most processors): of each slot only the query and the bottom of the stack are in use.
template <class Query, std::size_t W>
struct StreamSlot : StreamRay<Query, W> {
  private:
    static constexpr std::size_t kLines = sizeof(StreamRay<Query, W>) / 64;
    static constexpr std::size_t kSets = 64, kStep = 39;
    [[maybe_unused]] std::byte gap_[64 * (1 + (kStep + kSets - 1 - kLines % kSets) % kSets)];
};

/// Visits one node or leaf of one ray; false if the ray is done.
template <class Query, std::size_t W, class Stats>
HWY_INLINE bool advance(StreamSlot<Query, W>& slot, const WideNodeOf<W>* nodes,
                        const PrefetchTable& prefetch_table, Stats stats) {
    Query& query = slot.query();
    NodeStack<W>& stack = slot.stack;
    std::size_t height = slot.height;
    do {
        --height;
    } while (stack.entry[height] > query.s_max);
    const NodeRef ref = NodeRef::from_bits(stack.child[height]);
    if (ref.is_leaf()) {
        if (query.visit(ref, stats)) return false;
    } else {
        const WideNodeOf<W>& node = nodes[ref.index()];
        stats.nodes(1);
        stats.boxes(node.child_count());
        Lanes<float, W> entries, exits;
        cross_children(node, query.slabs, Lanes<float, W>(query.s_max), entries, exits);
        height = stack.template push<Query::kOrdered>(height, node, entries, exits,
                                                      query.slabs.near.octant);
    }
    slot.height = height;
    prefetch_table.prefetch(stack.child[height - 1]);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
