/// Vectors of eight (or N) lanes of float or double with the operators of a scalar, for blocks of
/// eight primitives, the eight children of a node, and rays prepared together.
///
/// A block of double is one AVX-512 register of double, two of AVX, four of SSE. Every operation is
/// correctly rounded (IEEE), so each lane has the bits of the scalar form on every target; only
/// mul_add and its variants are fused where the target can.
/// Conventions: included once per target, by the pattern of Highway's foreach_target.h; everything
/// is in HWY_NAMESPACE and must not be used outside it.

#if defined(ALHAZEN_SIMD_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_LANES_INL_H_
#undef ALHAZEN_SIMD_LANES_INL_H_
#else
#define ALHAZEN_SIMD_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Unrolls loops over parts, except in plain C++, where eight copies only slow down compilation.
#undef ALHAZEN_UNROLL
#if HWY_TARGET == HWY_SCALAR
#define ALHAZEN_UNROLL
#else
#define ALHAZEN_UNROLL HWY_UNROLL(8)
#endif

HWY_BEFORE_NAMESPACE();
namespace alhazen {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::size_t kLaneCount = 8;
inline constexpr std::uint32_t kAllLanes = (1u << kLaneCount) - 1;

/// The registers of a block. Those of double have at most four lanes in blocks of eight: occasional
/// 512-bit instructions lower the clock of many processors by a sixth. Blocks of 16 are for code
/// that uses such registers all the time.
template <class T, std::size_t N = kLaneCount>
using LaneTag = hn::CappedTag<T, (sizeof(T) == 8 && N > 4) ? (N > 8 ? 8 : 4) : N>;

/// Number of registers in a block.
template <class T, std::size_t N = kLaneCount>
inline constexpr std::size_t kParts = N / hn::MaxLanes(LaneTag<T, N>());

template <class T, std::size_t N = kLaneCount>
struct LaneMask {
    hn::Mask<LaneTag<T, N>> part[kParts<T, N>];

    // Not defaulted: GCC would generate it outside of the target that NEON's masks need.
    HWY_INLINE LaneMask() {}
};

template <class T, std::size_t N = kLaneCount>
struct Lanes {
    hn::Vec<LaneTag<T, N>> part[kParts<T, N>];

