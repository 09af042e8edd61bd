/// The frustum packet of the wide BVH: rays with a common point (eye rays, shadow rays of a point
/// light) traverse the tree as one frustum; single rays are distinguished in the leaves.
///
/// Source: Fuetterling, Lojewski, Pfreundt and Ebert, "Efficient Ray Tracing Kernels for Modern CPU
/// Architectures", JCGT 4(5), 2015 (large packets, a test of the whole packet per node); Wald,
/// Boulos and Shirley, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume Hierarchies",
/// ACM TOG 26(1), 2007 (coherent traversal, nodes skipped by a bound of all rays).
/// Differs: no box is tested against single rays: first against the frustum of the packet, then
/// against those of its groups of eight rays, in lanes. All slack of `SlabRay`, and the distance of
/// the rays from a common point, is in the planes of the frustum, which therefore meets every box
/// in which the exact test of a ray finds a hit.
/// Let z be the axis of the largest component of all directions, whose sign they share, D = +-z the
/// depth of the rays along it, P a point near which all rays pass, either where they begin or where
/// they end, k = D - D_P, and h = k or -k the distance from P, not negative within the rays'
/// ranges. A point of a ray has x = P_x + T h + r, where T is the ray's slope and |r| at most the
/// distance at which the ray passes P. The slack is twice 13.2 e R + 4 delta (e = 2^-24, R the
/// reach, as for SlabRay) and twice the distance from P; docs/design/boxes.md has the proof.
/// Conventions: included once per target (see simd/lanes-inl.h). A packet of rays in all directions
/// or from afar is rejected; statistics count a packet as one ray.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_PACKET_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_PACKET_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_PACKET_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>
#include <span>

#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/accel/wide_bvh/trace/ray_group-inl.h"
#include "alhazen/accel/wide_bvh/trace/slab_ray.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The rays of a packet and the frustum around them. Constructed by make_packet-inl.h.
class RayPacket {
  public:
    static constexpr std::size_t kResolvedGroups = 1;  ///< together

    RayGroup groups[kPacketGroups];
    RayLanes rays[kPacketGroups];  ///< unmodified, except t_max
    std::size_t group_count = 0;
    std::uint32_t kx = 0, ky = 0, kz = 0;
    float error = 0;       ///< of a sheared coordinate of any ray, as in triangle_filter.h
    float near_error = 0;  ///< as in TriangleFilterRay, for any ray
    float s_error = 0;     ///< of a local parameter, for a slope of 1
    float point[3];        ///< P, along kx, ky, kz
    float away[2];         ///< largest distance at which the rays pass P, in x and in y
    float k_max = 0;       ///< the largest group_k_max
    /// [x, y][group] The range of slopes; empty for an unused group.
    HWY_ALIGN float slope_lo[2][kPacketGroups];
    HWY_ALIGN float slope_hi[2][kPacketGroups];
    /// The range of k of the rays of each group.
    HWY_ALIGN float group_k_max[kPacketGroups];
    HWY_ALIGN float group_k_min[kPacketGroups];
    /// [x, y][group] The middle slope, with the sign for h; the largest distance of a slope of the
    /// group from it.
    HWY_ALIGN float group_middle[2][kPacketGroups];
    HWY_ALIGN float group_spread[kPacketGroups];
    float middle[2];   ///< middle of all slopes, in x and in y
    float widest = 0;  ///< largest distance of a slope from `middle`

    /// False if the rays differ too much; no other function may be called then. `used`: bits of the
    /// rays to trace; clears those that do not fit into the packet, which must be traced otherwise:
    /// rays that cannot be used, or whose dominant axis or sign differs from that of the first.
    [[nodiscard]] bool make(const LocalFrame& frame, std::span<const Ray> given,
                            std::uint64_t& used);
    /// Ends these lanes of a group.
    static HWY_INLINE void retire(RayGroup& group, std::uint32_t lanes) {
        for (; lanes != 0; lanes &= lanes - 1) {
            group.s_max[std::countr_zero(lanes)] = -std::numeric_limits<float>::infinity();
        }
    }

