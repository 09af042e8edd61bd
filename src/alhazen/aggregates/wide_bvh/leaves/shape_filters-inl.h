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

/// Three rows of lanes, along the axes of the ray.
struct AxisRows {
    Floats x, y, z;
};
HWY_INLINE AxisRows load_rows(const float (&rows)[3][kBlockWidth], const TriangleFilterRay& ray) {
    return {load_lanes(rows[ray.kx]), load_lanes(rows[ray.ky]), load_lanes(rows[ray.kz])};
}
HWY_INLINE AxisRows from_center(const float (&center)[3][kBlockWidth],
                                const TriangleFilterRay& ray) {
    const AxisRows c = load_rows(center, ray);
    return {Floats(ray.origin[0]) - c.x, Floats(ray.origin[1]) - c.y, Floats(ray.origin[2]) - c.z};
}
HWY_INLINE Floats dot_rows(const AxisRows& a, const AxisRows& b) {
    return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
/// a - s b
HWY_INLINE AxisRows minus_scaled(const AxisRows& a, const Floats& s, const AxisRows& b) {
    return {neg_mul_add(s, b.x, a.x), neg_mul_add(s, b.y, a.y), neg_mul_add(s, b.z, a.z)};
}

/// The part of the ray within all bodies met so far, by its coordinate along the main axis.
struct Chord {
    Floats first, last;
};

HWY_INLINE void meet_slab(const Floats& along, const Floats& slope, const Floats& half,
                          Chord& chord) {
    const Floats steep = copysign(max_lanes(abs(slope), Floats(0x1p-40f)), slope);
    const Floats inverse = Floats(1.0f) / steep;
    const Floats middle = -(along * inverse);
    const Floats reach = half * abs(inverse);
    chord.first = max_lanes(chord.first, middle - reach);
    chord.last = min_lanes(chord.last, middle + reach);
}

/// Bits of the lanes whose chord is not empty and overlaps the range of the ray.
HWY_INLINE std::uint32_t finish_filter(const Chord& chord, const TriangleFilterRay& ray,
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
HWY_INLINE bool round_chord(const AxisRows& from, const AxisRows& slope, const Floats& radius,
                            std::uint32_t used, std::uint32_t& missed, Chord& chord) {
    const Floats squared = max_lanes(dot_rows(slope, slope), Floats(0x1p-60f));
    const Floats inverse = Floats(1.0f) / squared;
    const Floats middle = -(dot_rows(from, slope) * inverse);
    const AxisRows nearest = minus_scaled(from, -middle, slope);
    const Floats room = radius * radius - dot_rows(nearest, nearest);
    missed = bits_of(room < Floats(0.0f));
    if ((used & ~missed) == 0) return false;
    const Floats half = sqrt(max_lanes(room, Floats(0.0f)) * inverse);
    chord = {middle - half, middle + half};
    return true;
}

HWY_NOINLINE inline std::uint32_t shape_candidates(const SphereBlock& block,
                                                   const TriangleFilterRay& ray, float s_min,
                                                   float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return block.lanes;
    const AxisRows slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const Floats radius = load_lanes(block.radius) + Floats(kRoundSlack * ray.edge_slack);
    Chord chord;
    std::uint32_t missed;
    if (!round_chord(from_center(block.center, ray), slope, radius, block.lanes, missed, chord)) {
        return 0;
    }
    return block.lanes & ~missed & finish_filter(chord, ray, s_min, s_max, out);
}

HWY_NOINLINE inline std::uint32_t shape_candidates(const FrustumBlock& block,
                                                   const TriangleFilterRay& ray, float s_min,
                                                   float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return block.lanes;
    const Floats slack(kRoundSlack * ray.edge_slack);
    const AxisRows axis = load_rows(block.axis, ray);
    const AxisRows from = from_center(block.center, ray);
    const AxisRows slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const Floats along = dot_rows(axis, from), climb = dot_rows(axis, slope);
    Chord chord;
    std::uint32_t missed;
    if (!round_chord(minus_scaled(from, along, axis), minus_scaled(slope, climb, axis),
                     load_lanes(block.radius) + slack, block.lanes, missed, chord)) {
        return 0;
    }
    meet_slab(along, climb, load_lanes(block.half_height) + slack, chord);
    return block.lanes & ~missed & finish_filter(chord, ray, s_min, s_max, out);
}

/// For a ray out of the range of float, unused lanes pass as well.
HWY_NOINLINE inline std::uint32_t shape_candidates(const BoxBlock& block,
                                                   const TriangleFilterRay& ray, float s_min,
                                                   float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return kAllLanes;
    const Floats slack(kSlabSlack * ray.edge_slack);
    const AxisRows from = from_center(block.center, ray);
    const AxisRows slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    Chord chord{Floats(-std::numeric_limits<float>::infinity()),
                Floats(std::numeric_limits<float>::infinity())};
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
        const AxisRows direction = load_rows(block.direction[k], ray);
        meet_slab(dot_rows(direction, from), dot_rows(direction, slope),
                  load_lanes(block.half[k]) + slack, chord);
    }
    return finish_filter(chord, ray, s_min, s_max, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
