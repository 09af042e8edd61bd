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

#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to interleave
/// Transposes the 4 x 4 matrices in the blocks of 128 bits of four rows.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void transpose_quads(D d, const V& a, const V& b, const V& c, const V& e,
                                V (&columns)[4]) {
    const hn::Repartition<double, D> pairs;
    const auto ab_low = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    const auto ce_low = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
    const auto ab_high = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
    const auto ce_high = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
    columns[0] = hn::BitCast(d, hn::InterleaveLower(pairs, ab_low, ce_low));
    columns[1] = hn::BitCast(d, hn::InterleaveUpper(pairs, ab_low, ce_low));
    columns[2] = hn::BitCast(d, hn::InterleaveLower(pairs, ab_high, ce_high));
    columns[3] = hn::BitCast(d, hn::InterleaveUpper(pairs, ab_high, ce_high));
}
#endif

/// Transposes a 4 x 4 matrix: lane k of row i becomes lane i of row k.
HWY_INLINE void transpose(Lanes<float, 4> (&rows)[4]) {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (kParts<float, 4> == 1) {
        hn::Vec<LaneTag<float, 4>> columns[4];
        transpose_quads(LaneTag<float, 4>(), rows[0].part[0], rows[1].part[0], rows[2].part[0],
                        rows[3].part[0], columns);
        for (std::size_t k = 0; k < 4; ++k) rows[k].part[0] = columns[k];
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
    hn::Vec<hn::CappedTag<float, 16>> first[4], second[4];  // columns k and k + 4
    transpose_quads(d, rows[0], rows[1], rows[2], rows[3], first);
    transpose_quads(d, rows[4], rows[5], rows[6], rows[7], second);
    HWY_UNROLL(4)
    for (std::size_t k = 0; k < 4; ++k) {
        rows[k] = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(second[k]), first[k]);
        rows[4 + k] = hn::OddEvenBlocks(second[k], hn::SwapAdjacentBlocks(first[k]));
    }
}
#endif
/// Stores lane i of eight rows of sixteen lanes as eight numbers at place(i). Precondition: sixteen
/// floats are two registers or one.
template <class Place>
HWY_INLINE void store_columns([[maybe_unused]] const Lanes<float, 16>* rows,
                              [[maybe_unused]] Place&& place) {
#if HWY_CAP_GE512
    const hn::CappedTag<float, 8> eight;
    hn::Vec<hn::CappedTag<float, 16>> columns[8];
    HWY_UNROLL(8)
    for (std::size_t k = 0; k < 8; ++k) columns[k] = rows[k].part[0];
    transpose_blocks(columns);
    HWY_UNROLL(8)
    for (std::size_t i = 0; i < 8; ++i) {
        hn::Store(hn::LowerHalf(eight, columns[i]), eight, place(i));
        hn::Store(hn::UpperHalf(eight, columns[i]), eight, place(8 + i));
    }
#elif HWY_TARGET != HWY_SCALAR
    const LaneTag<float, 16> d;
    HWY_UNROLL(2)
    for (std::size_t n = 0; n < 2; ++n) {
        hn::Vec<LaneTag<float, 16>> first[4], second[4];  // columns k and k + 4
        transpose_quads(d, rows[0].part[n], rows[1].part[n], rows[2].part[n], rows[3].part[n],
                        first);
        transpose_quads(d, rows[4].part[n], rows[5].part[n], rows[6].part[n], rows[7].part[n],
                        second);
        HWY_UNROLL(4)
        for (std::size_t k = 0; k < 4; ++k) {
            hn::Store(hn::ConcatLowerLower(d, second[k], first[k]), d, place(8 * n + k));
            hn::Store(hn::ConcatUpperUpper(d, second[k], first[k]), d, place(8 * n + 4 + k));
        }
    }
#endif
}
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
