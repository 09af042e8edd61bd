#pragma once
/// Points of surfaces as paths from any direction find them.

#include <gtest/gtest.h>

#include "alhazen/renderers/light_transport/scatter_point.h"
#include "alhazen/scene/scene.h"

namespace alhazen::testing {

/// Sets the point of the scene at (0.1, 0.2, 0), seen from the direction `view`.
inline void set_scatter_point(const Scene& scene, const Vec3& view, ScatterPoint& scatter,
                              BsdfCache* known = nullptr) {
    const Ray ray{Vec3{0.1, 0.2, 0} + 5 * view, -view};
    Hit hit;
    ASSERT_TRUE(scene.aggregate->closest(ray, hit, {nullptr}));
    ShadingPoint point;
    set_shading_point(scene, ray, hit, {.meets_backs = true}, {}, point);
    scatter.set(scene, point, {}, kColorChannels, true, known);
}

}  // namespace alhazen::testing
