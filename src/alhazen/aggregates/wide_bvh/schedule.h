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

/// Fewest rays of a packet in lanes (lane_queries-inl.h) in a subtree: fewer go on one by one.
inline constexpr int kMinPacketLanes = 3;
/// Most registers that sixteen numbers may take where packets in lanes look for closest hits: with
/// four, eye rays by pyramids are a third faster, while any hit gains by lanes with four as well.
inline constexpr std::size_t kMostLaneRegisters = 2;
/// Fewest primitives with a test in lanes for each one without, where packets go as pyramids: the
/// others are tested ray by ray, and packets were slower among them.
inline constexpr std::size_t kLanePrimitivesPerScalar = 64;

/// How coherent rays go.
enum class CoherentRoad {
    Lanes,     ///< packets in lanes (lane_queries-inl.h)
    Pyramids,  ///< packets in beams (packet_queries-inl.h), by trial
    Alone,     ///< in no packet
};

/// The road of a tree whose schedule is Packets. `registers`: of sixteen floats. Lanes test solids
/// and algebraic surfaces ray by ray, where pyramids test them eight rays at a time; both test
/// cylinders, cones and discs ray by ray, and shadow rays, soon done, gain nothing where these are
/// half of the tree.
[[nodiscard]] inline CoherentRoad coherent_road(const WideBvhLayout& layout, bool any_hit,
                                                std::size_t registers) {
    if (!layout.others.empty()) return CoherentRoad::Pyramids;
    const std::size_t lanes = layout.triangles.size() + layout.spheres.size();
    const std::size_t scalars = layout.frustums.size();
    if (any_hit) return 3 * scalars <= 2 * lanes ? CoherentRoad::Lanes : CoherentRoad::Alone;
    if (registers <= kMostLaneRegisters) return CoherentRoad::Lanes;
    return kLanePrimitivesPerScalar * scalars <= lanes ? CoherentRoad::Pyramids
                                                       : CoherentRoad::Alone;
}
/// Fewest rays of a packet: fewer are no faster than single rays.
inline constexpr std::uint32_t kMinPacketRays = 16;
/// Work of a packet: 2 a node, 4 a leaf block, 1 a triangle and group of rays, 3 more where the
/// finer filter decides, and so much for a shape and group of rays. A unit is about 50
/// instructions.
struct PacketWork {
    std::uint32_t shape;
    /// For each ray: from here on the rays are as fast one by one. A packet that took more counts
    /// as a failure.
    std::uint32_t fair;
    std::uint32_t most;  ///< for each ray; then the packet gives up
};
inline constexpr PacketWork kClosestPacketWork = {6, 14, 20};
/// A single ray that may end at any hit is soon done.
inline constexpr PacketWork kOccludedPacketWork = {12, 10, 14};
/// After n failures in a row, n at most this, 2^n - 1 packets are not tried.
inline constexpr std::uint32_t kMaxPacketBackoff = 4;
/// Largest tree whose coherent rays in no packet are traced one by one, bytes. The stream hides the
/// latency of memory; a tree in the caches has little, and neighbouring rays predict each other's
/// branches. Single eye rays are 5 to 10 % faster than the stream's, shadow rays 25 %.
inline constexpr std::size_t kMaxSingleTreeBytes = std::size_t{64} << 20;
/// The same of rays that are not coherent.
inline constexpr std::size_t kMaxIncoherentSingleBytes = std::size_t{1} << 20;
/// Fewest rays for the stream.
inline constexpr std::size_t kMinStreamRays = 16;

/// The schedules of one tree, by coherence.
class Schedules {
  public:
    Schedules() = default;
    /// `unbounded`: primitives outside the tree, ascending. `treeless`: TreelessPackets takes all
    /// others. `has_packets`: the kernels of the tree trace packets.
    Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
              std::span<const PrimitiveId> unbounded, bool treeless, bool has_packets);

    [[nodiscard]] Schedule of_batch(Coherence coherence) const {
        return batches_[static_cast<std::size_t>(coherence)];
    }

  private:
    std::array<Schedule, 2> batches_{Schedule::Stream, Schedule::Stream};  ///< [coherence]
};

}  // namespace alhazen
