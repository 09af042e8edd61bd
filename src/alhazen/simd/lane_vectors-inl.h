/// Vectors of three coordinates in lanes: one vector a lane, with the operations of math/vec.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_SIMD_LANE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_LANE_VECTORS_INL_H_
#undef ALHAZEN_SIMD_LANE_VECTORS_INL_H_
#else
#define ALHAZEN_SIMD_LANE_VECTORS_INL_H_
#endif

#include <type_traits>

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <std::size_t N = kLaneCount>
struct VectorLanes {
    Lanes<double, N> x, y, z;
};

/// Calls f(N), an integral constant, for the smallest number of lanes, 8 or 16, that holds all bits
/// of `lanes`.
template <class F>
HWY_INLINE void with_lane_count(std::uint32_t lanes, F&& f) {
    if (lanes >> 8 != 0) {
        f(std::integral_constant<std::size_t, 16>());
    } else {
        f(std::integral_constant<std::size_t, 8>());
    }
}

/// Loads or stores the first N lanes of each row.
template <std::size_t N = kLaneCount, std::size_t kRow>
HWY_INLINE VectorLanes<N> load_vectors(const double (&values)[3][kRow]) {
    static_assert(N <= kRow);
    return {load_lanes<N>(values[0]), load_lanes<N>(values[1]), load_lanes<N>(values[2])};
}
template <std::size_t N, std::size_t kRow>
HWY_INLINE void store_vectors(const VectorLanes<N>& v, double (&values)[3][kRow]) {
    static_assert(N <= kRow);
    store_lanes(v.x, values[0]);
    store_lanes(v.y, values[1]);
    store_lanes(v.z, values[2]);
}

template <std::size_t N>
HWY_INLINE VectorLanes<N> operator+(const VectorLanes<N>& a, const VectorLanes<N>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> operator-(const VectorLanes<N>& a, const VectorLanes<N>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> operator-(const VectorLanes<N>& a) {
    return {-a.x, -a.y, -a.z};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> operator*(const Lanes<double, N>& s, const VectorLanes<N>& a) {
    return {s * a.x, s * a.y, s * a.z};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> operator/(const VectorLanes<N>& a, const Lanes<double, N>& s) {
    return {a.x / s, a.y / s, a.z / s};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> abs(const VectorLanes<N>& a) {
    return {abs(a.x), abs(a.y), abs(a.z)};
}
template <std::size_t N>
HWY_INLINE Lanes<double, N> dot(const VectorLanes<N>& a, const VectorLanes<N>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> cross(const VectorLanes<N>& a, const VectorLanes<N>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <std::size_t N>
HWY_INLINE VectorLanes<N> select_lanes(const LaneMask<double, N>& mask, const VectorLanes<N>& yes,
                                       const VectorLanes<N>& no) {
    return {select_lanes(mask, yes.x, no.x), select_lanes(mask, yes.y, no.y),
            select_lanes(mask, yes.z, no.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
