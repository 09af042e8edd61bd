/// The nearest hits of the rays of a packet in lanes while it is traced, and where they are written
/// when it is done: once, whether rays hit or not.
///
/// Conventions: included once per target (see simd/lanes-inl.h). Ties are decided as by `wins`
/// (primitives/nearest_hit.h). Sets of rays are bits.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_HITS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_HITS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_PACKETS_LANE_HITS_INL_H_
#endif

#include <hwy/cache_control.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "alhazen/accel/wide_bvh/trace/lane_packet-inl.h"
#include "alhazen/geometry/hit.h"
#include "alhazen/geometry/ray_columns.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

class LaneHits {
  public:
    /// No hit. Not defaulted: see FilteredLanes.
    HWY_INLINE LaneHits() {
        fill(t_, std::numeric_limits<double>::infinity());
        fill(u_, 0.0);
        fill(v_, 0.0);
        fill(id_, static_cast<std::uint32_t>(kNoPrimitive));
        fill(part_, std::uint32_t{0});
    }

    [[nodiscard]] HWY_INLINE double t(std::size_t i) const { return t_[i]; }
    [[nodiscard]] HWY_INLINE PrimitiveId id(std::size_t i) const { return PrimitiveId{id_[i]}; }
    /// Rays that hit something before.
    [[nodiscard]] HWY_INLINE std::uint32_t earlier() const { return earlier_; }
    HWY_INLINE void set_earlier(std::size_t i, const Hit& hit) {
        earlier_ |= 1u << i;
        t_[i] = hit.t;
        id_[i] = static_cast<std::uint32_t>(hit.top());
    }

    [[nodiscard]] HWY_INLINE bool wins(std::size_t i, double t, PrimitiveId id) const {
        return t < t_[i] || (t == t_[i] && id < PrimitiveId{id_[i]});
    }
    HWY_INLINE void offer(std::size_t i, PrimitiveId id, const ShapeHit& hit) {
        if (!wins(i, hit.t, id)) return;
        changed_ |= 1u << i;
        t_[i] = hit.t;
        u_[i] = hit.u;
        v_[i] = hit.v;
        part_[i] = hit.part;
        id_[i] = static_cast<std::uint32_t>(id);
    }
    /// The same for the rays `lanes` of the n-th N, with triangles; `id` has bits of PrimitiveId.
    template <std::size_t N>
    HWY_INLINE void offer_triangles(std::size_t n, std::uint32_t lanes, const Lanes<float, N>& id,
                                    const double (&t)[N], const double (&u)[N],
                                    const double (&v)[N]) {
        const std::size_t at = n * N;
        const Lanes<double, N> offered = load_lanes<N>(t), best = load_lanes<N>(t_ + at);
        std::uint32_t won = lanes & bits_of(offered < best);
        std::uint32_t tied = lanes & ~won & bits_of(offered <= best);
        if (HWY_UNLIKELY(tied != 0)) {
            alignas(64) float ids[N];
            store_lanes(id, ids);
            for (; tied != 0; tied &= tied - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(tied));
                if (std::bit_cast<std::uint32_t>(ids[i]) < id_[at + i]) won |= 1u << i;
            }
        }
        changed_ |= won << at;
        const auto wide = lanes_of_bits<double, N>(won);
        const auto put = [&](const Lanes<double, N>& values, double* row) HWY_ATTR {
            store_lanes(select_lanes(wide, values, load_lanes<N>(row + at)), row + at);
        };
        put(offered, t_);
        put(load_lanes<N>(u), u_);
        put(load_lanes<N>(v), v_);
        const auto narrow = lanes_of_bits<float, N>(won);
        const auto put_bits = [&](const Lanes<float, N>& bits, std::uint32_t* row) HWY_ATTR {
            if constexpr (kPlain) {
                alignas(64) float values[N];
                store_lanes(bits, values);
                for (std::size_t i = 0; i < N; ++i) {
                    if ((won >> i & 1) != 0) row[at + i] = std::bit_cast<std::uint32_t>(values[i]);
                }
            } else {
                float* const to = reinterpret_cast<float*>(row) + at;
                store_lanes(select_lanes(narrow, bits, load_lanes<N>(to)), to);
            }
        };
        put_bits(id, id_);
        put_bits(Lanes<float, N>(0.0f), part_);
    }

    /// Writes the hits of the first rays: all of them, or those that are new.
    HWY_INLINE void write(std::span<Hit> hits, bool all) const {
        const std::uint32_t count = static_cast<std::uint32_t>(hits.size());
        const std::uint32_t every = count == 32 ? ~0u : (1u << count) - 1;
        if (HWY_LIKELY(all)) {
            if (changed_ == 0) return write_none(hits);
            std::size_t i = 0;
#if HWY_CAP_GE256
            if constexpr (kIdFollowsPart) {
                for (; i + 4 <= count; i += 4) write_four(i, &hits[i]);
            }
#endif
            for (; i < count; ++i) write(i, hits[i]);
            return;
        }
        for (std::uint32_t rest = changed_ & every; rest != 0; rest &= rest - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(rest));
            write(i, hits[i]);
        }
    }
    HWY_INLINE void write(const HitColumns& columns, std::size_t first, std::size_t count) const {
        copy(t_, columns.t, first, count);
        copy(u_, columns.u, first, count);
        copy(v_, columns.v, first, count);
        copy(id_, columns.primitive, first, count);
    }

  private:
    /// Loads and stores of plain C++ may not take one type for another.
    static constexpr bool kPlain = HWY_TARGET == HWY_SCALAR;

    template <class T>
    using Row = T[kPacketLanes];
    template <class T>
    using Tag = LaneTag<T, kPacketLanes>;

    template <class T>
    static HWY_INLINE void fill(Row<T>& row, T value) {
        const Tag<T> d;
        HWY_UNROLL(8)
        for (std::size_t i = 0; i < kPacketLanes; i += hn::Lanes(d)) {
            hn::Store(hn::Set(d, value), d, row + i);
        }
    }
    template <class T, class Number>
    static HWY_INLINE void copy(const Row<T>& row, std::span<Number> column, std::size_t first,
                                std::size_t count) {
        if (column.empty()) return;
        Number* const to = &column[first];
        if (kPlain || HWY_UNLIKELY(count < kPacketLanes)) {
            for (std::size_t i = 0; i < count; ++i) to[i] = Number{row[i]};
            return;
        }
        const Tag<T> d;
        HWY_UNROLL(8)
        for (std::size_t i = 0; i < kPacketLanes; i += hn::Lanes(d)) {
            hn::StoreU(hn::Load(d, row + i), d, reinterpret_cast<T*>(to) + i);
        }
    }
