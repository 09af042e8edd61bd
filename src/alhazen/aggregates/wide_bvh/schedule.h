#pragma once
/// The schedule of a batch of rays in the wide BVH, and the thresholds of its choice. The geometric
/// conditions of a packet: accel/wide_bvh/trace/packet-inl.h.
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
    Stream,           ///< several interleaved (accel/wide_bvh/trace/sorted_stream-inl.h)
    Packets,          ///< packets of coherent rays; rays in no packet one by one
    TreelessPackets,  ///< lanes of rays against every primitive (treeless_packets.h)
};

/// Largest number of primitives of a tree that treeless packets replace (docs/log/wide_bvh.md).
inline constexpr std::size_t kMaxTreelessPrimitives = 4;

/// Smallest number of rays of a lane packet (lane_queries-inl.h) in a subtree; fewer continue one
/// by one.
inline constexpr int kMinPacketLanes = 3;
/// The same for closest hits in trees whose rays do not wait for memory.
inline constexpr int kMinClosestLanes = 2;
/// Largest number of registers of sixteen floats for which lane packets trace closest hits. With
/// more, frustum packets are faster; any-hit queries always use lane packets.
inline constexpr std::size_t kMostLaneRegisters = 2;
/// Smallest ratio of leaf blocks with a test in lanes to those tested ray by ray.
inline constexpr std::size_t kLanePrimitivesPerScalar = 64;

/// The traversal of coherent rays.
enum class CoherentTraversal {
    Lanes,   ///< lane packets (lane_queries-inl.h)
    Frusta,  ///< frustum packets (packet_queries-inl.h), given up if they exceed PacketWork::most
    Alone,   ///< no packets
};

/// The traversal of a tree whose schedule is Packets. `registers`: of sixteen floats. Lane packets
/// test solids and algebraic surfaces ray by ray, frustum packets eight rays at a time; with fused
/// instructions lane packets test cylinders and cones eight rays at a time, else both test them ray
/// by ray. `others_alone`: see Schedules.
[[nodiscard]] inline CoherentTraversal coherent_traversal(const WideBvhLayout& layout, bool any_hit,
                                                          std::size_t registers,
                                                          bool others_alone = false) {
    if (!layout.others.empty() && !others_alone) return CoherentTraversal::Frusta;
    if (registers <= kMostLaneRegisters) return CoherentTraversal::Lanes;
    const std::size_t lanes = layout.triangles.size() + layout.spheres.size();
    const std::size_t scalars = layout.frustums.size() + layout.others.size();
    // Shadow rays end early: packets gain nothing where two fifths of the blocks are scalar.
    if (any_hit) {
        return 3 * scalars <= 2 * lanes ? CoherentTraversal::Lanes : CoherentTraversal::Alone;
    }
    return kLanePrimitivesPerScalar * scalars <= lanes ? CoherentTraversal::Frusta
                                                       : CoherentTraversal::Alone;
}
/// Smallest number of rays of a frustum packet: fewer are no faster than single rays.
inline constexpr std::uint32_t kMinPacketRays = 16;
/// Work of a frustum packet: 2 per node, 4 per leaf block, 1 per triangle and group of rays, 3 more
/// if the finer filter decides, and `shape` per shape and group of rays. A unit is about 50
/// instructions.
struct PacketWork {
    std::uint32_t shape;
    /// Work per ray from which on single rays are as fast. A packet with more is a failure.
    std::uint32_t fair;
    std::uint32_t most;  ///< work per ray at which the packet is abandoned
};
inline constexpr PacketWork kClosestPacketWork = {6, 14, 20};
/// Single any-hit rays end early.
inline constexpr PacketWork kOccludedPacketWork = {12, 10, 14};
/// After n failures in a row, n at most this value, 2^n - 1 packets are skipped.
inline constexpr std::uint32_t kMaxPacketBackoff = 4;
/// Largest tree whose coherent rays in no packet, or left over from one in lanes, are traced one by
/// one, bytes. The stream hides the latency of memory; a tree in the caches has little, and
/// neighbouring rays predict each other's branches.
inline constexpr std::size_t kMaxSingleTreeBytes = std::size_t{64} << 20;
/// The same for rays that are not coherent, unless most blocks hold triangles: batches take the
/// stream in such trees of any size. It is not so much faster in small ones that rays which come
/// one by one are worth gathering.
inline constexpr std::size_t kMaxIncoherentSingleBytes = std::size_t{1} << 20;
/// The same for trees of round shapes: a branch on what their filter finds waits long for it where
/// one ray is traced at a time.
inline constexpr std::size_t kMaxRoundSingleBytes = std::size_t{16} << 10;
/// Size of a tree up to which incoherent rays are traced one by one, bytes.
[[nodiscard]] std::size_t most_single_bytes(const WideBvhLayout& layout);
/// Smallest number of coherent rays in no packet for the stream.
inline constexpr std::size_t kMinStreamRays = 16;
/// Smallest number of rays of a batch for the stream in trees up to kMaxSingleTreeBytes.
inline constexpr std::size_t kMinStreamBatch = 8;

/// The schedules of one tree, by coherence.
class Schedules {
  public:
    Schedules() = default;
    /// `unbounded`: primitives outside the tree, ascending. `treeless`: TreelessPackets traces all
    /// others. `has_packets`: the kernels of the tree trace packets.
    Schedules(const PrimitiveTable& table, const WideBvhLayout& layout,
              std::span<const PrimitiveId> unbounded, bool treeless, bool has_packets);

    [[nodiscard]] Schedule of_batch(Coherence coherence) const {
        return batches_[static_cast<std::size_t>(coherence)];
    }
    /// The same for a batch of `count` rays: few are not worth a stream.
    [[nodiscard]] Schedule of_batch(Coherence coherence, std::size_t count) const {
        const Schedule schedule = of_batch(coherence);
        return schedule == Schedule::Stream && count < least_stream_ ? Schedule::Single : schedule;
    }
    /// Whether rays that come one by one are worth gathering.
    [[nodiscard]] bool gain_by_batches(Coherence coherence) const {
        return of_batch(coherence) != Schedule::Single &&
               (coherence == Coherence::Coherent || gathers_);
    }
    /// Whether rays that leave a packet in lanes wait for memory, one by one.
    [[nodiscard]] bool waits() const { return waits_; }
    /// Whether none of the shapes without a block of their own is an instance or has a packet test
    /// that counts (`takes_lanes`): frustum packets would gain nothing.
    [[nodiscard]] bool others_alone() const { return others_alone_; }

  private:
    std::array<Schedule, 2> batches_{Schedule::Stream, Schedule::Stream};  ///< [coherence]
    std::size_t least_stream_ = 0;  ///< least number of rays for the stream
    bool gathers_ = true, waits_ = false, others_alone_ = false;
};

}  // namespace alhazen
