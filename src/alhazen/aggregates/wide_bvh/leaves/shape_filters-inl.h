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

/// Parameters, in the local frame, of the lanes that passed a filter.
struct FilteredShapes {
    std::uint32_t sure;               ///< bits of the lanes that are hit for certain
    HWY_ALIGN float lo[kBlockWidth];  ///< not beyond the first hit
    HWY_ALIGN float hi[kBlockWidth];  ///< of sure lanes: not before the first hit
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

/// The crossings of a line with a slab: `middle`, give or take half the width times `stretch`.
template <class F>
struct SlabLine {
    F middle, stretch;
};
template <class F>
HWY_INLINE SlabLine<F> line_in_slab(const F& along, const F& slope) {
    const F steep = copysign(max_lanes(abs(slope), F(0x1p-40f)), slope);
    const F inverse = F(1.0f) / steep;
    return {-(along * inverse), abs(inverse)};
}
template <class F>
HWY_INLINE void clip_to_slab(const SlabLine<F>& line, const F& half, Chord<F>& chord) {
    const F reach = half * line.stretch;
    chord.first = max_lanes(chord.first, line.middle - reach);
    chord.last = min_lanes(chord.last, line.middle + reach);
}
template <class F>
HWY_INLINE Chord<F> whole_line() {
    return {F(-std::numeric_limits<float>::infinity()), F(std::numeric_limits<float>::infinity())};
}

/// What is certainly in the range of a ray.
template <class F>
struct SureRange {
    F sz, slack;  ///< of a coordinate along the main axis: its parameter, and the error of that
    F min, max;

    /// The lanes whose part from `first` to `last` is in the range; `hi`: parameters not before it.
    HWY_INLINE auto holds(const F& first, const F& last, F& hi) const {
        const F a = first * sz, b = last * sz;
        hi = max_lanes(a, b) + slack;
        return (min_lanes(a, b) - slack >= min) & (hi <= max);
    }
};
HWY_INLINE SureRange<Floats> sure_range(const TriangleFilterRay& ray) {
    return {Floats(ray.sz), Floats(ray.s_slack), Floats(ray.sure_min), Floats(ray.sure_max)};
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
    out.sure = 0;
    return true;
}

/// A line that passes round bodies around 0. Its distance is that of its moment, which needs no
/// division: all else waits for less.
template <class F>
struct RoundLine {
    F squared, inverse;  ///< its slope, squared, and one over that
    F middle;            ///< where it is nearest to 0
    F moment;            ///< its distance there times its slope, squared

    HWY_INLINE RoundLine(const AxisRows<F>& from, const AxisRows<F>& slope)
        : squared(max_lanes(dot_rows(slope, slope), F(0x1p-60f))), inverse(F(1.0f) / squared) {
        middle = -(dot_rows(from, slope) * inverse);
        const AxisRows<F> turn{mul_sub(from.y, slope.z, from.z * slope.y),
                               mul_sub(from.z, slope.x, from.x * slope.z),
                               mul_sub(from.x, slope.y, from.y * slope.x)};
        moment = dot_rows(turn, turn);
    }
    /// Half the chord in a circle or a sphere times the slope, squared; negative if that is missed.
    HWY_INLINE F room(const F& radius) const { return mul_sub(radius * radius, squared, moment); }
    /// Half the chord.
    HWY_INLINE F half(const F& room) const { return sqrt(max_lanes(room, F(0.0f))) * inverse; }
    /// The chord in a circle or a sphere, and which lanes miss it.
    HWY_INLINE Chord<F> chord(const F& radius, std::uint32_t& missed) const {
        const F left = room(radius);
        missed = bits_of(left < F(0.0f));
        const F reach = half(left);
        return {middle - reach, middle + reach};
    }
    /// The lanes that cross a circle or sphere between `narrow` and the radius of `outer` for
    /// certain, in the range and in `within`. `hi`: as in FilteredShapes.
    HWY_INLINE auto sure(const Chord<F>& outer, const F& narrow, const Chord<F>& within,
                         const SureRange<F>& range, F& hi) const {
        const F left = room(narrow), reach = half(left);
        const F in = middle - reach, out = middle + reach;
        const F never(std::numeric_limits<float>::infinity());
        F hi_in, hi_out;
        const auto inside = (left > F(0.0f)) & (narrow > F(0.0f));
        const auto enters = inside & range.holds(outer.first, in, hi_in) &
                            (within.first <= outer.first) & (in <= within.last);
        const auto leaves = inside & range.holds(out, outer.last, hi_out) & (within.first <= out) &
                            (outer.last <= within.last);
        hi = min_lanes(select_lanes(enters, hi_in, never), select_lanes(leaves, hi_out, never));
        return enters | leaves;
    }
};

/// If `kAtOnce`, no branch depends on what is computed: for callers that use the result later.
template <bool kAtOnce>
HWY_NOINLINE std::uint32_t shape_candidates(const SphereBlock& block, const TriangleFilterRay& ray,
                                            float s_min, float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return block.lanes;
    const AxisRows<Floats> slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const Floats radius = load_lanes(block.radius), slack(kRoundSlack * ray.edge_slack);
    const RoundLine<Floats> line(from_center(block.center, ray), slope);
    std::uint32_t missed;
    const Chord<Floats> chord = line.chord(radius + slack, missed);
    if (!kAtOnce && (block.lanes & ~missed) == 0) return 0;
    const std::uint32_t met = block.lanes & ~missed & finish_filter(chord, ray, s_min, s_max, out);
    if (!kAtOnce && met == 0) return 0;
    Floats hi;
    out.sure = met & bits_of(line.sure(chord, radius - slack - slack, whole_line<Floats>(),
                                       sure_range(ray), hi));
    store_lanes(hi, out.hi);
    return met;
}

/// A line in the cylinder around a shape: across the axis, and along it.
template <class F>
struct CylinderLine {
    F along, climb;
    RoundLine<F> round;

