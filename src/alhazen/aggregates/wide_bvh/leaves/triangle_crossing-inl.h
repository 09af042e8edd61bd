/// Where rays cross triangles, within bounds, in lanes: triangles against one ray, rays against one
/// triangle, or a ray and a triangle of its own a lane. All filters of triangles share it.
///
/// Source: triangle_filter.h, whose bounds these are.
/// Conventions: included once per target (see simd/lanes-inl.h). Of lanes with a NaN none is missed
/// and none is sure, if masks of what is missed are negated and those of what is sure are not.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_CROSSING_INL_H_) == \
    defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_CROSSING_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_CROSSING_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_TRIANGLE_CROSSING_INL_H_
#endif

#include <cstddef>

#include "alhazen/aggregates/wide_bvh/leaves/rays_at_blocks-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <class F>
HWY_INLINE F least_of(const F& a, const F& b, const F& c) {
    return min_lanes(min_lanes(a, b), c);
}
template <class F>
HWY_INLINE F most_of(const F& a, const F& b, const F& c) {
    return max_lanes(max_lanes(a, b), c);
}

/// The corners of triangles from the origin of their ray, sheared so that it is the z axis.
template <class F>
struct ShearedCorners {
    AxisRows<F> corner[3];

    // Not defaulted, as for LaneMask.
    HWY_INLINE ShearedCorners() {}

    /// `from_origin`: corner i, along the axes of the ray; `sx`, `sy`: its slope.
    HWY_INLINE void set(std::size_t i, const AxisRows<F>& from_origin, const F& sx, const F& sy) {
        corner[i] = {neg_mul_add(sx, from_origin.z, from_origin.x),
                     neg_mul_add(sy, from_origin.z, from_origin.y), from_origin.z};
    }
    /// The largest |x| or |y|.
    [[nodiscard]] HWY_INLINE F across() const {
        return most_of(across(corner[0]), across(corner[1]), across(corner[2]));
    }
    /// The largest |z|.
    [[nodiscard]] HWY_INLINE F along() const {
        return most_of(abs(corner[0].z), abs(corner[1].z), abs(corner[2].z));
    }

  private:
    static HWY_INLINE F across(const AxisRows<F>& p) { return max_lanes(abs(p.x), abs(p.y)); }
};

/// The edge functions of triangles, opposite to their corners.
template <class F>
struct EdgeFunctions {
    F u, v, w, least, most;

    HWY_INLINE EdgeFunctions(const F& of_u, const F& of_v, const F& of_w)
        : u(of_u), v(of_v), w(of_w), least(least_of(u, v, w)), most(most_of(u, v, w)) {}
    HWY_INLINE explicit EdgeFunctions(const ShearedCorners<F>& sheared)
        : EdgeFunctions(edge(sheared, 1, 2), edge(sheared, 2, 0), edge(sheared, 0, 1)) {}

    [[nodiscard]] HWY_INLINE F sum() const { return u + v + w; }
    /// The sum of numbers of the three corners, weighted by them.
    [[nodiscard]] HWY_INLINE F weighted(const F& a, const F& b, const F& c) const {
        return mul_add(u, a, mul_add(v, b, w * c));
    }
    /// The lanes whose signs are mixed beyond an error: they miss their triangle.
    [[nodiscard]] HWY_INLINE auto mixed(const F& error) const {
        return (least < -error) & (most > error);
    }
    /// The lanes whose signs are the same beyond an error: their line crosses the triangle.
    [[nodiscard]] HWY_INLINE auto alike(const F& error) const {
        return (least > error) | (most < -error);
    }

  private:
    static HWY_INLINE F edge(const ShearedCorners<F>& sheared, std::size_t i, std::size_t k) {
        const auto &a = sheared.corner[i], &b = sheared.corner[k];
        return mul_sub(a.x, b.y, a.y * b.x);
    }
};

/// An edge function of corners that are sheared along a slope, for slopes that are (a, b) more: it
/// is [0] + a [1] + b [2], for the terms in a b cancel.
template <class F>
struct LinearEdge {
    F part[3];

    /// `e`: the corner that it is opposite to.
    HWY_INLINE LinearEdge(const ShearedCorners<F>& sheared, std::size_t e) {
        const auto &a = sheared.corner[(e + 1) % 3], &b = sheared.corner[(e + 2) % 3];
        part[0] = mul_sub(a.x, b.y, a.y * b.x);
        part[1] = mul_sub(a.y, b.z, a.z * b.y);
        part[2] = mul_sub(a.z, b.x, a.x * b.z);
    }
};

/// A filter: which lanes miss their triangle, and where the others cross it.
template <class F>
struct TriangleCrossing {
    F lo, hi;  ///< the range of their parameters

    HWY_INLINE explicit TriangleCrossing(const ShearedCorners<F>& corners)
        : corners_(corners), edges_(corners), across_(corners.across()) {}

    /// The lanes that miss their triangle by the bound for all triangles.
    [[nodiscard]] HWY_INLINE auto missed_by_far(const F& edge_slack,
                                                const F& edge_slack_min) const {
        return edges_.mixed(mul_add(across_, edge_slack, edge_slack_min));
    }
    /// Sets the bounds of the crossing. `sz`: the reciprocals of the directions; `near_error`: the
    /// part of the error of corners that all triangles share.
    HWY_INLINE void bound(const F& sz, const F& near_error) {
        const F off = mul_add(across_ + corners_.along(), F(7.3f * 0x1p-24f), near_error);
        error_ = off * mul_add(across_, F(5.12f), off * F(2.12f));
        const F a = corners_.corner[0].z * sz, b = corners_.corner[1].z * sz,
                c = corners_.corner[2].z * sz;
        const F first = least_of(a, b, c), last = most_of(a, b, c);
        const F inverse = F(1.0f) / edges_.sum();
        const F place = edges_.weighted(a, b, c) * inverse;
        const F s = min_lanes(max_lanes(place, first), last);
        const F slack =
            mul_add(F(25.0f) * error_ * (last - first), abs(inverse), off * F(1.6f) * abs(sz));
        lo = s - slack;
        hi = s + slack;
    }
    /// After `bound`: the lanes that miss their triangle, or meet it outside of a range.
    [[nodiscard]] HWY_INLINE auto missed(const F& s_min, const F& s_max) const {
        return edges_.mixed(error_) | (lo > s_max) | (hi < s_min);
    }
    /// After `bound`: the lanes whose lines cross their triangle for certain.
    [[nodiscard]] HWY_INLINE auto crossed() const { return edges_.alike(error_); }
    /// After `bound`: the lanes that cross their triangle in a range for certain.
    [[nodiscard]] HWY_INLINE auto sure(const F& s_min, const F& s_max) const {
        return crossed() & (lo >= s_min) & (hi <= s_max);
    }

  private:
    const ShearedCorners<F>& corners_;
    EdgeFunctions<F> edges_;
    F across_;
    F error_;  ///< of an edge function
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
