/// Sixteen rays of a batch in lanes, prepared for nodes and for triangles.
///
/// Conventions: included once per target (see simd/lanes-inl.h). Every number has the bits that
/// `make_ray` and `make_triangle_filter_ray` give.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_ROWS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_ROWS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAY_ROWS_INL_H_
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/given_rays-inl.h"
#include "alhazen/accel/wide_bvh/trace/slab_ray.h"
#include "alhazen/accel/wide_bvh/trace/tree_box-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// As SlabRay and TriangleFilterRay, a ray a lane.
struct RayRows {
    static constexpr std::size_t kRays = 16;
    using F = Lanes<float, kRays>;
    using Mask = LaneMask<float, kRays>;

    F local[8];  ///< origins, directions and ends in the local frame
    F reciprocal[3], near_offset[3], far_offset[3], s_min, s_max;
    Mask negative[3];        ///< components of the direction
    Mask along_x, along_y;   ///< the largest component of the direction, else it is z
    F longest, distance;     ///< largest components of direction and origin
    F begin, end;            ///< of the range, in the range of float
    std::uint32_t prepared;  ///< bits of the rays that all this holds for
    std::uint32_t left;      ///< bits of other rays, which leave the box of the tree

    // Not defaulted, as for LaneMask.
    HWY_INLINE RayRows() {}

    /// Prepares those from `first` on for nodes. Prepared are those that `make_ray_nearby` accepts,
    /// except a few. `bound`: as in `make_ray`. If all leave `box`, nothing else is set.
    HWY_INLINE void load(const LaneFrame& frame, const DistanceBound& bound, const TreeBox& box,
                         const GivenRays& rays, std::size_t first);
    /// Bits of the rays that meet a box: rows lo.x, lo.y, lo.z, hi.x, hi.y, hi.z, of which this is
    /// column i; where they enter it.
    template <std::size_t N>
    [[nodiscard]] HWY_INLINE Mask meet(const float (&planes)[6][N], std::size_t i, F& entry) const;
    /// The sixteen numbers of a SlabRay.
    HWY_INLINE void slab_rows(F (&rows)[16]) const;
    /// The sixteen numbers of a TriangleFilterRay.
    HWY_INLINE void filter_rows(const FrameSlack& slack, F (&rows)[16]) const;
};

HWY_INLINE void RayRows::load(const LaneFrame& frame, const DistanceBound& bound,
                              const TreeBox& box, const GivenRays& rays, std::size_t first) {
    load_local(frame, rays, first, local);
    prepared = 0;
    left = box.left_by(local, local + 3, local[6]);
    if (left == (1u << kRays) - 1) return;
    const F* const origin = local;
    const F* const direction = local + 3;
    const F d0 = abs(direction[0]), d1 = abs(direction[1]), d2 = abs(direction[2]);
    const F o0 = abs(origin[0]), o1 = abs(origin[1]), o2 = abs(origin[2]);
    longest = max_lanes(max_lanes(d0, d1), d2);
    distance = max_lanes(max_lanes(o0, o1), o2);
    along_x = d0 >= longest;
    along_y = d1 >= longest;
    const F zero(0.0f), one(1.0f);
    // Sums propagate a NaN. Ends that are equal in float, or -0, may be out of order in double.
    prepared = bits_of((o0 + o1 + o2 <= F(8.0f)) & (d0 + d1 + d2 <= F(0x1p40f)) &
                       (longest >= F(frame.frame.slack.least_length)) & (local[6] < local[7]) &
                       (copysign(one, local[6]) > zero)) &
               ~left;
    const F space = mul_add(distance, F(bound.slope), F(bound.constant));
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const F steep = copysign(larger_by_bits(abs(direction[k]), F(0x1p-100f)), direction[k]);
        reciprocal[k] = one / steep;
        const F c = -(origin[k] * reciprocal[k]);
        const F aside = space * abs(reciprocal[k]);
        near_offset[k] = c - aside;
        far_offset[k] = c + aside;
        negative[k] = steep < zero;
    }
    begin = min_lanes(local[6], F(1e37f));
    end = min_lanes(local[7], F(1e37f));
    const F step(0x1p-100f), more(1.0f + 0x1p-22f), less(1.0f - 0x1p-22f);
    s_min = max_lanes(mul_sub(begin, less, step), zero);
    s_max = max_lanes(mul_sub(end, more, -step), zero);
}

