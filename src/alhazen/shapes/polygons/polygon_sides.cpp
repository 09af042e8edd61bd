#include "alhazen/shapes/polygons/polygon_sides.h"

#include "alhazen/simd/dispatch.h"

// Compiles the rest of this file once per target.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "alhazen/shapes/polygons/polygon_sides.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep
// After foreach_target.h.
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace {

// A name of its own, because several kernels may be compiled as one source.
namespace side_formulas {
#include "alhazen/geometry/watertight_triangle_formulas-inl.h"
}  // namespace side_formulas

/// y of a corner; x is not used.
template <class Real>
HWY_INLINE Real sheared_y(const Real& y, const Real& z, const SideRay& ray) {
    const Real zero(0.0);
    return side_formulas::sheared<Real>(zero, y, z, zero, Real(ray.oy), Real(ray.oz), zero,
                                        Real(ray.sy))
        .y;
}

/// Eight corners along two axes.
template <int kY, int kZ>
HWY_INLINE void load_corners(const Vec3* corners, Doubles& y, Doubles& z) {
    const LaneTag<double, kLaneCount> d;
    for (std::size_t i = 0; i < kParts<double, kLaneCount>; ++i) {
        hn::Vec<LaneTag<double, kLaneCount>> axes[3];
        hn::LoadInterleaved3(d, &corners[i * hn::Lanes(d)].x, axes[0], axes[1], axes[2]);
        y.part[i] = axes[kY];
        z.part[i] = axes[kZ];
    }
}

template <int kZ>
std::uint64_t corners_above_along(std::span<const Vec3> corners, const SideRay& ray) {
    constexpr int kY = (kZ + 2) % 3;
    std::uint64_t above = 0;
    std::size_t i = 0;
    for (; i + kLaneCount <= corners.size(); i += kLaneCount) {
        Doubles y, z;
        load_corners<kY, kZ>(corners.data() + i, y, z);
        above |= std::uint64_t{bits_of(sheared_y(y, z, ray) > Doubles(0.0))} << i;
    }
    for (; i < corners.size(); ++i) {
        const Vec3& p = corners.data()[i];
        above |= std::uint64_t{sheared_y(p[kY], p[kZ], ray) > 0.0} << i;
    }
    return above;
}

std::uint64_t corners_above_ray(std::span<const Vec3> corners, const SideRay& ray) {
    if (ray.kz == 0) return corners_above_along<0>(corners, ray);
    if (ray.kz == 1) return corners_above_along<1>(corners, ray);
    return corners_above_along<2>(corners, ray);
}

}  // namespace

using CornersAboveKernel = std::uint64_t (*)(std::span<const Vec3>, const SideRay&);
CornersAboveKernel corners_above_of_target() {
    return &corners_above_ray;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace alhazen {

ALHAZEN_KERNEL_TABLE(corners_above_of_target);

std::uint64_t corners_above(std::span<const Vec3> corners, const SideRay& ray) {
    return ALHAZEN_KERNEL(corners_above_of_target)()(corners, ray);
}

}  // namespace alhazen
#endif
