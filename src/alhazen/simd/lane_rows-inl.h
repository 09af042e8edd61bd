/// Transposition of rows of numbers in registers, from an array of rays to rays in lanes, and the
/// extremes of several rows.
///
/// Conventions: included once per target (see simd/lanes-inl.h). If registers hold four floats,
/// nothing goes through memory: a wide load after narrow stores stalls on store forwarding.

#if defined(ALHAZEN_SIMD_LANE_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_LANE_ROWS_INL_H_
#undef ALHAZEN_SIMD_LANE_ROWS_INL_H_
#else
#define ALHAZEN_SIMD_LANE_ROWS_INL_H_
#endif

#include <cstddef>

#include "alhazen/simd/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

/// Transposes a 4 x 4 matrix: lane k of row i becomes lane i of row k.
HWY_INLINE void transpose(Lanes<float, 4> (&rows)[4]) {
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to interleave
    if constexpr (kParts<float, 4> == 1) {
        const LaneTag<float, 4> d;
        const auto a = hn::InterleaveLower(d, rows[0].part[0], rows[1].part[0]);
        const auto b = hn::InterleaveLower(d, rows[2].part[0], rows[3].part[0]);
        const auto c = hn::InterleaveUpper(d, rows[0].part[0], rows[1].part[0]);
        const auto e = hn::InterleaveUpper(d, rows[2].part[0], rows[3].part[0]);
        rows[0].part[0] = hn::ConcatLowerLower(d, b, a);
        rows[1].part[0] = hn::ConcatUpperUpper(d, b, a);
        rows[2].part[0] = hn::ConcatLowerLower(d, e, c);
        rows[3].part[0] = hn::ConcatUpperUpper(d, e, c);
        return;
    }
#endif
    HWY_ALIGN float values[4][4], columns[4][4];
    for (std::size_t i = 0; i < 4; ++i) store_lanes(rows[i], values[i]);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 4; ++k) columns[k][i] = values[i][k];
    }
    for (std::size_t i = 0; i < 4; ++i) rows[i] = load_lanes<4>(columns[i]);
}
#if HWY_CAP_GE512
/// Transposes two 8 x 8 matrices, whose rows are the halves of the registers: row k becomes column
/// k.
HWY_INLINE void transpose_blocks(hn::Vec<hn::CappedTag<float, 16>> (&rows)[8]) {
    const hn::CappedTag<float, 16> d;
    const hn::CappedTag<double, 8> pairs;
    using Part = hn::Vec<hn::CappedTag<float, 16>>;
    Part quads[2][4];  // of the first four rows and the others: columns k and k + 4
    HWY_UNROLL(2)
    for (std::size_t h = 0; h < 2; ++h) {
        const Part* const r = rows + 4 * h;
        const auto l01 = hn::BitCast(pairs, hn::InterleaveLower(d, r[0], r[1]));
        const auto l23 = hn::BitCast(pairs, hn::InterleaveLower(d, r[2], r[3]));
        const auto u01 = hn::BitCast(pairs, hn::InterleaveUpper(d, r[0], r[1]));
        const auto u23 = hn::BitCast(pairs, hn::InterleaveUpper(d, r[2], r[3]));
        quads[h][0] = hn::BitCast(d, hn::InterleaveLower(pairs, l01, l23));
        quads[h][1] = hn::BitCast(d, hn::InterleaveUpper(pairs, l01, l23));
        quads[h][2] = hn::BitCast(d, hn::InterleaveLower(pairs, u01, u23));
        quads[h][3] = hn::BitCast(d, hn::InterleaveUpper(pairs, u01, u23));
    }
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
        rows[k] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(quads[1][k]), quads[0][k]);
        rows[4 + k] = hn::OddEvenBlocks(quads[1][k], hn::SwapAdjacentBlocks(quads[0][k]));
    }
}
#endif
/// The lanes of a, b, c and e in this order.
template <std::size_t N = 16>
HWY_INLINE Lanes<float, N> joined(const Lanes<float, N / 4>& a, const Lanes<float, N / 4>& b,
                                  const Lanes<float, N / 4>& c, const Lanes<float, N / 4>& e) {
    Lanes<float, N> r;
    constexpr std::size_t kEach = kParts<float, N / 4>;
    if constexpr (kParts<float, N> == 4 * kEach) {
        for (std::size_t i = 0; i < kEach; ++i) {
            r.part[i] = a.part[i];
            r.part[kEach + i] = b.part[i];
            r.part[2 * kEach + i] = c.part[i];
            r.part[3 * kEach + i] = e.part[i];
        }
#if HWY_TARGET != HWY_SCALAR
    } else {
        const LaneTag<float, N / 2> half;
        const auto lower = hn::Combine(half, b.part[0], a.part[0]);
        const auto upper = hn::Combine(half, e.part[0], c.part[0]);
        if constexpr (kParts<float, N> == 2) {
            r.part[0] = lower;
            r.part[1] = upper;
        } else {
            r.part[0] = hn::Combine(LaneTag<float, N>(), upper, lower);
        }
#endif
    }
    return r;
}

