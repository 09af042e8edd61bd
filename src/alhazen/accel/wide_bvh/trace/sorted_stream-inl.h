/// The stream kernel of the wide BVH: arbitrary rays, interleaved, that wait in lists by what they
/// do next: no branch asks for it, which would be mispredicted several times a ray.
///
/// Source: Kocberber, Falsafi and Grot, "Asynchronous Memory Access Chaining", PVLDB 9(4), 2015;
/// Tsakok, "Faster Incoherent Rays: Multi-BVH Ray Stream Tracing", HPG 2009 (rays of a stream
/// sorted by their next step).
/// Differs: each ray has a stack of its own and visits its children nearest first, or for any hit
/// in the order of the tree.
/// Conventions: included once per target (see simd/lanes-inl.h). `Query` has `filter_block(NodeRef,
/// stats)`, which begins the test of the first block of a leaf; `settle(stats)`, which ends it, in
/// a step of its own, if `waits()` is true; both return true to stop. Both may lower `s_max`, the
/// parameter up to which hits are searched. `slabs` is the ray. `Source` has `start(void* place,
/// const float*& entries)`, which constructs the query of the next ray there and returns false if
/// there is none, and sets `entries` to where it enters the W children of the root, infinity where
/// it does not, if that is known; and `finish(query, stats)`, called after its last leaf. A source
/// of any-hit queries may have `subtrees(std::uint32_t* place)`, which puts the subtrees with which
/// the last ray begins there, the first last, at most kMostBegun, and returns their number; 0: it
/// begins with the root.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_SORTED_STREAM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_SORTED_STREAM_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_SORTED_STREAM_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_SORTED_STREAM_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "alhazen/accel/wide_bvh/trace/stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// What a ray does next.
enum class NextStep : std::uint8_t { Node, Leaf, Settle, Finish };

/// [whether a leaf is to be settled] [first four bits of the next subtree] the next step.
inline constexpr auto kNextSteps = [] {
    std::array<std::array<NextStep, 16>, 2> next{};
    for (std::size_t bits = 0; bits < 16; ++bits) {
        next[0][bits] = bits < 8 ? NextStep::Node : NextStep::Leaf;
        next[1][bits] = NextStep::Settle;
    }
    next[0][15] = NextStep::Finish;  // NodeRef::none()
    return next;
}();

/// The lists of the rays in flight, by their next step.
template <class Slot, std::size_t kSlots>
class StepLists {
  public:
    StepLists() = default;
    StepLists(const StepLists&) = delete;
    StepLists& operator=(const StepLists&) = delete;

    HWY_INLINE void add(NextStep step, Slot& slot) { *end_[index(step)]++ = &slot; }
    [[nodiscard]] HWY_INLINE std::size_t count(NextStep step) const {
        return static_cast<std::size_t>(end_[index(step)] - begin_[index(step)]);
    }
    /// Calls f(slot) for the rays that are in the list now, and removes them.
    template <class F>
    HWY_INLINE void take(NextStep step, F&& f) {
        const Taken taken = take_list(step);
        for (std::size_t i = 0; i < taken.count; ++i) f(*taken.slots[i]);
    }
    /// As `take`, and calls then(slot) for each when f has been called for `kBehind` more.
    template <std::size_t kBehind, class F, class Then>
    HWY_INLINE void take(NextStep step, F&& f, Then&& then) {
        const Taken taken = take_list(step);
        for (std::size_t i = 0; i < taken.count; ++i) {
            f(*taken.slots[i]);
            if (i >= kBehind) then(*taken.slots[i - kBehind]);
        }
        for (std::size_t i = taken.count - std::min(kBehind, taken.count); i < taken.count; ++i) {
            then(*taken.slots[i]);
        }
    }
    /// As `take`, two rays at a time: two(slot, slot), one(slot) for the last of an odd number.
    /// Calls then(slot) for each when the next two are done.
    template <class Two, class One, class Then>
    HWY_INLINE void take_pairs(NextStep step, Two&& two, One&& one, Then&& then) {
        const Taken taken = take_list(step);
        std::size_t i = 0;
        for (; i + 1 < taken.count; i += 2) {
            two(*taken.slots[i], *taken.slots[i + 1]);
            if (i == 0) continue;
            then(*taken.slots[i - 2]);
            then(*taken.slots[i - 1]);
        }
        if (i < taken.count) one(*taken.slots[i]);
        for (i -= std::min<std::size_t>(i, 2); i < taken.count; ++i) then(*taken.slots[i]);
    }

