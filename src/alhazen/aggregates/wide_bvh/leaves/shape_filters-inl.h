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

#include "alhazen/aggregates/wide_bvh/leaves/rays_at_blocks-inl.h"
#include "alhazen/aggregates/wide_bvh/leaves/shape_filters.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

template <class In>
HWY_INLINE AxisRows<typename In::F> from_center(const In& in) {
    const auto c = axis_rows(
        in, [](const auto& block) HWY_ATTR -> const auto& { return block.center; });
    return origin_of(in) - c;
}
/// The part of the ray within all bodies met so far, by its coordinate along the main axis, or by
/// its parameter where those of round bodies are (RoundLine).
template <class F>
struct Chord {
    F first, last;
};

/// The crossings of a line with a slab: `middle`, give or take half the width times `stretch`.
template <class F>
struct SlabLine {
    F middle, stretch;
};
/// `unit`: 1, or the parameter of a coordinate of 1 along the main axis.
template <class F>
HWY_INLINE SlabLine<F> line_in_slab(const F& along, const F& slope, const F& unit) {
    const F steep = copysign(max_lanes(abs(slope), F(0x1p-40f)), slope);
    const F inverse = unit / steep;
    return {-(along * inverse), abs(inverse)};
}
template <class F>
HWY_INLINE Chord<F> chord_in_slab(const SlabLine<F>& line, const F& half) {
    const F reach = half * line.stretch;
    return {line.middle - reach, line.middle + reach};
}
template <class F>
HWY_INLINE Chord<F> common_part(const Chord<F>& a, const Chord<F>& b) {
    return {max_lanes(a.first, b.first), min_lanes(a.last, b.last)};
}

/// What is certainly in the range of a ray.
template <class F>
struct SureRange {
    F slack;  ///< the error of a parameter
    F min, max;

    /// A part of the ray that is certainly in the range.
    [[nodiscard]] HWY_INLINE Chord<F> certain() const { return {min + slack, max - slack}; }
    /// The lanes whose part from `first` to `last` is in the range; `hi`: parameters not before it.
    HWY_INLINE auto holds(const F& first, const F& last, F& hi) const {
        hi = last + slack;
        return (first - slack >= min) & (hi <= max);
    }
};
template <class In>
HWY_INLINE SureRange<typename In::F> sure_range(const In& in) {
    return {in.number([](const auto& at) HWY_ATTR { return at.ray.s_slack; }),
            in.number([](const auto& at) HWY_ATTR { return at.ray.sure_min; }),
            in.number([](const auto& at) HWY_ATTR { return at.ray.sure_max; })};
}

/// Bits of the lanes whose chord is not empty and overlaps the range of the ray.
template <class In>
HWY_INLINE std::uint32_t finish_filter(const In& in, const Chord<typename In::F>& parameters) {
    using F = typename In::F;
    const F slack = in.number([](const auto& at) HWY_ATTR { return at.ray.s_slack; });
    const F lo = parameters.first - slack, hi = parameters.last + slack;
    in.set_lo(lo);
    const F s_min = in.number([](const auto& at) HWY_ATTR { return at.s_min; });
    const F s_max = in.number([](const auto& at) HWY_ATTR { return at.s_max; });
    return all_lanes_of(in) &
           ~bits_of((parameters.first > parameters.last) | (lo > s_max) | (hi < s_min));
}
/// Passes all lanes, from any parameter, for a ray out of the range of float.
HWY_INLINE bool passes_all(const TriangleFilterRay& ray, FilteredShapes& out) {
    if (HWY_LIKELY(ray.edge_slack < std::numeric_limits<float>::infinity())) return false;
    store_lanes(Floats(-std::numeric_limits<float>::infinity()), out.lo);
    out.sure = 0;
    return true;
}

/// A line that passes round bodies around 0, by its parameters. Its distance is that of its moment,
/// which needs no division: all else waits for less.
template <class F>
struct RoundLine {
    F squared;   ///< its slope, squared
    F quotient;  ///< the parameter of a coordinate of 1 along the main axis over that
    F middle;    ///< where it is nearest to 0
    F moment;    ///< its distance there times its slope, squared