    HWY_INLINE CylinderLine(const AxisRows<F>& from, const AxisRows<F>& slope,
                            const AxisRows<F>& axis)
        : along(dot_rows(axis, from)),
          climb(dot_rows(axis, slope)),
          round(minus_scaled(from, along, axis), minus_scaled(slope, climb, axis)) {}
    /// The lanes that cross the side of the cylinder for certain, between its ends and in the
    /// range. `side`: the chord in the wider one.
    HWY_INLINE auto sure(const Chord<F>& side, const SlabLine<F>& slab, const F& half_height,
                         const F& radius, const F& slack, const SureRange<F>& range, F& hi) const {
        Chord<F> between = whole_line<F>();
        clip_to_slab(slab, half_height - slack - slack, between);
        return round.sure(side, radius - slack - slack, between, range, hi);
    }
};

template <bool kAtOnce>
HWY_NOINLINE std::uint32_t shape_candidates(const FrustumBlock& block, const TriangleFilterRay& ray,
                                            float s_min, float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return block.lanes;
    const Floats slack(kRoundSlack * ray.edge_slack);
    const AxisRows<Floats> slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const CylinderLine<Floats> line(from_center(block.center, ray), slope,
                                    load_rows(block.axis, ray));
    const Floats radius = load_lanes(block.radius), half_height = load_lanes(block.half_height);
    std::uint32_t missed;
    const Chord<Floats> side = line.round.chord(radius + slack, missed);
    if (!kAtOnce && (block.lanes & ~missed) == 0) return 0;
    const SlabLine<Floats> slab = line_in_slab(line.along, line.climb);
    Chord<Floats> chord = side;
    clip_to_slab(slab, half_height + slack, chord);
    const std::uint32_t met = block.lanes & ~missed & finish_filter(chord, ray, s_min, s_max, out);
    out.sure = 0;
    if (!kAtOnce && (met & block.certain) == 0) return met;
    Floats hi;
    out.sure = met & block.certain &
               bits_of(line.sure(side, slab, half_height, radius, slack, sure_range(ray), hi));
    store_lanes(hi, out.hi);
    return met;
}

/// A line in the slabs of a slanted box.
template <class F>
struct BoxLine {
    F along[3], climb[3];
    SlabLine<F> slab[3];

