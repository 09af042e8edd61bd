/// The candidates of the rays of a packet in lanes, until they are resolved.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_CANDIDATES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_CANDIDATES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_CANDIDATES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_CANDIDATES_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/aggregates/wide_bvh/packets/packet_resolution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A row of places, by registers as wide as those that read it at once: what was stored by smaller
/// ones is waited for.
HWY_INLINE void set_places(const PacketFloats& bits, TrianglePlace (&places)[kPacketLanes]) {
    const LaneTag<float, kPacketLanes> d;
    const LaneTag<TrianglePlace, kPacketLanes> to;
    for (std::size_t i = 0; i < kParts<float, kPacketLanes>; ++i) {
        hn::Store(hn::BitCast(to, bits.part[i]), to, places + i * hn::Lanes(d));
    }
}
HWY_INLINE void set_places(TrianglePlace place, TrianglePlace (&places)[kPacketLanes]) {
    set_places(PacketFloats(std::bit_cast<float>(place)), places);
}

/// The candidates of the rays of a packet. Most rays have one: it is kept in lanes, further ones in
/// a list.
class LaneCandidates {
  public:
    HWY_INLINE LaneCandidates() { store_lanes(PacketFloats(kNone), lo_); }

    /// Adds a triangle for the rays of `candidates`; a kept one beyond the s_max of its ray is
    /// replaced. False when the list is full: then nothing is done.
    [[nodiscard]] HWY_INLINE bool add(TrianglePlace place, std::uint32_t candidates,
                                      const PacketFloats& begin, const PacketFloats& s_max) {
        const PacketFloats lo = load_row(lo_), none(kNone);
        // A NaN goes to the list, where it is never replaced. Every s_max is less than kNone.
        const PacketMask keep =
            lanes_of_bits<float, kPacketLanes>(candidates) & (begin < none) & (lo > s_max);
        const std::uint32_t rest = candidates & ~bits_of(keep);
        if (HWY_UNLIKELY(rest != 0)) {
            if (overflow_count_ == kMaxOverflow) return false;
            Overflow& overflow = overflow_[overflow_count_++];
            store_lanes(begin, overflow.lo);
            overflow.lanes = rest;
            overflow.place = place;
        }
        store_lanes(select_lanes(keep, begin, lo), lo_);
        store_lanes(select_lanes(keep, PacketFloats(std::bit_cast<float>(place)), load_row(place_)),
                    place_);
        return true;
    }

    /// Calls `resolve(lanes, places)` for the candidates up to `s_max`, or only those of the list,
    /// and drops them.
    template <class Resolve>
    HWY_INLINE void take_all(const PacketRow& s_max, Resolve&& resolve) {
        const PacketFloats lo = load_row(lo_);
        const std::uint32_t lanes = bits_of((lo < PacketFloats(kNone)) & (lo <= load_row(s_max)));
        if (lanes != 0) {
            alignas(64) TrianglePlace places[kPacketLanes];
            set_places(load_row(place_), places);
            resolve(lanes, places);
        }
        store_lanes(PacketFloats(kNone), lo_);
        take_overflow(s_max, resolve);
    }
    template <class Resolve>
    HWY_INLINE void take_overflow(const PacketRow& s_max, Resolve&& resolve) {
        for (std::size_t n = 0; n < overflow_count_; ++n) {
            const Overflow& b = overflow_[n];
            // Written so that a NaN is not passed over.
            const std::uint32_t lanes = b.lanes & ~bits_of(load_row(b.lo) > load_row(s_max));
            if (lanes == 0) continue;
            alignas(64) TrianglePlace places[kPacketLanes];
            set_places(b.place, places);
            resolve(lanes, places);
        }
        overflow_count_ = 0;
    }

  private:
    static constexpr float kNone = std::numeric_limits<float>::infinity();
    static constexpr std::size_t kMaxOverflow = 16;
    struct alignas(64) Overflow {
        PacketRow lo;
        std::uint32_t lanes;
        TrianglePlace place;
    };
    alignas(64) PacketRow lo_;     ///< kNone: none
    alignas(64) PacketRow place_;  ///< bits of a TrianglePlace
    std::size_t overflow_count_ = 0;
    Overflow overflow_[kMaxOverflow];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