  private:
    static constexpr std::size_t kSteps = 4;
    struct Taken {
        Slot* const* slots;
        std::size_t count;
    };
    static HWY_INLINE std::size_t index(NextStep step) { return static_cast<std::size_t>(step); }
    /// Exchanges the list with an empty one. Nothing is copied, for what was stored slot by slot
    /// would be waited for where it is loaded several at a time.
    HWY_INLINE Taken take_list(NextStep step) {
        const Taken taken{begin_[index(step)], count(step)};
        Slot** const empty = std::exchange(spare_, begin_[index(step)]);
        begin_[index(step)] = end_[index(step)] = empty;
        return taken;
    }

    Slot* room_[kSteps + 1][kSlots];
    Slot** begin_[kSteps] = {room_[0], room_[1], room_[2], room_[3]};
    Slot** end_[kSteps] = {room_[0], room_[1], room_[2], room_[3]};
    Slot** spare_ = room_[kSteps];
};

/// The rays of `traverse_sorted`.
template <class Query, std::size_t W, class Source, class Stats>
class SortedStream {
  public:
    HWY_INLINE SortedStream(const WideNodeOf<W>* nodes, NodeRef root,
                            const PrefetchTable& prefetch_table, bool fetches, Source& source,
                            Stats stats)
        : nodes_(nodes),
          root_(root),
          prefetch_table_(prefetch_table),
          fetches_(fetches),
          source_(source),
          stats_(stats) {}

    HWY_INLINE void run() {
        for (Slot& slot : slots_) {
            if (!start(slot)) break;
            queue(slot);
        }
        while (true) {
            lists_.template take<kNodesBehind>(
                NextStep::Node, [&](Slot& slot) HWY_ATTR { visit_node(slot); },
                [&](Slot& slot) HWY_ATTR { queue(slot); });
            const bool idle = lists_.count(NextStep::Node) == 0;
            const std::size_t leaves = lists_.count(NextStep::Leaf);
            if (leaves >= kEnough || (idle && leaves > 0)) {
                visit_leaves();
                lists_.take(NextStep::Settle, [&](Slot& slot) HWY_ATTR { settle(slot); });
            }
            const bool starved =
                lists_.count(NextStep::Node) == 0 && lists_.count(NextStep::Leaf) == 0;
            const std::size_t done = lists_.count(NextStep::Finish);
            if (starved && done == 0) return;
            if (starved || done >= kEnough) {
                lists_.template take<kEndsBehind>(
                    NextStep::Finish,
                    [&](Slot& slot) HWY_ATTR {
                        source_.finish(slot.query(), stats_);
                        (void)start(slot);
                    },
                    [&](Slot& slot) HWY_ATTR {
                        if (HWY_LIKELY(slot.height != 0)) queue(slot);
                    });
            }
        }
    }

  private:
    using Slot = StreamSlot<Query, W>;
    /// Fewer rays wait until there are as many, so that most passes of a list end where the
    /// processor expects it.
    static constexpr std::size_t kEnough = 10;

    /// Number of rays that are visited before a ray is queued. The next step of a ray comes out of
    /// a long chain of operations; what waits for its end keeps the processor from running ahead.
    static constexpr std::size_t kNodesBehind = 5, kLeavesBehind = 2, kEndsBehind = 2;

