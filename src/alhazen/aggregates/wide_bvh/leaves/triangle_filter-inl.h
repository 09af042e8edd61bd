/// The triangle filter on a block: see triangle_filter.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes the filter and is
/// never sure.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_FILTER_INL_H_
#endif

#include <cstddef>
#include <cstring>

#include "alhazen/accel/wide_bvh/trace/slab_ray-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/lane_crossing-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Bits of the lanes that may be hit and of those that certainly are; the range of their parameters
/// in the local frame.
struct FilteredTriangles {
    std::uint32_t candidates, sure;
    HWY_ALIGN float lo[kBlockWidth];
    HWY_ALIGN float hi[kBlockWidth];
};

/// Precondition: `slabs` and `axes` are of the same ray.
HWY_INLINE void make_triangle_filter_ray(const SlabRay& slabs, const AxisLanes& axes,
                                         TriangleFilterRay& filter) {
    // The positions of the axes x, y, z for main axis 0, 1 and 2; the fourth is arbitrary.
    HWY_ALIGN static constexpr std::int32_t kTurned[3][4] = {
        {1, 2, 0, 3}, {2, 0, 1, 3}, {0, 1, 2, 3}};
    const std::uint32_t kz = axes.main_axis;
    const float sz = slabs.reciprocal[kz];
    const auto turned = [&](const AxisLanes::F& a) HWY_ATTR { return permuted(a, kTurned[kz]); };
    // The fourth of each is set below. Addressed relative to the whole object, not to the member,
    // beyond whose end it lies: where lanes are stored one by one, compilers notice.
    static_assert(offsetof(TriangleFilterRay, sx) == offsetof(TriangleFilterRay, origin) + 16);
    static_assert(offsetof(TriangleFilterRay, sure_max) ==
                  offsetof(TriangleFilterRay, sure_min) + sizeof(float));
    float* const origin = reinterpret_cast<float*>(&filter);
    store_lanes(turned(axes.origin), origin);
    store_lanes(turned(axes.direction) * AxisLanes::F(sz), origin + 4);
    std::memcpy(&filter.kx, kTurned[kz], sizeof(kTurned[kz]));
    filter.sz = sz;
    constexpr float e = 0x1p-24f;
    const float error = 13.2f * e * axes.reach + 4.0f * axes.delta;
    filter.near_error = 2.2f * e * axes.reach + 4.0f * axes.delta;
    filter.edge_slack = 5.12f * error;
    filter.edge_slack_min = 2.12f * error * error;
    filter.s_slack = (14.2f * e * axes.reach + 4.0f * axes.delta) * std::abs(sz);
    store_lanes(axes.sure, origin + offsetof(TriangleFilterRay, sure_min) / sizeof(float));
    if (HWY_UNLIKELY(!axes.regular)) {
        filter.edge_slack = filter.near_error = std::numeric_limits<float>::infinity();
    }
}

/// The corners of the triangles of a block, sheared so that the ray is the z axis.
struct ShearedCorners {
    struct {
        Floats x, y, z;
    } corner[3];
};
HWY_INLINE ShearedCorners sheared_corners(const TriangleBlock& block,
                                          const TriangleFilterRay& ray) {
    ShearedCorners v;
    const Floats ox(ray.origin[0]), oy(ray.origin[1]), oz(ray.origin[2]);
    const Floats sx(ray.sx), sy(ray.sy);
    const std::size_t kx = ray.kx, ky = ray.ky, kz = ray.kz;
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
        auto& p = v.corner[i];
        p.z = load_lanes(block.vertex[i][kz]) - oz;
        p.x = neg_mul_add(sx, p.z, load_lanes(block.vertex[i][kx]) - ox);
        p.y = neg_mul_add(sy, p.z, load_lanes(block.vertex[i][ky]) - oy);
    }
    return v;
}
/// The edge function of two of these corners.
template <class Corner>
HWY_INLINE Floats edge_of(const Corner& a, const Corner& b) {
    return mul_sub(a.x, b.y, a.y * b.x);
}

