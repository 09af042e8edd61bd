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

#include <type_traits>

#include "alhazen/math/affine.h"
#include "alhazen/shapes/core/lane_surfaces.h"
#include "alhazen/simd/lane_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {
namespace lane_surface_formulas {

template <std::size_t N>
using Numbers = Lanes<double, N>;

/// Calls f(N, first, set), N an integral constant, for blocks of lanes that hold all of `wanted`:
/// `set` is `wanted` from lane `first` on. Returns the union of the sets that f returns.
template <class F>
HWY_INLINE std::uint32_t for_blocks_of_eight(std::uint32_t wanted, F&& f) {
    using Eight = std::integral_constant<std::size_t, 8>;
    const std::uint32_t low = f(Eight(), std::size_t{0}, wanted & 0xff), high = wanted >> 8;
    return high == 0 ? low : low | f(Eight(), std::size_t{8}, high) << 8;
}
/// The same with blocks of sixteen where registers hold eight doubles.
template <class F>
HWY_INLINE std::uint32_t for_lane_blocks(std::uint32_t wanted, F&& f) {
#if HWY_CAP_GE512
    if (wanted >> 8 != 0) {
        return f(std::integral_constant<std::size_t, 16>(), std::size_t{0}, wanted);
    }
#endif
    return for_blocks_of_eight(wanted, f);
}

template <std::size_t N>
HWY_INLINE VectorLanes<N> vectors_of(const Vec3& v) {
    return {Numbers<N>(v.x), Numbers<N>(v.y), Numbers<N>(v.z)};
}
/// Loads or stores N lanes from lane `first` on.
template <std::size_t N>
HWY_INLINE VectorLanes<N> load_from(const double (&rows)[3][kSurfaceLanes], std::size_t first) {
    return {load_lanes<N>(rows[0] + first), load_lanes<N>(rows[1] + first),
            load_lanes<N>(rows[2] + first)};
}
template <std::size_t N>
HWY_INLINE void store_from(const VectorLanes<N>& v, double (&rows)[3][kSurfaceLanes],
                           std::size_t first) {
    store_lanes(v.x, rows[0] + first);
    store_lanes(v.y, rows[1] + first);
    store_lanes(v.z, rows[2] + first);
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> times(const Mat3& m, const VectorLanes<N>& v) {
    return v.x * vectors_of<N>(m.x_axis) + v.y * vectors_of<N>(m.y_axis) +
           v.z * vectors_of<N>(m.z_axis);
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> transpose_times(const Mat3& m, const VectorLanes<N>& v) {
    return {dot(vectors_of<N>(m.x_axis), v), dot(vectors_of<N>(m.y_axis), v),
            dot(vectors_of<N>(m.z_axis), v)};
}
/// The points of the rays at their hits.
template <std::size_t N>
HWY_INLINE VectorLanes<N> hit_points(const LaneSurfaces& lanes, std::size_t first) {
    return load_from<N>(lanes.origin, first) +
           load_lanes<N>(lanes.t + first) * load_from<N>(lanes.direction, first);
}
/// `unit_or` where it needs no fallback: `sure` loses the other lanes.
template <std::size_t N>
HWY_INLINE VectorLanes<N> unit_of(const VectorLanes<N>& v, LaneMask<double, N>& sure) {
    const Numbers<N> squared = dot(v, v);
    sure = sure & (squared > Numbers<N>(1e-200)) & (squared < Numbers<N>(1e200));
    return v / sqrt(squared);
}
/// Stores the surfaces; returns the lanes of `wanted` that are sure.
template <std::size_t N>
HWY_INLINE std::uint32_t finish(const VectorLanes<N>& point, const VectorLanes<N>& normal,
                                const LaneMask<double, N>& sure, std::uint32_t wanted,
                                std::size_t first, LaneSurfaces& lanes) {
    store_from(point, lanes.point, first);
    store_from(normal, lanes.normal, first);
    return wanted & bits_of(sure);
}

}  // namespace lane_surface_formulas
}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
