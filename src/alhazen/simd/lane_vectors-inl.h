/// Vectors of three coordinates in lanes: one vector a lane, with the operations of math/vec.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h).

#if defined(ALHAZEN_SIMD_LANE_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_LANE_VECTORS_INL_H_
#undef ALHAZEN_SIMD_LANE_VECTORS_INL_H_
#else
#define ALHAZEN_SIMD_LANE_VECTORS_INL_H_
#endif

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

struct LaneVectors {
    Doubles x, y, z;
};

HWY_INLINE LaneVectors load_vectors(const double (&values)[3][kLaneCount]) {
    return {load_lanes(values[0]), load_lanes(values[1]), load_lanes(values[2])};
}
HWY_INLINE void store_vectors(const LaneVectors& v, double (&values)[3][kLaneCount]) {
    store_lanes(v.x, values[0]);
    store_lanes(v.y, values[1]);
    store_lanes(v.z, values[2]);
}

HWY_INLINE LaneVectors operator+(const LaneVectors& a, const LaneVectors& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE LaneVectors operator-(const LaneVectors& a, const LaneVectors& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE LaneVectors operator-(const LaneVectors& a) {
    return {-a.x, -a.y, -a.z};
}
HWY_INLINE LaneVectors operator*(const Doubles& s, const LaneVectors& a) {
    return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE LaneVectors operator/(const LaneVectors& a, const Doubles& s) {
    return {a.x / s, a.y / s, a.z / s};
}
HWY_INLINE LaneVectors abs(const LaneVectors& a) {
    return {abs(a.x), abs(a.y), abs(a.z)};
}
HWY_INLINE Doubles dot(const LaneVectors& a, const LaneVectors& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE LaneVectors cross(const LaneVectors& a, const LaneVectors& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE LaneVectors select_lanes(const LaneMask<double>& mask, const LaneVectors& yes,
                                    const LaneVectors& no) {
    return {select_lanes(mask, yes.x, no.x), select_lanes(mask, yes.y, no.y),
            select_lanes(mask, yes.z, no.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
