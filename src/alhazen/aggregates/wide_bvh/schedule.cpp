#include "alhazen/aggregates/wide_bvh/schedule.h"

#include <algorithm>

#include "alhazen/primitives/primitive_lanes.h"

namespace alhazen {

namespace {

/// Largest tree of packets, bytes. On the bunny packets are 1.6 to 2 times as fast as the stream
/// for eye rays at 512x512; in trees beyond the caches they are slower. Where primitives are finer
/// than the distance of the rays a packet gives up.
constexpr std::size_t kMaxPacketTreeBytes = std::size_t{8} << 20;
/// Fewest primitives with a test in lanes for each one without, in trees of packets: the others are
/// tested ray by ray, and packets were slower among them.
constexpr std::size_t kLanePrimitivesPerScalar = 64;
/// Largest tree whose coherent rays are traced one by one, bytes. The stream hides the latency of
/// memory; a tree in the caches has little, and neighbouring rays predict each other's branches.
/// Single eye rays are 5 to 10 % faster than the stream's, shadow rays 25 %. Incoherent rays in
/// trees below 1 MB would gain 10 to 15 %; in larger ones the stream is faster.
constexpr std::size_t kMaxSingleTreeBytes = std::size_t{64} << 20;

enum class BatchQuery { Closest, Occluded };

struct ScheduledTree {
    std::size_t bytes;
    bool treeless;       ///< TreelessPackets takes all primitives
    bool suits_packets;  ///< packets are faster than single rays
    bool has_packets;    ///< the kernels trace packets
};

Schedule choose_schedule(const ScheduledTree& tree, BatchQuery query, Coherence coherence) {
    if (tree.treeless) return Schedule::TreelessPackets;
    if (coherence == Coherence::Any) return Schedule::Stream;
    // Packets of shadow rays are slower than single rays: 2.3 M rays/s against 5.9 (bunny), 2.4
    // against 7.9 (Sponza).
    if (query == BatchQuery::Closest && tree.suits_packets) {
        return tree.has_packets ? Schedule::Packets : Schedule::Stream;
    }
    return tree.bytes <= kMaxSingleTreeBytes ? Schedule::Single : Schedule::Stream;
}

bool suits_packets(const PrimitiveTable& table, const WideBvhLayout& layout,
                   std::span<const PrimitiveId> unbounded) {
    if (layout.memory_bytes() > kMaxPacketTreeBytes) return false;
    std::size_t in_lanes = 0, scalar = 0;
    for (std::uint32_t i = 0; i < table.size(); ++i) {
        if (i == table.first(kTriangleKind)) {
            const std::uint32_t end = table.first(kTriangleKind + 1);
            in_lanes += end - i;
            i = end;
            if (i == table.size()) break;
        }
        const PrimitiveId id{i};
        if (std::binary_search(unbounded.begin(), unbounded.end(), id)) continue;
        ++(takes_lanes(table, id) ? in_lanes : scalar);
    }
    return kLanePrimitivesPerScalar * scalar <= in_lanes;
}

}  // namespace

Schedules::Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
                     std::span<const PrimitiveId> unbounded, bool treeless, bool has_packets) {
    const ScheduledTree tree{layout.memory_bytes(), treeless,
                             suits_packets(table, layout, unbounded), has_packets};
    for (const Coherence coherence : {Coherence::Any, Coherence::Coherent}) {
        const auto i = static_cast<std::size_t>(coherence);
        closest_[i] = choose_schedule(tree, BatchQuery::Closest, coherence);
        occluded_[i] = choose_schedule(tree, BatchQuery::Occluded, coherence);
    }
}

}  // namespace alhazen
