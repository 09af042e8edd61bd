/// Where rays in lanes cross the plane of one triangle, within bounds: what the filters of both
/// kinds of packets share.
///
/// Source: triangle_filter.h, whose finer bound of edge functions and bounds of the crossing it
/// has.
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LANE_CROSSING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LANE_CROSSING_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LANE_CROSSING_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_LANE_CROSSING_INL_H_
#endif

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// `v`: the corners in the frame of the rays, x and y sheared, of which `far` is the largest; `eu`,
/// `ev`, `ew`: the edge functions; `sz`: the reciprocals of the directions. Sets `lo` and `hi`, and
/// returns what an edge function is off at most.
template <class F, class Corner>
HWY_INLINE F bound_crossing(const Corner (&v)[3], const F& far, const F& eu, const F& ev,
                            const F& ew, const F& sz, const F& near_error, F& lo, F& hi) {
    const F depth = max_lanes(max_lanes(abs(v[0].z), abs(v[1].z)), abs(v[2].z));
    const F off = mul_add(far + depth, F(7.3f * 0x1p-24f), near_error);
    const F fine = off * mul_add(far, F(5.12f), off * F(2.12f));
    const F sa = v[0].z * sz, sb = v[1].z * sz, sc = v[2].z * sz;
    const F first = min_lanes(min_lanes(sa, sb), sc), last = max_lanes(max_lanes(sa, sb), sc);
    const F inverse = F(1.0f) / (eu + ev + ew);
    const F place = mul_add(eu, sa, mul_add(ev, sb, ew * sc)) * inverse;
    const F s = min_lanes(max_lanes(place, first), last);
    const F slack =
        mul_add(F(25.0f) * fine * (last - first), abs(inverse), off * F(1.6f) * abs(sz));
    lo = s - slack;
    hi = s + slack;
    return fine;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
