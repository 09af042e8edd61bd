/// The candidates of the rays of a frustum packet, until they are resolved (candidate_queue-inl.h).
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_CANDIDATES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_CANDIDATES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_CANDIDATES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_PACKET_CANDIDATES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/packet-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_resolution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The candidates of the rays of a packet: one per ray in lanes, further ones in a list.
class PacketCandidates {
  public:
    static constexpr float kNone = std::numeric_limits<float>::infinity();

    HWY_INLINE explicit PacketCandidates(const RayPacket& packet) : packet_(packet) {
        const GroupFloats none(kNone);
        for (std::size_t g = 0; g < packet.group_count; ++g) store_lanes(none, kept_[g].lo);
    }

    /// Adds a triangle for the rays of `candidates`; replaces a kept one beyond the s_max of its
    /// ray. False, without effect, if the list is full.
    [[nodiscard]] HWY_INLINE bool add(std::size_t g, TrianglePlace place,
                                      const LaneMask<float, kGroupRays>& candidates,
                                      const GroupFloats& begin) {
        const RayGroup& group = packet_.groups[g];
        Kept& kept = kept_[g];
        const GroupFloats lo = load_lanes<kGroupRays>(kept.lo), none(kNone);
        // A NaN goes to the list, which never replaces it.
        const auto keep = candidates & (begin < none) &
                          ((lo > load_lanes<kGroupRays>(group.s_max)) | (lo >= none));
        const std::uint32_t rest = bits_of(candidates) & ~bits_of(keep) & group.used;
        if (HWY_UNLIKELY(rest != 0)) {
            if (overflow_count_ == kMaxOverflow) return false;
            Overflow& overflow = overflow_[overflow_count_++];
            store_lanes(begin, overflow.lo);
            overflow.group = static_cast<std::uint32_t>(g);
            overflow.lanes = rest;
            overflow.place = place;
        }
        store_lanes(select_lanes(keep, begin, lo), kept.lo);
        store_lanes(select_lanes(keep, GroupFloats(std::bit_cast<float>(place)),
                                 load_lanes<kGroupRays>(kept.place)),
                    kept.place);
        return true;
    }

    /// Calls `resolve(g, lanes, places)` for all candidates (take_overflow: only those of the list)
    /// and removes them.
    template <class Resolve>
    HWY_INLINE void take_all(Resolve&& resolve) {
        for (std::size_t g = 0; g < packet_.group_count; ++g) {
            const RayGroup& group = packet_.groups[g];
            const GroupFloats lo = load_lanes<kGroupRays>(kept_[g].lo);
            const std::uint32_t lanes =
                bits_of((lo < GroupFloats(kNone)) & (lo <= load_lanes<kGroupRays>(group.s_max))) &
                group.used;
            if (lanes == 0) continue;
            TrianglePlace places[kGroupRays];
            std::memcpy(places, kept_[g].place, sizeof(places));
            resolve(g, lanes, places);
            store_lanes(GroupFloats(kNone), kept_[g].lo);
        }
        take_overflow(resolve);
    }
    template <class Resolve>
    HWY_INLINE void take_overflow(Resolve&& resolve) {
        for (std::size_t n = 0; n < overflow_count_; ++n) {
            const Overflow& b = overflow_[n];
            const RayGroup& group = packet_.groups[b.group];
            // Written so that NaN is resolved.
            const std::uint32_t beyond =
                bits_of(load_lanes<kGroupRays>(b.lo) > load_lanes<kGroupRays>(group.s_max));
            const std::uint32_t lanes = b.lanes & group.used & ~beyond;
            if (lanes == 0) continue;
            TrianglePlace places[kGroupRays];
            for (TrianglePlace& place : places) place = b.place;
            resolve(b.group, lanes, places);
        }
        overflow_count_ = 0;
    }

  private:
    static constexpr std::size_t kMaxOverflow = 16;
    struct alignas(64) Kept {
        GroupRow lo;     ///< kNone for no candidate
        GroupRow place;  ///< bits of a TrianglePlace
    };
    struct alignas(64) Overflow {
        GroupRow lo;
        std::uint32_t group, lanes;
        TrianglePlace place;
    };
    const RayPacket& packet_;
    Kept kept_[kPacketGroups];
    std::size_t overflow_count_ = 0;
    Overflow overflow_[kMaxOverflow];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
