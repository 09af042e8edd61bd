/// The filters of spheres, cylinders and slanted boxes on a block: see shape_filters.h.
///
/// Conventions: included once per target (see simd/lanes-inl.h). The filters are not inlined: one
/// copy per target compiles much faster and traces as fast.

#if defined(ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHAPE_FILTERS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHAPE_FILTERS_INL_H_
#undef ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHAPE_FILTERS_INL_H_
#else
#define ALHAZEN_AGGREGATES_WIDE_BVH_LEAVES_SHAPE_FILTERS_INL_H_
#endif

#include <limits>

#include "alhazen/aggregates/wide_bvh/leaves/leaf_blocks.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters.h"
#include "alhazen/aggregates/wide_bvh/leaves/triangle_filter.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// The first parameters at which the lanes that passed a filter may be hit, in the local frame.
struct FilteredShapes {
    HWY_ALIGN float lo[kBlockWidth];
};

/// Three rows of lanes, along the axes of the ray: `F` has a lane for each shape, for one ray, or
/// for each ray, for one shape.
template <class F>
struct AxisRows {
    F x, y, z;
};
HWY_INLINE AxisRows<Floats> load_rows(const float (&rows)[3][kBlockWidth],
                                      const TriangleFilterRay& ray) {
    return {load_lanes(rows[ray.kx]), load_lanes(rows[ray.ky]), load_lanes(rows[ray.kz])};
}
HWY_INLINE AxisRows<Floats> from_center(const float (&center)[3][kBlockWidth],
                                        const TriangleFilterRay& ray) {
    const AxisRows<Floats> c = load_rows(center, ray);
    return {Floats(ray.origin[0]) - c.x, Floats(ray.origin[1]) - c.y, Floats(ray.origin[2]) - c.z};
}
template <class F>
HWY_INLINE F dot_rows(const AxisRows<F>& a, const AxisRows<F>& b) {
    return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
/// a - s b
template <class F>
HWY_INLINE AxisRows<F> minus_scaled(const AxisRows<F>& a, const F& s, const AxisRows<F>& b) {
    return {neg_mul_add(s, b.x, a.x), neg_mul_add(s, b.y, a.y), neg_mul_add(s, b.z, a.z)};
}

/// The part of the ray within all bodies met so far, by its coordinate along the main axis.
template <class F>
struct Chord {
    F first, last;
};

template <class F>
HWY_INLINE void meet_slab(const F& along, const F& slope, const F& half, Chord<F>& chord) {
    const F steep = copysign(max_lanes(abs(slope), F(0x1p-40f)), slope);
    const F inverse = F(1.0f) / steep;
    const F middle = -(along * inverse);
    const F reach = half * abs(inverse);
    chord.first = max_lanes(chord.first, middle - reach);
    chord.last = min_lanes(chord.last, middle + reach);
}

/// Bits of the lanes whose chord is not empty and overlaps the range of the ray.
HWY_INLINE std::uint32_t finish_filter(const Chord<Floats>& chord, const TriangleFilterRay& ray,
                                       float s_min, float s_max, FilteredShapes& out) {
    const Floats sz(ray.sz), slack(ray.s_slack);
    const Floats a = chord.first * sz, b = chord.last * sz;
    const Floats lo = min_lanes(a, b) - slack, hi = max_lanes(a, b) + slack;
    store_lanes(lo, out.lo);
    return kAllLanes &
           ~bits_of((chord.first > chord.last) | (lo > Floats(s_max)) | (hi < Floats(s_min)));
}

/// Passes all lanes, from any parameter, for a ray out of the range of float.
HWY_INLINE bool passes_all(const TriangleFilterRay& ray, FilteredShapes& out) {
    if (HWY_LIKELY(ray.edge_slack < std::numeric_limits<float>::infinity())) return false;
    store_lanes(Floats(-std::numeric_limits<float>::infinity()), out.lo);
    return true;
}

/// Sets `chord` to that of a line `from` + z `slope` in a circle or a sphere around 0. False,
/// without setting anything, if all lanes miss it.
template <class F>
HWY_INLINE bool round_chord(const AxisRows<F>& from, const AxisRows<F>& slope, const F& radius,
                            std::uint32_t used, std::uint32_t& missed, Chord<F>& chord) {
    const F squared = max_lanes(dot_rows(slope, slope), F(0x1p-60f));
    const F inverse = F(1.0f) / squared;
    const F middle = -(dot_rows(from, slope) * inverse);
    const AxisRows<F> nearest = minus_scaled(from, -middle, slope);
    const F room = radius * radius - dot_rows(nearest, nearest);
    missed = bits_of(room < F(0.0f));
    if ((used & ~missed) == 0) return false;
    const F half = sqrt(max_lanes(room, F(0.0f)) * inverse);
    chord = {middle - half, middle + half};
    return true;
}

HWY_NOINLINE inline std::uint32_t shape_candidates(const SphereBlock& block,
                                                   const TriangleFilterRay& ray, float s_min,
                                                   float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return block.lanes;
    const AxisRows<Floats> slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const Floats radius = load_lanes(block.radius) + Floats(kRoundSlack * ray.edge_slack);
    Chord<Floats> chord;
    std::uint32_t missed;
    if (!round_chord(from_center(block.center, ray), slope, radius, block.lanes, missed, chord)) {
        return 0;
    }
    return block.lanes & ~missed & finish_filter(chord, ray, s_min, s_max, out);
}

/// The chord in the cylinder around a shape; false if all of `used` miss it.
template <class F>
HWY_INLINE bool frustum_chord(const AxisRows<F>& from, const AxisRows<F>& slope,
                              const AxisRows<F>& axis, const F& half_height, const F& radius,
                              std::uint32_t used, std::uint32_t& missed, Chord<F>& chord) {
    const F along = dot_rows(axis, from), climb = dot_rows(axis, slope);
    if (!round_chord(minus_scaled(from, along, axis), minus_scaled(slope, climb, axis), radius,
                     used, missed, chord)) {
        return false;
    }
    meet_slab(along, climb, half_height, chord);
    return true;
}

HWY_NOINLINE inline std::uint32_t shape_candidates(const FrustumBlock& block,
                                                   const TriangleFilterRay& ray, float s_min,
                                                   float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return block.lanes;
    const Floats slack(kRoundSlack * ray.edge_slack);
    const AxisRows<Floats> slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    Chord<Floats> chord;
    std::uint32_t missed;
    if (!frustum_chord(from_center(block.center, ray), slope, load_rows(block.axis, ray),
                       load_lanes(block.half_height) + slack, load_lanes(block.radius) + slack,
                       block.lanes, missed, chord)) {
        return 0;
    }
    return block.lanes & ~missed & finish_filter(chord, ray, s_min, s_max, out);
}

/// The chord in the slanted box around a shape.
template <class F>
HWY_INLINE Chord<F> box_chord(const AxisRows<F>& from, const AxisRows<F>& slope,
                              const AxisRows<F> (&direction)[3], const F (&half)[3]) {
    Chord<F> chord{F(-std::numeric_limits<float>::infinity()),
                   F(std::numeric_limits<float>::infinity())};
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        meet_slab(dot_rows(direction[k], from), dot_rows(direction[k], slope), half[k], chord);
    }
    return chord;
}

/// For a ray out of the range of float, unused lanes pass as well.
HWY_NOINLINE inline std::uint32_t shape_candidates(const BoxBlock& block,
                                                   const TriangleFilterRay& ray, float s_min,
                                                   float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return kAllLanes;
    const Floats slack(kSlabSlack * ray.edge_slack);
    const AxisRows<Floats> slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const AxisRows<Floats> direction[3] = {load_rows(block.direction[0], ray),
                                           load_rows(block.direction[1], ray),
                                           load_rows(block.direction[2], ray)};
    const Floats half[3] = {load_lanes(block.half[0]) + slack, load_lanes(block.half[1]) + slack,
                            load_lanes(block.half[2]) + slack};
    return finish_filter(box_chord(from_center(block.center, ray), slope, direction, half), ray,
                         s_min, s_max, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