/// False if no triangle of the block is hit up to `s_max`; then `out` is not set.
template <bool kAtOnce = false>
HWY_INLINE bool filter_triangles(const TriangleBlock& block, const TriangleFilterRay& ray,
                                 float s_min, float s_max, FilteredTriangles& out) {
    const ShearedCorners sheared = sheared_corners(block, ray);
    const auto& v = sheared.corner;
    const Floats eu = edge_of(v[1], v[2]), ev = edge_of(v[2], v[0]), ew = edge_of(v[0], v[1]);
    const auto reach = [](const auto& a) HWY_ATTR { return max_lanes(abs(a.x), abs(a.y)); };
    const Floats far = max_lanes(max_lanes(reach(v[0]), reach(v[1])), reach(v[2]));
    const Floats error = mul_add(far, Floats(ray.edge_slack), Floats(ray.edge_slack_min));
    const Floats least = min_lanes(min_lanes(eu, ev), ew);
    const Floats most = max_lanes(max_lanes(eu, ev), ew);
    std::uint32_t candidates = kAllLanes & ~bits_of((least < -error) & (most > error));
    if (!kAtOnce && candidates == 0) return false;

    // Few blocks reach this point, where the distance of the triangles tightens the bound.
    const Floats depth = max_lanes(max_lanes(abs(v[0].z), abs(v[1].z)), abs(v[2].z));
    const Floats off = mul_add(far + depth, Floats(7.3f * 0x1p-24f), Floats(ray.near_error));
    const Floats fine = off * mul_add(far, Floats(5.12f), off * Floats(2.12f));
    const Floats sz(ray.sz);
    const Floats sa = v[0].z * sz, sb = v[1].z * sz, sc = v[2].z * sz;
    const Floats det = eu + ev + ew;
    const Floats first = min_lanes(min_lanes(sa, sb), sc);
    const Floats last = max_lanes(max_lanes(sa, sb), sc);
    // Divided by the sum of the weights: the position, and the factor of its error.
    const Floats inverse = Floats(1.0f) / det;
    const Floats place = mul_add(eu, sa, mul_add(ev, sb, ew * sc)) * inverse;
    const Floats s = min_lanes(max_lanes(place, first), last);
    const Floats slack =
        mul_add(Floats(25.0f) * fine * (last - first), abs(inverse), off * Floats(1.6f) * abs(sz));
    const Floats lo = s - slack, hi = s + slack;
    candidates &=
        ~bits_of(((least < -fine) & (most > fine)) | (lo > Floats(s_max)) | (hi < Floats(s_min)));
    if (!kAtOnce && candidates == 0) return false;
    out.candidates = candidates;
    out.sure = candidates & bits_of(((least > fine) | (most < -fine)) &
                                    (lo >= Floats(ray.sure_min)) & (hi <= Floats(ray.sure_max)));
    store_lanes(lo, out.lo);
    store_lanes(hi, out.hi);
    return true;
}

/// A ray at a block of triangles, and what is found there.
struct RayAtTriangles {
    const TriangleBlock& block;
    const TriangleFilterRay& ray;
    float s_min, s_max;
    FilteredTriangles& found;
};

/// Whether two rays, each with a block of its own, fill one register.
inline constexpr bool kPairsTriangles = kParts<float, 2 * kBlockWidth> == 1;

/// As filter_triangles<true> for both, by the finer bound alone.
HWY_INLINE void filter_two([[maybe_unused]] const RayAtTriangles& a,
                           [[maybe_unused]] const RayAtTriangles& b) {
    if constexpr (kPairsTriangles) {
        using F = Lanes<float, 2 * kBlockWidth>;
        const auto of_b = lanes_of_bits<float, 2 * kBlockWidth>(kAllLanes << kBlockWidth);
        const auto each = [&](float x, float y) HWY_ATTR { return select_lanes(of_b, F(y), F(x)); };
        const auto row = [&](std::size_t i, std::size_t x, std::size_t y) HWY_ATTR {
            return joined(load_lanes(a.block.vertex[i][x]), load_lanes(b.block.vertex[i][y]));
        };
        const F ox = each(a.ray.origin[0], b.ray.origin[0]);
        const F oy = each(a.ray.origin[1], b.ray.origin[1]);
        const F oz = each(a.ray.origin[2], b.ray.origin[2]);
        const F sx = each(a.ray.sx, b.ray.sx), sy = each(a.ray.sy, b.ray.sy);
        struct {
            F x, y, z;
        } v[3];
        F far(0.0f);
        HWY_UNROLL(3)
        for (std::size_t i = 0; i < 3; ++i) {
            v[i].z = row(i, a.ray.kz, b.ray.kz) - oz;
            v[i].x = neg_mul_add(sx, v[i].z, row(i, a.ray.kx, b.ray.kx) - ox);
            v[i].y = neg_mul_add(sy, v[i].z, row(i, a.ray.ky, b.ray.ky) - oy);
            far = max_lanes(far, max_lanes(abs(v[i].x), abs(v[i].y)));
        }
        const auto edge = [](const auto& p, const auto& q)
                              HWY_ATTR { return mul_sub(p.x, q.y, p.y * q.x); };
        const F eu = edge(v[1], v[2]), ev = edge(v[2], v[0]), ew = edge(v[0], v[1]);
        F lo, hi;
        const F fine = bound_crossing(v, far, eu, ev, ew, each(a.ray.sz, b.ray.sz),
                                      each(a.ray.near_error, b.ray.near_error), lo, hi);
        const F least = min_lanes(min_lanes(eu, ev), ew), most = max_lanes(max_lanes(eu, ev), ew);
        // Written so that a NaN is a candidate and not sure.
        const std::uint32_t candidates =
            ~bits_of(((least < -fine) & (most > fine)) | (lo > each(a.s_max, b.s_max)) |
                     (hi < each(a.s_min, b.s_min)));
        const std::uint32_t sure =
            candidates & bits_of(((least > fine) | (most < -fine)) &
                                 (lo >= each(a.ray.sure_min, b.ray.sure_min)) &
                                 (hi <= each(a.ray.sure_max, b.ray.sure_max)));
        a.found.candidates = candidates & kAllLanes;
        b.found.candidates = candidates >> kBlockWidth & kAllLanes;
        a.found.sure = sure & kAllLanes;
        b.found.sure = sure >> kBlockWidth & kAllLanes;
        store_lanes(lower_half(lo), a.found.lo);
        store_lanes(lower_half(hi), a.found.hi);
        store_lanes(upper_half(lo), b.found.lo);
        store_lanes(upper_half(hi), b.found.hi);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
