#include "alhazen/aggregates/wide_bvh/schedule.h"

#include <algorithm>
#include <atomic>

#include "alhazen/aggregates/wide_bvh/stream_override.h"
#include "alhazen/primitives/primitive_lanes.h"

namespace alhazen {

namespace {

std::atomic<int> stream_overrides{0};

struct ScheduledTree {
    std::size_t bytes;
    bool treeless;       ///< TreelessPackets traces all primitives
    bool suits_packets;  ///< packets are faster than single rays for some query and target
    bool has_packets;    ///< the kernels trace packets
    std::size_t most_single_bytes;
};

Schedule choose_schedule(const ScheduledTree& tree, Coherence coherence) {
    if (tree.treeless) return Schedule::TreelessPackets;
    if (coherence == Coherence::Any) {
        const bool single = tree.bytes <= tree.most_single_bytes && stream_overrides == 0;
        return single ? Schedule::Single : Schedule::Stream;
    }
    if (tree.suits_packets && tree.has_packets) return Schedule::Packets;
    return tree.bytes <= kMaxSingleTreeBytes ? Schedule::Single : Schedule::Stream;
}

bool suits_packets(const PrimitiveTable& table, std::span<const PrimitiveId> unbounded) {
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

/// See Schedules::others_alone. Hits inside instances need a path, which lane packets have not.
bool are_alone(const PrimitiveTable& table, const WideBvhLayout& layout) {
    for (const BoxBlock& block : layout.others) {
        for (const BlockId id : block.ids) {
            if (!id.used()) continue;
            if (table.kind(id.id()) == kInstanceKind || takes_lanes(table, id.id())) return false;
        }
    }
    return true;
}

}  // namespace

std::size_t most_single_bytes(const WideBvhLayout& layout) {
    const std::size_t triangles = layout.triangles.size() + layout.indices.size();
    const std::size_t round = layout.spheres.size() + layout.frustums.size();
    // Of shapes without a filter in lanes the stream gains nothing, and rays one by one try the
    // last occluders.
    if (triangles > round + 4 * layout.others.size()) return 0;
    return round >= triangles + layout.others.size() ? kMaxRoundSingleBytes
                                                     : kMaxIncoherentSingleBytes;
}

StreamOverride::StreamOverride() {
    ++stream_overrides;
}
StreamOverride::~StreamOverride() {
    --stream_overrides;
}

Schedules::Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
                     std::span<const PrimitiveId> unbounded, bool treeless, bool has_packets) {
    others_alone_ = are_alone(table, layout);
    const ScheduledTree tree{layout.memory_bytes(), treeless,
                             others_alone_ || suits_packets(table, unbounded), has_packets,
                             most_single_bytes(layout)};
    waits_ = tree.bytes > kMaxSingleTreeBytes;
    gathers_ = tree.bytes > kMaxIncoherentSingleBytes || tree.most_single_bytes > 0 ||
               stream_overrides > 0;
    if (!waits_ && stream_overrides == 0) least_stream_ = kMinStreamBatch;
    for (const Coherence coherence : {Coherence::Any, Coherence::Coherent}) {
        batches_[static_cast<std::size_t>(coherence)] = choose_schedule(tree, coherence);
    }
}

}  // namespace alhazen