    Lanes() = default;
    HWY_INLINE explicit Lanes(T value) {
        for (std::size_t i = 0; i < kParts<T, N>; ++i) part[i] = hn::Set(LaneTag<T, N>(), value);
    }
};

using Doubles = Lanes<double>;
using Floats = Lanes<float>;

/// Loads from an address aligned to a block (64 bytes for double, 32 for float).
template <std::size_t N = kLaneCount, class T>
HWY_INLINE Lanes<T, N> load_lanes(const T* values) {
    Lanes<T, N> r;
    const LaneTag<T, N> d;
    for (std::size_t i = 0; i < kParts<T, N>; ++i) {
        r.part[i] = hn::Load(d, values + i * hn::Lanes(d));
    }
    return r;
}
template <class T, std::size_t N>
HWY_INLINE void store_lanes(const Lanes<T, N>& a, T* values) {
    const LaneTag<T, N> d;
    for (std::size_t i = 0; i < kParts<T, N>; ++i) {
        hn::Store(a.part[i], d, values + i * hn::Lanes(d));
    }
}

/// Loads from any address.
template <std::size_t N = kLaneCount, class T>
HWY_INLINE Lanes<T, N> load_unaligned(const T* values) {
    Lanes<T, N> r;
    const LaneTag<T, N> d;
    for (std::size_t i = 0; i < kParts<T, N>; ++i) {
        r.part[i] = hn::LoadU(d, values + i * hn::Lanes(d));
    }
    return r;
}

/// Rounds to the nearest float.
template <std::size_t N>
HWY_INLINE Lanes<float, N> as_floats(const Lanes<double, N>& a) {
    const LaneTag<double, N> d;
    const hn::Rebind<float, LaneTag<double, N>> df;
    if constexpr (kParts<double, N> == 1) {
        Lanes<float, N> r;
        r.part[0] = hn::DemoteTo(df, a.part[0]);
        return r;
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to combine
    } else if constexpr (kParts<double, N> == 2 && kParts<float, N> == 1) {
        Lanes<float, N> r;
        r.part[0] = hn::Combine(LaneTag<float, N>(), hn::DemoteTo(df, a.part[1]),
                                hn::DemoteTo(df, a.part[0]));
        return r;
#endif
    } else {
        alignas(64) float values[N];
        for (std::size_t i = 0; i < kParts<double, N>; ++i) {
            hn::Store(hn::DemoteTo(df, a.part[i]), df, values + i * hn::Lanes(d));
        }
        return load_lanes<N>(values);
    }
}

/// Every float is a double.
template <std::size_t N>
HWY_INLINE Lanes<double, N> as_doubles(const Lanes<float, N>& a) {
    Lanes<double, N> r;
    const LaneTag<double, N> d;
    if constexpr (kParts<double, N> == kParts<float, N>) {
        for (std::size_t i = 0; i < kParts<double, N>; ++i) {
            r.part[i] = hn::PromoteTo(d, a.part[i]);
        }
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to divide
    } else {
        static_assert(kParts<double, N> == 2 * kParts<float, N>);
        const hn::Half<LaneTag<float, N>> half;
        for (std::size_t i = 0; i < kParts<float, N>; ++i) {
            r.part[2 * i] = hn::PromoteTo(d, hn::LowerHalf(half, a.part[i]));
            r.part[2 * i + 1] = hn::PromoteTo(d, hn::UpperHalf(half, a.part[i]));
        }
#endif
    }
    return r;
}

/// Sets the fourth lane to 0.
HWY_INLINE Lanes<float, 4> first_three(const Lanes<float, 4>& a) {
    HWY_ALIGN static constexpr std::uint32_t kKeep[4] = {~0u, ~0u, ~0u, 0};
    Lanes<float, 4> r;
    const LaneTag<float, 4> d;
    const hn::RebindToUnsigned<LaneTag<float, 4>> du;
    for (std::size_t i = 0; i < kParts<float, 4>; ++i) {
        const auto keep = hn::Load(du, kKeep + i * hn::Lanes(d));
        r.part[i] = hn::And(a.part[i], hn::BitCast(d, keep));
    }
    return r;
}
/// The lanes of `a`, then those of `b`.
template <std::size_t N>
HWY_INLINE Lanes<float, 2 * N> joined(const Lanes<float, N>& a, const Lanes<float, N>& b) {
    Lanes<float, 2 * N> r;
    if constexpr (kParts<float, 2 * N> == 2 * kParts<float, N>) {
        for (std::size_t i = 0; i < kParts<float, N>; ++i) {
            r.part[i] = a.part[i];
            r.part[kParts<float, N> + i] = b.part[i];
        }
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to combine
    } else {
        r.part[0] = hn::Combine(LaneTag<float, 2 * N>(), b.part[0], a.part[0]);
#endif
    }
    return r;
}
/// The upper half of the lanes.
template <std::size_t N>
HWY_INLINE Lanes<float, N / 2> upper_half(const Lanes<float, N>& a) {
    Lanes<float, N / 2> r;
    if constexpr (kParts<float, N> == 2 * kParts<float, N / 2>) {
        for (std::size_t i = 0; i < kParts<float, N / 2>; ++i) {
            r.part[i] = a.part[kParts<float, N / 2> + i];
        }
#if HWY_TARGET != HWY_SCALAR
    } else {
        r.part[0] = hn::UpperHalf(LaneTag<float, N / 2>(), a.part[0]);
#endif
    }
    return r;
}
/// The largest of each four lanes, in all four. Precondition: no NaN, nothing negative.
template <std::size_t N>
HWY_INLINE Lanes<float, N> largest_of_fours(const Lanes<float, N>& a) {
    Lanes<float, N> r;
#if HWY_TARGET == HWY_SCALAR
    HWY_ALIGN float values[N];
    store_lanes(a, values);
    for (std::size_t first = 0; first < N; first += 4) {
        float most = values[first];
        for (std::size_t i = 1; i < 4; ++i) {
            if (values[first + i] > most) most = values[first + i];
        }
        for (std::size_t i = 0; i < 4; ++i) values[first + i] = most;
    }
    r = load_lanes<N>(values);
#else
    const LaneTag<float, N> d;
    const hn::RebindToSigned<LaneTag<float, N>> di;  // integer comparison is faster
    for (std::size_t i = 0; i < kParts<float, N>; ++i) {
        auto most = hn::BitCast(di, a.part[i]);
        most = hn::Max(most, hn::Shuffle1032(most));
        most = hn::Max(most, hn::Shuffle2301(most));
        r.part[i] = hn::BitCast(d, most);
    }
#endif
    return r;
}
/// Lane i is lane place[i] of `a`; `place` is aligned to 16 bytes.
HWY_INLINE Lanes<float, 4> permuted(const Lanes<float, 4>& a, const std::int32_t* place) {
    Lanes<float, 4> r;
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t i = 0; i < 4; ++i) r.part[i] = a.part[place[i]];
#else
    const LaneTag<float, 4> d;
    const hn::RebindToSigned<LaneTag<float, 4>> di;
    r.part[0] = hn::TableLookupLanes(a.part[0], hn::IndicesFromVec(d, hn::Load(di, place)));
#endif
    return r;
}
template <class T, std::size_t N>
HWY_INLINE T first_lane(const Lanes<T, N>& a) {
    return hn::GetLane(a.part[0]);
}