template <std::size_t N>
HWY_INLINE RayRows::Mask RayRows::meet(const float (&planes)[6][N], std::size_t i, F& entry) const {
    F near[3], far[3];
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const F lo(planes[k][i]), hi(planes[k + 3][i]);
        near[k] = mul_add(select_lanes(negative[k], hi, lo), reciprocal[k], near_offset[k]);
        far[k] = mul_add(select_lanes(negative[k], lo, hi), reciprocal[k], far_offset[k]);
    }
    entry = larger_by_bits(larger_by_bits(near[0], near[1]), larger_by_bits(near[2], s_min));
    const F exit = smaller_by_bits(smaller_by_bits(far[0], far[1]), smaller_by_bits(far[2], s_max));
    return entry <= exit;
}

HWY_INLINE void RayRows::slab_rows(F (&rows)[16]) const {
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        rows[k] = reciprocal[k];
        rows[4 + k] = near_offset[k];
        rows[8 + k] = far_offset[k];
    }
    rows[3] = rows[7] = rows[11] = F(0.0f);
    rows[12] = s_min;
    rows[13] = s_max;
    // The two words of NearRows.
    const auto word = [](std::size_t octant, std::size_t which) {
        const auto words = std::bit_cast<std::array<std::uint32_t, 2>>(kNearRows[octant]);
        return F(std::bit_cast<float>(words[which]));
    };
    const auto &x_down = negative[0], &y_down = negative[1], &z_down = negative[2];
    rows[14] = select_lanes(x_down, select_lanes(y_down, word(3, 0), word(1, 0)),
                            select_lanes(y_down, word(2, 0), word(0, 0)));
    rows[15] = select_lanes(z_down,
                            select_lanes(x_down, select_lanes(y_down, word(7, 1), word(5, 1)),
                                         select_lanes(y_down, word(6, 1), word(4, 1))),
                            select_lanes(x_down, select_lanes(y_down, word(3, 1), word(1, 1)),
                                         select_lanes(y_down, word(2, 1), word(0, 1))));
}

HWY_INLINE void RayRows::filter_rows(const FrameSlack& slack, F (&rows)[16]) const {
    const F* const origin = local;
    const F* const direction = local + 3;
    const auto pick = [&](const F& x, const F& y, const F& z) HWY_ATTR {
        return select_lanes(along_x, x, select_lanes(along_y, y, z));
    };
    const auto index = [](std::uint32_t i) { return F(std::bit_cast<float>(i)); };
    const F sz = pick(reciprocal[0], reciprocal[1], reciprocal[2]);
    rows[0] = pick(origin[1], origin[2], origin[0]);
    rows[1] = pick(origin[2], origin[0], origin[1]);
    rows[2] = pick(origin[0], origin[1], origin[2]);
    rows[4] = pick(direction[1], direction[2], direction[0]) * sz;
    rows[5] = pick(direction[2], direction[0], direction[1]) * sz;
    rows[6] = sz;
    rows[8] = pick(index(1), index(2), index(0));
    rows[9] = pick(index(2), index(0), index(1));
    rows[10] = pick(index(0), index(1), index(2));
    constexpr float e = 0x1p-24f;
    const F step(0x1p-100f), more(1.0f + 0x1p-22f), less(1.0f - 0x1p-22f);
    const F delta = F(slack.delta.slope) * distance + F(slack.delta.constant);
    const F reach = F(slack.reach.slope) * distance + F(slack.reach.constant);
    const F four_delta = F(4.0f) * delta;
    const F error = F(13.2f * e) * reach + four_delta;
    rows[3] = F(5.12f) * error;
    rows[7] = F(2.12f) * error * error;
    rows[11] = (F(14.2f * e) * reach + four_delta) * abs(sz);
    rows[12] = mul_add(begin, more, step);
    rows[13] = mul_add(end, less, -step);
    rows[14] = F(2.2f * e) * reach + four_delta;
    rows[15] = F(0.0f);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