#if HWY_CAP_GE256
    // The layout of a class with a base is the compiler's business.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"
    static constexpr bool kIdFollowsPart = offsetof(Hit, t) == 0 && offsetof(Hit, u) == 8 &&
                                           offsetof(Hit, v) == 16 && offsetof(Hit, part) == 24 &&
                                           offsetof(Hit, primitive) == 28;
#pragma GCC diagnostic pop
    using FourNumbers = hn::Vec<hn::CappedTag<double, 4>>;

    /// Writes t, u, v, and part and id in the place of a fourth number, by one store.
    static HWY_INLINE void put(const FourNumbers& numbers, Hit& hit) {
        hn::StoreU(numbers, hn::CappedTag<double, 4>(), &hit.t);
        hit.path.clear();
    }
    HWY_INLINE void write_four(std::size_t i, Hit* hits) const {
        const hn::CappedTag<double, 4> d;
        const hn::CappedTag<double, 2> half;
        const hn::CappedTag<std::uint32_t, 4> narrow;
        const auto t = hn::Load(d, t_ + i), u = hn::Load(d, u_ + i), v = hn::Load(d, v_ + i);
        const auto part = hn::Load(narrow, part_ + i), id = hn::Load(narrow, id_ + i);
        const auto last = hn::Combine(d, hn::BitCast(half, hn::InterleaveUpper(narrow, part, id)),
                                      hn::BitCast(half, hn::InterleaveLower(narrow, part, id)));
        const auto tu_even = hn::InterleaveLower(d, t, u), tu_odd = hn::InterleaveUpper(d, t, u);
        const auto vl_even = hn::InterleaveLower(d, v, last);
        const auto vl_odd = hn::InterleaveUpper(d, v, last);
        put(hn::ConcatLowerLower(d, vl_even, tu_even), hits[0]);
        put(hn::ConcatLowerLower(d, vl_odd, tu_odd), hits[1]);
        put(hn::ConcatUpperUpper(d, vl_even, tu_even), hits[2]);
        put(hn::ConcatUpperUpper(d, vl_odd, tu_odd), hits[3]);
    }
#endif
    /// As the rest, but no ray has a hit.
    static HWY_INLINE void write_none(std::span<Hit> hits) {
#if HWY_CAP_GE256
        if constexpr (kIdFollowsPart) {
            constexpr std::uint64_t id = static_cast<std::uint32_t>(kNoPrimitive);
            HWY_ALIGN static constexpr std::uint64_t kNone[4] = {
                std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity()), 0, 0,
                id << 32};
            const hn::CappedTag<std::uint64_t, 4> d;
            const FourNumbers none = hn::BitCast(hn::CappedTag<double, 4>(), hn::Load(d, kNone));
            for (Hit& hit : hits) put(none, hit);
            return;
        }
