/// Axis-aligned boxes and balls around the eight shapes of a block, in float.
///
/// For slabs |d_k . (p - c)| <= h_k whose directions have length 1 and satisfy |d_i . d_j| <= e, p
/// - c is the sum of (d_k . (p - c)) d_k up to terms of e times the widths: along an axis a it
/// reaches sum h_k |d_k a| + 1.8 e (h_0 + h_1 + h_2); the bound uses 4 e.
/// Conventions: in the frame of the tree, where coordinates are at most about 1, with slack for all
/// rounding. Included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_BLOCK_BOXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_BLOCK_BOXES_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_BLOCK_BOXES_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_BLOCK_BOXES_INL_H_
#endif

#include <limits>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

class BlockBoxes {
  public:
    HWY_INLINE explicit BlockBoxes(const SphereBlock& block) {
        const Floats radius = load_lanes(block.radius);
        const Floats half[3] = {radius, radius, radius};
        set(block.center, half, radius);
    }
    /// Around each cylinder: along an axis it reaches the radius beyond the ends of its own axis.
    HWY_INLINE explicit BlockBoxes(const FrustumBlock& block) {
        const Floats height = load_lanes(block.half_height), radius = load_lanes(block.radius);
        Floats half[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            half[axis] = mul_add(height, abs(load_lanes(block.axis[axis])), radius);
        }
        const LaneMask<float> ball = height >= Floats(FrustumBlock::kEndless);
        set(block.center, half, select_lanes(ball, radius, height + radius));
    }
    /// For slabs that are not orthogonal (sheared shapes), the box around the ball.
    HWY_INLINE explicit BlockBoxes(const BoxBlock& block) {
        constexpr float kAcross = 0x1p-19f;
        Floats direction[3][3];
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                direction[k][axis] = load_lanes(block.direction[k][axis]);
            }
        }
        const auto leaning = [&](std::size_t i, std::size_t j) HWY_ATTR {
            return abs(direction[i][0] * direction[j][0] + direction[i][1] * direction[j][1] +
                       direction[i][2] * direction[j][2]);
        };
        const Floats radius = load_lanes(block.radius), most(std::numeric_limits<float>::max());
        // Shapes without end have the box of their ball, too.
        const LaneMask<float> across =
            (max_lanes(max_lanes(leaning(0, 1), leaning(1, 2)), leaning(2, 0)) < Floats(kAcross)) &
            (radius <= most);
        Floats reach[3], half[3];
        for (std::size_t k = 0; k < 3; ++k) {
            reach[k] = max_lanes(min_lanes(load_lanes(block.half[k]), most), Floats(0.0f));
        }
        const Floats room = Floats(4.0f * kAcross) * (reach[0] + reach[1] + reach[2]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            half[axis] = room;
            for (std::size_t k = 0; k < 3; ++k) {
                half[axis] = half[axis] + reach[k] * abs(direction[k][axis]);
            }
            half[axis] = select_lanes(across, min_lanes(half[axis], radius), radius);
        }
        set(block.center, half, radius);
    }

    /// The bounds of one shape.
    struct Bounds {
        float lo[3], hi[3];       ///< the box
        float center[3], radius;  ///< the ball
    };
    [[nodiscard]] HWY_INLINE Bounds bounds(std::size_t lane) const {
        Bounds b;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            b.lo[axis] = rows_[axis][lane];
            b.hi[axis] = rows_[3 + axis][lane];
            b.center[axis] = (*center_)[axis][lane];
        }
        b.radius = radius_[lane];
        return b;
    }
    /// [lower x, y, z, upper x, y, z][lane], as the planes of a node.
    using Rows = float[6][kBlockWidth];
    [[nodiscard]] HWY_INLINE const Rows& rows() const { return rows_; }

  private:
    HWY_INLINE void set(const float (&center)[3][kBlockWidth], const Floats (&half)[3],
                        const Floats& radius) {
        // Covers some roundings of numbers up to 2.
        const Floats room(0x1p-20f);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const Floats c = load_lanes(center[axis]), h = half[axis] + room;
            store_lanes(c - h, rows_[axis]);
            store_lanes(c + h, rows_[3 + axis]);
        }
        store_lanes(radius, radius_);
        center_ = &center;
    }

    HWY_ALIGN Rows rows_;
    HWY_ALIGN float radius_[kBlockWidth];
    const float (*center_)[3][kBlockWidth];
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
