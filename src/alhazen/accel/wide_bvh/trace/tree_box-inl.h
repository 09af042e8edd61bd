/// The box of a tree, which many rays miss: they are done before anything else is computed of them.
///
/// Conventions: included once per target (see simd/lanes-inl.h). Sets of rays are bits.

#if defined(ALHAZEN_ACCEL_WIDE_BVH_TRACE_TREE_BOX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TREE_BOX_INL_H_
#undef ALHAZEN_ACCEL_WIDE_BVH_TRACE_TREE_BOX_INL_H_
#else
#define ALHAZEN_ACCEL_WIDE_BVH_TRACE_TREE_BOX_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "alhazen/accel/wide_bvh/nodes/local_frame.h"
#include "alhazen/accel/wide_bvh/nodes/wide_node.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The box around all children of a node, as planes of a node with one child.
template <std::size_t W>
HWY_INLINE void find_box(const WideNodeOf<W>& node, float (&planes)[6][1]) {
    const std::uint32_t count = node.child_count();
    for (std::size_t k = 0; k < 3; ++k) {
        planes[k][0] = *std::min_element(node.planes[k], node.planes[k] + count);
        planes[k + 3][0] = *std::max_element(node.planes[k + 3], node.planes[k + 3] + count);
    }
}

/// The box of a tree with the slack of any ray that begins near: a ray that does not meet it hits
/// nothing.
struct TreeBox {
    static constexpr float kNear = 8.0f;  ///< largest coordinate of a beginning
    float lo[3], hi[3];
    float least_length = 0.0f;  ///< as in FrameSlack

    /// One that all rays meet which begin near.
    TreeBox() {
        for (std::size_t k = 0; k < 3; ++k) {
            lo[k] = -0x1p20f;
            hi[k] = 0x1p20f;
        }
    }
    /// `slack`: of a box, as in `make_ray`.
    template <std::size_t W>
    TreeBox(const WideNodeOf<W>& root, const DistanceBound& slack, const FrameSlack& of_frame);

    /// Bits of the rays that begin beside it and go away. A direction that rounds to 0 keeps its
    /// sign. Of rays whose range begins before 0, or whose length float does not hold: none.
    template <std::size_t N>
    [[nodiscard]] HWY_INLINE std::uint32_t left_by(const Lanes<float, N>* origin,
                                                   const Lanes<float, N>* direction,
                                                   const Lanes<float, N>& begin) const {
        using F = Lanes<float, N>;
        const F one(1.0f), zero(0.0f);
        const auto leaves = [&](std::size_t k) HWY_ATTR {
            const F way = copysign(one, direction[k]);
            return origin[k] * way >= select_lanes(way > zero, F(hi[k]), F(-lo[k]));
        };
        // A NaN is larger than all by its bits, and fails each comparison.
        const auto most = [](const F* v) HWY_ATTR {
            return larger_by_bits(larger_by_bits(abs(v[0]), abs(v[1])), abs(v[2]));
        };
        const F longest = most(direction);
        return bits_of((leaves(0) | leaves(1) | leaves(2)) & (most(origin) <= F(kNear)) &
                       (longest >= F(least_length)) & (longest <= F(0x1p40f)) &
                       (copysign(one, begin) > zero));
    }
    /// Bits of the rays from a point, with a range from 0 or more, that miss it, by the reciprocals
    /// of their directions. The rounding of differences and products is less than that of SlabRay.
    template <std::size_t N>
    [[nodiscard]] HWY_INLINE std::uint32_t missed_from(const float (&point)[3],
                                                       const Lanes<float, N>* reciprocal) const {
        using F = Lanes<float, N>;
        F entry(0.0f), exit;
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            const F a = F(lo[k] - point[k]) * reciprocal[k],
                    b = F(hi[k] - point[k]) * reciprocal[k];
            entry = max_lanes(entry, min_lanes(a, b));
            exit = k == 0 ? max_lanes(a, b) : min_lanes(exit, max_lanes(a, b));
        }
        return bits_of(entry > exit);
    }
};

template <std::size_t W>
TreeBox::TreeBox(const WideNodeOf<W>& root, const DistanceBound& slack, const FrameSlack& of_frame)
    : least_length(of_frame.least_length) {
    float planes[6][1];
    find_box(root, planes);
    // More than the slack, for the sum rounds.
    const float more = 1.01f * slack.at(kNear);
    for (std::size_t k = 0; k < 3; ++k) {
        lo[k] = planes[k][0] - more;
        hi[k] = planes[k + 3][0] + more;
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
