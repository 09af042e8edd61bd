#pragma once
/// Points of one surface seen from both ends of a path.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "alhazen/renderers/light_transport/scatter_point.h"

namespace alhazen::testing {

inline void expect_close(double a, double b, const std::string& what) {
    EXPECT_NEAR(a, b, 1e-9 * std::max(std::abs(a), std::abs(b)) + 1e-12) << what;
}

/// Expects that light is scattered alike in whichever direction a path goes, and that each density
/// is known from both sides; the geometric normal is z. `eye` and `light` are the point as seen
/// from there. Returns the value that the eye sees.
inline double expect_both_directions_agree(const ScatterPoint& eye, const Vec3& to_eye,
                                           const ScatterPoint& light, const Vec3& to_light,
                                           const std::string& what) {
    const double seen = eye.value(to_light, Transport::Radiance).a;
    // Importance has the geometric cosines of both sides.
    const double sent = light.value(to_eye, Transport::Importance).a *
                        light.importance_correction(to_eye) * std::abs(to_light.z / to_eye.z);
    expect_close(seen, sent, what + " value");
    expect_close(eye.density(to_light), light.reverse_density(to_eye),
                 what + " density from the eye");
    expect_close(light.density(to_eye), eye.reverse_density(to_light),
                 what + " density from the light");
    return seen;
}

}  // namespace alhazen::testing
