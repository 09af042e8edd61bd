/// Rays of a batch prepared sixteen at a time, in lanes, and tested against the root's children.
///
/// Conventions: included once per target (see simd/lanes-inl.h). Every number has the bits that
/// `make_ray` and `make_triangle_filter_ray` give.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_RECORDS_INL_H_
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/given_rays-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// A ray prepared for nodes and for triangles.
struct RayRecord {
    SlabRay slabs;
    TriangleFilterRay filter;
};

/// A ray of a batch with its record.
struct PreparedRay {
    const Ray& ray;
    const RayRecord& record;
};

/// Sixteen records.
class RayRecords {
  public:
    static constexpr std::size_t kRays = 16;
    /// False where sixteen numbers are more than two registers.
    static constexpr bool kSupported = kParts<float, kRays> <= 2;

    RayRecords() = default;
    RayRecords(const RayRecords&) = delete;
    RayRecords& operator=(const RayRecords&) = delete;

    /// Prepares those from `first` on. Returns the bits of the rays that are prepared: those that
    /// `make_ray_nearby` accepts, except a few. `bound`: as in `make_ray`. `missed`: set to the
    /// bits of those that meet no child of the root; 0 if that is null.
    template <std::size_t W>
    HWY_INLINE std::uint32_t prepare(const LaneFrame& frame, const DistanceBound& bound,
                                     const GivenRays& rays, std::size_t first,
                                     const WideNodeOf<W>* root, std::uint32_t& missed);

    [[nodiscard]] HWY_INLINE const RayRecord& operator[](std::size_t i) const { return ray_[i]; }
    /// Whether it is known where rays enter the children of the root.
    template <std::size_t W>
    static constexpr bool kHasEntries = kSupported&& W == kLaneCount;
    /// Where ray i enters the children of the root, infinity where it does not. Precondition: the
    /// root was given, and the ray does not miss it.
    [[nodiscard]] HWY_INLINE const float (&entries(std::size_t i) const)[kLaneCount] {
        return entry_[i];
    }

  private:
    using F = Lanes<float, kRays>;

    /// As SlabRay.
    struct InLanes {
        F reciprocal[3], near_offset[3], far_offset[3], s_min, s_max;
        LaneMask<float, kRays> negative[3];  ///< components of the direction

        // Not defaulted, as for LaneMask.
        HWY_INLINE InLanes() {}
    };

    /// Stores row k of eight as number k of ray i at place(i).
    template <class Place>
    static HWY_INLINE void store_eight(const F* rows, Place&& place);
    /// Stores row k as number k of each ray. `Part`: SlabRay or TriangleFilterRay, sixteen numbers.
    template <class Part>
    HWY_INLINE void store(const F (&rows)[16], Part RayRecord::*part);
    /// Bits of the rays that meet the box of a child. Sets `entry_` if kHasEntries.
    template <std::size_t W>
    [[nodiscard]] HWY_INLINE std::uint32_t meet(const InLanes& ray, const WideNodeOf<W>& node);

    RayRecord ray_[kRays];
    alignas(32) float entry_[kRays][kLaneCount];
};

template <class Place>
HWY_INLINE void RayRecords::store_eight(const F* rows, Place&& place) {
#if HWY_CAP_GE512
    const hn::CappedTag<float, 8> eight;
    hn::Vec<hn::CappedTag<float, 16>> columns[8];
    HWY_UNROLL(8)
    for (std::size_t k = 0; k < 8; ++k) columns[k] = rows[k].part[0];
    transpose_blocks(columns);
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < 8; ++i) {
        hn::Store(hn::LowerHalf(eight, columns[i]), eight, place(i));
        hn::Store(hn::UpperHalf(eight, columns[i]), eight, place(8 + i));
    }
