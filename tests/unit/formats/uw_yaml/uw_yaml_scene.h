#pragma once
/// Short scenes of the course.

#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "alhazen/scene_model/scene_description.h"

namespace alhazen::testing {

inline const std::string kCourseMaterials = R"(
Materials:
    Red One:
        Shader: Blinn-Phong Shader
        Uniforms:
            Diffuse: {Color: {R: 0.75, G: 0, B: 5e-05, A: 1}, Color Map: "", Use Texture: false}
            Specular: {Color: {R: 0.5, G: 0.25, B: 0.125, A: 1}, Color Map: "", Use Texture: false}
            Emissive: {Color: {R: 0.01, G: 0, B: 0, A: 1}, Color Map: "", Use Texture: false}
            Transmittence: {Color: {R: 0, G: 0.9, B: 0, A: 1}, Color Map: "", Use Texture: false}
            Shininess: 25.6
            IndexOfRefraction: 1.5
)";

/// A scene whose root has `components` (lines indented by 8) and `children` (by 4).
inline std::string course_scene(const std::string& components,
                                const std::string& children = "    []\n") {
    return "Name: test" + kCourseMaterials +
           "Root:\n    Name: Root\n    Enabled: true\n    Components:\n" + components +
           "    Children:\n" + children;
}

template <class S>
const S& shape_of(const SceneDescription& scene, std::size_t part) {
    return std::get<S>(std::get<AnyShape>(scene.objects.at(0).parts.at(part).what));
}

inline void expect_point(const Vec3& p, const Vec3& expected) {
    EXPECT_NEAR(length(p - expected), 0.0, 1e-12)
        << p.x << " " << p.y << " " << p.z << " instead of " << expected.x << " " << expected.y
        << " " << expected.z;
}

}  // namespace alhazen::testing
