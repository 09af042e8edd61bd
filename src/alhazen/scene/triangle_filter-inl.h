/// The triangle filter on a block: see triangle_filter.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). A NaN passes the filter and is
/// never sure.

#if defined(ALHAZEN_SCENE_TRIANGLE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SCENE_TRIANGLE_FILTER_INL_H_
#undef ALHAZEN_SCENE_TRIANGLE_FILTER_INL_H_
#else
#define ALHAZEN_SCENE_TRIANGLE_FILTER_INL_H_
#endif

#include "alhazen/accel/wide_bvh/slab_ray-inl.h"
#include "alhazen/scene/leaf_blocks.h"
#include "alhazen/scene/triangle_filter.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Bits of the lanes that may be hit, and of those that are for sure; where, in local parameters.
struct FilteredTriangles {
    std::uint32_t candidates, sure;
    HWY_ALIGN float lo[kBlockWidth];
    HWY_ALIGN float hi[kBlockWidth];
};

template <std::size_t N>
HWY_INLINE void make_triangle_filter_rays(const RayLanes<N>& rays, const SlabRays<N>& slabs,
                                          TriangleFilterRays<N>& filter) {
    using D = Lanes<double, N>;
    D o[3], d[3];
    for (std::size_t k = 0; k < 3; ++k) {
        o[k] = load_lanes<N>(slabs.origin[k]);
        d[k] = load_lanes<N>(slabs.direction[k]);
    }
    const D ax = abs(d[0]), ay = abs(d[1]), az = abs(d[2]);
    const auto x_first = (ax >= ay) & (ax >= az);
    const auto y_second = ay >= az;
    // kx, ky, kz are y, z, x or z, x, y or x, y, z.
    const auto turned = [&](const D(&v)[3], std::size_t k) HWY_ATTR {
        return select(x_first, v[(k + 1) % 3], select(y_second, v[(k + 2) % 3], v[k]));
    };
    for (std::size_t k = 0; k < 3; ++k) store_as_floats(turned(o, k), filter.origin[k]);
    const D inverse = D(1.0) / turned(d, 2);
    store_as_floats(turned(d, 0) * inverse, filter.sx);
    store_as_floats(turned(d, 1) * inverse, filter.sy);
    store_as_floats(inverse, filter.sz);
    const std::uint32_t x = bits_of(x_first), y = bits_of(y_second);
    for (std::size_t i = 0; i < N; ++i) {
        const std::uint32_t kz = (x >> i & 1) != 0 ? 0 : 2 - (y >> i & 1);
        filter.axis[0][i] = 0x021 >> 4 * kz & 3;  // 1, 2, 0
        filter.axis[1][i] = 0x102 >> 4 * kz & 3;  // 2, 0, 1
        filter.axis[2][i] = kz;
    }
    const D delta = load_lanes<N>(slabs.delta), reach = load_lanes<N>(slabs.reach);
    const D error = D(0x1p-24 * 9.0) * reach + delta + delta;
    store_as_floats(D(5.11) * error, filter.edge_slack);
    store_as_floats(D(2.11) * error * error, filter.edge_slack_min);
    store_as_floats(D(0x1p-24 * 13.0) * reach + D(4.0) * delta, filter.s_slack);
    const LocalParameters<N> local{load_lanes<N>(slabs.t_scale), load_lanes<N>(slabs.t_shift)};
    const D infinite(std::numeric_limits<double>::infinity());
    const D t_max = rays.t_max();
    store_as_floats(local.above(rays.t_min()), filter.sure_min);
    store_as_floats(select(t_max < infinite, local.below(t_max), infinite), filter.sure_max);
    for (std::size_t i = 0; i < N; ++i) {
        // Nothing is known of such a ray.
        if (slabs.t_scale[i] == 0) {
            filter.edge_slack[i] = std::numeric_limits<float>::infinity();
        }
    }
}

/// False when no triangle of the block is hit up to `s_max`: then `out` is not set.
template <std::size_t N>
HWY_INLINE bool filter_triangles(const TriangleBlock& block, const TriangleFilterRays<N>& rays,
                                 std::size_t ray, float s_min, float s_max,
                                 FilteredTriangles& out) {
    struct {
        Floats x, y, z;
    } v[3];
    const Floats ox(rays.origin[0][ray]), oy(rays.origin[1][ray]), oz(rays.origin[2][ray]);
    const Floats sx(rays.sx[ray]), sy(rays.sy[ray]);
    const std::size_t kx = rays.axis[0][ray], ky = rays.axis[1][ray], kz = rays.axis[2][ray];
    HWY_UNROLL(3)
    for (int i = 0; i < 3; ++i) {
        v[i].z = load_lanes(block.vertex[i][kz]) - oz;
        v[i].x = neg_mul_add(sx, v[i].z, load_lanes(block.vertex[i][kx]) - ox);
        v[i].y = neg_mul_add(sy, v[i].z, load_lanes(block.vertex[i][ky]) - oy);
    }
    const auto edge = [](const auto& a, const auto& b)
                          HWY_ATTR { return mul_sub(a.x, b.y, a.y * b.x); };
    const Floats eu = edge(v[1], v[2]), ev = edge(v[2], v[0]), ew = edge(v[0], v[1]);
    const auto reach = [](const auto& a) HWY_ATTR { return max_lanes(abs(a.x), abs(a.y)); };
    const Floats far = max_lanes(max_lanes(reach(v[0]), reach(v[1])), reach(v[2]));
    const Floats error =
        mul_add(far, Floats(rays.edge_slack[ray]), Floats(rays.edge_slack_min[ray]));
    const Floats least = min_lanes(min_lanes(eu, ev), ew);
    const Floats most = max_lanes(max_lanes(eu, ev), ew);
    std::uint32_t candidates = kAllLanes & ~bits_of((least < -error) & (most > error));
    if (candidates == 0) return false;

    const Floats sz(rays.sz[ray]);
    const Floats sa = v[0].z * sz, sb = v[1].z * sz, sc = v[2].z * sz;
    const Floats det = eu + ev + ew;
    const Floats first = min_lanes(min_lanes(sa, sb), sc);
    const Floats last = max_lanes(max_lanes(sa, sb), sc);
    // Over the sum of the weights, the place and the weight of its error.
    const Floats inverse = Floats(1.0f) / det;
    const Floats place = mul_add(eu, sa, mul_add(ev, sb, ew * sc)) * inverse;
    const Floats s = min_lanes(max_lanes(place, first), last);
    const Floats slack =
        mul_add(Floats(25.0f) * error * (last - first), abs(inverse), Floats(rays.s_slack[ray]));
    const Floats lo = s - slack, hi = s + slack;
    candidates &= ~bits_of((lo > Floats(s_max)) | (hi < Floats(s_min)));
    if (candidates == 0) return false;
    out.candidates = candidates;
    out.sure = candidates &
               bits_of(((least > error) | (most < -error)) & (lo >= Floats(rays.sure_min[ray])) &
                       (hi <= Floats(rays.sure_max[ray])));
    store_lanes(lo, out.lo);
    store_lanes(hi, out.hi);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