    HWY_INLINE BoxLine(const AxisRows<F>& from, const AxisRows<F>& slope,
                       const AxisRows<F> (&direction)[3]) {
        HWY_UNROLL(3)
        for (std::size_t k = 0; k < 3; ++k) {
            along[k] = dot_rows(direction[k], from);
            climb[k] = dot_rows(direction[k], slope);
            slab[k] = line_in_slab(along[k], climb[k]);
        }
    }
    /// The squared distance from the axis across the first two slabs, where the line is in the
    /// middle of the third one.
    HWY_INLINE F off_axis() const {
        const F u = mul_add(slab[2].middle, climb[0], along[0]);
        const F v = mul_add(slab[2].middle, climb[1], along[1]);
        return mul_add(u, u, v * v);
    }
    /// How far from the axis the line gets beyond that within the third slab, at most: the length
    /// of a slope is at most 3^(1/2).
    HWY_INLINE F spread(const F& half2) const { return F(1.75f) * (half2 * slab[2].stretch); }
    /// The chord in the box; of flat shapes, if it is not empty, that in the third slab, where
    /// their plane is met.
    HWY_INLINE Chord<F> chord(const F (&half)[3], const F& inset) const {
        Chord<F> across = whole_line<F>();
        clip_to_slab(slab[2], half[2], across);
        Chord<F> chord = across;
        clip_to_slab(slab[0], half[0], chord);
        clip_to_slab(slab[1], half[1], chord);
        const auto plane = (inset < F(BoxBlock::kNotFlat)) & (chord.first <= chord.last);
        return {select_lanes(plane, across.first, chord.first),
                select_lanes(plane, across.last, chord.last)};
    }
    /// The lanes that cross the third slab within the narrower ones of the first two for certain,
    /// or within a narrower disc (BoxBlock::inset), in the range. `half` includes the slack.
    HWY_INLINE auto sure(const F (&half)[3], const F& inset, const F& slack, const F& off,
                         const F& spread, const SureRange<F>& range, F& hi) const {
        const F less = slack + slack + inset;
        Chord<F> within = whole_line<F>(), flat = whole_line<F>();
        clip_to_slab(slab[0], half[0] - less, within);
        clip_to_slab(slab[1], half[1] - less, within);
        clip_to_slab(slab[2], half[2], flat);
        const F room = -(inset + slack + slack + spread);  // of a disc, whose radius is -inset
        const auto in_rectangle =
            (inset >= F(0.0f)) & (within.first <= flat.first) & (flat.last <= within.last);
        const auto in_disc = (room > F(0.0f)) & (off <= room * room);
        return (in_rectangle | in_disc) & range.holds(flat.first, flat.last, hi);
    }
};

/// The lanes of flat shapes whose ball a line does not meet within the third slab. `radius`
/// includes the slack.
template <class F>
HWY_INLINE auto outside_ball(const F& off, const F& spread, const F& radius, const F& inset) {
    const F reach = radius + spread;
    return (inset < F(BoxBlock::kNotFlat)) & (off > reach * reach);
}

/// For a ray out of the range of float, unused lanes pass as well.
template <bool kAtOnce>
HWY_NOINLINE std::uint32_t shape_candidates(const BoxBlock& block, const TriangleFilterRay& ray,
                                            float s_min, float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return kAllLanes;
    const Floats slack(kSlabSlack * ray.edge_slack);
    const AxisRows<Floats> slope{Floats(ray.sx), Floats(ray.sy), Floats(1.0f)};
    const AxisRows<Floats> direction[3] = {load_rows(block.direction[0], ray),
                                           load_rows(block.direction[1], ray),
                                           load_rows(block.direction[2], ray)};
    const Floats half[3] = {load_lanes(block.half[0]) + slack, load_lanes(block.half[1]) + slack,
                            load_lanes(block.half[2]) + slack};
    const BoxLine<Floats> line(from_center(block.center, ray), slope, direction);
    const Floats inset = load_lanes(block.inset);
    std::uint32_t met = finish_filter(line.chord(half, inset), ray, s_min, s_max, out);
    if (!kAtOnce && met == 0) return 0;
    const Floats off = line.off_axis(), spread = line.spread(half[2]);
    met &= ~bits_of(outside_ball(off, spread, load_lanes(block.radius) + slack + slack, inset));
    Floats hi;
    out.sure = met & bits_of(line.sure(half, inset, slack, off, spread, sure_range(ray), hi));
    store_lanes(hi, out.hi);
    return met;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