/// The minimum and the maximum of each of four rows, in lane i for row i. Precondition: no NaN.
template <std::size_t N>
struct LaneExtremes {
    Lanes<float, 4> least, most;

    HWY_INLINE explicit LaneExtremes(const Lanes<float, N> (&rows)[4]) {
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to interleave
        const LaneTag<float, N> d;
        const hn::Repartition<double, LaneTag<float, N>> pairs;
        using Part = hn::Vec<LaneTag<float, N>>;
        const auto smaller = [](auto x, auto y) { return hn::Min(x, y); };
        const auto larger = [](auto x, auto y) { return hn::Max(x, y); };
        Part low[kParts<float, N>], high[kParts<float, N>];
        ALHAZEN_UNROLL
        for (std::size_t i = 0; i < kParts<float, N>; ++i) {
            const Part l01 = hn::InterleaveLower(d, rows[0].part[i], rows[1].part[i]);
            const Part u01 = hn::InterleaveUpper(d, rows[0].part[i], rows[1].part[i]);
            const Part l23 = hn::InterleaveLower(d, rows[2].part[i], rows[3].part[i]);
            const Part u23 = hn::InterleaveUpper(d, rows[2].part[i], rows[3].part[i]);
            // Each block of four: rows 0, 1, 0, 1, and 2, 3, 2, 3.
            const auto fold = [&](const auto& combine) HWY_ATTR {
                const auto a = hn::BitCast(pairs, combine(l01, u01));
                const auto b = hn::BitCast(pairs, combine(l23, u23));
                return combine(hn::BitCast(d, hn::InterleaveLower(pairs, a, b)),
                               hn::BitCast(d, hn::InterleaveUpper(pairs, a, b)));
            };
            low[i] = fold(smaller);
            high[i] = fold(larger);
        }
        for (std::size_t i = 1; i < kParts<float, N>; ++i) {
            low[0] = smaller(low[0], low[i]);
            high[0] = larger(high[0], high[i]);
        }
        least.part[0] = over_blocks(d, low[0], smaller);
        most.part[0] = over_blocks(d, high[0], larger);
#else
        for (std::size_t k = 0; k < 4; ++k) {
            least.part[k] = most.part[k] = rows[k].part[0];
            for (std::size_t i = 1; i < N; ++i) {
                least.part[k] = hn::Min(least.part[k], rows[k].part[i]);
                most.part[k] = hn::Max(most.part[k], rows[k].part[i]);
            }
        }
#endif
    }

  private:
#if HWY_TARGET != HWY_SCALAR
    template <class D, class F>
    static HWY_INLINE auto over_blocks(D, hn::Vec<D> a, const F& combine) {
        if constexpr (hn::MaxLanes(D()) == 4) {
            return a;
        } else {
            const hn::Half<D> half;
            return over_blocks(half, combine(hn::LowerHalf(half, a), hn::UpperHalf(half, a)),
                               combine);
        }
    }
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
