/// The first sign changes of eight polynomials in Bernstein form, in lanes.
///
/// Source: math/bernstein_roots.h and shapes/algebraic/polynomial_solid.h, the same operations in
/// the same order.
/// Differs: finds only what is certain from the signs; see polynomial_lanes.h.
/// Conventions: included once per target (see simd/lanes-inl.h); internal to this folder.

#if defined(ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_ROOTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_ROOTS_INL_H_
#undef ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_ROOTS_INL_H_
#else
#define ALHAZEN_SHAPES_ALGEBRAIC_POLYNOMIAL_ROOTS_INL_H_
#endif

#include <algorithm>
#include <limits>

#include "alhazen/shapes/algebraic/polynomial_lanes.h"
#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

static_assert(kRayLanes == kLaneCount);

using Mask = LaneMask<double>;

HWY_INLINE bool none(const Mask& mask) {
    bool r = true;
    for (std::size_t i = 0; i < kParts<double>; ++i) {
        r = r && hn::AllFalse(LaneTag<double>(), mask.part[i]);
    }
    return r;
}
HWY_INLINE Mask is_finite(const Doubles& a) {
    return abs(a) < Doubles(std::numeric_limits<double>::infinity());
}

/// The degree: a compile-time constant for N <= 6.
template <int N>
HWY_INLINE int degree_of(const PolynomialLanes& lanes) {
    return N <= 6 ? N : lanes.degree;
}

/// Polynomials with coefficients times binomials: see ScaledPolynomial.
template <int N>
struct ScaledLanes {
    Doubles s[N + 1];
    int n;

    HWY_INLINE explicit ScaledLanes(const PolynomialLanes& lanes) : n(degree_of<N>(lanes)) {
        if constexpr (N > 6) {  // the compiler does not see that every value read was written
            for (Doubles& coefficient : s) coefficient = Doubles(0.0);
        }
        const double* row = bernstein::kBinomials<N>[static_cast<std::size_t>(n)].data();
        for (int i = 0; i <= n; ++i) s[i] = Doubles(row[i]) * load_lanes(lanes.b[i]);
    }
    HWY_INLINE void mirror(const Mask& mirrored) {
        for (int i = 0; i <= (n - 1) / 2; ++i) {
            const Doubles a = s[i], b = s[n - i];
            s[i] = select_lanes(mirrored, b, a);
            s[n - i] = select_lanes(mirrored, a, b);
        }
    }
    HWY_INLINE void operator()(const Doubles& w, Doubles& value, Doubles& slope) const {
        value = s[n];
        slope = Doubles(0.0);
        for (int i = n - 1; i >= 0; --i) {
            slope = slope * w + value;
            value = value * w + s[i];
        }
    }
};

/// A polynomial on a part of each segment, with the signs at its ends.
template <int N>
struct LanePart {
    Doubles b[N + 1], error;
    Doubles lo, hi, first;  ///< the part, and the sign at lo: 1 or -1
};

/// Lanes with at least one and at least two sign changes; `known`: lanes in which every sign is
/// certain.
struct LaneSigns {
    std::uint32_t one = 0, two = 0, known = kAllLanes;
};
template <int N>
HWY_INLINE LaneSigns signs_of(const Doubles* b, int n, const Doubles& error) {
    LaneSigns signs;
    std::uint32_t before = bits_of(b[0] < Doubles(0.0));
    Mask known = abs(b[0]) > error;
    for (int i = 1; i <= n; ++i) {
        known = known & (abs(b[i]) > error);
        const std::uint32_t now = bits_of(b[i] < Doubles(0.0)), change = now ^ before;
        signs.two |= signs.one & change;
        signs.one |= change;
        before = now;
    }
    signs.known = bits_of(known);
    return signs;
}

/// The coefficients that differ most from the first one, and the largest magnitude: see `extremes`.
template <int N>
HWY_INLINE Doubles most_unlike(const Doubles* b, int n, const Doubles& first, Doubles& largest) {
    Doubles lowest(0.0), middle(0.5);
    largest = max_lanes(abs(b[0]), abs(b[n]));
    for (int i = 1; i < n; ++i) {
        largest = max_lanes(largest, abs(b[i]));
        const Doubles value = first * b[i];
        const Mask lower = value < lowest;
        lowest = select_lanes(lower, value, lowest);
        const double place = std::clamp(static_cast<int>(8.0 * i / n + 0.5), 1, 7) / 8.0;
        middle = select_lanes(lower, Doubles(place), middle);
    }
    return middle;
}

