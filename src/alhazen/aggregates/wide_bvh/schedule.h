#pragma once
/// The schedule of a batch of rays in the wide BVH, and the thresholds of its choice. Which rays
/// fit into one packet is geometry: accel/wide_bvh/trace/packet-inl.h.
///
/// The schedule never changes a hit. Measurements: docs/benchmarks.md, docs/log/wide_bvh.md.
/// Complexity and threads: chosen once per tree; const functions may be called from many threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/primitives/aggregate.h"
#include "alhazen/primitives/primitive_table.h"

namespace alhazen {

/// How the rays of a batch are traced.
enum class Schedule {
    Single,           ///< one by one
    Stream,           ///< several interleaved (accel/wide_bvh/trace/stream-inl.h)
    Packets,          ///< packets of coherent rays; rays in no packet one by one
    TreelessPackets,  ///< lanes of rays against every primitive (treeless_packets.h)
};

/// Most primitives of a tree that treeless packets replace. Lanes miss a few shapes in less time
/// than one ray takes through the tree: torus 2.4, Barth's sextic 2.3, quartic 2.4 times faster.
inline constexpr std::size_t kMaxTreelessPrimitives = 4;

/// Fewest rays of a packet: fewer are no faster than single rays.
inline constexpr int kMinPacketRays = 16;
/// Work after which a packet gives up: 1 per node, 2 per leaf block. Measured: about the cost of
/// its rays one by one.
inline constexpr std::uint32_t kMaxPacketWork = 200;
/// After n failures in a row, n at most this, 2^n - 1 packets are traced as single rays.
inline constexpr std::size_t kMaxPacketBackoff = 4;

/// The schedules of one tree, by query and coherence.
class Schedules {
  public:
    Schedules() = default;
    /// `unbounded`: primitives outside the tree, ascending. `treeless`: TreelessPackets takes all
    /// others. `has_packets`: the kernels of the tree trace packets.
    Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
              std::span<const PrimitiveId> unbounded, bool treeless, bool has_packets);

    [[nodiscard]] Schedule closest(Coherence coherence) const {
        return closest_[static_cast<std::size_t>(coherence)];
    }
    [[nodiscard]] Schedule occluded(Coherence coherence) const {
        return occluded_[static_cast<std::size_t>(coherence)];
    }

  private:
    // [coherence]
    std::array<Schedule, 2> closest_{Schedule::Stream, Schedule::Stream};
    std::array<Schedule, 2> occluded_{Schedule::Stream, Schedule::Stream};
};

}  // namespace alhazen
