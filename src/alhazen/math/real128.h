#pragma once
/// A number with 113 bits, to check what was computed with 53.
///
/// Source: IEEE 754-2008, binary128. Differs: the compiler's own arithmetic; the square root is
/// Newton's from that of double. Conventions: slow (software), used by checks only.

#include <cmath>

namespace alhazen {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Real128;  // the extension is named, so that -Wpedantic lets it be
#else
using Real128 = long double;
static_assert(sizeof(long double) == 16);
#endif

/// Of a number within the range of double; 0 for what is not positive.
inline Real128 square_root(Real128 x) {
    if (!(x > 0)) return 0;
    Real128 y = std::sqrt(static_cast<double>(x));
    if (!(y > 0)) return 0;
    // Each step doubles the digits that are right.
    for (int i = 0; i < 3; ++i) y = (y + x / y) / 2;
    return y;
}

}  // namespace alhazen
