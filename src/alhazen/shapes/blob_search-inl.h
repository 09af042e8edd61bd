/// Where eight rays enter a blob, from its rows along them, side by side in lanes.
///
/// Source: blob.cpp and math/bernstein_roots.h. Differs: see blob_lanes.h.
/// Conventions: included once per target (see simd/lanes-inl.h); internal to this folder.

#if defined(ALHAZEN_SHAPES_BLOB_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SHAPES_BLOB_SEARCH_INL_H_
#undef ALHAZEN_SHAPES_BLOB_SEARCH_INL_H_
#else
#define ALHAZEN_SHAPES_BLOB_SEARCH_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/shapes/blob_lanes.h"
#include "alhazen/shapes/polynomial_refine-inl.h"
#include "alhazen/shapes/polynomial_roots-inl.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// What all rows together are, and what their sums round.
struct RowTotals {
    Doubles first_in, last_out;
    Doubles most;   ///< no place is stronger
    Doubles error;  ///< no coefficient in a span rounds more: what the scalar text says, or more
    std::uint32_t unknown = 0;  ///< a row of these lanes is no known bump, or rounds too much
};
HWY_INLINE RowTotals totals_of(const Blob& blob, const BlobRayLanes& rays,
                               std::span<const BlobRow> rows) {
    const Doubles infinite(std::numeric_limits<double>::infinity()), none_yet(0.0);
    RowTotals totals{infinite, -infinite, none_yet, none_yet};
    Mask known = infinite > none_yet;
    double strengths = 0.0, by_distance = 0.0, fixed = 0.0, least_radius = 0.0;
    for (const BlobRow& row : rows) {
        const Doubles in = load_lanes(row.in), peak = load_lanes(row.peak);
        const Doubles strength(std::max(0.0, row.strength));
        totals.first_in = min_lanes(totals.first_in, in);
        totals.last_out = max_lanes(totals.last_out, load_lanes(row.out));
        const Doubles q = max_lanes(peak, none_yet);
        totals.most = totals.most + strength * (q * q);
        known = known & ((load_lanes(row.bend) > none_yet) | (peak < none_yet));
        const double size = std::abs(row.strength);
        strengths += size;
        by_distance += size * row.inverse_radius;
        fixed += size * (128.0 + 192.0 * row.span * row.inverse_radius);
        least_radius = std::max(least_radius, row.inverse_radius);
    }
    Doubles coordinates = abs(load_lanes(rays.origin[0]));
    for (int k = 1; k < 3; ++k) {
        coordinates = max_lanes(coordinates, abs(load_lanes(rays.origin[k])));
    }
    const Doubles distance = load_lanes(rays.far) + Doubles(blob.reach);
    fixed += 4.0 * static_cast<double>(rows.size()) * (blob.threshold + strengths);
    totals.error = Doubles(1.001 * 0x1p-53) *
                   (Doubles(192.0 * by_distance) * (distance + coordinates) + Doubles(fixed));
    // As LocalRay::room: what a bump rounds must be nothing beside what makes it weak.
    const Doubles room = Doubles(0x1p-46 * least_radius) * distance;
    known = known & (Doubles(3.0 * strengths) * room < Doubles(0.0004 * blob.threshold));
    totals.unknown = kAllLanes & ~bits_of(known);
    return totals;
}

/// The span of each lane that begins at t0: where it ends, and its polynomial.
HWY_INLINE Doubles span_end(std::span<const BlobRow> rows, const Doubles& t0) {
    Doubles t1(std::numeric_limits<double>::infinity());
    for (const BlobRow& row : rows) {
        const Doubles in = load_lanes(row.in), out = load_lanes(row.out);
        t1 = select(in > t0, min_lanes(t1, in), t1);
        t1 = select(out > t0, min_lanes(t1, out), t1);
    }
    return t1;
}
HWY_INLINE void span_polynomial(const Blob& blob, std::span<const BlobRow> rows, const Doubles& t0,
                                const Doubles& t1, Doubles* b) {
    const Doubles nothing(0.0);
    for (int k = 0; k <= 4; ++k) b[k] = Doubles(blob.threshold);
    for (const BlobRow& row : rows) {
        const Mask holds = (load_lanes(row.in) <= t0) & (load_lanes(row.out) > t0);
        if (none(holds)) continue;
        const Doubles s = select(holds, Doubles(row.strength), nothing);
        const Doubles third = select(holds, Doubles(row.strength * (1.0 / 3.0)), nothing);
        take_bump(load_lanes(row.middle), load_lanes(row.peak), load_lanes(row.bend), t0, t1, s,
                  third, b);
    }
}
/// The last place at or before t where a piece begins or ends.
HWY_INLINE Doubles event_before(std::span<const BlobRow> rows, const Doubles& t) {
    Doubles event(-std::numeric_limits<double>::infinity());
    for (const BlobRow& row : rows) {
        const Doubles in = load_lanes(row.in), out = load_lanes(row.out);
        event = select(in <= t, max_lanes(event, in), event);
        event = select(out <= t, max_lanes(event, out), event);
    }
    return event;
}