#define ALHAZEN_LANES_UNARY(name, expression)                                  \
    template <class T, std::size_t N>                                          \
    HWY_INLINE Lanes<T, N> name(const Lanes<T, N>& a) {                        \
        Lanes<T, N> r;                                                         \
        ALHAZEN_UNROLL                                                         \
        for (std::size_t i = 0; i < kParts<T, N>; ++i) r.part[i] = expression; \
        return r;                                                              \
    }
#define ALHAZEN_LANES_BINARY(name, expression)                                 \
    template <class T, std::size_t N>                                          \
    HWY_INLINE Lanes<T, N> name(const Lanes<T, N>& a, const Lanes<T, N>& b) {  \
        Lanes<T, N> r;                                                         \
        ALHAZEN_UNROLL                                                         \
        for (std::size_t i = 0; i < kParts<T, N>; ++i) r.part[i] = expression; \
        return r;                                                              \
    }
#define ALHAZEN_LANES_COMPARE(name, expression)                                  \
    template <class T, std::size_t N>                                            \
    HWY_INLINE LaneMask<T, N> name(const Lanes<T, N>& a, const Lanes<T, N>& b) { \
        LaneMask<T, N> r;                                                        \
        ALHAZEN_UNROLL                                                           \
        for (std::size_t i = 0; i < kParts<T, N>; ++i) r.part[i] = expression;   \
        return r;                                                                \
    }

template <class T, std::size_t N>
HWY_INLINE auto bits_as_integers(const hn::Vec<LaneTag<T, N>>& a) {
    return hn::BitCast(hn::RebindToSigned<LaneTag<T, N>>(), a);
}

