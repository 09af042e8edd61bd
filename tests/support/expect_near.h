#pragma once
/// Comparison of vectors and colours by components.

#include <gtest/gtest.h>

#include "alhazen/imaging/image/rgb.h"
#include "alhazen/math/vec.h"

namespace alhazen::testing {

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
    EXPECT_NEAR(a.x, b.x, tolerance);
    EXPECT_NEAR(a.y, b.y, tolerance);
    EXPECT_NEAR(a.z, b.z, tolerance);
}
inline void expect_near(const Rgb& a, const Rgb& b, double tolerance = 1e-12) {
    EXPECT_NEAR(a.r, b.r, tolerance);
    EXPECT_NEAR(a.g, b.g, tolerance);
    EXPECT_NEAR(a.b, b.b, tolerance);
}

}  // namespace alhazen::testing
