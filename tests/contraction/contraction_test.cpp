/// Fails when the compiler fuses a product and a sum into one rounding.
///
/// The watertight triangle test and the ordered roots need that a * b - c * d is antisymmetric when
/// the products are swapped; a fused one rounds the two products differently. Plain program, so
/// that it can be compiled with the flags of the project and, as a proof that it notices, with
/// fusing allowed. Exit status: 0 nothing is fused, 1 something is, 77 the processor cannot run
/// this build.

#include <cstdio>

#include "alhazen/math/vec.h"

namespace {

int failures = 0;

void expect_equal(const char* what, double found, double expected) {
    if (found == expected) return;
    std::printf("%s: found %a, expected %a: the compiler fuses\n", what, found, expected);
    ++failures;
}

/// A value that the compiler must not compute with in advance.
template <class T>
T opaque(T value) {
    volatile T hidden = value;
    return hidden;
}

template <class T>
T difference_of_products(T a, T b, T c, T d) {
    return a * b - c * d;
}

}  // namespace

int main() {
#if defined(__x86_64__) && defined(__FMA__)
    if (!__builtin_cpu_supports("fma")) return 77;
#endif
    // (1 + h)^2 = 1 + 2 h + h^2, and h^2 is lost when the product is rounded.
    const double x = opaque(1 + 0x1p-30), square = opaque(1 + 0x1p-29);
    expect_equal("a * b - c * d", difference_of_products(x, x, opaque(x), opaque(x)), 0);
    expect_equal("a * b + c", x * opaque(x) + -square, 0);
    expect_equal("c - a * b", square - opaque(x) * x, 0);
    const float y = opaque(1 + 0x1p-13f);
    expect_equal("float a * b - c * d", double(difference_of_products(y, y, opaque(y), opaque(y))),
                 0);
    const alhazen::Vec3 a{x, opaque(x), opaque(x)}, b{opaque(x), opaque(x), opaque(x)};
    const alhazen::Vec3 v = alhazen::cross(a, b);
    expect_equal("cross x", v.x, 0);
    expect_equal("cross y", v.y, 0);
    expect_equal("cross z", v.z, 0);
    return failures == 0 ? 0 : 1;
}