ALHAZEN_LANES_UNARY(operator-, hn::Neg(a.part[i]))
ALHAZEN_LANES_UNARY(abs, hn::Abs(a.part[i]))
ALHAZEN_LANES_UNARY(sqrt, hn::Sqrt(a.part[i]))
ALHAZEN_LANES_BINARY(operator+, hn::Add(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(operator-, hn::Sub(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(operator*, hn::Mul(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(operator/, hn::Div(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(copysign, hn::CopySign(a.part[i], b.part[i]))
/// Minimum and maximum; the result for a NaN operand differs between targets.
ALHAZEN_LANES_BINARY(min_lanes, hn::Min(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(max_lanes, hn::Max(a.part[i], b.part[i]))
/// Minimum and maximum as in <cmath>: a NaN operand is ignored.
ALHAZEN_LANES_BINARY(fmin, hn::IfThenElse(hn::IsNaN(a.part[i]), b.part[i],
                                          hn::IfThenElse(hn::IsNaN(b.part[i]), a.part[i],
                                                         hn::Min(a.part[i], b.part[i]))))
ALHAZEN_LANES_BINARY(fmax, hn::IfThenElse(hn::IsNaN(a.part[i]), b.part[i],
                                          hn::IfThenElse(hn::IsNaN(b.part[i]), a.part[i],
                                                         hn::Max(a.part[i], b.part[i]))))
ALHAZEN_LANES_COMPARE(operator<, hn::Lt(a.part[i], b.part[i]))
ALHAZEN_LANES_COMPARE(operator<=, hn::Le(a.part[i], b.part[i]))
ALHAZEN_LANES_COMPARE(operator>, hn::Gt(a.part[i], b.part[i]))
ALHAZEN_LANES_COMPARE(operator>=, hn::Ge(a.part[i], b.part[i]))

/// Maximum and minimum of floats without NaN, compared as integers, which takes one cycle instead
/// of four. Exact where one operand (for the maximum) or both (for the minimum) are at least +0;
/// otherwise one of the negative operands.
ALHAZEN_LANES_BINARY(larger_by_bits,
                     hn::BitCast(LaneTag<T, N>(), hn::Max(bits_as_integers<T, N>(a.part[i]),
                                                          bits_as_integers<T, N>(b.part[i]))))
ALHAZEN_LANES_BINARY(smaller_by_bits,
                     hn::BitCast(LaneTag<T, N>(), hn::Min(bits_as_integers<T, N>(a.part[i]),
                                                          bits_as_integers<T, N>(b.part[i]))))

#undef ALHAZEN_LANES_UNARY
#undef ALHAZEN_LANES_BINARY
#undef ALHAZEN_LANES_COMPARE

/// Fused where the target can: only for bounds whose margin covers either rounding.
#define ALHAZEN_LANES_FUSED(name, operation)                                \
    template <class T, std::size_t N>                                       \
    HWY_INLINE Lanes<T, N> name(const Lanes<T, N>& a, const Lanes<T, N>& b, \
                                const Lanes<T, N>& c) {                     \
        Lanes<T, N> r;                                                      \
        ALHAZEN_UNROLL                                                      \
        for (std::size_t i = 0; i < kParts<T, N>; ++i) {                    \
            r.part[i] = operation(a.part[i], b.part[i], c.part[i]);         \
        }                                                                   \
        return r;                                                           \
    }
ALHAZEN_LANES_FUSED(mul_add, hn::MulAdd)         ///< a b + c
ALHAZEN_LANES_FUSED(mul_sub, hn::MulSub)         ///< a b - c
ALHAZEN_LANES_FUSED(neg_mul_add, hn::NegMulAdd)  ///< c - a b
#undef ALHAZEN_LANES_FUSED

/// True if mul_add and its variants are fused; otherwise scalar code with std::fma gives other bits
/// than lanes.
#if (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2) || (HWY_ARCH_ARM_A64 && HWY_TARGET == HWY_NEON)
inline constexpr bool kFusesExactly = true;
#else
inline constexpr bool kFusesExactly = false;
#endif

/// a b - c d with the bits of `difference_of_products` (math/quadratic.h), where kFusesExactly.
template <std::size_t N>
HWY_INLINE Lanes<double, N> difference_of_products(const Lanes<double, N>& a,
                                                   const Lanes<double, N>& b,
                                                   const Lanes<double, N>& c,
                                                   const Lanes<double, N>& d) {
    const Lanes<double, N> cd = c * d;
    return mul_sub(a, b, cd) + neg_mul_add(c, d, cd);
}

/// Lane by lane: `yes` where the mask is set, else `no`.
template <class T, std::size_t N>
HWY_INLINE Lanes<T, N> select_lanes(const LaneMask<T, N>& mask, const Lanes<T, N>& yes,
                                    const Lanes<T, N>& no) {
    Lanes<T, N> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T, N>; ++i) {
        r.part[i] = hn::IfThenElse(mask.part[i], yes.part[i], no.part[i]);
    }
    return r;
}

/// Lane 0 is combine(combine(lane 0, lane 1), combine(lane 2, lane 3)) of a; lanes 1 to 3 are the
/// same of b, c and d.
template <class F>
HWY_INLINE Lanes<double, 4> combined_lanes(const Lanes<double, 4>& a, const Lanes<double, 4>& b,
                                           const Lanes<double, 4>& c, const Lanes<double, 4>& d,
                                           const F& combine) {
    Lanes<double, 4> r;
#if HWY_TARGET != HWY_SCALAR  // the scalar target has nothing to interleave
    if constexpr (kParts<double, 4> == 1) {
        const LaneTag<double, 4> tag;
        const auto ab = combine(hn::InterleaveLower(tag, a.part[0], b.part[0]),
                                hn::InterleaveUpper(tag, a.part[0], b.part[0]));
        const auto cd = combine(hn::InterleaveLower(tag, c.part[0], d.part[0]),
                                hn::InterleaveUpper(tag, c.part[0], d.part[0]));
        r.part[0] = combine(hn::ConcatLowerLower(tag, cd, ab), hn::ConcatUpperUpper(tag, cd, ab));
        return r;
    }
#endif
    // Transposes, then combines columns.
    HWY_ALIGN double rows[4][4], columns[4][4];
    store_lanes(a, rows[0]);
    store_lanes(b, rows[1]);
    store_lanes(c, rows[2]);
    store_lanes(d, rows[3]);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 4; ++k) columns[k][i] = rows[i][k];
    }
    const Lanes<double, 4> x = load_lanes<4>(columns[0]), y = load_lanes<4>(columns[1]);
    const Lanes<double, 4> z = load_lanes<4>(columns[2]), w = load_lanes<4>(columns[3]);
    for (std::size_t i = 0; i < kParts<double, 4>; ++i) {
        r.part[i] = combine(combine(x.part[i], y.part[i]), combine(z.part[i], w.part[i]));
    }
    return r;
}
/// Lanes 0 to 3 are the largest lanes of a, b, c and d. Precondition: no NaN.
HWY_INLINE Lanes<double, 4> largest_of_each(const Lanes<double, 4>& a, const Lanes<double, 4>& b,
                                            const Lanes<double, 4>& c, const Lanes<double, 4>& d) {
    return combined_lanes(a, b, c, d, [](auto x, auto y) { return hn::Max(x, y); });
}
/// Lanes 0 to 3 are the sums of the lanes of a, b, c and d.
HWY_INLINE Lanes<double, 4> sum_of_each(const Lanes<double, 4>& a, const Lanes<double, 4>& b,
                                        const Lanes<double, 4>& c, const Lanes<double, 4>& d) {
    return combined_lanes(a, b, c, d, [](auto x, auto y) { return hn::Add(x, y); });
}

template <class T, std::size_t N>
HWY_INLINE LaneMask<T, N> operator|(const LaneMask<T, N>& a, const LaneMask<T, N>& b) {
    LaneMask<T, N> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T, N>; ++i) r.part[i] = hn::Or(a.part[i], b.part[i]);
    return r;
}
template <class T, std::size_t N>
HWY_INLINE LaneMask<T, N> operator&(const LaneMask<T, N>& a, const LaneMask<T, N>& b) {
    LaneMask<T, N> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T, N>; ++i) r.part[i] = hn::And(a.part[i], b.part[i]);
    return r;
}

template <class T, std::size_t N>
HWY_INLINE LaneMask<T, N> operator!(const LaneMask<T, N>& a) {
    LaneMask<T, N> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T, N>; ++i) r.part[i] = hn::Not(a.part[i]);
    return r;
}

/// The mask as bits: bit i is lane i.
template <class T, std::size_t N>
HWY_INLINE std::uint32_t bits_of(const LaneMask<T, N>& a) {
    const LaneTag<T, N> d;
    std::uint32_t bits = 0;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T, N>; ++i) {
        std::uint8_t byte[8] = {};  // Highway may write a whole word
        hn::StoreMaskBits(d, a.part[i], byte);
        std::uint32_t part = byte[0];
        if constexpr (hn::MaxLanes(LaneTag<T, N>()) > 8) {
            if constexpr (std::endian::native == std::endian::little) {
                std::uint16_t both;  // as one word: compilers combine bytes one by one
                std::memcpy(&both, byte, sizeof(both));
                part = both;
            } else {
                part |= std::uint32_t{byte[1]} << 8;
            }
        }
        bits |= part << (i * hn::Lanes(d));
    }
    return bits;
}

/// The mask whose lane i is set where bit i is.
template <class T, std::size_t N = kLaneCount>
HWY_INLINE LaneMask<T, N> lanes_of_bits(std::uint32_t bits) {
    const LaneTag<T, N> d;
    LaneMask<T, N> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T, N>; ++i) {
        const std::uint32_t part = bits >> (i * hn::Lanes(d));
        std::uint8_t bytes[8] = {};  // Highway may read a whole word
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(bytes, &part, sizeof(part));
        } else {
            bytes[0] = static_cast<std::uint8_t>(part);
            bytes[1] = static_cast<std::uint8_t>(part >> 8);
        }
        r.part[i] = hn::LoadMaskBits(d, bytes);
    }
    return r;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard, toggled for every target
