/// Formulas of surfaces in lanes that several shapes share.
///
/// Source: math/unit_vector.h, the same operations in the same order.
/// Conventions: included once per target (see simd/lanes-inl.h); internal to shapes/.

#if defined(ALHAZEN_SHAPES_CORE_LANE_SURFACE_FORMULAS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SHAPES_CORE_LANE_SURFACE_FORMULAS_INL_H_
#undef ALHAZEN_SHAPES_CORE_LANE_SURFACE_FORMULAS_INL_H_
#else
#define ALHAZEN_SHAPES_CORE_LANE_SURFACE_FORMULAS_INL_H_
#endif

#include "alhazen/math/affine.h"
#include "alhazen/shapes/core/lane_surfaces.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace lane_surface_formulas {

using Vectors = VectorLanes<kRayLanes>;
using Mask = LaneMask<double>;

HWY_INLINE Vectors vectors_of(const Vec3& v) {
    return {Doubles(v.x), Doubles(v.y), Doubles(v.z)};
}
HWY_INLINE Vectors times(const Mat3& m, const Vectors& v) {
    return v.x * vectors_of(m.x_axis) + v.y * vectors_of(m.y_axis) + v.z * vectors_of(m.z_axis);
}
HWY_INLINE Vectors transpose_times(const Mat3& m, const Vectors& v) {
    return {dot(vectors_of(m.x_axis), v), dot(vectors_of(m.y_axis), v),
            dot(vectors_of(m.z_axis), v)};
}
/// The points of the rays at their hits.
HWY_INLINE Vectors hit_points(const LaneSurfaces& lanes) {
    return load_vectors(lanes.origin) + load_lanes(lanes.t) * load_vectors(lanes.direction);
}
/// `unit_or` where it needs no fallback: `sure` loses the other lanes.
HWY_INLINE Vectors unit_of(const Vectors& v, Mask& sure) {
    const Doubles squared = dot(v, v);
    sure = sure & (squared > Doubles(1e-200)) & (squared < Doubles(1e200));
    return v / sqrt(squared);
}
/// Stores the surfaces; returns the lanes of `wanted` that are sure.
HWY_INLINE std::uint32_t finish(const Vectors& point, const Vectors& normal, const Mask& sure,
                                std::uint32_t wanted, LaneSurfaces& lanes) {
    store_vectors(point, lanes.point);
    store_vectors(normal, lanes.normal);
    return wanted & bits_of(sure);
}

}  // namespace lane_surface_formulas
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
