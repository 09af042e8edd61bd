#include <algorithm>

#include "alhazen/scene/compile_materials.h"
#include "alhazen/scene/geometry_compiler.h"
#include "alhazen/scene/scene.h"

namespace alhazen {

Scene compile_without_geometry(const SceneDescription& description) {
    Scene scene;
    compile_materials(description, scene);
    scene.all_opaque =
        std::all_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return opacity_of(m) == Opacity::Opaque; });
    scene.has_scattering =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& m) { return !m.scattering.coefficient.is_black(); });
    scene.census.texture_bytes = texture_bytes(scene.textures);
    scene.census.scene_bytes = scene.census.texture_bytes;
    return scene;
}

void build_aggregate(const SceneDescription& description, const CompileOptions& options,
                     Scene& scene) {
    GeometryCompiler(description, options, nullptr).build(scene);
}

void build_aggregate_taking_meshes(SceneDescription& description, const CompileOptions& options,
                                   Scene& scene) {
    GeometryCompiler(description, options, &description.meshes).build(scene);
}

Scene compile(const SceneDescription& description, const CompileOptions& options) {
    Scene scene = compile_without_geometry(description);
    build_aggregate(description, options, scene);
    return scene;
}

Scene compile_taking_meshes(SceneDescription& description, const CompileOptions& options) {
    Scene scene = compile_without_geometry(description);
    build_aggregate_taking_meshes(description, options, scene);
    return scene;
}

}  // namespace alhazen