/// For lanes with two sign changes of the coefficients: returns those in which `found_between`
/// finds a point between the changes, which becomes `hi`.
template <int N>
HWY_INLINE std::uint32_t find_between(const PolynomialLanes& lanes, const Doubles& first,
                                      Doubles& hi) {
    const int n = degree_of<N>(lanes);
    Doubles b[N + 1], largest;
    for (int i = 0; i <= n; ++i) b[i] = load_lanes(lanes.b[i]);
    const Doubles middle = most_unlike<N>(b, n, first, largest);
    const Mask mirrored = middle > Doubles(0.5);
    const Doubles rest = Doubles(1.0) - middle;
    const Doubles far = select_lanes(mirrored, middle, rest),
                  near = select_lanes(mirrored, rest, middle);
    Doubles value, slope;
    ScaledLanes<N> q(lanes);
    q.mirror(mirrored);
    q(near / far, value, slope);
    Doubles scale(1.0);
    for (int i = 1; i <= n; ++i) scale = scale * far;
    const Doubles error = load_lanes(lanes.error) + Doubles(4.0 * n * 0x1p-52) * largest;
    hi = middle;
    return bits_of(-first * value * scale > error);
}

/// As `split`.
template <int N>
HWY_INLINE void split(const LanePart<N>& part, int n, const Doubles& r, Doubles* left,
                      Doubles* right) {
    const Doubles rest = Doubles(1.0) - r;
    left[0] = right[0] = part.b[0];
    for (int i = 1; i <= n; ++i) right[i] = part.b[i];
    for (int k = 1; k <= n; ++k) {
        for (int i = 0; i <= n - k; ++i) right[i] = rest * right[i] + r * right[i + 1];
        left[k] = right[0];
    }
}

/// The parameters at u: see CoveredSignChanges.
HWY_INLINE Doubles parameter_at(const PolynomialLanes& lanes, const Doubles& u) {
    const Doubles entry = load_lanes(lanes.entry), exit = load_lanes(lanes.exit);
    const Doubles along = entry + u * (exit - entry);
    return select_lanes(exit < along, exit, along);
}

/// The brackets found by a search.
struct LaneBrackets {
    Doubles lo, hi, sign;
    std::uint32_t known = 0;

    HWY_INLINE void set(std::uint32_t lanes, const Doubles& l, const Doubles& h, const Doubles& s) {
        const Mask mask = lanes_of_bits<double>(lanes);
        lo = select_lanes(mask, l, lo);
        hi = select_lanes(mask, h, hi);
        sign = select_lanes(mask, s, sign);
        known |= lanes;
    }
};

/// As `search`, where every sign is certain and one side of each split has at most one change;
/// returns the lanes of `wanted` in which it completes. `found` holds the first brackets that do
/// not end before the rays begin; lanes without one have no sign change there.
template <int N>
HWY_NOINLINE std::uint32_t search(std::uint32_t wanted, const RayLanes& rays,
                                  const PolynomialLanes& lanes, LanePart<N>& part,
                                  LaneBrackets& found) {
    const int n = degree_of<N>(lanes);
    const auto reached = [&](const Doubles& u) HWY_ATTR {
        return bits_of(parameter_at(lanes, u) >= load_lanes(rays.t_min));
    };
    constexpr int kMostSplits = 12;
    const Doubles least_part(0x1p-52), unit(1.0);
    LaneBrackets later;  // the lowest bracket to the right of a part that is still searched
    later.lo = later.hi = later.sign = found.lo = found.hi = found.sign = unit;
    std::uint32_t active = wanted, done = 0;
    for (int i = 0; i < kMostSplits && active != 0; ++i) {
        Doubles largest, left[N + 1], right[N + 1];
        const Doubles r = most_unlike<N>(part.b, n, part.first, largest);
        const Doubles size = part.hi - part.lo;
        const Mask divisible = (size > least_part) & !(largest <= Doubles(8.0) * part.error);
        split(part, n, r, left, right);
        part.error = part.error + Doubles(n * 0x1p-52) * largest;
        const LaneSigns l = signs_of<N>(left, n, part.error), g = signs_of<N>(right, n, part.error);
        active &= l.known & g.known & ~(l.two & g.two) & bits_of(divisible);
        const Doubles middle = part.lo + r * size;
        const Doubles sign = select_lanes(right[0] < Doubles(0.0), -unit, unit);
        const std::uint32_t to_right = active & ~l.two & g.two, to_left = active & l.two;
        const std::uint32_t open = active & ~found.known, to_end = reached(part.hi);
        const std::uint32_t in_left = open & l.one & ~l.two & reached(middle);
        found.set(in_left, part.lo, middle, part.first);
        found.set(open & ~in_left & ~l.two & g.one & ~g.two & to_end, middle, part.hi, sign);
        later.set(open & to_left & g.one & to_end, middle, part.hi, sign);
        done |= active & ~(to_left | to_right);
        active = to_left | to_right;
        const Mask leftward = lanes_of_bits<double>(to_left),
                   rightward = lanes_of_bits<double>(to_right);
        for (int k = 0; k <= n; ++k) {
            part.b[k] =
                select_lanes(leftward, left[k], select_lanes(rightward, right[k], part.b[k]));
        }
        part.hi = select_lanes(leftward, middle, part.hi);
        part.lo = select_lanes(rightward, middle, part.lo);
        part.first = select_lanes(rightward, sign, part.first);
    }
    found.set(done & later.known & ~found.known, later.lo, later.hi, later.sign);
    return done;
}