    HWY_INLINE RoundLine(const AxisRows<F>& from, const AxisRows<F>& slope, const F& unit)
        : squared(max_lanes(dot_rows(slope, slope), F(0x1p-60f))), quotient(unit / squared) {
        middle = -(dot_rows(from, slope) * quotient);
        quotient = abs(quotient);
        const AxisRows<F> turn{mul_sub(from.y, slope.z, from.z * slope.y),
                               mul_sub(from.z, slope.x, from.x * slope.z),
                               mul_sub(from.x, slope.y, from.y * slope.x)};
        moment = dot_rows(turn, turn);
    }
    /// Half the chord in a circle or a sphere times the slope, squared; negative if that is missed.
    HWY_INLINE F room(const F& radius) const { return mul_sub(radius * radius, squared, moment); }
    /// Half the chord.
    HWY_INLINE F half(const F& room) const { return sqrt(max_lanes(room, F(0.0f))) * quotient; }
    /// The chord in a circle or a sphere, and which lanes miss it.
    HWY_INLINE Chord<F> chord(const F& radius, std::uint32_t& missed) const {
        const F left = room(radius);
        missed = bits_of(left < F(0.0f));
        const F reach = half(left);
        return {middle - reach, middle + reach};
    }
    /// The lanes that cross a circle or sphere between `narrow` and the radius of `outer` for
    /// certain, in the range. `hi`: as in FilteredShapes.
    HWY_INLINE auto sure(const Chord<F>& outer, const F& narrow, const SureRange<F>& range,
                         F& hi) const {
        const F left = room(narrow), reach = half(left);
        const F never(std::numeric_limits<float>::infinity());
        F hi_in, hi_out;
        const auto inside = (left > F(0.0f)) & (narrow > F(0.0f));
        const auto enters = inside & range.holds(outer.first, middle - reach, hi_in);
        const auto leaves = inside & range.holds(middle + reach, outer.last, hi_out);
        hi = min_lanes(select_lanes(enters, hi_in, never), select_lanes(leaves, hi_out, never));
        return enters | leaves;
    }
    /// Those that enter it, in `within`, which is in the range.
    HWY_INLINE auto surely_enters(const Chord<F>& outer, const F& narrow, const Chord<F>& within,
                                  const SureRange<F>& range, F& hi) const {
        const F left = room(narrow), in = middle - half(left);
        hi = in + range.slack;
        return (left > F(0.0f)) & (narrow > F(0.0f)) & (within.first <= outer.first) &
               (in <= within.last);
    }
};

/// The filters. If `kAtOnce`, no branch depends on what is computed: for callers that use the
/// result later.
template <bool kAtOnce, template <class> class In>
HWY_INLINE std::uint32_t filter_shapes(const In<SphereBlock>& in) {
    using F = typename In<SphereBlock>::F;
    const std::uint32_t lanes = in.bits([](const auto& block) HWY_ATTR { return block.lanes; });
    const F radius =
        in.row([](const auto& block, const auto&) HWY_ATTR -> const auto& { return block.radius; });
    const F slack =
        in.number([](const auto& at) HWY_ATTR { return kRoundSlack * at.ray.edge_slack; });
    const RoundLine<F> line(from_center(in), slopes_of(in), parameter_unit(in));
    std::uint32_t missed;
    const Chord<F> chord = line.chord(radius + slack, missed);
    if (!kAtOnce && (lanes & ~missed) == 0) return 0;
    const std::uint32_t met = lanes & ~missed & finish_filter(in, chord);
    if (!kAtOnce && met == 0) return 0;
    F hi;
    const std::uint32_t sure =
        met & bits_of(line.sure(chord, radius - slack - slack, sure_range(in), hi));
    in.set_sure(sure, hi);
    return met;
}