#elif HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to interleave
    if constexpr (kSupported) {
        const LaneTag<float, kRays> d;
        const hn::Repartition<double, LaneTag<float, kRays>> pairs;
        HWY_UNROLL(2)
        for (std::size_t part8 = 0; part8 < 2; ++part8) {
            hn::Vec<LaneTag<float, kRays>> quads[2][4];
            HWY_UNROLL(2)
            for (std::size_t h = 0; h < 2; ++h) {
                const F* const r = rows + 4 * h;
                const auto in_pairs = [&](std::size_t a, std::size_t b, bool upper) HWY_ATTR {
                    const auto x = r[a].part[part8], y = r[b].part[part8];
                    return hn::BitCast(
                        pairs, upper ? hn::InterleaveUpper(d, x, y) : hn::InterleaveLower(d, x, y));
                };
                const auto l01 = in_pairs(0, 1, false), l23 = in_pairs(2, 3, false);
                const auto u01 = in_pairs(0, 1, true), u23 = in_pairs(2, 3, true);
                quads[h][0] = hn::BitCast(d, hn::InterleaveLower(pairs, l01, l23));
                quads[h][1] = hn::BitCast(d, hn::InterleaveUpper(pairs, l01, l23));
                quads[h][2] = hn::BitCast(d, hn::InterleaveLower(pairs, u01, u23));
                quads[h][3] = hn::BitCast(d, hn::InterleaveUpper(pairs, u01, u23));
            }
            HWY_UNROLL(4)
            for (std::size_t k = 0; k < 4; ++k) {
                hn::Store(hn::ConcatLowerLower(d, quads[1][k], quads[0][k]), d,
                          place(8 * part8 + k));
                hn::Store(hn::ConcatUpperUpper(d, quads[1][k], quads[0][k]), d,
                          place(8 * part8 + 4 + k));
            }
        }
    }
#endif
}

template <class Part>
HWY_INLINE void RayRecords::store(const F (&rows)[16], Part RayRecord::*part) {
    static_assert(sizeof(Part) == 16 * sizeof(float));
    HWY_UNROLL(2)
    for (std::size_t half = 0; half < 2; ++half) {
        store_eight(rows + 8 * half, [&](std::size_t ray) HWY_ATTR {
            return reinterpret_cast<float*>(&(ray_[ray].*part)) + 8 * half;
        });
    }
}

