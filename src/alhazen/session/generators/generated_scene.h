#pragma once
/// Common parts of generated native scenes: a camera, a sun, a pale sky.

#include "alhazen/scene_model/scene_description.h"

namespace alhazen {

struct GeneratedView {
    Vec3 eye, target;
    double fov_deg = 40;  ///< both directions; the image is square
};

/// A scene without materials whose root is an object without parts. z is up; 512 x 512 pixels.
[[nodiscard]] SceneDescription generated_scene(const GeneratedView& view);

/// Adds a diffuse material and returns its id.
MaterialId add_material(SceneDescription& scene, const char* name, const Rgb& color);

/// Adds an object without parts; its index stays valid.
ObjectIndex add_object(SceneDescription& scene, const char* name);

MeshIndex add_mesh(SceneDescription& scene, const char* name, TriangleMesh mesh);

[[nodiscard]] Part part_of(AnyShape shape, MaterialId material);
[[nodiscard]] Part part_of(MeshIndex mesh, MaterialId material);
[[nodiscard]] Part part_of(ObjectIndex object, const Affine& outer_from_object);

}  // namespace alhazen