/// Result of the signs of the coefficients for the first crossing.
template <int N>
HWY_INLINE void classify(const RayLanes& rays, bool capped, PolynomialLanes& lanes) {
    const int n = degree_of<N>(lanes);
    const Doubles error = load_lanes(lanes.error), entry = load_lanes(lanes.entry);
    Doubles total = error;
    Mask known = error >= Doubles(0.0);
    std::uint32_t negative = 0, starts_negative = 0;
    std::uint32_t one = 0, two = 0, three = 0;  // one, two, and three or more sign changes
    for (int i = 0; i <= n; ++i) {
        const Doubles b = load_lanes(lanes.b[i]), size = abs(b);
        total = total + size;
        known = known & (size > error);
        const std::uint32_t now = bits_of(b < Doubles(0.0)), change = now ^ negative;
        negative = now;
        if (i == 0) {
            starts_negative = now;
            continue;
        }
        three |= two & change;
        two |= one & change;
        one |= change;
    }
    const Doubles t_min = load_lanes(rays.t_min), t_max = load_lanes(rays.t_max);
    const Mask finite = is_finite(total);
    // The parameter at the start of the search is the entry, with +0 for -0, which is equivalent.
    const std::uint32_t covered = bits_of((t_min <= entry) & (entry <= t_max) & is_finite(entry));
    lanes.at_entry = 0;
    if (capped) {
        const Mask negative_start = load_lanes(lanes.b[0]) < Doubles(-2.0) * error;
        lanes.at_entry =
            ~(lanes.missed | lanes.unsure) & covered & bits_of(negative_start & finite);
    }
    const std::uint32_t plain =
        ~(lanes.missed | lanes.unsure | lanes.at_entry) & bits_of(known & finite);
    lanes.missed |= plain & ~one & ~starts_negative;
    // A cap at the start precedes later crossings.
    const std::uint32_t behind_cap = capped ? starts_negative & covered : 0;
    lanes.bracketed = plain & one & ~two & ~behind_cap;
    const Doubles first =
        select_lanes(load_lanes(lanes.b[0]) < Doubles(0.0), Doubles(-1.0), Doubles(1.0));
    // The last change is followed at most by a cap.
    const std::uint32_t ends = ~(capped ? negative : 0);
    lanes.last = lanes.bracketed & ends;
    LaneBrackets found;
    found.lo = Doubles(0.0);
    found.hi = Doubles(1.0);
    found.sign = first;
    std::uint32_t several = plain & two & ~behind_cap;
    if (const std::uint32_t twice = several & ~three; twice != 0) {
        Doubles middle;
        const std::uint32_t between = twice & find_between<N>(lanes, first, middle);
        const std::uint32_t before = between & bits_of(parameter_at(lanes, middle) < t_min);
        found.set(between & ~before, found.lo, middle, first);
        found.set(before, middle, found.hi, -first);
        lanes.bracketed |= between;
        lanes.last |= before & ends;
        several &= ~between;
    }
    if (several != 0) {
        LanePart<N> whole;
        for (int i = 0; i <= n; ++i) whole.b[i] = load_lanes(lanes.b[i]);
        whole.error = error;
        whole.lo = Doubles(0.0);
        whole.hi = Doubles(1.0);
        whole.first = first;
        LaneBrackets searched;
        const std::uint32_t done = search<N>(several, rays, lanes, whole, searched);
        found.set(done & searched.known, searched.lo, searched.hi, searched.sign);
        lanes.bracketed |= done & searched.known;
        lanes.missed |= done & ~searched.known & ends;
    }
    store_lanes(found.lo, lanes.lo);
    store_lanes(found.hi, lanes.hi);
    store_lanes(found.sign, lanes.sign_lo);
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
