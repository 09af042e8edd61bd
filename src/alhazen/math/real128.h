#pragma once
/// Numbers with 113-bit significands, for checking results computed with 53 bits.
///
/// Source: IEEE 754-2008, binary128.
/// Differs: uses the compiler's arithmetic; the square root is Newton's method from the square root
/// in double.
/// Conventions: slow (software), for checks only.

#include <cmath>

namespace alhazen {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Real128;  // __extension__: accepted by -Wpedantic
#else
using Real128 = long double;
static_assert(sizeof(long double) == 16);
#endif

/// The square root of a number within the range of double; 0 if x is not positive.
inline Real128 square_root(Real128 x) {
    if (!(x > 0)) return 0;
    Real128 y = std::sqrt(static_cast<double>(x));
    if (!(y > 0)) return 0;
    // Each step doubles the number of correct digits.
    for (int i = 0; i < 3; ++i) y = (y + x / y) / 2;
    return y;
}

}  // namespace alhazen