/// A line in the cylinder around a shape: across the axis, and along it.
template <class F>
struct CylinderLine {
    F along, climb;
    RoundLine<F> round;

    HWY_INLINE CylinderLine(const AxisRows<F>& from, const AxisRows<F>& slope,
                            const AxisRows<F>& axis, const F& unit)
        : along(dot_rows(axis, from)),
          climb(dot_rows(axis, slope)),
          round(minus_scaled(from, along, axis), minus_scaled(slope, climb, axis), unit) {}
    /// The lanes that enter the cylinder through its side for certain, between its ends and in the
    /// range. `side`: the chord in the wider one. Few rays only leave through it.
    HWY_INLINE auto sure(const Chord<F>& side, const SlabLine<F>& slab, const F& half_height,
                         const F& radius, const F& slack, const SureRange<F>& range, F& hi) const {
        const Chord<F> between =
            common_part(range.certain(), chord_in_slab(slab, half_height - slack - slack));
        return round.surely_enters(side, radius - slack - slack, between, range, hi);
    }
};

template <bool kAtOnce, template <class> class In>
HWY_INLINE std::uint32_t filter_shapes(const In<FrustumBlock>& in) {
    using F = typename In<FrustumBlock>::F;
    const std::uint32_t lanes = in.bits([](const auto& block) HWY_ATTR { return block.lanes; });
    const F slack =
        in.number([](const auto& at) HWY_ATTR { return kRoundSlack * at.ray.edge_slack; });
    const F unit = parameter_unit(in);
    const CylinderLine<F> line(
        from_center(in), slopes_of(in),
        axis_rows(
            in, [](const auto& block) HWY_ATTR -> const auto& { return block.axis; }),
        unit);
    const F radius =
        in.row([](const auto& block, const auto&) HWY_ATTR -> const auto& { return block.radius; });
    const F half_height = in.row([](const auto& block, const auto&)
                                     HWY_ATTR -> const auto& { return block.half_height; });
    std::uint32_t missed;
    const Chord<F> side = line.round.chord(radius + slack, missed);
    if (!kAtOnce && (lanes & ~missed) == 0) return 0;
    const SlabLine<F> slab = line_in_slab(line.along, line.climb, unit);
    const Chord<F> chord = common_part(side, chord_in_slab(slab, half_height + slack));
    const std::uint32_t met = lanes & ~missed & finish_filter(in, chord);
    const std::uint32_t certain =
        met & in.bits([](const auto& block) HWY_ATTR { return block.certain; });
    if (!kAtOnce && certain == 0) {
        in.set_none_sure();
        return met;
    }
    F hi;
    const std::uint32_t sure =
        certain & bits_of(line.sure(side, slab, half_height, radius, slack, sure_range(in), hi));
    in.set_sure(sure, hi);
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
            slab[k] = line_in_slab(along[k], climb[k], F(1.0f));
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
        const Chord<F> across = chord_in_slab(slab[2], half[2]);
        const Chord<F> aside =
            common_part(chord_in_slab(slab[0], half[0]), chord_in_slab(slab[1], half[1]));
        const Chord<F> chord = common_part(across, aside);
        const auto plane = (inset < F(BoxBlock::kNotFlat)) & (chord.first <= chord.last);
        return {select_lanes(plane, across.first, chord.first),
                select_lanes(plane, across.last, chord.last)};
    }
    /// The lanes that cross the third slab within the narrower ones of the first two for certain,
    /// or within a narrower disc (BoxBlock::inset), in the range. `half` includes the slack;
    /// `parameters`: of the chord in the third slab.
    HWY_INLINE auto sure(const F (&half)[3], const F& inset, const F& slack, const F& off,
                         const F& spread, const Chord<F>& parameters, const SureRange<F>& range,
                         F& hi) const {
        const F less = slack + slack + inset;
        const Chord<F> within = common_part(chord_in_slab(slab[0], half[0] - less),
                                            chord_in_slab(slab[1], half[1] - less));
        const Chord<F> flat = chord_in_slab(slab[2], half[2]);
        const F room = -(inset + slack + slack + spread);  // of a disc, whose radius is -inset
        const auto in_rectangle =
            (inset >= F(0.0f)) & (within.first <= flat.first) & (flat.last <= within.last);
        const auto in_disc = (room > F(0.0f)) & (off <= room * room);
        return (in_rectangle | in_disc) & range.holds(parameters.first, parameters.last, hi);
    }
};

