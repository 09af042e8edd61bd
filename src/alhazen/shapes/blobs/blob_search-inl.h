/// The entry points of eight rays into a blob, from its rows along them, in lanes.
///
/// Source: blob.cpp and math/bernstein_roots.h.
/// Differs: as in blob_lanes.h.
/// Conventions: included once per target (see simd/lanes-inl.h); internal to this folder.

#if defined(ALHAZEN_SHAPES_BLOBS_BLOB_SEARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SHAPES_BLOBS_BLOB_SEARCH_INL_H_
#undef ALHAZEN_SHAPES_BLOBS_BLOB_SEARCH_INL_H_
#else
#define ALHAZEN_SHAPES_BLOBS_BLOB_SEARCH_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <limits>

#include "alhazen/shapes/algebraic/polynomial_refine-inl.h"
#include "alhazen/shapes/algebraic/polynomial_roots-inl.h"
#include "alhazen/shapes/blobs/blob_lanes.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Bounds over all rows, and the rounding of their sums.
struct RowTotals {
    Doubles first_in, last_out;
    Doubles most;   ///< upper bound of the density
    Doubles error;  ///< rounding bound of a span's coefficients, at least the scalar one
    std::uint32_t unknown = 0;  ///< lanes with a row that is no known bump, or that rounds too much
};
HWY_INLINE RowTotals totals_of(const Blob& blob, const BlobRayLanes& rays,
                               std::span<const BlobRow> rows) {
    const Doubles infinite(std::numeric_limits<double>::infinity()), none_yet(0.0);
    RowTotals totals{infinite, -infinite, none_yet, none_yet};
    Mask known = infinite > none_yet;
    double strengths = 0.0, by_distance = 0.0, fixed = 0.0, least_radius = 0.0;
    for (const BlobRow& row : rows) {
        const Doubles in = load_lanes(row.in), peak = load_lanes(row.peak);
        const Doubles weight(row.weight);
        totals.first_in = min_lanes(totals.first_in, in);
        totals.last_out = max_lanes(totals.last_out, load_lanes(row.out));
        const Doubles q = max_lanes(peak, none_yet);
        totals.most = totals.most + weight * (q * q);
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
    // As LocalRay::room: the rounding of a bump must be negligible in the test for weakness.
    const Doubles room = Doubles(0x1p-46 * least_radius) * distance;
    known = known & (Doubles(3.0 * strengths) * room < Doubles(0.0004 * blob.threshold));
    totals.unknown = kAllLanes & ~bits_of(known);
    return totals;
}

/// The span of each lane that begins at t0: its end and its polynomial.
HWY_INLINE Doubles span_end(std::span<const BlobRow> rows, const Doubles& t0) {
    Doubles t1(std::numeric_limits<double>::infinity());
    for (const BlobRow& row : rows) {
        const Doubles in = load_lanes(row.in), out = load_lanes(row.out);
        t1 = select_lanes(in > t0, min_lanes(t1, in), t1);
        t1 = select_lanes(out > t0, min_lanes(t1, out), t1);
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
        const Doubles s = select_lanes(holds, Doubles(row.strength), nothing);
        const Doubles third = select_lanes(holds, Doubles(row.third), nothing);
        take_bump(load_lanes(row.middle), load_lanes(row.peak), load_lanes(row.bend), t0, t1, s,
                  third, b);
    }
}
/// Upper bound of the density on [t0, t1], up to rounding.
HWY_INLINE Doubles most_within(std::span<const BlobRow> rows, const Doubles& t0,
                               const Doubles& t1) {
    const Doubles nothing(0.0);
    Doubles most(0.0);
    for (const BlobRow& row : rows) {
        const Doubles middle = load_lanes(row.middle);
        const Doubles off = min_lanes(max_lanes(middle, t0), t1) - middle;
        const Doubles bump = neg_mul_add(load_lanes(row.bend), off * off, load_lanes(row.peak));
        const Doubles q = max_lanes(bump, nothing);
        most = mul_add(Doubles(row.weight), q * q, most);
    }
    return most;
}
/// The last point at or before t where a piece begins or ends.
HWY_INLINE Doubles event_before(std::span<const BlobRow> rows, const Doubles& t) {
    Doubles event(-std::numeric_limits<double>::infinity());
    for (const BlobRow& row : rows) {
        const Doubles in = load_lanes(row.in), out = load_lanes(row.out);
        event = select_lanes(in <= t, max_lanes(event, in), event);
        event = select_lanes(out <= t, max_lanes(event, out), event);
    }
    return event;
}

/// Result of the signs of the coefficients of a span.
struct SpanSigns {
    std::uint32_t outside = 0;                       ///< all of the span is outside
    std::uint32_t once = 0, twice = 0, oftener = 0;  ///< begins outside; number of changes
    std::uint32_t inside = 0;                        ///< all of the span is inside
    std::uint32_t leaves = 0;                        ///< begins inside, with one sign change
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
    const std::uint32_t certain = bits_of(known), begins = certain & ~negative[0];
    std::uint32_t one = 0, two = 0, three = 0;  // one, two, and three or more sign changes
    for (int k = 1; k <= 4; ++k) {
        const std::uint32_t change = negative[k] ^ negative[k - 1];
        three |= two & change;
        two |= one & change;
        one |= change;
    }
    const std::uint32_t negative_start = certain & negative[0];
    return {begins & ~one,  begins & one & ~two,   begins & two & ~three,
            begins & three, negative_start & ~one, negative_start & one & ~two};
}

/// The spans in which rays enter or leave, with their polynomials.
struct CrossedSpans {
    PolynomialLanes lanes;
    Doubles t0, t1;  ///< the span
    Doubles lo, hi;  ///< the part that contains the first sign change, alone
    std::uint32_t set = 0;

    HWY_INLINE void add(std::uint32_t more, const Doubles* b, const Doubles& from,
                        const Doubles& to, const Doubles& low, const Doubles& high) {
        const Mask mask = lanes_of_bits<double>(more);
        const bool first = set == 0;
        for (int k = 0; k <= 4; ++k) {
            store_lanes(first ? b[k] : select_lanes(mask, b[k], load_lanes(lanes.b[k])),
                        lanes.b[k]);
        }
        t0 = first ? from : select_lanes(mask, from, t0);
        t1 = first ? to : select_lanes(mask, to, t1);
        lo = first ? low : select_lanes(mask, low, lo);
        hi = first ? high : select_lanes(mask, high, hi);
        set |= more;
    }
};

/// Result of the search in lanes with several sign changes: those that enter, between lo and hi,
/// and those that stay outside. The rest is uncertain.
struct SearchedSpans {
    std::uint32_t enter, outside;
    Doubles lo, hi;
};
HWY_NOINLINE SearchedSpans search_spans(const SpanSigns& signs, std::uint32_t wanted,
                                        const Doubles* b, const Doubles& error) {
    const Doubles start(0.0), unit(1.0);
    PolynomialLanes lanes;
    LanePart<4> whole;
    lanes.degree = 4;
    for (int k = 0; k <= 4; ++k) store_lanes(whole.b[k] = b[k], lanes.b[k]);
    store_lanes(error, lanes.error);
    SearchedSpans result;
    result.enter = wanted & signs.twice & find_between<4>(lanes, unit, result.hi);
    result.lo = start;
    result.outside = 0;
    const std::uint32_t rest = wanted & ~result.enter;
    if (rest == 0) return result;
    RayLanes everywhere;
    store_lanes(Doubles(-std::numeric_limits<double>::infinity()), everywhere.t_min);
    store_lanes(start, lanes.entry);
    store_lanes(unit, lanes.exit);
    whole.error = error;
    whole.lo = start;
    whole.hi = whole.first = unit;
    LaneBrackets found;
    const std::uint32_t done = search<4>(rest, everywhere, lanes, whole, found);
    const Mask bracketed = lanes_of_bits<double>(done & found.known);
    result.lo = select_lanes(bracketed, found.lo, result.lo);
    result.hi = select_lanes(bracketed, found.hi, result.hi);
    result.enter |= done & found.known;
    result.outside = done & ~found.known;
    return result;
}

/// Refines t where the rays cross the surface. `sign_lo`: 1 where they enter, -1 where they leave.
HWY_NOINLINE Doubles crossings(CrossedSpans& spans, double sign_lo) {
    spans.lanes.degree = 4;
    store_lanes(spans.lo, spans.lanes.lo);
    store_lanes(spans.hi, spans.lanes.hi);
    store_lanes(Doubles(sign_lo), spans.lanes.sign_lo);
    Doubles u = polished<4>(spans.lanes, lanes_of_bits<double>(spans.set));
    u = select_lanes(u < spans.lo, spans.lo, select_lanes(spans.hi < u, spans.hi, u));
    return spans.t0 + u * (spans.t1 - spans.t0);
}

/// Advances eight rays along their spans.
class BlobWalk {
  public:
    HWY_INLINE BlobWalk(const Blob& blob, const BlobRayLanes& rays, std::span<const BlobRow> rows,
                        BlobHitLanes& out)
        : blob_(blob),
          rows_(rows),
          out_(out),
          totals_(totals_of(blob, rays, rows)),
          shift_(load_lanes(rays.shift)),
          t_min_(load_lanes(rays.t_min)),
          t_max_(load_lanes(rays.t_max)),
          // Where the rays begin, or earlier by more than the rounding.
          begin_((t_min_ - shift_) - Doubles(0x1p-48) * (abs(t_min_) + abs(shift_))),
          limit_(0.9985 * blob.threshold),
          t0_(totals_.first_in) {
        out_.hit = out_.leave = 0;
        out_.unsure = kAllLanes & ~(rays.finite & ~totals_.unknown & bits_of(begin_ <= begin_));
        left_ = kAllLanes & ~(out_.unsure | bits_of(totals_.most < limit_));
    }

    HWY_INLINE void run() {
        if (left_ == 0) return;
        const std::uint32_t late = left_ & bits_of(begin_ > t0_);
        if (late != 0)
            t0_ = select_lanes(lanes_of_bits<double>(late), event_before(rows_, begin_), t0_);
        for (;;) {
            pass_weak_spans();
            if (left_ == 0) break;
            Doubles b[5];
            span_polynomial(blob_, rows_, t0_, t1_, b);
            const SpanSigns signs = span_signs(b, totals_.error);
            // A lane that has been inside must still be inside.
            give_up(inside_ & ~(signs.inside | signs.leaves));
            // For rays that begin within this span, skips the part before.
            const std::uint32_t begin_here = left_ & bits_of(t0_ <= begin_);
            const std::uint32_t may_leave = begin_here | inside_;
            const std::uint32_t entered = cross(begin_here & signs.once, b, 1.0, out_.hit);
            const std::uint32_t behind = cross(may_leave & signs.leaves, b, -1.0, out_.leave);
            inside_ = entered | (may_leave & signs.inside);
            const std::uint32_t outside = behind | (left_ & signs.outside);
            give_up(~(inside_ | outside | enter(signs, ~begin_here, b)));
            t0_ = t1_;
        }
        finish();
    }

  private:
    /// Leaves these lanes to the scalar code.
    HWY_INLINE void give_up(std::uint32_t lanes) {
        out_.unsure |= left_ & lanes;
        left_ &= ~lanes;
    }

    /// Advances every lane to its next span that is not weak.
    HWY_INLINE void pass_weak_spans() {
        t1_ = t0_;
        for (std::uint32_t weak = kAllLanes; weak != 0;) {
            t0_ = select_lanes(lanes_of_bits<double>(weak), t1_, t0_);
            const std::uint32_t more = bits_of((t0_ < totals_.last_out) & (shift_ + t0_ <= t_max_));
            give_up(inside_ & ~more);
            left_ &= more;
            t1_ = span_end(rows_, t0_);
            weak &= left_ & ~inside_ & bits_of(most_within(rows_, t0_, t1_) < limit_);
        }
    }

    /// Records the lanes that enter in this span, after a closer test; returns those that do not.
    HWY_INLINE std::uint32_t enter(const SpanSigns& signs, std::uint32_t lanes, const Doubles* b) {
        if (const std::uint32_t once = left_ & lanes & signs.once; once != 0) {
            entered_.add(once, b, t0_, t1_, Doubles(0.0), Doubles(1.0));
            left_ &= ~once;
        }
        const std::uint32_t several = left_ & (signs.twice | signs.oftener);
        if (several == 0) return 0;
        const SearchedSpans searched = search_spans(signs, several, b, totals_.error);
        if (searched.enter != 0) {
            entered_.add(searched.enter, b, t0_, t1_, searched.lo, searched.hi);
        }
        left_ &= ~searched.enter;
        return searched.outside;
    }

    /// Finds where these lanes cross the surface, and adds those that cross in their range to
    /// `hit`; returns those that cross before it.
    HWY_INLINE std::uint32_t cross(std::uint32_t lanes, const Doubles* b, double sign_lo,
                                   std::uint32_t& hit) {
        if (lanes == 0) return 0;
        CrossedSpans spans;
        spans.add(lanes, b, t0_, t1_, Doubles(0.0), Doubles(1.0));
        const Doubles at = shift_ + crossings(spans, sign_lo);
        report(lanes, at, hit);
        return lanes & bits_of(at < t_min_);
    }
    /// Adds the lanes whose range contains `at` to `hit`; these and the lanes that end before `at`
    /// are done.
    HWY_INLINE void report(std::uint32_t lanes, const Doubles& at, std::uint32_t& hit) {
        const std::uint32_t covered = lanes & bits_of((t_min_ <= at) & (at <= t_max_));
        const bool first = (out_.hit | out_.leave) == 0;
        store_lanes(
            first ? at : select_lanes(lanes_of_bits<double>(covered), at, load_lanes(out_.t)),
            out_.t);
        hit |= covered;
        left_ &= ~(covered | (lanes & bits_of(at > t_max_)));
    }

    /// Leaves lanes that enter before they begin to the scalar code.
    HWY_INLINE void finish() {
        if (entered_.set == 0) return;
        const Doubles at = shift_ + crossings(entered_, 1.0);
        report(entered_.set, at, out_.hit);
        out_.unsure |= entered_.set & ~(out_.hit | bits_of(at > t_max_));
    }

    const Blob& blob_;
    const std::span<const BlobRow> rows_;
    BlobHitLanes& out_;
    const RowTotals totals_;
    const Doubles shift_, t_min_, t_max_, begin_, limit_;
    Doubles t0_, t1_;  ///< the span of each lane
    CrossedSpans entered_;
    std::uint32_t left_;        ///< the lanes still active
    std::uint32_t inside_ = 0;  ///< the active lanes that have been inside since they began
};

inline void search(const Blob& blob, const BlobRayLanes& rays, std::span<const BlobRow> rows,
                   BlobHitLanes& out) {
    BlobWalk(blob, rays, rows, out).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
