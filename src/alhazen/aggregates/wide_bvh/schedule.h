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
/// than one ray takes through the tree (docs/log/wide_bvh.md).
inline constexpr std::size_t kMaxTreelessPrimitives = 4;

/// Fewest rays of a lane packet (lane_queries-inl.h) in a subtree; fewer continue one by one.
inline constexpr int kMinPacketLanes = 3;
/// Most registers of sixteen floats with which lane packets look for closest hits. With more,
/// frustum packets are faster; for any hit lane packets always are.
inline constexpr std::size_t kMostLaneRegisters = 2;
/// Fewest leaf blocks with a test in lanes for each one without. The latter are tested ray by ray.
inline constexpr std::size_t kLanePrimitivesPerScalar = 64;

/// The traversal of coherent rays.
enum class CoherentTraversal {
    Lanes,   ///< lane packets (lane_queries-inl.h)
    Frusta,  ///< frustum packets (packet_queries-inl.h), given up where they fail
    Alone,   ///< no packets
};

/// The traversal of a tree whose schedule is Packets. `registers`: of sixteen floats. Lane packets
/// test solids and algebraic surfaces ray by ray, frustum packets eight rays at a time; both test
/// cylinders, cones and discs ray by ray.
[[nodiscard]] inline CoherentTraversal coherent_traversal(const WideBvhLayout& layout, bool any_hit,
                                                          std::size_t registers) {
    if (!layout.others.empty()) return CoherentTraversal::Frusta;
    const std::size_t lanes = layout.triangles.size() + layout.spheres.size();
    const std::size_t scalars = layout.frustums.size();
    // Shadow rays end early: packets gain nothing where two fifths of the blocks are scalar.
    if (any_hit) {
        return 3 * scalars <= 2 * lanes ? CoherentTraversal::Lanes : CoherentTraversal::Alone;
    }
    if (registers <= kMostLaneRegisters) return CoherentTraversal::Lanes;
    return kLanePrimitivesPerScalar * scalars <= lanes ? CoherentTraversal::Frusta
                                                       : CoherentTraversal::Alone;
}
/// Fewest rays of a packet: fewer are no faster than single rays.
inline constexpr std::uint32_t kMinPacketRays = 16;
/// Work of a packet: 2 a node, 4 a leaf block, 1 a triangle and group of rays, 3 more where the
/// finer filter decides, and `shape` for a shape and a group of rays. A unit is about 50
/// instructions.
struct PacketWork {
    std::uint32_t shape;
    /// Work per ray from which on single rays are as fast. A packet with more counts as a failure.
    std::uint32_t fair;
    std::uint32_t most;  ///< work per ray at which the packet is given up
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
