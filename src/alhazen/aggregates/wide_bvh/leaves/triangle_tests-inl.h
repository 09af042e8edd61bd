/// The triangle tests of leaves, policies of a query: the type of a result for a block (`Found`),
/// the test, and the slack of boxes.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_TESTS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_TESTS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_TRIANGLE_TESTS_INL_H_
#endif

#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Exact hits: a filter in float, then exact resolution in double of the candidates.
struct FilteredTriangleTest {
    using Found = FilteredTriangles;
    static constexpr bool kExact = true;

    static HWY_INLINE const DistanceBound& slab_slack(const LocalFrame& frame) {
        return frame.slack.slab;
    }
    /// False if nothing is found; then `found` is not set.
    static HWY_INLINE bool find(const TriangleBlock& block, const TriangleFilterRay& ray,
                                float s_min, float s_max, Found& found) {
        return filter_triangles(block, ray, s_min, s_max, found);
    }
};

/// Triangles of a block that are hit, in single precision: edge functions, their sum, parameters.
struct FloatTriangles {
    Floats ev, ew, det, s;
    std::uint32_t sure;  ///< bits of the lanes that are hit

    // Not defaulted, as for LaneMask.
    HWY_INLINE FloatTriangles() {}
};

/// Single-precision hits: faster, with possible errors at edges. Parameters have the precision of
/// float; boxes have no slack.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013, without
/// its fallback in double for edge functions that are zero.
struct FloatTriangleTest {
    using Found = FloatTriangles;
    static constexpr bool kExact = false;

    static HWY_INLINE DistanceBound slab_slack(const LocalFrame&) { return {0.0f, 0.0f}; }

    static HWY_INLINE bool find(const TriangleBlock& block, const TriangleFilterRay& ray,
                                float s_min, float s_max, Found& found) {
        const AxisRows<Floats> origin{Floats(ray.origin[0]), Floats(ray.origin[1]),
                                      Floats(ray.origin[2])};
        ShearedCorners<Floats> v;
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            v.set(i, load_axes(block.vertex[i], ray) - origin, Floats(ray.sx), Floats(ray.sy));
        }
        const EdgeFunctions<Floats> edges(v);
        const Floats zero(0.0f);
        const std::uint32_t inside = bits_of((edges.least >= zero) | (edges.most <= zero));
        if (inside == 0) return false;
        found.ev = edges.v;
        found.ew = edges.w;
        found.det = edges.sum();
        found.s = edges.weighted(v.corner[0].z, v.corner[1].z, v.corner[2].z) * Floats(ray.sz) /
                  found.det;
        // A NaN (a triangle seen edge on) is no hit.
        found.sure = inside & bits_of((found.s >= Floats(s_min)) & (found.s <= Floats(s_max)));
        return found.sure != 0;
    }
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
