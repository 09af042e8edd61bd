/// What the filters of triangles and shapes take and find: one ray at a block of eight, or two
/// rays, each at a block of its own, in registers of sixteen.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAYS_AT_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAYS_AT_BLOCKS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAYS_AT_BLOCKS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_RAYS_AT_BLOCKS_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Bits of the triangles of a block that may be hit and of those that certainly are; the range of
/// their parameters in the local frame.
struct FilteredTriangles {
    std::uint32_t candidates, sure;
    HWY_ALIGN float lo[kBlockWidth];
    HWY_ALIGN float hi[kBlockWidth];
};

/// Parameters, in the local frame, of the shapes of a block that passed a filter.
struct FilteredShapes {
    std::uint32_t sure;               ///< bits of the lanes that are hit for certain
    HWY_ALIGN float lo[kBlockWidth];  ///< not beyond the first hit
    HWY_ALIGN float hi[kBlockWidth];  ///< of sure lanes: not before the first hit
};

/// The lane of `bits`, at least one, with the least number.
HWY_INLINE std::size_t lane_of_least(std::uint32_t bits, const float* numbers) {
    auto lane = static_cast<std::size_t>(std::countr_zero(bits));
    for (bits &= bits - 1; bits != 0; bits &= bits - 1) {
        const auto other = static_cast<std::size_t>(std::countr_zero(bits));
        if (numbers[other] < numbers[lane]) lane = other;
    }
    return lane;
}

/// Three rows of lanes, along the axes of the ray: `F` has a lane for each shape, for one ray, or
/// for each ray, for one shape.
template <class F>
struct AxisRows {
    F x, y, z;
};
template <class F>
HWY_INLINE F dot_rows(const AxisRows<F>& a, const AxisRows<F>& b) {
    return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
/// a - s b
template <class F>
HWY_INLINE AxisRows<F> minus_scaled(const AxisRows<F>& a, const F& s, const AxisRows<F>& b) {
    return {neg_mul_add(s, b.x, a.x), neg_mul_add(s, b.y, a.y), neg_mul_add(s, b.z, a.z)};
}
template <class F>
HWY_INLINE AxisRows<F> operator-(const AxisRows<F>& a, const AxisRows<F>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Three rows of a block along the axes of `axes`, which has kx, ky and kz.
template <class Axes>
HWY_INLINE AxisRows<Floats> load_axes(const float (&rows)[3][kBlockWidth], const Axes& axes) {
    return {load_lanes(rows[axes.kx]), load_lanes(rows[axes.ky]), load_lanes(rows[axes.kz])};
}

/// What the filter of a block finds: FilteredTriangles or FilteredShapes.
template <class Block>
struct FilteredBy {
    using Type = FilteredShapes;
};
template <>
struct FilteredBy<TriangleBlock> {
    using Type = FilteredTriangles;
};

/// A ray and a block whose primitives it may hit from `s_min` to `s_max`: what a filter takes, and
/// where it stores what it finds.
template <class Block>
struct RayAtBlock {
    using F = Floats;
    const Block& block;
    const TriangleFilterRay& ray;
    float s_min, s_max;
    typename FilteredBy<Block>::Type& out;

    /// `get` takes the block and the ray, or one of them.
    template <class Get>
    HWY_INLINE F row(Get&& get) const {
        return load_lanes(get(block, ray));
    }
    template <class Get>
    HWY_INLINE F number(Get&& get) const {
        return F(get(*this));
    }
    template <class Get>
    HWY_INLINE std::uint32_t bits(Get&& get) const {
        return get(block);
    }
    HWY_INLINE void set_candidates(std::uint32_t candidates) const { out.candidates = candidates; }
    HWY_INLINE void set_lo(const F& lo) const { store_lanes(lo, out.lo); }
    HWY_INLINE void set_none_sure() const { out.sure = 0; }
    HWY_INLINE void set_sure(std::uint32_t sure, const F& hi) const {
        out.sure = sure;
        store_lanes(hi, out.hi);
    }
};
/// Whether a register holds what is computed of two.
inline constexpr bool kPairsRays = kParts<float, 2 * kBlockWidth> == 1;
/// Two of them, the second in the upper half of the lanes.
template <class Block>
struct TwoRaysAtBlocks {
    using F = Lanes<float, 2 * kBlockWidth>;
    const RayAtBlock<Block>&first, &second;

    template <class Get>
    HWY_INLINE F row(Get&& get) const {
        return joined(first.row(get), second.row(get));
    }
    template <class Get>
    HWY_INLINE F number(Get&& get) const {
        const auto upper = lanes_of_bits<float, 2 * kBlockWidth>(kAllLanes << kBlockWidth);
        return select_lanes(upper, F(get(second)), F(get(first)));
    }
    template <class Get>
    HWY_INLINE std::uint32_t bits(Get&& get) const {
        return get(first.block) | get(second.block) << kBlockWidth;
    }
    HWY_INLINE void set_candidates(std::uint32_t candidates) const {
        first.set_candidates(candidates & kAllLanes);
        second.set_candidates(candidates >> kBlockWidth);
    }
    HWY_INLINE void set_lo(const F& lo) const {
        first.set_lo(lower_half(lo));
        second.set_lo(upper_half(lo));
    }
    HWY_INLINE void set_none_sure() const { first.out.sure = second.out.sure = 0; }
    HWY_INLINE void set_sure(std::uint32_t sure, const F& hi) const {
        first.set_sure(sure & kAllLanes, lower_half(hi));
        second.set_sure(sure >> kBlockWidth, upper_half(hi));
    }
};

/// Rows along the axes of the ray; `rows` takes a block.
template <class In, class Rows>
HWY_INLINE AxisRows<typename In::F> axis_rows(const In& in, Rows&& rows) {
    const auto row = [&](std::uint32_t TriangleFilterRay::*axis) HWY_ATTR {
        return in.row([&](const auto& block, const TriangleFilterRay& ray)
                          HWY_ATTR { return rows(block)[ray.*axis]; });
    };
    return {row(&TriangleFilterRay::kx), row(&TriangleFilterRay::ky), row(&TriangleFilterRay::kz)};
}
template <class In>
HWY_INLINE AxisRows<typename In::F> slopes_of(const In& in) {
    return {in.number([](const auto& at) HWY_ATTR { return at.ray.sx; }),
            in.number([](const auto& at) HWY_ATTR { return at.ray.sy; }), typename In::F(1.0f)};
}
template <class In>
HWY_INLINE AxisRows<typename In::F> origin_of(const In& in) {
    return {in.number([](const auto& at) HWY_ATTR { return at.ray.origin[0]; }),
            in.number([](const auto& at) HWY_ATTR { return at.ray.origin[1]; }),
            in.number([](const auto& at) HWY_ATTR { return at.ray.origin[2]; })};
}
template <class In>
HWY_INLINE std::uint32_t all_lanes_of(const In& in) {
    return in.bits([](const auto&) HWY_ATTR { return kAllLanes; });
}
/// The parameter of a coordinate of 1 along the main axis.
template <class In>
HWY_INLINE typename In::F parameter_unit(const In& in) {
    return in.number([](const auto& at) HWY_ATTR { return at.ray.sz; });
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
