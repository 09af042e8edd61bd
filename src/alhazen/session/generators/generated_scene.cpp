#include "alhazen/session/generators/generated_scene.h"

#include <utility>

#include "alhazen/math/constants.h"

namespace alhazen {

SceneDescription generated_scene(const GeneratedView& view) {
    SceneDescription scene;
    scene.format = "generated";
    scene.up_axis = UpAxis::Z;
    scene.cameras.push_back({"main",
                             look_along(view.eye, view.target - view.eye, {0, 0, 1},
                                        view.fov_deg * kRadiansPerDegree, 1.0),
                             1.0,
                             {}});
    scene.lights.push_back({"sky", AmbientLight{{0.25, 0.25, 0.25}}, {}});
    scene.lights.push_back(
        {"sun", DirectionalLight{.to_light = {0.3, -0.5, 0.8}, .color = {0.8, 0.8, 0.75}}, {}});
    scene.picture = {512, 512, Rgb{0.02, 0.02, 0.05}};
    scene.objects.push_back({"scene", {}, {}});
    return scene;
}

MaterialId add_material(SceneDescription& scene, const char* name, const Rgb& color) {
    Material material;
    material.name = name;
    material.diffuse.color = material.ambient.color = color;
    scene.materials.push_back({material, {}});
    return MaterialId(scene.materials.size() - 1);
}

ObjectIndex add_object(SceneDescription& scene, const char* name) {
    scene.objects.push_back({name, {}, {}});
    return ObjectIndex(scene.objects.size() - 1);
}

MeshIndex add_mesh(SceneDescription& scene, const char* name, TriangleMesh mesh) {
    scene.meshes.push_back({name, std::make_shared<TriangleMesh>(std::move(mesh)), {}});
    return MeshIndex(scene.meshes.size() - 1);
}

Part part_of(AnyShape shape, MaterialId material) {
    Part part;
    part.what = std::move(shape);
    part.material = material;
    return part;
}

Part part_of(MeshIndex mesh, MaterialId material) {
    Part part;
    part.what = mesh;
    part.material = material;
    return part;
}

Part part_of(ObjectIndex object, const Affine& outer_from_object) {
    Part part;
    part.what = object;
    part.object_from_part = outer_from_object;
    return part;
}

}  // namespace alhazen