/// What the signs of the coefficients of a span tell.
struct SpanSigns {
    std::uint32_t outside = 0;  ///< all of it
    std::uint32_t once = 0, twice = 0;  ///< it begins outside and the signs change so often
};
HWY_INLINE SpanSigns span_signs(const Doubles* b, const Doubles& error) {
    Doubles total = abs(b[0]);
    for (int k = 1; k <= 4; ++k) total = total + abs(b[k]);
    Mask known = is_finite(total);
    std::uint32_t negative[5];
    for (int k = 0; k <= 4; ++k) {
        known = known & (abs(b[k]) > error);
        negative[k] = bits_of(b[k] < Doubles(0.0));
    }
    const std::uint32_t begins = bits_of(known) & ~negative[0];
    std::uint32_t one = 0, two = 0, three = 0;  // so many changes and more
    for (int k = 1; k <= 4; ++k) {
        const std::uint32_t change = negative[k] ^ negative[k - 1];
        three |= two & change;
        two |= one & change;
        one |= change;
    }
    return {begins & ~one, begins & one & ~two, begins & two & ~three};
}

/// The spans in which rays enter, with their polynomials.
struct EnteredSpans {
    PolynomialLanes lanes;
    Doubles t0, t1;
    std::uint32_t once = 0, twice = 0;

    HWY_INLINE void set(const SpanSigns& signs, const Doubles* b, const Doubles& from,
                        const Doubles& to) {
        const std::uint32_t entered = signs.once | signs.twice;
        const Mask mask = mask_of(entered);
        const bool first = (once | twice) == 0;
        for (int k = 0; k <= 4; ++k) {
            store_lanes(first ? b[k] : select(mask, b[k], load_lanes(lanes.b[k])), lanes.b[k]);
        }
        t0 = first ? from : select(mask, from, t0);
        t1 = first ? to : select(mask, to, t1);
        once |= signs.once;
        twice |= signs.twice;
    }
};

/// Refines where the rays enter: t of these lanes; `unsure`, those in which it is not found.
HWY_INLINE Doubles entries(EnteredSpans& spans, const Doubles& error, std::uint32_t& unsure) {
    const Doubles unit(1.0), start(0.0);
    Doubles hi = unit;
    spans.lanes.degree = 4;
    store_lanes(error, spans.lanes.error);
    if (spans.twice != 0) {
        Doubles middle;
        const std::uint32_t found = spans.twice & find_between<4>(spans.lanes, unit, middle);
        hi = select(mask_of(found), middle, hi);
        unsure |= spans.twice & ~found;
        spans.once |= found;
    }
    store_lanes(start, spans.lanes.lo);
    store_lanes(hi, spans.lanes.hi);
    store_lanes(unit, spans.lanes.sign_lo);
    Doubles u = polished<4>(spans.lanes, mask_of(spans.once));
    u = select(u < start, start, select(hi < u, hi, u));
    return spans.t0 + u * (spans.t1 - spans.t0);
}

inline void search(const Blob& blob, const BlobRayLanes& rays, std::span<const BlobRow> rows,
                   BlobHitLanes& out) {
    const RowTotals totals = totals_of(blob, rays, rows);
    const Doubles shift = load_lanes(rays.shift), t_min = load_lanes(rays.t_min),
                  t_max = load_lanes(rays.t_max);
    // Where the rays begin, or earlier by more than what is rounded.
    const Doubles begin = (t_min - shift) - Doubles(0x1p-48) * (abs(t_min) + abs(shift));
    out.hit = 0;
    out.unsure = kAllLanes & ~(rays.finite & ~totals.unknown & bits_of(begin <= begin));
    const std::uint32_t strong =
        kAllLanes & ~bits_of(totals.most < Doubles(0.9985 * blob.threshold));
    std::uint32_t left = strong & ~out.unsure;
    if (left == 0) return;
    Doubles t0 = totals.first_in;
    if (const std::uint32_t late = left & bits_of(begin > t0); late != 0) {
        t0 = select(mask_of(late), event_before(rows, begin), t0);
    }
    EnteredSpans entered;
    for (;;) {
        left &= bits_of((t0 < totals.last_out) & (shift + t0 <= t_max));
        if (left == 0) break;
        const Doubles t1 = span_end(rows, t0);
        Doubles b[5];
        span_polynomial(blob, rows, t0, t1, b);
        SpanSigns signs = span_signs(b, totals.error);
        signs.once &= left;
        signs.twice &= left;
        out.unsure |= left & ~(signs.outside | signs.once | signs.twice);
        if ((signs.once | signs.twice) != 0) entered.set(signs, b, t0, t1);
        left &= signs.outside;
        t0 = t1;
    }
    if ((entered.once | entered.twice) == 0) return;
    const Doubles at = shift + entries(entered, totals.error, out.unsure);
    store_lanes(at, out.t);
    out.hit = entered.once & bits_of((t_min <= at) & (at <= t_max));
    out.unsure |= entered.once & ~(out.hit | bits_of(at > t_max));
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