    /// Bits of the children that the frustum meets; `nearest`: their least depths.
    HWY_INLINE std::uint32_t intersect_children(const WideNode& node, Floats& nearest) const {
        return intersect_boxes(node.planes, nearest);
    }
    /// The same for eight boxes, [lower x, y, z, upper x, y, z][box].
    HWY_INLINE std::uint32_t intersect_boxes(const float (&planes)[6][kLaneCount],
                                             Floats& nearest) const {
        const Floats sign(sign_), minus_depth(-depth_of_point_);
        // Depths of the near and the far plane.
        nearest = mul_add(load_lanes(planes[near_row_]), sign, minus_depth);
        const Floats farthest = mul_add(load_lanes(planes[far_row_]), sign, minus_depth);
        const Floats zero(0.0f);
        const Floats h0 = max_lanes(from_start_ ? nearest : -farthest, zero);
        const Floats h1 = max_lanes(from_start_ ? farthest : -nearest, zero);
        LaneMask<float> missed = (nearest > Floats(k_max)) | (farthest < Floats(k_min_));
        HWY_UNROLL(2)
        for (std::size_t i = 0; i < 2; ++i) {
            const Floats lo = load_lanes(planes[lateral_row_[i]]) - Floats(point_hi_[i]);
            const Floats hi = load_lanes(planes[lateral_row_[i] + 3]) - Floats(point_lo_[i]);
            const Floats above =
                neg_mul_add(Floats(hi_up_[i]), h1, neg_mul_add(Floats(hi_down_[i]), h0, lo));
            const Floats below =
                neg_mul_add(Floats(lo_up_[i]), h0, neg_mul_add(Floats(lo_down_[i]), h1, hi));
            missed = missed | (above > zero) | (below < zero);
        }
        return kAllLanes & ~bits_of(missed);
    }

    /// Bits of the groups whose frustum meets a box. `box`: rows as in intersect_boxes, `stride`
    /// floats apart.
    HWY_INLINE std::uint32_t intersect_groups(const float* box, std::size_t stride) const {
        const Floats near(sign_ * box[near_row_ * stride] - depth_of_point_);
        const Floats far(sign_ * box[far_row_ * stride] - depth_of_point_);
        const Floats zero(0.0f);
        const Floats h0 = max_lanes(from_start_ ? near : -far, zero);
        const Floats h1 = max_lanes(from_start_ ? far : -near, zero);
        LaneMask<float> missed = (near > load_lanes(group_k_max)) | (far < load_lanes(group_k_min));
        HWY_UNROLL(2)
        for (std::size_t i = 0; i < 2; ++i) {
            const Floats lo(box[lateral_row_[i] * stride] - point_hi_[i]);
            const Floats hi(box[(lateral_row_[i] + 3) * stride] - point_lo_[i]);
            const Floats above = neg_mul_add(load_lanes(group_hi_up_[i]), h1,
                                             neg_mul_add(load_lanes(group_hi_down_[i]), h0, lo));
            const Floats below = neg_mul_add(load_lanes(group_lo_up_[i]), h0,
                                             neg_mul_add(load_lanes(group_lo_down_[i]), h1, hi));
            missed = missed | (above > zero) | (below < zero);
        }
        return all_groups() & ~bits_of(missed);
    }
    [[nodiscard]] std::uint32_t all_groups() const { return (1u << group_count) - 1; }
    /// Bits of the groups with a ray that reaches depth `k`.
    [[nodiscard]] HWY_INLINE std::uint32_t reaching(float k) const {
        return bits_of(load_lanes(group_k_max) >= Floats(k));
    }

