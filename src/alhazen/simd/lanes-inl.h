/// Eight lanes of float or double with the operators of a scalar: what the templates of geometry/
/// need to run on a block of eight primitives, and the node test on eight children.
///
/// A block is one AVX-512 register of double, two of AVX, four of SSE. Every operation is the
/// correctly rounded IEEE one and nothing is fused unless `mul_add` is called, so each lane has
/// the bits of the scalar form on every target.
/// Conventions: included once per target, by the pattern of Highway's foreach_target.h;
/// everything is in HWY_NAMESPACE and must not escape from it.

#if defined(ALHAZEN_SIMD_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef ALHAZEN_SIMD_LANES_INL_H_
#undef ALHAZEN_SIMD_LANES_INL_H_
#else
#define ALHAZEN_SIMD_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

// Loops over parts vanish, except in plain C++, where eight copies of everything only take long to
// compile.
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

template <class T>
using LaneTag = hn::CappedTag<T, kLaneCount>;

/// Registers in a block.
template <class T>
inline constexpr std::size_t kParts = kLaneCount / hn::MaxLanes(LaneTag<T>());

template <class T>
struct LaneMask {
    hn::Mask<LaneTag<T>> part[kParts<T>];
};

template <class T>
struct Lanes {
    hn::Vec<LaneTag<T>> part[kParts<T>];

    Lanes() = default;
    /// All lanes the same.
    HWY_INLINE explicit Lanes(T value) {
        for (std::size_t i = 0; i < kParts<T>; ++i) part[i] = hn::Set(LaneTag<T>(), value);
    }
};

using Doubles = Lanes<double>;
using Floats = Lanes<float>;

/// `values` is aligned to a block (64 bytes for double, 32 for float).
template <class T>
HWY_INLINE Lanes<T> load_lanes(const T* values) {
    Lanes<T> r;
    const LaneTag<T> d;
    for (std::size_t i = 0; i < kParts<T>; ++i) r.part[i] = hn::Load(d, values + i * hn::Lanes(d));
    return r;
}
template <class T>
HWY_INLINE void store_lanes(const Lanes<T>& a, T* values) {
    const LaneTag<T> d;
    for (std::size_t i = 0; i < kParts<T>; ++i) hn::Store(a.part[i], d, values + i * hn::Lanes(d));
}

#define ALHAZEN_LANES_UNARY(name, expression)                               \
    template <class T>                                                      \
    HWY_INLINE Lanes<T> name(const Lanes<T>& a) {                           \
        Lanes<T> r;                                                         \
        ALHAZEN_UNROLL                                                      \
        for (std::size_t i = 0; i < kParts<T>; ++i) r.part[i] = expression; \
        return r;                                                           \
    }
#define ALHAZEN_LANES_BINARY(name, expression)                              \
    template <class T>                                                      \
    HWY_INLINE Lanes<T> name(const Lanes<T>& a, const Lanes<T>& b) {        \
        Lanes<T> r;                                                         \
        ALHAZEN_UNROLL                                                      \
        for (std::size_t i = 0; i < kParts<T>; ++i) r.part[i] = expression; \
        return r;                                                           \
    }
#define ALHAZEN_LANES_COMPARE(name, expression)                             \
    template <class T>                                                      \
    HWY_INLINE LaneMask<T> name(const Lanes<T>& a, const Lanes<T>& b) {     \
        LaneMask<T> r;                                                      \
        ALHAZEN_UNROLL                                                      \
        for (std::size_t i = 0; i < kParts<T>; ++i) r.part[i] = expression; \
        return r;                                                           \
    }

ALHAZEN_LANES_UNARY(operator-, hn::Neg(a.part[i]))
ALHAZEN_LANES_UNARY(sqrt, hn::Sqrt(a.part[i]))
ALHAZEN_LANES_BINARY(operator+, hn::Add(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(operator-, hn::Sub(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(operator*, hn::Mul(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(operator/, hn::Div(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(copysign, hn::CopySign(a.part[i], b.part[i]))
/// The smaller and the larger; which of them comes out for a NaN operand differs between targets.
ALHAZEN_LANES_BINARY(min_lanes, hn::Min(a.part[i], b.part[i]))
ALHAZEN_LANES_BINARY(max_lanes, hn::Max(a.part[i], b.part[i]))
/// As in <cmath>: a NaN operand is dropped.
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

#undef ALHAZEN_LANES_UNARY
#undef ALHAZEN_LANES_BINARY
#undef ALHAZEN_LANES_COMPARE

/// a b + c, fused where the target can: only for bounds that carry slack for either rounding.
template <class T>
HWY_INLINE Lanes<T> mul_add(const Lanes<T>& a, const Lanes<T>& b, const Lanes<T>& c) {
    Lanes<T> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T>; ++i) {
        r.part[i] = hn::MulAdd(a.part[i], b.part[i], c.part[i]);
    }
    return r;
}

template <class T>
HWY_INLINE LaneMask<T> operator|(const LaneMask<T>& a, const LaneMask<T>& b) {
    LaneMask<T> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T>; ++i) r.part[i] = hn::Or(a.part[i], b.part[i]);
    return r;
}
template <class T>
HWY_INLINE LaneMask<T> operator&(const LaneMask<T>& a, const LaneMask<T>& b) {
    LaneMask<T> r;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T>; ++i) r.part[i] = hn::And(a.part[i], b.part[i]);
    return r;
}

/// Bit i for lane i.
template <class T>
HWY_INLINE std::uint32_t bits_of(const LaneMask<T>& a) {
    const LaneTag<T> d;
    std::uint32_t bits = 0;
    ALHAZEN_UNROLL
    for (std::size_t i = 0; i < kParts<T>; ++i) {
        std::uint8_t byte[8] = {};  // Highway may write a whole word
        hn::StoreMaskBits(d, a.part[i], byte);
        bits |= static_cast<std::uint32_t>(byte[0]) << (i * hn::Lanes(d));
    }
    return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace alhazen
HWY_AFTER_NAMESPACE();

#endif  // include guard that opens again for every target
