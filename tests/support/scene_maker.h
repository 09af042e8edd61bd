#pragma once
/// Builder of small scene descriptions for tests.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "alhazen/scene/scene.h"

namespace alhazen::testing {

/// Adds parts to one root object; objects made by `object` can be instanced.
class SceneMaker {
  public:
    SceneMaker() {
        description_.objects.push_back({"root", {}, {}});
        description_.format = "test";
        CameraDescription camera;
        camera.camera = look_along({0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 0.7, 1.0);
        description_.cameras.push_back(camera);
        description_.conventions.shading.ambient_inside_times_kt = false;
        description_.conventions.shading.air_index = 1.0;
    }

    SceneDescription& description() { return description_; }

    MaterialId material(Material m) {
        description_.materials.push_back({std::move(m), {}});
        return MaterialId{static_cast<std::uint32_t>(description_.materials.size() - 1)};
    }
    void light(Light l) { description_.lights.push_back({"", l, {}}); }

    ObjectIndex object(const std::string& name) {
        description_.objects.push_back({name, {}, {}});
        return ObjectIndex{static_cast<std::uint32_t>(description_.objects.size() - 1)};
    }
    template <class What>
    void add(What what, MaterialId material = MaterialId{0}, const Affine& placement = {},
             ObjectIndex owner = ObjectIndex{0}) {
        Part part;
        if constexpr (requires { AnyShape{what}; }) {
            part.what = AnyShape{std::move(what)};
        } else {
            part.what = what;
        }
        part.object_from_part = placement;
        part.material = material;
        description_.objects[static_cast<std::size_t>(owner)].parts.push_back(std::move(part));
    }
    MeshIndex mesh(TriangleMesh m) {
        description_.meshes.push_back({"", std::make_shared<TriangleMesh>(std::move(m)), {}});
        return MeshIndex{static_cast<std::uint32_t>(description_.meshes.size() - 1)};
    }

    /// Validates and compiles the scene; a finding fails the test.
    [[nodiscard]] Scene compile(const std::string& accelerator = "list") {
        if (description_.materials.empty()) material({});
        Diagnostics diagnostics;
        validate(description_, diagnostics);
        for (const Diagnostic& d : diagnostics.all()) {
            EXPECT_NE(d.severity, Severity::Error) << to_string(d);
        }
        return alhazen::compile(description_, {.accelerator = accelerator});
    }

  private:
    SceneDescription description_;
};

/// A closed tetrahedron around the origin, counter-clockwise from outside.
inline TriangleMesh tetrahedron() {
    TriangleMesh mesh;
    mesh.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    return mesh;
}

}  // namespace alhazen::testing