    /// False if there is no ray left.
    HWY_INLINE bool start(Slot& slot) {
        const float* entries = nullptr;
        slot.height = 0;
        if (!source_.start(slot.place, entries)) return false;
        slot.begin(root_);
        if (entries != nullptr) enter_root(slot, entries);
        if constexpr (requires { source_.subtrees(slot.stack.child); }) {
            const std::size_t count = source_.subtrees(slot.stack.child + 1);
            if (count != 0) slot.height = 1 + count;
        }
        return true;
    }
    /// As visit_node, for the root.
    HWY_INLINE void enter_root(Slot& slot, const float* entries) {
        const Query& query = slot.query();
        const WideNodeOf<W>& node = nodes_[root_.index()];
        stats_.nodes(1);
        stats_.boxes(node.child_count());
        // Where the ray leaves a child that it enters was compared already.
        slot.height = slot.stack.template push<Query::kOrdered>(
            1, node, load_lanes<W>(entries), Lanes<float, W>(query.s_max), query.slabs.near.octant);
    }
    /// `waits`: a leaf is to be settled before.
    HWY_INLINE void queue(Slot& slot, bool waits = false) {
        const std::uint32_t next = slot.stack.child[slot.height - 1];
        if (fetches_) prefetch_table_.prefetch(next);
        lists_.add(kNextSteps[waits][next >> 28], slot);
    }
    HWY_INLINE void visit_node(Slot& slot) {
        Query& query = slot.query();
        const std::size_t height = slot.height - 1;
        const WideNodeOf<W>& node = nodes_[NodeRef::from_bits(slot.stack.child[height]).index()];
        stats_.nodes(1);
        stats_.boxes(node.child_count());
        Lanes<float, W> entries, exits;
        cross_children(node, query.slabs, Lanes<float, W>(query.s_max), entries, exits);
        slot.height = slot.stack.template push<Query::kOrdered>(height, node, entries, exits,
                                                                query.slabs.near.octant);
    }
    HWY_INLINE void visit_leaves() {
        const auto one = [&](Slot& slot) HWY_ATTR { visit_leaf(slot, take_leaf(slot)); };
        const auto then = [&](Slot& slot) HWY_ATTR { queue(slot, slot.query().waits()); };
        if constexpr (Query::kPairs) {
            lists_.take_pairs(
                NextStep::Leaf,
                [&](Slot& a, Slot& b) HWY_ATTR {
                    const NodeRef of_a = take_leaf(a), of_b = take_leaf(b);
                    if (HWY_LIKELY(
                            Query::filter_blocks(a.query(), of_a, b.query(), of_b, stats_))) {
                        return;
                    }
                    visit_leaf(a, of_a);
                    visit_leaf(b, of_b);
                },
                one, then);
        } else {
            lists_.template take<kLeavesBehind>(NextStep::Leaf, one, then);
        }
    }
    /// Removes the first block of a leaf from the stack.
    HWY_INLINE NodeRef take_leaf(Slot& slot) {
        const std::size_t top = slot.height - 1;
        const NodeRef leaf = NodeRef::from_bits(slot.stack.child[top]);
        slot.stack.child[top] = leaf.after_first_block().bits();
        slot.height = top + (leaf.count() > 1);
        return leaf;
    }
    HWY_INLINE void visit_leaf(Slot& slot, NodeRef leaf) {
        Query& query = slot.query();
        const float s_max = query.s_max;
        if (query.filter_block(leaf, stats_)) return slot.stop();
        if (query.s_max < s_max) drop_beyond(slot);
    }
    HWY_INLINE void settle(Slot& slot) {
        Query& query = slot.query();
        const float s_max = query.s_max;
        if (query.settle(stats_)) {
            slot.stop();
        } else if (query.s_max < s_max) {
            drop_beyond(slot);
        }
        queue(slot);
    }
    /// Removes the subtrees beyond the end of the ray, when that has moved: the visits need not
    /// ask.
    HWY_INLINE void drop_beyond(Slot& slot) {
        slot.height = slot.stack.drop_beyond(slot.height, slot.query().s_max);
    }

    const WideNodeOf<W>* nodes_;
    NodeRef root_;
    const PrefetchTable& prefetch_table_;
    const bool fetches_;
    Source& source_;
    [[no_unique_address]] Stats stats_;
    StepLists<Slot, kBatchSlots> lists_;
    Slot slots_[kBatchSlots];
};

/// Traces every ray of `source` through the tree. `fetches`: whether nodes and leaves are
/// prefetched.
template <class Query, std::size_t W, class Source, class Stats>
HWY_INLINE void traverse_sorted(const WideNodeOf<W>* nodes, NodeRef root,
                                const PrefetchTable& prefetch_table, bool fetches, Source& source,
                                Stats stats) {
    SortedStream<Query, W, Source, Stats> stream(nodes, root, prefetch_table, fetches, source,
                                                 stats);
    stream.run();
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