template <std::size_t W>
HWY_INLINE std::uint32_t RayRecords::prepare(const LaneFrame& frame, const DistanceBound& bound,
                                             const GivenRays& rays, std::size_t first,
                                             const WideNodeOf<W>* root, std::uint32_t& missed) {
    F local[8];
    load_local(frame, rays, first, local);
    const FrameSlack& slack = frame.frame.slack;
    const F(&origin)[8] = local;
    const F* const direction = local + 3;
    const F d0 = abs(direction[0]), d1 = abs(direction[1]), d2 = abs(direction[2]);
    const F o0 = abs(origin[0]), o1 = abs(origin[1]), o2 = abs(origin[2]);
    const F longest = max_lanes(max_lanes(d0, d1), d2);
    const F distance = max_lanes(max_lanes(o0, o1), o2);
    const F zero(0.0f), one(1.0f);
    // Sums propagate a NaN. Ends that are equal in float, or -0, may be out of order in double.
    const std::uint32_t prepared =
        bits_of((o0 + o1 + o2 <= F(8.0f)) & (d0 + d1 + d2 <= F(0x1p40f)) &
                (longest >= F(slack.least_length)) & (local[6] < local[7]) &
                (copysign(one, local[6]) > zero));

    InLanes ray;
    F slabs[16], filter[16];
    const F space = mul_add(distance, F(bound.slope), F(bound.constant));
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const F steep = copysign(larger_by_bits(abs(direction[k]), F(0x1p-100f)), direction[k]);
        const F reciprocal = one / steep;
        const F c = -(origin[k] * reciprocal);
        const F aside = space * abs(reciprocal);
        slabs[k] = ray.reciprocal[k] = reciprocal;
        slabs[4 + k] = ray.near_offset[k] = c - aside;
        slabs[8 + k] = ray.far_offset[k] = c + aside;
        ray.negative[k] = steep < zero;
    }
    slabs[3] = slabs[7] = slabs[11] = zero;
    const F begin = min_lanes(local[6], F(1e37f)), end = min_lanes(local[7], F(1e37f));
    const F step(0x1p-100f), more(1.0f + 0x1p-22f), less(1.0f - 0x1p-22f);
    slabs[12] = ray.s_min = max_lanes(mul_sub(begin, less, step), zero);
    slabs[13] = ray.s_max = max_lanes(mul_sub(end, more, -step), zero);
    // The two words of NearRows.
    const auto word = [](std::size_t octant, std::size_t which) {
        const auto words = std::bit_cast<std::array<std::uint32_t, 2>>(kNearRows[octant]);
        return F(std::bit_cast<float>(words[which]));
    };
    const auto &x_down = ray.negative[0], &y_down = ray.negative[1], &z_down = ray.negative[2];
    slabs[14] = select_lanes(x_down, select_lanes(y_down, word(3, 0), word(1, 0)),
                             select_lanes(y_down, word(2, 0), word(0, 0)));
    slabs[15] = select_lanes(z_down,
                             select_lanes(x_down, select_lanes(y_down, word(7, 1), word(5, 1)),
                                          select_lanes(y_down, word(6, 1), word(4, 1))),
                             select_lanes(x_down, select_lanes(y_down, word(3, 1), word(1, 1)),
                                          select_lanes(y_down, word(2, 1), word(0, 1))));
    store(slabs, &RayRecord::slabs);
    missed = root != nullptr ? prepared & ~meet(ray, *root) : 0;

    const auto along_x = d0 >= longest, along_y = d1 >= longest;
    const auto pick = [&](const F& x, const F& y, const F& z) HWY_ATTR {
        return select_lanes(along_x, x, select_lanes(along_y, y, z));
    };
    const auto index = [](std::uint32_t i) { return F(std::bit_cast<float>(i)); };
    const F sz = pick(slabs[0], slabs[1], slabs[2]);
    filter[0] = pick(origin[1], origin[2], origin[0]);
    filter[1] = pick(origin[2], origin[0], origin[1]);
    filter[2] = pick(origin[0], origin[1], origin[2]);
    filter[4] = pick(direction[1], direction[2], direction[0]) * sz;
    filter[5] = pick(direction[2], direction[0], direction[1]) * sz;
    filter[6] = sz;
    filter[8] = pick(index(1), index(2), index(0));
    filter[9] = pick(index(2), index(0), index(1));
    filter[10] = pick(index(0), index(1), index(2));
    constexpr float e = 0x1p-24f;
    const F delta = F(slack.delta.slope) * distance + F(slack.delta.constant);
    const F reach = F(slack.reach.slope) * distance + F(slack.reach.constant);
    const F four_delta = F(4.0f) * delta;
    const F error = F(13.2f * e) * reach + four_delta;
    filter[3] = F(5.12f) * error;
    filter[7] = F(2.12f) * error * error;
    filter[11] = (F(14.2f * e) * reach + four_delta) * abs(sz);
    filter[12] = mul_add(begin, more, step);
    filter[13] = mul_add(end, less, -step);
    filter[14] = F(2.2f * e) * reach + four_delta;
    filter[15] = zero;
    store(filter, &RayRecord::filter);
    return prepared;
}

template <std::size_t W>
HWY_INLINE std::uint32_t RayRecords::meet(const InLanes& ray, const WideNodeOf<W>& node) {
    LaneMask<float, kRays> met = lanes_of_bits<float, kRays>(0);
    const F never(std::numeric_limits<float>::infinity());
    F entries[W];
    if constexpr (kHasEntries<W>) {
        for (F& entry : entries) entry = never;
    }
    for (std::size_t i = 0; i < node.child_count(); ++i) {
        F near[3], far[3];
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            const F lo(node.planes[k][i]), hi(node.planes[k + 3][i]);
            near[k] = mul_add(select_lanes(ray.negative[k], hi, lo), ray.reciprocal[k],
                              ray.near_offset[k]);
            far[k] = mul_add(select_lanes(ray.negative[k], lo, hi), ray.reciprocal[k],
                             ray.far_offset[k]);
        }
        const F entry =
            larger_by_bits(larger_by_bits(near[0], near[1]), larger_by_bits(near[2], ray.s_min));
        const F exit =
            smaller_by_bits(smaller_by_bits(far[0], far[1]), smaller_by_bits(far[2], ray.s_max));
        const auto here = entry <= exit;
        if constexpr (kHasEntries<W>) entries[i] = select_lanes(here, entry, never);
        met = met | here;
    }
    const std::uint32_t bits = bits_of(met);
    if constexpr (kHasEntries<W>) {
        if (bits != 0) {
            store_eight(entries, [&](std::size_t i) HWY_ATTR { return entry_[i]; });
        }
    }
    return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