/// The lanes of flat shapes whose ball a line does not meet within the third slab. `radius`
/// includes the slack.
template <class F>
HWY_INLINE auto outside_ball(const F& off, const F& spread, const F& radius, const F& inset) {
    const F reach = radius + spread;
    return (inset < F(BoxBlock::kNotFlat)) & (off > reach * reach);
}

template <bool kAtOnce, template <class> class In>
HWY_INLINE std::uint32_t filter_shapes(const In<BoxBlock>& in) {
    using F = typename In<BoxBlock>::F;
    const F slack =
        in.number([](const auto& at) HWY_ATTR { return kSlabSlack * at.ray.edge_slack; });
    const auto direction_of = [&](std::size_t k) HWY_ATTR {
        return axis_rows(
            in, [k](const auto& block) HWY_ATTR -> const auto& { return block.direction[k]; });
    };
    const auto half_of = [&](std::size_t k) HWY_ATTR {
        return slack + in.row([k](const auto& block, const auto&)
                                  HWY_ATTR -> const auto& { return block.half[k]; });
    };
    const AxisRows<F> direction[3] = {direction_of(0), direction_of(1), direction_of(2)};
    const F half[3] = {half_of(0), half_of(1), half_of(2)};
    const BoxLine<F> line(from_center(in), slopes_of(in), direction);
    const F inset =
        in.row([](const auto& block, const auto&) HWY_ATTR -> const auto& { return block.inset; });
    const F radius =
        in.row([](const auto& block, const auto&) HWY_ATTR -> const auto& { return block.radius; });
    const Chord<F> chord = line.chord(half, inset);
    const F unit = parameter_unit(in), a = chord.first * unit, b = chord.last * unit;
    // Where the chord is empty, NaN among others, it is in parameters, too.
    const Chord<F> parameters{min_lanes(a, b), max_lanes(a, b)};
    std::uint32_t met = finish_filter(in, parameters) & ~bits_of(chord.first > chord.last);
    if (!kAtOnce && met == 0) return 0;
    const F off = line.off_axis(), spread = line.spread(half[2]);
    met &= ~bits_of(outside_ball(off, spread, radius + slack + slack, inset));
    F hi;
    const std::uint32_t sure =
        met & bits_of(line.sure(half, inset, slack, off, spread, parameters, sure_range(in), hi));
    in.set_sure(sure, hi);
    return met;
}

/// Bits of the lanes that pass all of it where a ray is out of the range of float.
HWY_INLINE std::uint32_t all_lanes(const BoxBlock&) {
    return kAllLanes;  // unused ones as well
}
template <class Block>
HWY_INLINE std::uint32_t all_lanes(const Block& block) {
    return block.lanes;
}

/// Bits of the lanes that the ray may hit. Not inlined.
template <bool kAtOnce, class Block>
HWY_NOINLINE std::uint32_t shape_candidates(const Block& block, const TriangleFilterRay& ray,
                                            float s_min, float s_max, FilteredShapes& out) {
    if (passes_all(ray, out)) return all_lanes(block);
    return filter_shapes<kAtOnce>(RayAtBlock<Block>{block, ray, s_min, s_max, out});
}
/// The same for two rays that do not pass all lanes; those of the second in the upper half.
template <class Block>
HWY_NOINLINE std::uint32_t shape_candidates(const RayAtBlock<Block>& first,
                                            const RayAtBlock<Block>& second) {
    return filter_shapes<true>(TwoRaysAtBlocks<Block>{first, second});
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
