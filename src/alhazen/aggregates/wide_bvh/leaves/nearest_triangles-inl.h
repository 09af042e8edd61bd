/// The triangle filter on a block for the closest hit of a single ray: the end of the ray stays in
/// a register, from leaf to node.
///
/// Source: triangle_filter-inl.h, whose bounds these are.
/// Differs: what comes next waits for the end of the ray, so it does not pass through words of bits
/// and memory: it is the least of what lanes selected, in lanes.
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes the filter and does
/// not limit the ray.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_NEAREST_TRIANGLES_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_NEAREST_TRIANGLES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_NEAREST_TRIANGLES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_NEAREST_TRIANGLES_INL_H_
#endif

#include <cstdint>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_crossing-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// `yes` where a >= b, else `no`: sooner known than `select_lanes` where masks have registers of
/// their own (four cycles, not six).
template <std::size_t N>
HWY_INLINE Lanes<float, N> select_at_least(const Lanes<float, N>& a, const Lanes<float, N>& b,
                                           const Lanes<float, N>& yes, const Lanes<float, N>& no) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
    if constexpr (N == 8) {
        Lanes<float, N> r;
        r.part[0].raw = _mm256_blendv_ps(no.part[0].raw, yes.part[0].raw,
                                         _mm256_cmp_ps(a.part[0].raw, b.part[0].raw, _CMP_GE_OQ));
        return r;
    }
#endif
    return select_lanes(a >= b, yes, no);
}

/// The least lane in every lane. Precondition: nothing negative, no NaN.
template <std::size_t N>
HWY_INLINE Lanes<float, N> least_by_bits(const Lanes<float, N>& a) {
    const LaneTag<float, N> d;
    auto least = bits_as_integers<float, N>(a.part[0]);
    for (std::size_t i = 1; i < kParts<float, N>; ++i) {
        least = hn::Min(least, bits_as_integers<float, N>(a.part[i]));
    }
    const auto every =
        hn::BitCast(d, hn::MinOfLanes(hn::RebindToSigned<LaneTag<float, N>>(), least));
    Lanes<float, N> r;
    for (std::size_t i = 0; i < kParts<float, N>; ++i) r.part[i] = every;
    return r;
}

/// The used lanes of a block.
HWY_INLINE LaneMask<float, kBlockWidth> used_lane_mask(const TriangleBlock& block) {
    const LaneTag<float, kBlockWidth> d;
    const hn::RebindToUnsigned<LaneTag<float, kBlockWidth>> du;
    static_assert(sizeof(BlockId) == sizeof(std::uint32_t));
    const auto* ids = reinterpret_cast<const std::uint32_t*>(block.ids);
    const auto none = hn::Set(du, static_cast<std::uint32_t>(kNoPrimitive));
    LaneMask<float, kBlockWidth> used;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<float, kBlockWidth>; ++i) {
        used.part[i] = hn::RebindMask(d, hn::Ne(hn::Load(du, ids + i * hn::Lanes(d)), none));
    }
    return used;
}

/// Bits of the lanes that may be hit, which may be unused ones, and where their hits begin at the
/// earliest. `lo` is set if there are any.
struct NearTriangles {
    std::uint32_t candidates;
    HWY_ALIGN float lo[kBlockWidth];
};

/// Lowers `s_max`, the same in every lane, to the end of the nearest triangle that is surely hit.
/// One that is hit beyond the range of the ray may limit it, too: nothing in the range is farther.
/// Precondition: the ray sees every triangle.
HWY_INLINE void find_near_triangles(const TriangleBlock& block, const TriangleFilterRay& ray,
                                    float s_min, Floats& s_max, NearTriangles& out) {
    out.candidates = 0;
    const AxisRows<Floats> origin{Floats(ray.origin[0]), Floats(ray.origin[1]),
                                  Floats(ray.origin[2])};
    ShearedCorners<Floats> corners;
    HWY_UNROLL(3)
    for (std::size_t i = 0; i < 3; ++i) {
        const AxisRows<Floats> corner{load_lanes(block.vertex[i][ray.kx]),
                                      load_lanes(block.vertex[i][ray.ky]),
                                      load_lanes(block.vertex[i][ray.kz])};
        corners.set(i, corner - origin, Floats(ray.sx), Floats(ray.sy));
    }
    TriangleCrossing<Floats> crossing(corners);
    if (bits_of(crossing.missed_by_far(Floats(ray.edge_slack), Floats(ray.edge_slack_min))) ==
        kAllLanes) {
        return;
    }
    crossing.bound(Floats(ray.sz), Floats(ray.near_error));
    // The jump is mostly foreseen, and what comes next does not wait for the filter.
    out.candidates = kAllLanes & ~bits_of(crossing.missed(Floats(s_min), s_max));
    if (out.candidates == 0) return;
    store_lanes(crossing.lo, out.lo);
    // Known before `lo` and `hi`.
    const LaneMask<float, kBlockWidth> crossed = crossing.crossed() & used_lane_mask(block);
    const Floats end = select_lanes(crossed, crossing.hi, s_max);
    s_max = least_by_bits(
        smaller_by_bits(s_max, select_at_least(crossing.lo, Floats(ray.sure_min), end, s_max)));
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