    /// Bits of the groups of which a ray may meet a ball. Let C be its center relative to P, m the
    /// middle slope of a group, q the distance of C from the line P + h (m, 1), and w the length by
    /// which slopes of the group differ from m. A ray that meets the ball does so where h <= C_h +
    /// r, so q <= r + w (C_h + r). The error of the computation in float is less than 34 e R plus,
    /// as for a box, delta and the distance at which rays pass P.
    HWY_INLINE std::uint32_t intersect_ball(const float (&center)[3], float radius) const {
        const float along = sign_ * center[kz] - depth_of_point_;
        const float deep = from_start_ ? along : -along;
        const float beside[2] = {center[kx] - point[0], center[ky] - point[1]};
        const Floats x(beside[0]), y(beside[1]), h(deep);
        const Floats mx = load_lanes(group_middle[0]), my = load_lanes(group_middle[1]);
        const Floats a = neg_mul_add(h, my, y), b = neg_mul_add(h, mx, x);
        const Floats c = mul_sub(x, my, y * mx);
        const Floats reach =
            mul_add(load_lanes(group_spread), Floats(std::max(deep + radius, 0.0f)),
                    Floats(radius + ball_slack_));
        const Floats squared = mul_add(a, a, mul_add(b, b, c * c));
        const Floats scale = mul_add(mx, mx, mul_add(my, my, Floats(1.0f)));
        return all_groups() & ~bits_of(squared > scale * (reach * reach));
    }

    /// Lowers the s_max of ray i.
    HWY_INLINE void limit(std::size_t i, float s) {
        float& s_max = groups[i / kGroupRays].s_max[i % kGroupRays];
        s_max = std::min(s_max, s);
    }
    /// Lowers the s_max of a group to its decreased t_max. `scale`: of the frame.
    HWY_INLINE void limit_group(std::size_t g, double scale) {
        if (scale == 0) return;
        // As LocalParameter::above.
        const Doubles t = load_lanes(rays[g].t_max) * Doubles(scale);
        const Doubles s = t + Doubles(kLocalSlack) * abs(t);
        const Floats above = as_floats(s + (abs(s) * Doubles(0x1p-23) + Doubles(0x1p-100)));
        const Floats s_max = load_lanes(groups[g].s_max);
        // A NaN (an unused ray) changes nothing.
        store_lanes(select_lanes(above < s_max, above, s_max), groups[g].s_max);
    }
    void shrink_all() { shrink(all_groups()); }
    /// Updates the depths of the groups in `changed`.
    HWY_INLINE void shrink(std::uint32_t changed) {
        for (; changed != 0; changed &= changed - 1) {
            const auto g = static_cast<std::size_t>(std::countr_zero(changed));
            group_k_max[g] = groups[g].deepest(k_slack_);
        }
        k_max = RayGroup::most_of(load_lanes(group_k_max));
    }
    /// Ends all rays of these groups.
    HWY_INLINE void finish(std::uint32_t done) {
        for (; done != 0; done &= done - 1) {
            group_k_max[std::countr_zero(done)] = -std::numeric_limits<float>::infinity();
        }
    }
    /// The sign of the directions along z.
    [[nodiscard]] HWY_INLINE float sign() const { return sign_; }

  private:
    static constexpr float kUnit = 0x1p-24f;
    /// Wider frusta meet too many boxes that no ray meets.
    static constexpr float kWidest = 0.5f;
    static constexpr float kFarthest = 0.25f;

    std::uint64_t load(const LocalFrame& frame, std::span<const Ray> given);
    bool keep_one_way(std::uint64_t& used);
    HWY_INLINE void make_slopes(std::size_t g);
    bool find_point();
    bool find_planes();

    float sign_ = 1, depth_of_point_ = 0, k_min_ = 0, k_slack_ = 0, reach_ = 0, delta_ = 0;
    std::size_t near_row_ = 0, far_row_ = 0, lateral_row_[2];
    bool from_start_ = true;
    float point_lo_[2], point_hi_[2];  ///< P with the slack
    float ball_slack_ = 0;
    /// The positive and negative parts of the largest and the smallest slope.
    float hi_up_[2], hi_down_[2], lo_up_[2], lo_down_[2];
    /// The same of each group.
    HWY_ALIGN float group_hi_up_[2][kPacketGroups], group_hi_down_[2][kPacketGroups];
    HWY_ALIGN float group_lo_up_[2][kPacketGroups], group_lo_down_[2][kPacketGroups];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