#endif
        for (Hit& hit : hits) {
            static_cast<ShapeHit&>(hit) = {std::numeric_limits<double>::infinity(), 0, 0, 0};
            hit.primitive = kNoPrimitive;
            hit.path.clear();
        }
    }
    HWY_INLINE void write(std::size_t i, Hit& hit) const {
        hit.t = t_[i];
        hit.u = u_[i];
        hit.v = v_[i];
        hit.part = part_[i];
        hit.primitive = PrimitiveId{id_[i]};
        hit.path.clear();
    }

    alignas(64) Row<double> t_, u_, v_;
    alignas(64) Row<std::uint32_t> id_, part_;
    std::uint32_t earlier_ = 0, changed_ = 0;
};

/// Writes to an array of hits. If `unset` these are of no account, else they limit the search.
struct HitArraySink {
    std::span<Hit> hits;
    bool unset;

    HWY_INLINE std::uint32_t begin(std::size_t first, std::size_t count, LaneHits& found) const {
        // They lie far apart, and are written when the packet is done.
        if (HWY_LIKELY(count == kPacketLanes)) {
            HWY_UNROLL(32)
            for (std::size_t i = 0; i < kPacketLanes; ++i) hwy::Prefetch(&hits[first + i]);
        }
        for (std::size_t i = 0; i < count && !unset; ++i) {
            if (hits[first + i].found()) found.set_earlier(i, hits[first + i]);
        }
        return ~0u >> (32 - count);
    }
    HWY_INLINE void end(std::size_t first, std::size_t count, const LaneHits& found) const {
        found.write(hits.subspan(first, count), unset);
    }
};

HWY_INLINE void clear_unset(const HitArraySink& sink, std::size_t first, std::size_t count) {
    if (!sink.unset) return;
    for (Hit& hit : sink.hits.subspan(first, count)) hit = Hit{};
}

/// Writes to columns of hits.
struct HitColumnsSink {
    const HitColumns& columns;

    HWY_INLINE std::uint32_t begin(std::size_t, std::size_t count, LaneHits&) const {
        return ~0u >> (32 - count);
    }
    HWY_INLINE void end(std::size_t first, std::size_t count, const LaneHits& found) const {
        found.write(columns, first, count);
    }
};

/// Bits of the rays of a packet that are occluded.
struct LaneOcclusion {
    std::uint32_t hit = 0;
};

/// Whether rays are occluded; those that are already are not traced.
struct OcclusionSink {
    std::span<bool> occluded;

    HWY_INLINE std::uint32_t begin(std::size_t first, std::size_t count, LaneOcclusion&) const {
        if (kWhole && HWY_LIKELY(count == kPacketLanes)) return unset_of_all(&occluded[first]);
        std::uint32_t wanted = 0;
        for (std::size_t i = 0; i < count; ++i) wanted |= std::uint32_t{!occluded[first + i]} << i;
        return wanted;
    }
    HWY_INLINE void end(std::size_t first, std::size_t count, const LaneOcclusion& found) const {
        if (kWhole && HWY_LIKELY(count == kPacketLanes)) {
            return set_of_all(found.hit, &occluded[first]);
        }
        for (std::size_t i = 0; i < count; ++i) {
            occluded[first + i] = occluded[first + i] || (found.hit >> i & 1) != 0;
        }
    }

  private:
    /// A bool is a byte, 0 or 1, of which a register holds as many as a packet has rays.
    using Tag = hn::CappedTag<std::uint8_t, kPacketLanes>;
    static constexpr bool kWhole = hn::MaxLanes(Tag()) == kPacketLanes &&
                                   std::endian::native == std::endian::little && sizeof(bool) == 1;

    static HWY_INLINE std::uint32_t unset_of_all(const bool* place) {
        const Tag d;
        const auto bytes = hn::LoadU(d, reinterpret_cast<const std::uint8_t*>(place));
        std::uint8_t bits[8] = {};  // as in bits_of
        hn::StoreMaskBits(d, hn::Eq(bytes, hn::Zero(d)), bits);
        std::uint32_t unset;
        std::memcpy(&unset, bits, sizeof(unset));
        return unset;
    }
    static HWY_INLINE void set_of_all(std::uint32_t hit, bool* place) {
        const Tag d;
        std::uint8_t bits[8] = {};
        std::memcpy(bits, &hit, sizeof(hit));
        std::uint8_t* const bytes = reinterpret_cast<std::uint8_t*>(place);
        const auto set = hn::IfThenElseZero(hn::LoadMaskBits(d, bits), hn::Set(d, 1));
        hn::StoreU(hn::Or(hn::LoadU(d, bytes), set), d, bytes);
    }
};
HWY_INLINE void clear_unset(const OcclusionSink&, std::size_t, std::size_t) {}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
