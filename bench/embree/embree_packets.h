#pragma once
/// A ray set in the form that rtcIntersect1/4/8/16 and rtcOccluded1/4/8/16 take, prepared before
/// timing starts.
/// Conventions: rays fill packets in order; unused lanes of the last packet are invalid. Denormal
/// numbers are flushed to zero while Embree traces, as its manual recommends.

#include <embree3/rtcore.h>

#include <array>
#include <limits>
#include <memory>

#include "kernel_rays.h"

namespace alhazen::bench {

inline constexpr std::array<int, 4> kPacketWidths{1, 4, 8, 16};

class EmbreePackets {
  public:
    virtual ~EmbreePackets() = default;
    /// Restores the rays to their state before tracing.
    virtual void reset() = 0;
    /// Traces all rays; `coherent` sets the context's flag.
    virtual void trace(RTCScene scene, bool coherent) = 0;
    /// Result of the last trace for ray i: t, infinite for a miss and 0 for any hit.
    static constexpr float kMiss = std::numeric_limits<float>::infinity();
    [[nodiscard]] virtual float t(std::size_t i) const = 0;
    [[nodiscard]] virtual std::size_t count_hits() const = 0;
};

/// `width` is one of kPacketWidths.
[[nodiscard]] std::unique_ptr<EmbreePackets> make_embree_packets(const RaySet& set, int width);

}  // namespace alhazen::bench
