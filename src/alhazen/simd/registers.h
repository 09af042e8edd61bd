#pragma once
/// 128-bit vector types of the compiler, for code compiled once for all instruction sets.

#include <cstdint>

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace alhazen {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Double2 = double __attribute__((vector_size(16)));

/// Lane by lane a < b ? a : b and a > b ? a : b, as one instruction, which compilers generate for
/// these expressions only where they may ignore NaN.
inline Float4 lesser(Float4 a, Float4 b) {
#ifdef __SSE2__
    return _mm_min_ps(a, b);
#else
    return a < b ? a : b;
#endif
}
inline Float4 greater(Float4 a, Float4 b) {
#ifdef __SSE2__
    return _mm_max_ps(a, b);
#else
    return a > b ? a : b;
#endif
}
inline Double2 lesser(Double2 a, Double2 b) {
#ifdef __SSE2__
    return _mm_min_pd(a, b);
#else
    return a < b ? a : b;
#endif
}
inline Double2 greater(Double2 a, Double2 b) {
#ifdef __SSE2__
    return _mm_max_pd(a, b);
#else
    return a > b ? a : b;
#endif
}

}  // namespace alhazen
